"""What a collaboration came to."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

from hrcplan.collaboration.history import EndedAction, actions_in
from hrcplan.collaboration.run import CompanionRun
from hrcplan.execution import events as ev


@dataclass(frozen=True, slots=True)
class CollaborationOutcome:
    """What a collaboration came to; actions that were taken back do not count.

    Attributes:
        success: Whether a goal holds and the people have confirmed that it is all.
        ending: How it ended; ``unfinished`` if it goes on.
        why: More about that.
        reached: The goals that hold, in alphabetical order.
        done_human: Actions of people that succeeded.
        done_robot: Actions of robots that succeeded.
        failed: Actions that failed.
        n_declared: Changes of goal that the robot has declared.
        duration_s: The end of the last action; a step of a domain without durations lasts 1.
    """

    success: bool
    ending: str
    why: str
    reached: tuple[str, ...]
    done_human: int
    done_robot: int
    failed: int
    n_declared: int
    duration_s: float

    def to_json(self) -> dict[str, Any]:
        """Return the outcome as a JSON object; its keys are the attributes."""
        return {**asdict(self), "reached": list(self.reached)}


def collaboration_outcome(run: CompanionRun) -> CollaborationOutcome:
    """Return what a collaboration came to; of an unfinished one so far."""
    outcomes = {m.number: m.outcome for m in run.history if isinstance(m, EndedAction)}
    done = [a.is_robot for a in actions_in(run.history) if outcomes.get(a.number) == ev.DONE]
    return CollaborationOutcome(
        success=run.run.ending == ev.GOAL,
        ending=run.run.ending or "unfinished",
        why=run.run.why,
        reached=tuple(sorted(run.reached)),
        done_human=done.count(False),
        done_robot=done.count(True),
        failed=list(outcomes.values()).count(ev.FAILED),
        n_declared=run.belief.n_declared,
        duration_s=round(run.run.counts.last_end_s, 6),
    )
