"""The posterior as a picture: a line per goal, changes marked."""

from __future__ import annotations

import io
from collections.abc import Sequence

from hrcplan.inference.run import Inference

# Okabe and Ito's colors: told apart by color-blind readers too.
COLORS = ("#0072B2", "#E69F00", "#009E73", "#D55E00", "#CC79A7", "#56B4E9", "#F0E442", "#000000")
GRAY = "#BBBBBB"
_MAX_LABELS = 60
_MAX_NAME = 34


def draw(found: Inference, form: str) -> bytes:
    """Return a chart as ``png`` or ``svg``: the goals that were ever likeliest have colors.

    Args:
        found: What was inferred.
        form: ``png`` or ``svg``.
    """
    import matplotlib as mpl

    mpl.use("Agg")
    mpl.rcParams.update({"svg.hashsalt": "hrcplan", "font.size": 9})
    from matplotlib.figure import Figure

    n = len(found.actions)
    figure = Figure(figsize=(min(24.0, 5.5 + 0.24 * n), 4.6), layout="constrained")
    axes = figure.add_subplot()
    shown = _shown(found.posterior)
    for goal in range(len(found.goals)):
        if goal not in shown:
            axes.plot([row[goal] for row in found.posterior], color=GRAY, linewidth=0.6, zorder=1)
    for i, (color, goal) in enumerate(zip(COLORS, shown, strict=False)):
        # Goals that are alike lie on one another: upper lines are thinner, every other has gaps.
        axes.plot(
            [row[goal] for row in found.posterior], color=color, linewidth=3.6 - 0.3 * i, zorder=3,
            linestyle=(0, (3, 1.5)) if i % 2 else "-", label=_short(found.goals[goal]),
        )  # fmt: skip
    for i, change in enumerate(found.changes):
        axes.axvline(change.at + 0.5, color="black", linestyle="--", linewidth=1, zorder=2,
                     label="goal change" if not i else None)  # fmt: skip
        axes.annotate(f"{change.probability:.2f}", (change.at + 0.5, 1.03), ha="center",
                      va="bottom", annotation_clip=False)  # fmt: skip
    for ignored in found.ignored:
        axes.plot(ignored.at + 1, -0.02, marker="x", color=GRAY, clip_on=False)
    axes.set_ylim(-0.02, 1.02)
    axes.set_xlim(0, max(1, n))
    labels = ["before", *(action.strip("()") for action in found.actions)]
    if n <= _MAX_LABELS:
        axes.set_xticks(range(n + 1), labels=labels, rotation=60, ha="right", fontsize=7)
    else:
        axes.set_xlabel("observation")
    axes.set_ylabel("probability")
    title = f"goals after each observation ({found.method})"
    axes.set_title(title, loc="left", fontsize=10, pad=16)
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(loc="center left", bbox_to_anchor=(1.01, 0.5), frameon=False, fontsize=8)
    buffer = io.BytesIO()
    metadata = {"Date": None} if form == "svg" else {"Software": None}
    figure.savefig(buffer, format=form, dpi=150, metadata=metadata)
    return buffer.getvalue()


def _shown(posterior: Sequence[Sequence[float]]) -> list[int]:
    """Return the goals worth a color, those with the most probability over time first."""
    totals = [sum(column) for column in zip(*posterior, strict=True)]
    order = sorted(range(len(totals)), key=lambda goal: -totals[goal])
    return order[: len(COLORS)]


def _short(name: str) -> str:
    return name if len(name) <= _MAX_NAME else name[: _MAX_NAME - 1] + "…"
