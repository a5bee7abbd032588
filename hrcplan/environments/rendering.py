"""An episode as text."""

from __future__ import annotations

from collections.abc import Iterable
from textwrap import fill

from hrcplan.environments.rollout import Move, Rollout

MODES = ("ansi",)
WIDTH = 80
N_MOVES = 6  # that are shown


def render(rollout: Rollout) -> str:
    """Return what was done last, what holds, and who acts now, in lines of at most 80 columns."""
    turns, bank = rollout.turns, rollout.bank
    if not rollout.moves and turns.ending is not None:
        return f"{bank.goals.title}: no episode has begun"
    head = f"{bank.goals.title}, timestep {turns.n_turns}, goal {rollout.goal_names}"
    facts = (f"({' '.join(fact)})" for fact in sorted(bank.goals.task.facts_of(turns.state)))
    now = f"ended: {turns.ending}" if turns.ending else f"{turns.mover.name} acts now"
    moves = [_words(rollout, move) for move in rollout.moves[-N_MOVES:]]
    return "\n".join([_folded([head]), *(f"  {text}" for text in moves), _folded(facts), now])


def _words(rollout: Rollout, move: Move) -> str:
    step = "wait" if move.step is None else " ".join(rollout.bank.table[move.step].words)
    return f"{move.mover.name}: {step}"


def _folded(words: Iterable[str]) -> str:
    return fill(" ".join(words), WIDTH, break_long_words=False, break_on_hyphens=False)
