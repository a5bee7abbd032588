"""The state of a collaboration: the run of the observer, and what was seen, asked and chosen."""

from __future__ import annotations

import enum
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from hrcplan.collaboration.events import Ask, Chosen, SharedCommand
from hrcplan.collaboration.history import BegunAction, History, Mark, actions_in
from hrcplan.execution import events as ev
from hrcplan.execution.run import Run, RunningAction


class CompanionPhase(enum.Enum):
    """What is open: nothing, the meaning of words, a question to people, or the robot's step."""

    LISTENING = "listening"
    READING = "reading"
    ASKING = "asking"
    CHOOSING = "choosing"


@dataclass(frozen=True, slots=True)
class CompanionRun:
    """Everything the companion knows; the next one follows from this one and one event.

    Attributes:
        run: What is believed, what runs, and what was counted.
        history: What was seen.
        phase: What is open.
        is_paused: Whether the robot begins nothing more.
        slot: Whose turn it is, as an index of the setup's slots.
        round: How many rounds of turns are over.
        has_acted: Whether the agent whose turn it is has acted or passed.
        question: The question that is open.
        denied: Goals that hold and of which people have said that they are not all.
        step_request: The robots that were asked for a step last, and the history then.
        n_asked_again: How often in a row the same choice was asked for again.
        belief: The last answer of the assistant.
        reached: The goals that held when people said that it is all.
    """

    run: Run
    history: History = ()
    phase: CompanionPhase = CompanionPhase.LISTENING
    is_paused: bool = False
    slot: int = 0
    round: int = 0
    has_acted: bool = False
    question: Ask | None = None
    denied: frozenset[str] = frozenset()
    step_request: tuple[tuple[str, ...], History] | None = None
    n_asked_again: int = 0
    belief: Chosen = field(default_factory=lambda: Chosen(0.0))
    reached: frozenset[str] = frozenset()

    @property
    def t(self) -> float:
        """When the last event happened."""
        return self.run.t

    @property
    def is_over(self) -> bool:
        """Whether the collaboration has ended."""
        return self.run.is_over

    @property
    def running(self) -> tuple[RunningAction, ...]:
        """The actions that have begun and not ended."""
        return self.run.running

    @property
    def last_reported(self) -> BegunAction | None:
        """The last action of a person that was not taken back; None if there is none."""
        return next((a for a in reversed(tuple(actions_in(self.history))) if not a.is_robot), None)

    def is_busy(self, agent: str) -> bool:
        """Return whether an agent does something that runs."""
        return any(agent in action.step.busy for action in self.running)

    def in_next_turn(self, n_slots: int) -> CompanionRun:
        """Return this run when the turn has passed on."""
        slot = (self.slot + 1) % n_slots
        return replace(self, slot=slot, round=self.round + (slot == 0), has_acted=False)

    def plus(self, *marks: Mark) -> CompanionRun:
        """Return this run with a longer history."""
        return replace(self, history=(*self.history, *marks)) if marks else self

    def with_dispatches(
        self, commands: Sequence[SharedCommand], robots: frozenset[str]
    ) -> CompanionRun:
        """Return this run with every dispatched action in its history."""
        return self.plus(*(
            BegunAction(c.number, c.agent, c.action, c.args, c.duration_s,
                        c.agent in robots or not c.agent)
            for c in commands if isinstance(c, ev.Dispatch)
        ))  # fmt: skip


CompanionStep = tuple[CompanionRun, tuple[SharedCommand, ...]]
"""What one event leads to: the next run, and commands in order."""
