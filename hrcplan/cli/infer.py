"""``hrcplan infer``: the goal of a human, inferred from observed actions."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from hrcplan.cli import options, output

if TYPE_CHECKING:
    from hrcplan.inference import GoalChange, Inference

N_SHOWN = 3
MAX_NAME = 28


@click.command(
    "infer",
    epilog=options.notes(
        "SOURCE: a bank (see 'hrcplan bank build'), or a folder with domain.pddl, template.pddl "
        "and hyps.dat.",
        'ACTIONS: a file with one ground action per line, as in "(get human pan)"; by default '
        'obs.dat in the folder SOURCE. Method cost also takes facts, as in "(not (at ann hall))".',
        "METHOD: exact, switching, forest or recursive (for a bank), cost (for a folder), or "
        "module:Class.",
    ),
)
@click.argument("source", metavar="SOURCE")
@click.argument("actions", required=False, metavar="[ACTIONS]")
@click.option("--method", metavar="METHOD",
              help="How to infer; by default switching for a bank, cost for a folder.")  # fmt: skip
@options.goals_per("team")
@options.timeout("Without effect: what is done is counted, so results are the same anywhere.",
                 None)  # fmt: skip
@options.seed("Method forest: random seed of its training.")
@options.picture("--plot", "Draw the posterior of the goals.")
@output.common_options
def command(
    source: str, actions: str | None, method: str | None, goals_per: str,
    timeout: float | None, seed: int, plot: Path | None,
) -> int:  # fmt: skip
    """Infer the human's goal, and where it changed, from the observed ACTIONS."""
    from hrcplan.inference import infer

    options.check_picture(plot, "--plot", source, *([] if actions is None else [actions]))
    method_options: dict[str, Any] = {
        "cost": {} if timeout is None else {"timeout_s": timeout},
        "forest": {"seed": seed, "n_jobs": -1},
    }
    name = method or _default(source)
    inference = infer(source, actions, name, goals_per, **method_options.get(name, {}))
    if plot is not None:
        from hrcplan.plots.posterior import draw

        output.write_atomically(plot, draw(inference, options.picture_form(plot)))
    if output.JSON:
        output.document(inference.as_json())
    else:
        each = inference.humans or {"": inference}
        texts = [f"{human}:\n{as_text(one)}" if human else as_text(one)
                 for human, one in each.items()]  # fmt: skip
        output.result("\n\n".join(texts))
    return 0


def _default(source: str) -> str:
    from hrcplan.inference.registry import BANK_METHOD, GOALS_METHOD

    return GOALS_METHOD if os.path.isdir(source) else BANK_METHOD


def as_text(answer: Inference) -> str:
    """Return the posterior as a table: the likeliest goals after each observation."""
    long = any(len(name) > MAX_NAME for name in answer.goals)
    names = [f"goal {i + 1}" for i in range(len(answer.goals))] if long else list(answer.goals)
    width = max([6, *(len(action) for action in answer.actions)])
    lines = [f"{'':>4}  {'action':<{width}}  likeliest goals"]
    changes = {change.at: change for change in answer.changes}
    by_step = {entry.at: entry for entry in answer.ignored}
    for row, posterior in enumerate(answer.posterior):
        if row - 1 in changes:
            lines.append(f"{'':>4}  -- {_change(changes[row - 1], names)} --")
        action = answer.actions[row - 1] if row else ""
        what = _likeliest(posterior, names)
        if row - 1 in by_step:
            what += f"  [ignored: {by_step[row - 1].reason}]"
        lines.append(output.fold(f"{row or '':>4}  {action:<{width}}  {what}", indent=width + 8))
    if long:
        lines += ["", *(f"{name}: {goal}" for name, goal in zip(names, answer.goals, strict=True))]
    if answer.changed is not None:
        lines += ["", f"probability that the goal has changed: {answer.changed:.2f}"]
    if answer.note:
        lines += ["", f"note: {answer.note}"]
    return "\n".join(lines)


def _change(change: GoalChange, names: list[str]) -> str:
    """Return a change in words; observations are numbered from 1."""
    text = f"goal change ({change.probability:.2f})"
    if change.before is not None and change.after is not None:
        text += f" from {names[change.before]} to {names[change.after]}"
    if change.first is not None and change.last is not None and change.first != change.last:
        text += f"; 90 %: before {change.first + 1} to {change.last + 1}"
    return text


def _likeliest(posterior: tuple[float, ...], names: list[str]) -> str:
    order = sorted(range(len(names)), key=lambda goal: -posterior[goal])
    best = [goal for goal in order if posterior[goal] == posterior[order[0]]]
    if len(best) > N_SHOWN:
        return f"{posterior[best[0]]:.2f} each of {len(best)} goals"
    return ", ".join(
        f"{posterior[goal]:.2f}{output.NO_BREAK}{names[goal]}" for goal in order[:N_SHOWN]
    )
