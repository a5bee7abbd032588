"""Random small domains: every reachable state against the lifted reading, and laws of the task."""

from __future__ import annotations

from collections import deque
from fractions import Fraction
from typing import Any

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from hrcplan.errors import UnsupportedError
from hrcplan.pddl.model import (
    DURATION,
    Action,
    And,
    Arithmetic,
    Atom,
    Compare,
    Condition,
    Constant,
    Domain,
    Effect,
    Equal,
    Expr,
    Formula,
    Function,
    Not,
    Or,
    Param,
    Problem,
    Quantified,
    Signature,
)
from hrcplan.task import Task
from tests.task.test_batch import compare as compare_batch

MAX_STATES = 25
THING, AGENT = ("thing",), ("agent",)
X, A, Z = Param("?x", THING), Param("?a", AGENT), Param("?z", ("thing", "agent"))
PREDICATES = {
    "p": Signature("p", (Z,)),
    "q": Signature("q", (Z, Z)),
    "r": Signature("r", ()),
    "fixed": Signature("fixed", (Z,)),
}
FUNCTIONS = {
    "total-cost": Signature("total-cost", ()),
    "mood": Signature("mood", (A,)),
    "price": Signature("price", (Z,)),
}
OBJECTS = {"one": "thing", "two": "thing", "ann": "agent", "bob": "agent"}
NUMBERS = st.sampled_from([0, 1, 2, 3, Fraction(1, 2)])


def atoms(terms: list[str], *, changing: bool = False) -> st.SearchStrategy[Atom]:
    term = st.sampled_from(terms)
    kinds = [
        st.just(Atom("r", ())),
        st.builds(lambda t: Atom("p", (t,)), term),
        st.builds(lambda s, t: Atom("q", (s, t)), term, term),
    ]
    if not changing:
        kinds.append(st.builds(lambda t: Atom("fixed", (t,)), term))
    return st.one_of(kinds)


def amounts(terms: list[str], agents: list[str], signs: str = "+-*/") -> st.SearchStrategy[Expr]:
    leaf: st.SearchStrategy[Expr] = st.one_of(
        NUMBERS.map(Constant),
        st.sampled_from(terms).map(lambda t: Function("price", (t,))),
        st.sampled_from(agents).map(lambda t: Function("mood", (t,))),
    )
    sums = st.builds(lambda o, a, b: Arithmetic(o, (a, b)), st.sampled_from(signs), leaf, leaf)
    return st.one_of(leaf, leaf, sums)


def formulas(terms: list[str], agents: list[str], depth: int = 2) -> st.SearchStrategy[Formula]:
    leaf: st.SearchStrategy[Formula] = st.one_of(
        atoms(terms),
        atoms(terms).map(Not),
        st.builds(Equal, st.sampled_from(terms), st.sampled_from(terms)),
        st.builds(
            Compare,
            st.sampled_from(["<", "<=", "=", ">=", ">"]),
            st.sampled_from(agents).map(lambda t: Function("mood", (t,))),
            amounts(terms, agents, "+-*"),  # no division by zero: the readings differ there
        ),
    )
    if depth == 0:
        return leaf
    inner = formulas(terms, agents, depth - 1)
    wider = formulas([*terms, "?z"], agents, depth - 1)
    parts = st.lists(inner, min_size=0, max_size=2).map(tuple)
    quantified = st.builds(lambda u, body: Quantified(u, (Z,), body), st.booleans(), wider)
    return st.one_of(leaf, inner.map(Not), parts.map(And), parts.map(Or), quantified)


@st.composite
def effects(draw: st.DrawFn, terms: list[str], agents: list[str], whens: list[str]) -> Effect:
    when = draw(st.sampled_from(whens))
    kind = draw(st.sampled_from(["add", "add", "delete", "cost", "mood"]))
    if kind == "cost":
        return Effect(when, "increase", Function("total-cost"), draw(amounts(terms, agents)))
    given = draw(st.one_of(st.just(And()), st.just(And()), formulas(terms, agents, 1)))
    if kind == "mood":
        # Halving and doubling would never end; what is assigned stays among few numbers.
        verb = draw(st.sampled_from(["assign", "assign", "decrease"]))
        target = Function("mood", (draw(st.sampled_from(agents)),))
        return Effect(when, verb, target, Constant(draw(NUMBERS)), (), given)
    for_all = draw(st.booleans())
    atom = draw(atoms([*terms, "?z"] if for_all else terms, changing=True))
    return Effect(when, kind, atom, None, (Z,) if for_all else (), given)


