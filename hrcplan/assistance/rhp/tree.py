"""The receding-horizon tree: what robot and human may do next, and what each branch costs.

Ghose et al. (RA-L 2025, III-B, III-D2, IV-C2). A tree for each candidate sequence costs by its own
attractor field; all trees have the same branches, so they are grown as one with a cost for each.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence, Set
from dataclasses import dataclass

from hrcplan.assistance.bigrams import Bigrams
from hrcplan.assistance.imagined_steps import BRANCHING, Branching, ImaginedSteps
from hrcplan.assistance.step_values import StepValues
from hrcplan.bank.progress import Progress
from hrcplan.core.arrays import Floats

DEPTH = 3

Field = Sequence[int]
"""For each label the number of goals that it helps to accomplish."""


@dataclass(frozen=True)
class TreeRoot:
    """Where a tree begins.

    Attributes:
        progress: The progress of the goals.
        last: The last step; None if nothing was done yet.
        fields: The summed attractor field of each candidate sequence.
        plausible: The goals that each sequence is consistent with, as bits; they weight the
            2-grams. Empty if these count the plans of the whole bank.
        belief: Returns the posterior of the goals; only asked where no 2-gram tells.
    """

    progress: Progress
    last: int | None
    fields: tuple[Field, ...]
    plausible: tuple[int, ...]
    belief: Callable[[], Floats]


@dataclass(frozen=True, slots=True)
class TreeBranch:
    """Steps in turn, the last one by the robot: what was before it, and the cost in each tree."""

    first: int
    progress: Progress
    step: int
    costs: tuple[int, ...]


class RecedingHorizonTree:
    """Grows branches of the steps that are most likely to follow, and costs them.

    Args:
        step_values: Knows what goals have next; its agents are the robots.
        bigrams: Which steps follow which.
        people: The agents that are not robots.
        branching: How many steps are tried at each depth.
        depth: How many steps a branch has; the robot's are the first, the third and so on.
    """

    def __init__(
        self, step_values: StepValues, bigrams: Bigrams, people: Set[str],
        branching: int = BRANCHING, depth: int = DEPTH,
    ) -> None:  # fmt: skip
        self.step_values, self.bigrams, self.people = step_values, bigrams, people
        self._branching, self.n_levels = (
            Branching(step_values, bigrams, branching),
            (depth + 1) // 2,
        )
        self.imagined_steps, self.label = (
            ImaginedSteps(step_values),
            step_values.tracker.combined_graph.label,
        )

    def costs(self, root: TreeRoot) -> dict[int, int]:
        """Return for each step that the robot may do first the cost of its cheapest branch.

        Eqs. 1 and 2: the robot's steps lower the cost by their attraction, the human's do not. A
        branch is only lowered further in the trees where it was among the cheapest one depth of
        the robot's before; one that is nowhere among them is final and need not be grown.
        """
        lowest: dict[int, int] = {}
        leaves: list[TreeBranch] = []
        now = self.imagined_steps.begin(root.progress)
        level = [
            TreeBranch(s, now, s, tuple(-field[self.label[s]] for field in root.fields))
            for s in self.next_steps(root, now, root.last, self.step_values.agents)
        ]
        for _ in range(1, self.n_levels):
            if not level:
                break
            least = [min(costs) for costs in zip(*(b.costs for b in level + leaves), strict=True)]
            next_level: list[TreeBranch] = []
            for branch in level:
                lowers = [cost == low for cost, low in zip(branch.costs, least, strict=True)]
                if not any(lowers):
                    _note(lowest, branch)
                else:
                    self._grow(root, branch, lowers, next_level, leaves)
            level = next_level
        for branch in level + leaves:
            _note(lowest, branch)
        return lowest

    def _grow(
        self, root: TreeRoot, branch: TreeBranch, lowers: Sequence[bool], inner: list[TreeBranch],
        leaves: list[TreeBranch],
    ) -> None:  # fmt: skip
        """Add a human and a robot step to a branch, in all ways; where there is none, it ends."""
        after = self.imagined_steps.after(branch.progress, branch.step)
        answers = self.next_steps(root, after, branch.step, self.people)
        if not answers:
            leaves.append(branch)
        for answer in answers:
            progress = self.imagined_steps.after(after, answer)
            steps = self.next_steps(root, progress, answer, self.step_values.agents)
            if not steps:
                leaves.append(branch)
            for step in steps:
                label = self.label[step]
                costs = tuple(
                    cost - field[label] if lower else cost
                    for cost, field, lower in zip(branch.costs, root.fields, lowers, strict=True)
                )
                inner.append(TreeBranch(branch.first, progress, step, costs))

    def next_steps(
        self, root: TreeRoot, progress: Progress, last: int | None, agents: Set[str]
    ) -> list[int]:
        """Return the steps that are tried after a step, the likeliest first."""
        next_steps = self.imagined_steps.next_steps(progress)
        return self._branching.expand(
            progress, next_steps, last, agents, root.belief, root.plausible
        )


def _note(lowest: dict[int, int], branch: TreeBranch) -> None:
    """Record the summed costs of a branch if they are the lowest after its first step."""
    total = sum(branch.costs)
    lowest[branch.first] = min(total, lowest.get(branch.first, total))
