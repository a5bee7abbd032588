"""All states that the agents of a task can get to, if they are not too many."""

from __future__ import annotations

import numpy as np

from hrcplan.bank.state_tables import SeenStates, group_rows
from hrcplan.core.arrays import Words
from hrcplan.errors import LimitError
from hrcplan.search.packed_states import FactPacking, PackedRules
from hrcplan.task.steps import StepTable

MAX_STATES = 1_000_000


def reachable_states(
    table: StepTable, packing: FactPacking, rules: PackedRules, max_states: int = MAX_STATES
) -> Words:
    """Return the states that can be reached from the initial state of a task, as rows.

    Args:
        table: The steps.
        packing: How states are packed.
        rules: The steps as rules over packed states.
        max_states: The most states.

    Raises:
        LimitError: if there are more states.
    """
    layer = packing.row(table.task.initial).reshape(1, -1)
    visited_states, layers, n = SeenStates(), [layer], 1
    visited_states.add(layer)
    while len(layer):
        after = np.concatenate([layer[:0], *(rows for _, _, rows in rules.expand(layer))])
        after = group_rows(after)[0] if len(after) else after
        layer = after[~visited_states.contains(after)]
        n += len(layer)
        if n > max_states:
            message = f"the agents can get to more than {max_states:,} states"
            hint = "use fewer objects or agents, or the approximation: bank build --turns solo"
            raise LimitError(message, code="memory", hint=hint)
        visited_states.add(layer)
        layers.append(layer)
    return np.concatenate(layers)


def check_states(table: StepTable, max_states: int = MAX_STATES) -> None:
    """Check that the agents can get to at most so many states.

    Raises:
        LimitError: if there are more states.
    """
    packing = FactPacking(tuple(range(len(table.task.facts))))
    reachable_states(table, packing, PackedRules(table.ops, packing), max_states)


def has_few_states(table: StepTable, max_states: int = MAX_STATES) -> bool:
    """Return whether the agents can get to at most so many states."""
    try:
        check_states(table, max_states)
    except LimitError:
        return False
    return True
