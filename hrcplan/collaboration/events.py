"""What people report (events), and what the robot asks (commands), besides those of execution."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from hrcplan.core.numbers import Number
from hrcplan.execution import codec
from hrcplan.execution import events as ev
from hrcplan.execution.driver import QUESTIONS
from hrcplan.execution.events import Command, Event
from hrcplan.pddl.model import Fact, FluentKey

ACT, ASK, NONE = "act", "ask", "none"
READINGS = (ACT, ASK, NONE)
DONE, WHICH, GOAL = "done", "which", "goal"
OTHER = "something else"
HALF = 0.5
YES, NO = "yes", "no"


@dataclass(frozen=True, slots=True)
class Begun:
    """A person begins an action without a dispatch."""

    t: float
    agent: str
    action: str
    args: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Passed:
    """A person does nothing now; "" is the person whose turn it is."""

    t: float
    agent: str = ""


@dataclass(frozen=True, slots=True)
class Idle:
    """Nothing has happened for some seconds: people who could act stand still."""

    t: float
    seconds: float


@dataclass(frozen=True, slots=True)
class Said:
    """A person says something; ``agent`` is "" if it is not known who."""

    t: float
    agent: str
    text: str


@dataclass(frozen=True, slots=True)
class Read:
    """The answer to `AskReading`: ``act`` (one option), ``ask`` (several), or ``none``.

    Options are ground actions as text. ``note`` says why there are none, if that is clear.
    """

    t: float
    outcome: str
    options: tuple[str, ...] = ()
    note: str = ""


@dataclass(frozen=True, slots=True)
class Answered:
    """A person answers the question that is open."""

    t: float
    choice: str


@dataclass(frozen=True, slots=True)
class Undone:
    """A person takes a reported action back: it was not begun, or (``attempted``) it failed."""

    t: float
    number: int
    attempted: bool = False


@dataclass(frozen=True, slots=True)
class StateTold:
    """A person says how an agent is; ``values`` are those of its agent state."""

    t: float
    values: Mapping[FluentKey, float | Number]


@dataclass(frozen=True, slots=True)
class Wanted:
    """The goal that a person has now; only robots that know it use it."""

    t: float
    goal: str


@dataclass(frozen=True, slots=True)
class Paused:
    """The robot is to begin nothing more."""

    t: float


@dataclass(frozen=True, slots=True)
class Stopped:
    """The robot is to stop what it does, and to begin nothing more."""

    t: float


@dataclass(frozen=True, slots=True)
class Continued:
    """The pause is over."""

    t: float


@dataclass(frozen=True, slots=True)
class Chosen:
    """The answer to `AskStep`: a ground action of a robot, or "" to wait; and what is believed.

    Attributes:
        t: When.
        action: The action's name; "" to wait.
        args: Its objects, the robot included.
        goals: Every goal's name and probability, the likeliest first.
        n_declared: How many changes of goal were declared so far.
        helps: The likeliest goals that the action helps.
        asks: Goals of which people are asked which one they have; none to ask nothing.
        takes_over: Why the robot does a step that people could do, such as "may fail".
        none_of_these: The probability that no listed goal is wanted; 0 if that is not weighed.
        composed: Further goals that were composed now, by their facts.
    """

    t: float
    action: str = ""
    args: tuple[str, ...] = ()
    goals: tuple[tuple[str, float], ...] = ()
    n_declared: int = 0
    helps: tuple[str, ...] = ()
    asks: tuple[str, ...] = ()
    takes_over: str = ""
    none_of_these: float = 0.0
    composed: tuple[str, ...] = ()

    @property
    def claims(self) -> bool:
        """Whether people probably want one of the listed goals."""
        return self.none_of_these <= HALF


@dataclass(frozen=True, slots=True)
class AskStep:
    """Request for a step of one of these robots."""

    t: float
    agents: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class AskReading:
    """Request for the action that one of these people means."""

    t: float
    agents: tuple[str, ...]
    text: str


@dataclass(frozen=True, slots=True)
class Ask:
    """A question to a person.

    ``done``: do these goals end it? ``which``: which of these actions? ``goal``: which of these
    goals (the last option is `OTHER`: none of them)?
    """

    t: float
    question: str
    options: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Correct:
    """The state is this: something that was reported has not happened."""

    t: float
    facts: frozenset[Fact]
    numbers: Mapping[FluentKey, Number]
    absent: frozenset[Fact] = frozenset()


PersonEvent = (
    Begun | Passed | Idle | Said | Answered | Undone | StateTold | Wanted | Paused | Stopped
    | Continued
    | ev.StopAsked
)  # fmt: skip
SharedEvent = Event | PersonEvent | Read | Chosen
SharedCommand = Command | AskStep | AskReading | Ask | Correct

KINDS: Mapping[str, type] = {
    **codec.KINDS,
    **{kind.__name__.lower(): kind
       for kind in (Begun, Passed, Idle, Said, Read, Answered, Undone, StateTold, Wanted, Paused,
                    Stopped, Continued, Chosen, AskStep, AskReading, Ask, Correct)},
}  # fmt: skip
SHARED_QUESTIONS: Mapping[type, type] = {**QUESTIONS, AskStep: Chosen, AskReading: Read}
