"""Which steps a look-ahead tree tries after a step: the few likeliest to follow (IV-C2)."""

from __future__ import annotations

from collections.abc import Callable, Sequence, Set
from itertools import islice

import numpy as np

from hrcplan.assistance.assistant import TIES
from hrcplan.assistance.bigrams import Bigrams
from hrcplan.assistance.step_values import NextSteps, StepValues
from hrcplan.bank.progress import Progress
from hrcplan.core.arrays import Floats
from hrcplan.errors import UsageError

BRANCHING = 5


class Branching:
    """Prunes a tree by 2-grams, and by the belief where no 2-gram tells.

    Args:
        outlook: Knows what goals have next.
        bigrams: Which steps follow which; without them the belief decides alone.
        branching: How many steps are tried from each place (b).

    Raises:
        UsageError: if ``branching`` is less than 1.
    """

    def __init__(
        self, outlook: StepValues, bigrams: Bigrams | None = None, branching: int = BRANCHING
    ) -> None:
        if branching < 1:
            raise UsageError(f"a tree {branching} steps wide has no branches")
        self.bigrams, self.branching = bigrams, branching
        self.label = outlook.tracker.joint.label
        self._able = outlook.bank.table.able
        self._called: dict[int, list[int]] = {}
        for step, label in enumerate(self.label):
            self._called.setdefault(label, []).append(step)

    def of(
        self, track: Progress, wanted: NextSteps, last: int | None, agents: Set[str],
        belief: Callable[[], Floats], plausible: Sequence[int] = (),
    ) -> list[int]:  # fmt: skip
        """Return the steps that are tried after a step, the likeliest first.

        They are next in a plan of some goal, and one of the agents can do them. What was seen
        after the last step comes first; places that are left go to what the likeliest goals want.

        Args:
            track: Where everything stands.
            wanted: What the goals want there.
            last: The last step.
            agents: Who is to act.
            belief: Returns the posterior of the goals; only asked where no 2-gram tells.
            plausible: Goals, as bits, whose plans the 2-grams count; all by default.
        """
        is_open = np.zeros(len(self.label), dtype=np.bool_)
        is_open[wanted.steps] = True
        found = self._seen(track, is_open.tolist(), last, agents, plausible)
        room = self.branching - len(found)
        if not room:
            return found
        left = [s for s in np.flatnonzero(is_open).tolist() if s not in found]
        left = list(self._able(track.world, left, agents))
        if len(left) > room:
            weights = np.bincount(wanted.steps, belief().take(wanted.goals), len(self.label))
            weights = weights.round(TIES)
            left.sort(key=lambda step: -weights[step])
        return found + left[:room]

    def _seen(
        self, track: Progress, is_open: Sequence[bool], last: int | None, agents: Set[str],
        plausible: Sequence[int],
    ) -> list[int]:  # fmt: skip
        """Return the open steps that were seen after a step, the most frequent first."""
        if last is None or self.bigrams is None:
            return []
        labels = self.bigrams.followers(self.label[last], plausible)
        seen = (step for label in labels for step in self._called[label] if is_open[step])
        return list(islice(self._able(track.world, seen, agents), self.branching))
