"""Start and end of an action read as one instant, for planners that know no duration."""

from __future__ import annotations

from collections.abc import Iterator

from hrcplan.core.bits import union
from hrcplan.errors import UnsupportedError
from hrcplan.task import BitEffect, GroundAction
from hrcplan.task.conditions import ALWAYS, Test


def unsure_changes(action: GroundAction) -> Iterator[BitEffect]:
    """Yield the changes that depend on the state, all of them read in the state before the action.

    They come on top of the action's ``adds`` and ``deletes``.

    Raises:
        UnsupportedError: where that state does not decide them.
    """
    sure = [c for c in action.at_start if c.tests == ALWAYS]
    unsure = [c for c in action.at_start if c.tests != ALWAYS]
    adds, deletes = union(c.adds for c in sure), union(c.deletes for c in sure)
    maybe = union(c.adds for c in unsure)
    change_mask = maybe | union(c.deletes for c in unsure)
    yield from unsure
    for change in action.at_end:
        always = change.tests == ALWAYS
        # One instant for both: an add of the start would win over a delete of the end.
        if change.deletes & (maybe if always else maybe | adds):
            raise UnsupportedError(f"the end of {action} undoes what its start may have done")
        if any(mask & change_mask for mask, _ in change.tests):
            raise UnsupportedError(f"the end of {action} depends on what its start may have done")
        tests = () if always else [_before(test, adds, deletes) for test in change.tests]
        tests_before = tuple(test for test in tests if test is not None)
        if tests_before:
            yield BitEffect(change.adds, change.deletes, tests_before)


def _before(test: Test, adds: int, deletes: int) -> Test | None:
    """Return what must hold before facts are added and deleted for ``test`` to hold after it."""
    mask, value = test
    if value & deletes or (mask & ~value) & adds:
        return None
    effects = adds | deletes
    return mask & ~effects, value & ~effects
