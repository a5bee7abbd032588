"""What was seen in a collaboration, in order, and what follows from it.

State and belief are folds over a history. To take an action back is to fold again without it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from hrcplan.core.numbers import Number
from hrcplan.execution import events as ev
from hrcplan.execution.action_model import ActionModel, BoundAction, StartEffects
from hrcplan.execution.codec import exact_number
from hrcplan.pddl.model import Fact, FluentKey
from hrcplan.pddl.semantics import LiftedState
from hrcplan.plans import PlannedAction


@dataclass(frozen=True, slots=True)
class BegunAction:
    """An agent began an action; ``number`` is that of its dispatch."""

    number: int
    agent: str
    action: str
    args: tuple[str, ...]
    lasts_s: float
    is_robot: bool

    @property
    def planned(self) -> PlannedAction:
        """The action, without times."""
        return PlannedAction(self.action, self.args)

    @property
    def words(self) -> tuple[str, ...]:
        """Name and objects."""
        return (self.action, *self.args)


@dataclass(frozen=True, slots=True)
class EndedAction:
    """An action ended: ``done``, ``failed`` or ``cancelled``."""

    number: int
    outcome: str
    n_late: int = 0
    """How often its duration could have passed once more: attempts that failed unseen."""


@dataclass(frozen=True, slots=True)
class SensedValues:
    """Agent state as it was sensed, or said by a person."""

    values: Mapping[FluentKey, Number]


@dataclass(frozen=True, slots=True)
class AskedGoal:
    """People were asked which goal they have, and answered ``choice``; "" is no answer."""

    options: tuple[str, ...]
    choice: str


@dataclass(frozen=True, slots=True)
class DeniedGoals:
    """Goals hold, and people have not said that this is all."""

    options: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class ComposedGoals:
    """Goals that people may have though they are not listed; see `hrcplan.bank.composed_goals`."""

    names: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class PassedTurn:
    """An agent did nothing in its turn."""

    agent: str


@dataclass(frozen=True, slots=True)
class WantedGoal:
    """What the people want from now on, for robots that know it."""

    goal: str


@dataclass(frozen=True, slots=True)
class SeenState:
    """A state was observed that did not follow from the actions."""

    facts: frozenset[Fact]
    numbers: Mapping[FluentKey, Number]


Mark = (
    BegunAction | EndedAction | PassedTurn | WantedGoal | SeenState | SensedValues | AskedGoal
    | DeniedGoals | ComposedGoals
)  # fmt: skip
History = tuple[Mark, ...]


def without(history: History, number: int) -> History:
    """Return a history in which an action was never begun."""
    return tuple(
        mark
        for mark in history
        if not (isinstance(mark, BegunAction | EndedAction) and mark.number == number)
    )


def as_failed(history: History, number: int) -> History:
    """Return a history in which an action has failed, when it ended or just now."""
    if all(not isinstance(mark, EndedAction) or mark.number != number for mark in history):
        return (*history, EndedAction(number, ev.FAILED))
    return tuple(
        EndedAction(number, ev.FAILED)
        if isinstance(mark, EndedAction) and mark.number == number
        else mark
        for mark in history
    )


def begun_action(history: History, number: int) -> BegunAction | None:
    """Return the action with a number; None if the history has none."""
    return next((mark for mark in actions_in(history) if mark.number == number), None)


def actions_in(history: History) -> Iterator[BegunAction]:
    """Yield the actions, in the order in which they began."""
    return (mark for mark in history if isinstance(mark, BegunAction))


def composed_in(history: History) -> tuple[str, ...]:
    """Return the names of all composed goals, in order."""
    return tuple(n for mark in history if isinstance(mark, ComposedGoals) for n in mark.names)


def state_after(
    history: History, model: ActionModel
) -> tuple[LiftedState, dict[int, StartEffects]]:
    """Return the state after a history, and what the start of each running action changed."""
    state, running = _state_and_running(history, model)
    return state, {number: effects for number, (_, effects, _) in running.items()}


_Running = dict[int, tuple[BoundAction, StartEffects, float]]


def _state_and_running(history: History, model: ActionModel) -> tuple[LiftedState, _Running]:
    state, running = model.initial(), _Running()
    for mark in history:
        match mark:
            case BegunAction():
                step = model.step(mark.planned)
                assert step is not None
                lasts = exact_number(mark.lasts_s)
                state, effects = model.begin(state, step, lasts)  # type: ignore[arg-type]
                running[mark.number] = step, effects, mark.lasts_s
            case EndedAction(number=number, outcome=outcome):
                step, effects, lasts_s = running.pop(number)
                if outcome == ev.DONE:
                    state = model.finish(state, step, exact_number(lasts_s))  # type: ignore[arg-type]
                else:
                    state = model.revert(state, effects)
            case SeenState(facts, numbers):
                state = LiftedState(facts, numbers)
    return state, running


def _settled_state(history: History, place: int, model: ActionModel) -> LiftedState:
    """Return the state just after a mark, if all that runs then had ended as it will end."""
    outcomes = {m.number: m.outcome for m in history if isinstance(m, EndedAction)}
    state, running = _state_and_running(history[: place + 1], model)
    for number, (step, effects, lasts_s) in running.items():
        if outcomes.get(number, ev.DONE) == ev.DONE:
            state = model.finish(state, step, exact_number(lasts_s))  # type: ignore[arg-type]
        else:
            state = model.revert(state, effects)
    return state


# What a belief sees.


@dataclass(frozen=True, slots=True)
class SeenAction:
    """An action as evidence: what runs counts as done; a failed attempt does not happen."""

    number: int
    agent: str
    words: tuple[str, ...]
    is_robot: bool
    happens: bool


@dataclass(frozen=True, slots=True)
class SeenEnd:
    """An action has ended well: who found it impossible when it began sees it now."""

    number: int


@dataclass(frozen=True, slots=True)
class SeenFacts:
    """The facts, once all that runs has ended: they do not follow from the actions."""

    facts: frozenset[Fact]


@dataclass(frozen=True, slots=True)
class SeenWait:
    """An agent did nothing in its turn; ``goes_on``: as before, and not for twice as long yet."""

    agent: str
    goes_on: bool


SeenMark = SeenAction | SeenEnd | SeenFacts | SeenWait | WantedGoal | AskedGoal | DeniedGoals


def evidence_in(history: History, model: ActionModel | None = None) -> tuple[SeenMark, ...]:
    """Return what a belief observes, in order.

    An action is evidence when it begins. A person's attempt that failed remains evidence without
    an effect; attempts of one action, without another action of this person between them, are one
    observation. What a robot failed to do has not happened. Who stands still on and on shows
    something new whenever that has lasted twice as long.

    Args:
        history: The history.
        model: How actions end; without it observed states are left out.
    """
    outcomes = {m.number: m.outcome for m in history if isinstance(m, EndedAction)}
    seen: list[SeenMark | None] = []
    waits: dict[str, int] = {}  # how often each agent has done nothing since it acted
    attempts: dict[str, int] = {}  # the place of each person's last action, if that failed
    for place, mark in enumerate(history):
        match mark:
            case SeenState() if model is not None:
                facts = frozenset(_settled_state(history, place, model).facts)
                seen.append(SeenFacts(facts))
            case BegunAction():
                happens = outcomes.get(mark.number, ev.DONE) == ev.DONE
                if mark.is_robot and not happens:
                    continue
                waits.pop(mark.agent, None)
                before = attempts.pop(mark.agent, None)
                if before is not None and _words(seen[before]) == mark.words:
                    seen[before] = None
                if not happens:
                    attempts[mark.agent] = len(seen)
                seen.append(SeenAction(mark.number, mark.agent, mark.words, mark.is_robot, happens))
            case EndedAction(number=number, outcome=ev.DONE):
                seen.append(SeenEnd(number))
            case PassedTurn(agent):
                n = waits[agent] = waits.get(agent, 0) + 1
                seen.append(SeenWait(agent, n & (n - 1) > 0))
            case WantedGoal() | AskedGoal() | DeniedGoals():
                seen.append(mark)
    return tuple(one for one in seen if one is not None)


def _words(one: SeenMark | None) -> tuple[str, ...] | None:
    return one.words if isinstance(one, SeenAction) else None
