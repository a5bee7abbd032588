"""What agents who take turns do next: by all plans of the team, or by each agent's solo plans."""

from __future__ import annotations

from hrcplan.bank.bank import Bank
from hrcplan.bank.solo_moves import SoloMoves
from hrcplan.bank.team_moves import TeamMoves


def team_moves(bank: Bank) -> TeamMoves | None:
    """Return what the agents of a team do; None where agents do not take turns.

    Raises:
        LimitError: if the team can get to too many states, and plans are no solo plans.
    """
    if bank.is_solo:
        return SoloMoves(bank)
    return TeamMoves(bank) if bank.team else None
