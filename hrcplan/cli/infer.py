"""``hrcplan infer``: what someone is after, from what they did."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import rich_click as click

from hrcplan.cli import output
from hrcplan.core.files import check_target
from hrcplan.errors import UsageError

if TYPE_CHECKING:
    from hrcplan.inference import Inference

N_SHOWN = 3
MAX_NAME = 28


@click.command("infer")
@click.argument("source", metavar="SOURCE")
@click.argument("actions", required=False, metavar="[ACTIONS]")
@click.option("--method", metavar="NAME",
              help="exact, switching, forest, recursive, cost, or module:Class.")  # fmt: skip
@click.option("--timeout", type=click.FloatRange(0, min_open=True), default=25.0,
              show_default=True, metavar="S",
              help="Seconds for the distances of method cost; then it estimates.")  # fmt: skip
@click.option("--seed", type=int, default=0, show_default=True, help="Of method forest.")
@click.option("--plot", type=click.Path(path_type=Path), metavar="FILE",
              help="Draw the posterior into a .png or .svg file.")  # fmt: skip
@output.common_options
def command(
    source: str, actions: str | None, method: str | None, timeout: float, seed: int,
    plot: Path | None,
) -> int:  # fmt: skip
    """Infer the goal from ACTIONS, one a line.

    SOURCE is a bank (`hrcplan bank build`), or a folder with domain.pddl, template.pddl and
    hyps.dat, whose obs.dat is then the default ACTIONS.
    """
    from hrcplan.inference import infer

    _check_target(plot, source, *([] if actions is None else [actions]))
    options: dict[str, Any] = {
        "cost": {"timeout_s": timeout},
        "forest": {"seed": seed, "n_jobs": -1},
    }
    name = method or _default(source)
    found = infer(source, actions, name, **options.get(name, {}))
    if plot is not None:
        from hrcplan.plots.posterior import draw

        output.write_atomically(plot, draw(found, plot.suffix[1:].lower()))
    if output.JSON:
        output.document(found.as_json())
    else:
        output.result(as_text(found))
    return 0


def _default(source: str) -> str:
    from hrcplan.inference.registry import BANK_METHOD, GOALS_METHOD

    return GOALS_METHOD if Path(source).is_dir() else BANK_METHOD


def _check_target(plot: Path | None, *inputs: str) -> None:
    if plot is None:
        return
    if plot.suffix.lower() not in (".png", ".svg"):
        raise UsageError(f"--plot writes .png or .svg, not '{plot.suffix}'", path=str(plot))
    check_target(plot, *inputs)


def as_text(found: Inference) -> str:
    """Return the posterior as a table: the likeliest goals after each observation."""
    long = any(len(name) > MAX_NAME for name in found.goals)
    names = [f"goal {i + 1}" for i in range(len(found.goals))] if long else list(found.goals)
    width = max([6, *(len(action) for action in found.actions)])
    lines = [f"{'':>4}  {'action':<{width}}  likeliest goals"]
    changes = {change.at: change for change in found.changes}
    ignored = {ignored.at: ignored for ignored in found.ignored}
    for row, posterior in enumerate(found.posterior):
        if row - 1 in changes:
            lines.append(f"{'':>4}  -- goal change ({changes[row - 1].probability:.2f}) --")
        action = found.actions[row - 1] if row else ""
        what = _likeliest(posterior, names)
        if row - 1 in ignored:
            what += f"  [ignored: {ignored[row - 1].reason}]"
        lines.append(f"{row or '':>4}  {action:<{width}}  {what}")
    if long:
        lines += ["", *(f"{name}: {goal}" for name, goal in zip(names, found.goals, strict=True))]
    if found.note:
        lines += ["", f"note: {found.note}"]
    return "\n".join(lines)


def _likeliest(posterior: tuple[float, ...], names: list[str]) -> str:
    order = sorted(range(len(names)), key=lambda goal: -posterior[goal])
    best = [goal for goal in order if posterior[goal] == posterior[order[0]]]
    if len(best) > N_SHOWN:
        return f"{posterior[best[0]]:.2f} each of {len(best)} goals"
    return ", ".join(f"{posterior[goal]:.2f} {names[goal]}" for goal in order[:N_SHOWN])
