"""What holds for every test: repeatable examples, and no hidden skips where skips are forbidden."""

import os
import signal
from collections.abc import Callable, Iterator

import pytest
from hypothesis import settings
from hypothesis import strategies as st

from hrcplan.bank import Bank, build, from_problems
from hrcplan.pddl.check import domain_in, problem_in
from hrcplan.pddl.source import SourceText
from tests import worlds

# A shared machine has slow moments, so no deadline; the same examples in every run, so that a
# failure can be seen again. To look for new ones: tools/test --hypothesis-profile=explore
settings.register_profile("hrcplan", deadline=None, derandomize=True)
settings.register_profile("explore", deadline=None, max_examples=1000)
settings.load_profile("hrcplan")

# A run in the background ignores Ctrl-C, and so would everything that the tests start.
signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture(autouse=True, scope="session")
def _own_cache(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Nothing is found in, or left in, the cache folder of whoever runs the tests."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("HRCPLAN_CACHE", str(tmp_path_factory.mktemp("cache")))
        yield


@pytest.hookimpl(tryfirst=True)
def pytest_sessionfinish(session: pytest.Session) -> None:
    """With HRCPLAN_NO_SKIPS=1 (as in CI) a skipped test fails the run."""
    reporter = session.config.pluginmanager.get_plugin("terminalreporter")
    if os.environ.get("HRCPLAN_NO_SKIPS") != "1" or reporter is None:
        return  # workers of xdist have no reporter; their controller has it
    skipped = reporter.stats.get("skipped", [])
    if skipped:
        session.exitstatus = pytest.ExitCode.TESTS_FAILED
        reporter.write_line("")
    for report in skipped:
        reporter.write_line(f"skipped, but no skips are allowed: {report.nodeid}", red=True)


@st.composite
def _small_bank(draw: st.DrawFn, kinds: tuple[str, ...] = ("free", "able", "moving")) -> Bank:
    """Draw a few goals over six facts, for two people and a robot.

    ``free``: everybody can do everything; ``able``: some actions are for some agents only;
    ``moving``: being able comes and goes, so that agents stay in the steps' names.
    """
    kind, facts = draw(st.sampled_from(kinds)), [f"(p{i})" for i in range(6)]
    rest = "(:action rest :parameters (?a - agent) :precondition (and) :effect (able ?a))"
    actions = [rest] if kind == "moving" else []
    for i in range(draw(st.integers(3, 7))):
        before = draw(st.lists(st.sampled_from(facts[: i % 6] or ["(and)"]), max_size=2))
        after = [facts[i % 6]]
        if draw(st.integers(0, 3)) == 0:
            after.append(f"(not {draw(st.sampled_from(facts[:i] or facts))})")
        if kind != "free" and draw(st.booleans()):
            before.append("(able ?a)")
            after += ["(not (able ?a))"] if kind == "moving" else []
        actions.append(
            f"(:action do{i} :parameters (?a - agent) :precondition (and {' '.join(before)})"
            f" :effect (and {' '.join(after)}))"
        )
    domain = domain_in(SourceText("domain", f"""(define (domain d) (:requirements :strips :typing)
      (:types agent - object) (:predicates (controllable ?a - agent) (able ?a - agent)
      {' '.join(facts)}) {' '.join(actions)})"""))  # fmt: skip
    able = draw(st.lists(st.sampled_from(["ann", "bob", "robo"]), unique=True))
    init = " ".join(f"(able {agent})" for agent in able)
    goals = [draw(st.lists(st.sampled_from(facts), min_size=1, max_size=3)) for _ in range(3)]
    problems = [
        problem_in(domain, SourceText("problem", f"""(define (problem g{n}) (:domain d)
          (:objects ann bob robo - agent) (:init (controllable robo) {init})
          (:goal (and {" ".join(goal)})))"""))
        for n, goal in enumerate(goals)
    ]  # fmt: skip
    return build(from_problems(problems))


@pytest.fixture(scope="session")
def small_bank() -> Callable[..., st.SearchStrategy[Bank]]:
    return _small_bank


def _distances(bank: Bank, goal: int) -> dict[int, int]:
    task, seen, waiting = bank.goals.task, {bank.initial}, [bank.initial]
    before: dict[int, list[int]] = {}
    while waiting:
        state = waiting.pop()
        for after in {task.successor(state, i) for i in task.applicable(state)}:
            before.setdefault(after, []).append(state)
            if after not in seen:
                seen.add(after)
                waiting.append(after)
    layer = [state for state in seen if bank.goals.is_reached(goal, state)]
    found, n = dict.fromkeys(layer, 0), 0
    while layer:
        n += 1
        layer = list({b for s in layer for b in before.get(s, ()) if b not in found})
        found.update(dict.fromkeys(layer, n))
    return found


@pytest.fixture(scope="session")
def distances() -> Callable[[Bank, int], dict[int, int]]:
    """How many actions lead to a goal at least, from every state that can be and has a way."""
    return _distances


@pytest.fixture(scope="session")
def workshop() -> Bank:
    """Five goals; agents' facts never change."""
    return build(worlds.world(worlds.WORKSHOP, worlds.PACKED, worlds.PARCELS))


@pytest.fixture(scope="session")
def hall() -> Bank:
    """Four goals; agents walk."""
    return build(worlds.world(worlds.HALL, worlds.ERRAND, worlds.ERRANDS))


@pytest.fixture(scope="session")
def hall_in_sequence(hall: Bank) -> Bank:
    """The same with plans that are sequences, as a bank has them that is not of team plans."""
    return worlds.without_turns(hall)


@pytest.fixture(scope="session")
def walk() -> worlds.Walk:
    return worlds.random_walk
