"""The posterior over goals as a plot: a line per goal, goal changes marked."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from hrcplan.inference.run import Inference
from hrcplan.plots import style

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MAX_WIDTH = 16.0  # inches: at most 2400 pixels
_MAX_LABELS = 48
_MAX_NAME = 34


@style.styled
def draw(inference: Inference, form: str) -> bytes:
    """Return a chart as a ``png`` or ``svg`` file; the likeliest goals have colors and names.

    Args:
        inference: Its posterior, one row per observation, the prior first.
        form: ``png`` or ``svg``.
    """
    n = len(inference.actions)
    figure, grid = style.figure(1, 1, min(MAX_WIDTH, 6.5 + 0.24 * n), 4.6)
    axes = grid[0][0]
    _lines(axes, inference)
    _marks(axes, inference)
    axes.set_ylim(-0.02, 1.02)
    axes.set_xlim(0, max(1, n))
    _observations(axes, inference)
    axes.set_ylabel("probability of the goal")
    axes.set_title(f"Goals after each observation, method {inference.method}", pad=18)
    axes.legend(loc="center left", bbox_to_anchor=(1.01, 0.5), fontsize=8)
    return style.file_bytes(figure, form)


def _lines(axes: Axes, inference: Inference) -> None:
    """Draw a line per goal: colored with a name for the likeliest, thin and gray for the others."""
    likeliest = _likeliest(inference.posterior)
    others = [goal for goal in range(len(inference.goals)) if goal not in likeliest]
    for i, goal in enumerate(others):
        label = f"{len(others)} other goals" if i == 0 else None
        axes.plot([row[goal] for row in inference.posterior], color=style.GRAY, linewidth=0.6,
                  zorder=1, label=label)  # fmt: skip
    for i, (color, goal) in enumerate(zip(style.LINES, likeliest, strict=False)):
        # Lines of equal goals lie on each other: upper ones are thinner, every other is dashed.
        axes.plot(
            [row[goal] for row in inference.posterior], color=color, linewidth=3.6 - 0.3 * i,
            linestyle=(0, (3, 1.5)) if i % 2 else "-", label=_short(inference.goals[goal]),
            zorder=3,
        )  # fmt: skip


def _marks(axes: Axes, inference: Inference) -> None:
    """Mark goal changes with their probabilities, and observations that were ignored."""
    for i, change in enumerate(inference.changes):
        axes.axvline(change.at + 0.5, color=style.INK, linestyle="--", linewidth=1, zorder=2,
                     label="goal change, with its probability" if i == 0 else None)  # fmt: skip
        axes.annotate(f"{change.probability:.2f}", (change.at + 0.5, 1.03), ha="center",
                      va="bottom", annotation_clip=False)  # fmt: skip
    for i, mark in enumerate(inference.ignored):
        axes.plot(mark.at + 1, -0.02, marker="x", color=style.SOFT, linestyle="none",
                  clip_on=False, label="ignored observation" if i == 0 else None)  # fmt: skip


def _observations(axes: Axes, inference: Inference) -> None:
    """Name the observations below the axis, or number them where there are many."""
    n = len(inference.actions)
    style.bare(axes, "y")
    if n > _MAX_LABELS:
        axes.set_xlabel("observation")
        return
    labels = ["prior", *(_short(action.strip("()")) for action in inference.actions)]
    axes.set_xticks(range(n + 1), labels=labels, rotation=60, ha="right",
                    rotation_mode="anchor", fontsize=8)  # fmt: skip


def _likeliest(posterior: Sequence[Sequence[float]]) -> list[int]:
    """Return the goals that get a color: those with the most probability over time, first."""
    totals = [sum(column) for column in zip(*posterior, strict=True)]
    order = sorted(range(len(totals)), key=lambda goal: -totals[goal])
    return order[: len(style.LINES)]


def _short(name: str) -> str:
    return name if len(name) <= _MAX_NAME else name[: _MAX_NAME - 1] + "…"
