"""pddlgym as the world of an episode in turns: a simulator by others says what comes of a step.

It reads files that our own writer makes, grounds nothing beforehand, and knows no numbers. It is
the optional extra ``pddlgym``, imported only when a world is made; nothing it says is printed.
"""

from __future__ import annotations

import io
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from types import ModuleType
from typing import Any, Protocol

from hrcplan.bank import Bank
from hrcplan.core.extras import install_command
from hrcplan.errors import UnsupportedError, UsageError
from hrcplan.pddl.classical import classical, classical_texts
from hrcplan.pddl.model import TRUE, And, Atom, Equal, Fact, Not, Problem, fact_text

MAX_NAMED = 3  # facts that an error names


class PddlgymWorld:
    """The world as pddlgym says; one environment serves all episodes.

    Args:
        bank: Whose task it is; goals play no part, since the world does not know them.

    Raises:
        UsageError: if pddlgym is not installed.
        UnsupportedError: if it cannot hold the task.
    """

    def __init__(self, bank: Bank) -> None:
        self._task = bank.goals.task
        if self._task.value_sets:
            raise UnsupportedError("pddlgym has no numbers, and an action changes one")
        self._core = _core()
        self._env = environment(replace(bank.goals.problem, goal=TRUE))
        self._objects: dict[str, _Entity] = {}
        self._literals: dict[int, _GymLiteral] = {}
        self._now = self.begin()

    def begin(self) -> int:
        """Return the initial state, and forget what was done."""
        state, _ = self._env.reset()
        self._objects = {entity.name: entity for entity in state.objects}
        self._now = self._bits()
        return self._now

    def do(self, state: int, action: int) -> int:
        """Return the state after a ground action of the task, given by its index.

        Raises:
            UsageError: if pddlgym is in another state, or the action cannot be done in it.
        """
        if state != self._now:
            raise UsageError(f"the world is in another state: {self._differences(state)}")
        # Not the environment's step(): it enumerates all literals, which takes ten times as long.
        try:
            after = self._core.get_successor_state(
                self._env.get_state(), self._literal(action), self._env.domain,
                raise_error_on_invalid_action=True,
            )  # fmt: skip
        except self._core.InvalidAction:
            raise UsageError(f"{self._task.actions[action]} cannot be done here") from None
        self._env.set_state(after)
        self._now = self._bits()
        return self._now

    def _literal(self, action: int) -> _GymLiteral:
        if action not in self._literals:
            ground = self._task.actions[action]
            predicate = self._env.domain.predicates[ground.name]
            self._literals[action] = predicate(*(self._objects[arg] for arg in ground.args))
        return self._literals[action]

    def _bits(self) -> int:
        return self._task.state_of(map(fact_of, self._env.get_state().literals))

    def _differences(self, state: int) -> str:
        facts = sorted(self._task.facts_of(state ^ self._now))
        facts_text = ", ".join(map(fact_text, facts[:MAX_NAMED]))
        more = len(facts) - MAX_NAMED
        return f"{facts_text} and {more} more differ" if more > 0 else f"{facts_text} differs"


class _Entity(Protocol):
    @property
    def name(self) -> str: ...


class _GymLiteral(Protocol):
    """What is read of a literal of pddlgym."""

    @property
    def predicate(self) -> _Entity: ...

    @property
    def variables(self) -> Sequence[_Entity]: ...


class _State(Protocol):
    """What is read of a state of pddlgym."""

    @property
    def objects(self) -> Iterable[_Entity]: ...

    @property
    def literals(self) -> Iterable[_GymLiteral]: ...


class _Domain(Protocol):
    @property
    def predicates(self) -> Mapping[str, Callable[..., _GymLiteral]]: ...


class _Environment(Protocol):
    """What is used of an environment of pddlgym."""

    @property
    def domain(self) -> _Domain: ...

    def reset(self) -> tuple[_State, Mapping[str, Any]]: ...

    def get_state(self) -> _State: ...

    def set_state(self, state: _State) -> None: ...


def fact_of(literal: _GymLiteral) -> Fact:
    """Return a literal of pddlgym as a fact, or an action of its as name and arguments."""
    return (literal.predicate.name, *(entity.name for entity in literal.variables))


def environment(problem: Problem) -> _Environment:
    """Return pddlgym's environment of a problem, its operators as actions; ``reset()`` begins.

    The files that it reads are gone afterwards; its own messages about them name them still.

    Raises:
        UsageError: if pddlgym is not installed.
        UnsupportedError: if it cannot hold the problem.
    """
    core = _core()
    _check_conditions(problem)
    domain, text = classical_texts(problem)
    with TemporaryDirectory(prefix="hrcplan-") as folder, _silence():
        problems = Path(folder, "problems")
        problems.mkdir()
        Path(folder, "domain.pddl").write_text(domain, encoding="utf-8")
        (problems / "problem.pddl").write_text(text, encoding="utf-8")
        try:
            env: _Environment = core.PDDLEnv(
                str(Path(folder, "domain.pddl")), str(problems),
                operators_as_actions=True, dynamic_action_space=True,
            )  # fmt: skip
        except Exception as error:
            raise UnsupportedError(f"pddlgym cannot hold this problem: {error}") from error
    return env


def _check_conditions(problem: Problem) -> None:
    """Refuse what it would misread: conditions on constants alone, or on one thing twice."""
    for action in classical(problem).domain.actions:
        for condition in action.conditions:
            assert isinstance(condition.formula, And)
            for part in condition.formula.parts:
                atom = part.body if isinstance(part, Not) else part
                terms = atom.args if isinstance(atom, Atom) else ()
                if isinstance(atom, Equal) or len(set(terms)) < len(terms):
                    raise UnsupportedError(f"pddlgym cannot hold {atom} in '{action.name}'")
                if terms and problem.domain.constants.keys() >= set(terms):
                    raise UnsupportedError(f"pddlgym never looks at {atom} in '{action.name}'")


def _core() -> ModuleType:
    with _silence():
        try:
            from pddlgym import core
        except ImportError as error:
            message = f"pddlgym cannot be imported: {error}"
            hint = f"{install_command('pddlgym')}, on a Python before 3.12"
            raise UsageError(message, code="missing-extra", hint=hint) from error
    module: ModuleType = core
    return module


@contextmanager
def _silence() -> Iterator[None]:
    """Keep what pddlgym and its imports print and warn of from our own output."""
    with (
        warnings.catch_warnings(), redirect_stdout(io.StringIO()), redirect_stderr(io.StringIO())
    ):  # fmt: skip
        warnings.simplefilter("ignore")
        yield
