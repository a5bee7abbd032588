"""What agents who take turns do next: by all plans of the team, or by each agent's solo plans."""

from __future__ import annotations

from weakref import WeakValueDictionary

from hrcplan.bank.bank import Bank
from hrcplan.bank.solo_moves import SoloMoves
from hrcplan.bank.team_moves import TeamMoves

_SHARED: WeakValueDictionary[tuple[int, int, str | None], TeamMoves] = WeakValueDictionary()


def team_moves(bank: Bank) -> TeamMoves | None:
    """Return what the agents of a team do; None where agents do not take turns.

    All who ask for one bank share it, and what it remembers.

    Raises:
        LimitError: if the team can get to too many states, and plans are no solo plans.
    """
    if not bank.is_solo and not bank.team:
        return None
    key = id(bank.table), id(bank.graphs), bank.human  # it holds the bank, so ids are not reused
    moves = _SHARED.get(key)
    if moves is None:
        moves = _SHARED[key] = SoloMoves(bank) if bank.is_solo else TeamMoves(bank)
    return moves