@st.composite
def actions(draw: st.DrawFn, name: str) -> Action:
    params = draw(st.sampled_from([(), (A,), (A, X), (X,), (A, Param("?b", AGENT)), (Z,)]))
    terms = [p.name for p in params] + ["one", "ann"]
    agents = [p.name for p in params if p.types == AGENT] + ["ann"]
    durative = draw(st.booleans())
    phases = ["start", "all", "end"] if durative else ["start"]
    made = st.builds(Condition, st.sampled_from(phases), formulas(terms, agents))
    conditions = tuple(draw(st.lists(made, max_size=3)))
    moments = ["start", "end"] if durative else ["start"]
    changes = tuple(draw(st.lists(effects(terms, agents, moments), min_size=1, max_size=4)))
    if not durative:
        return Action(name, params, conditions, changes)
    fixed = draw(amounts(terms, agents))
    if draw(st.booleans()):
        paid = Arithmetic("*", (Function(DURATION), Constant(2)))
        changes += (Effect("end", "increase", Function("total-cost"), paid),)
    return Action(name, params, conditions, changes, True, (("=", fixed),))


@st.composite
def problems(draw: st.DrawFn) -> Problem:
    made = tuple(draw(actions(f"act-{i}")) for i in range(draw(st.integers(1, 3))))
    priced = Effect("start", "increase", Function("total-cost"), Function("mood", ("?a",)))
    domain = Domain(
        "random",
        types={"thing": ("object",), "agent": ("object",)},
        predicates=PREDICATES,
        functions=FUNCTIONS,
        # Its cost makes (mood …) an agent state, whatever the others do.
        actions=(*made, Action("pay", (A,), (), (Effect("start", "add", Atom("r", ())), priced))),
    )
    universe = [("r",), *(("p", o) for o in OBJECTS), *(("fixed", o) for o in OBJECTS)]
    universe += [("q", o, p) for o in OBJECTS for p in OBJECTS]
    facts = frozenset(draw(st.lists(st.sampled_from(universe), max_size=8)))
    values = {("mood", agent): draw(NUMBERS) for agent in ("ann", "bob")}
    values |= {("price", o): draw(NUMBERS) for o in OBJECTS}
    goal = draw(formulas(["one", "ann"], ["ann"]))
    return Problem("random", domain, OBJECTS, facts, values, goal)


def ground(problem: Problem) -> Task | None:
    """Return the task, or None where it says that bits cannot hold it."""
    try:
        return Task(problem)
    except UnsupportedError:
        return None


@settings(max_examples=30, suppress_health_check=list(HealthCheck))
@given(problem=problems())
def test_every_reachable_state(problem: Problem, oracle: Any) -> None:
    """No ground action is missing, none is too many, and each does and costs what it should.

    Many states at once are treated like each of them.
    """
    task, lifted = ground(problem), oracle(problem)
    if task is None:
        return
    seen, waiting = {task.initial}, deque([lifted.initial])
    fixed = problem.facts.difference(task.facts)
    while waiting and len(seen) < MAX_STATES:
        state = waiting.popleft()
        assert fixed <= set(state.facts), "a fact that was said never to change"
        for after in lifted.compare(task, state).values():
            bits = lifted.bits(task, after.state)
            assert task.state_of(task.facts_of(bits)) == bits
            if bits not in seen:
                seen.add(bits)
                waiting.append(after.state)
    compare_batch(task, sorted(seen))


@settings(max_examples=25, suppress_health_check=list(HealthCheck))
@given(problem=problems(), data=st.data())
def test_changed_values_equal_a_fresh_task(problem: Problem, data: st.DataObject) -> None:
    """Whether the values only price actions or also shape them."""
    task = ground(problem)
    if task is None:
        return
    key = data.draw(st.sampled_from(sorted(problem.values)))
    values = {key: data.draw(NUMBERS)}
    fresh = ground(problem.with_values(values))
    if fresh is None:
        return
    changed = task.with_values(values)
    assert changed.problem == fresh.problem
    assert changed.actions == fresh.actions
    assert changed.facts == fresh.facts
    assert changed.costs == fresh.costs
    assert (changed.initial, changed.goal) == (fresh.initial, fresh.goal)
    assert changed.applicable(changed.initial) == fresh.applicable(fresh.initial)
    assert task.costs == Task(problem).costs
