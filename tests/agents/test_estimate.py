"""The filter is Bayes' rule: held against the enumeration of everything that can have happened."""

from itertools import product

import pytest

from hrcplan.agents.estimate import AgentStateEstimate, Cause, Prior
from hrcplan.agents.profile import load_profile
from hrcplan.agents.state import AgentModel
from hrcplan.pddl.inputs import read
from hrcplan.pddl.model import FluentKey

A, B, C = ("motivation", "human"), ("capacity", "human", "here"), ("capacity", "human", "there")
PRIOR = Prior({A: 1, B: 1, C: 4}, changed=0.3, hazard=0.2, lasting=0.6, slip=0.05,
              levels=(1, 2, 5, 8))  # fmt: skip
HERE, THERE, NOWHERE = (A, B), (A, C), ()
Seen = tuple[tuple[FluentKey, ...], bool]


def after(seen: tuple[Seen, ...], prior: Prior = PRIOR) -> AgentStateEstimate:
    found = AgentStateEstimate.begin(prior)
    for touched, failure in seen:
        found = found.failed(touched) if failure else found.went_well(touched)
    return found


def world(key: FluentKey, level: int, lasting: bool, strikes: bool) -> float:
    """Return the prior probability of one world, written out."""
    of_function = {A: 1, B: 2, C: 2}[key]
    n_levels = {A: 3, B: 3, C: 2}[key]  # those above the low value
    p = 1 / 2 / of_function / n_levels
    if not lasting:
        return p * (1 - PRIOR.lasting) if strikes else 0.0
    return p * PRIOR.lasting * (level / 10 if strikes else 1 - level / 10)


def enumerated(seen: tuple[Seen, ...]) -> tuple[dict[FluentKey, float], dict[FluentKey, float]]:
    """Return for each element how likely it has changed, and how likely it strikes next."""
    total, changed, strikes_next = 0.0, dict.fromkeys((A, B, C), 0.0), dict.fromkeys((A, B, C), 0.0)
    times = [*range(len(seen) + 1), None]  # 0: at the start; i: before observation i; None: never
    levels = {A: (2, 5, 8), B: (2, 5, 8), C: (5, 8)}
    worlds = [(k, v, lasting, s) for k in levels for v in levels[k]
              for lasting, s in product((True, False), repeat=2)]  # fmt: skip
    for time in times:
        none = 1.0 - PRIOR.changed
        p_time = PRIOR.changed if time == 0 else none * (1 - PRIOR.hazard) ** (
            len(seen) if time is None else time - 1
        ) * (1 if time is None else PRIOR.hazard)  # fmt: skip
        for key, level, lasting, strikes in worlds if time is not None else [(A, 2, True, False)]:
            p = p_time * (1.0 if time is None else world(key, level, lasting, strikes))
            for i, (touched, failure) in enumerate(seen, start=1):
                on = time is not None and i >= time and key in touched
                chance = (float(strikes) if lasting else level / 10) if on else 0.0
                well = (1 - PRIOR.slip) * (1 - chance)
                p *= 1 - well if failure else well
            total += p
            if time is not None:
                changed[key] += p
                strikes_next[key] += p * (float(strikes) if lasting else level / 10)
    return ({k: p / total for k, p in changed.items()},
            {k: p / total for k, p in strikes_next.items()})  # fmt: skip


@pytest.mark.parametrize("seen", [
    *product(product((HERE, THERE), (True, False)), repeat=2),
    ((HERE, False), (THERE, True), (THERE, True), (HERE, False), (THERE, False)),
    ((HERE, True), (HERE, True), (HERE, False), (THERE, True)),
])  # fmt: skip
def test_the_filter_equals_enumeration(seen: tuple[Seen, ...]) -> None:
    changed, strikes = enumerated(seen)
    found = after(seen)
    for key in (A, B, C):
        assert sum(found.levels(key).values()) == pytest.approx(changed[key], abs=1e-12)
        assert found.failing().get(key, 0) == pytest.approx(strikes[key], abs=1e-12)


def test_before_anything_is_observed_it_is_the_prior() -> None:
    found = AgentStateEstimate.begin(PRIOR)
    assert sum(PRIOR.causes.values()) == pytest.approx(1)
    assert found.weights.sum() == pytest.approx(PRIOR.changed)
    assert sum(found.levels(C).values()) == pytest.approx(PRIOR.changed / 4)


def test_who_fails_once_is_believed_to_have_changed_much() -> None:
    before, later = AgentStateEstimate.begin(PRIOR).levels(A), after(((HERE, True),)).levels(A)
    assert later[8] / later[2] > before[8] / before[2]


def test_what_nobody_touches_says_nothing() -> None:
    assert after(((NOWHERE, True),)) == AgentStateEstimate.begin(PRIOR)


def test_what_is_sensed_needs_no_estimate() -> None:
    found = after(((HERE, True),)).sensed(A)
    assert A not in found.failed(HERE).failing()
    assert found.failing()[B] > after(((HERE, True),)).failing()[B]


def test_a_cause_names_its_element() -> None:
    cause: Cause = next(iter(PRIOR.causes))
    assert cause[0] in PRIOR.lows


def test_what_is_told_is_the_price_of_failing_of_whatever_comes_next() -> None:
    """One thing causes it, so the chances of what an action touches add up."""
    model = AgentModel(read("transport", "two-boxes"))
    told_by = load_profile("estimated")
    belief = told_by.begin(model).failed(model.touching("move", ("human", "wp1", "wp4")))
    told = told_by.planner_values(model, {}, belief)
    p = belief.failing()
    for place in ("wp4", "wp2"):
        keys = [("motivation", "human"), ("knowledge", "human"), ("capacity", "human", place)]
        excess = sum(float(told[key] - model.low[key]) for key in keys)
        chance = sum(p[key] for key in keys if key in belief.blame())
        assert 1 - 2.718281828459045 ** (-excess / 10) == pytest.approx(chance, abs=2e-3)
    assert told[("motivation", "robot")] == model.low[("motivation", "robot")]
