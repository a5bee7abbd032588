"""``hrcplan study play``: a scripted episode with several methods side by side."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import click

from hrcplan.cli import options, output
from hrcplan.errors import UsageError

if TYPE_CHECKING:
    from rich.table import Table

    from hrcplan.studies.changed_mind.script import NarratedEpisode, NarratedTurn


_INDENT = "  "  # of what a robot believes


@click.command(
    "play",
    cls=options.SettingsCommand,
    epilog=options.notes(
        options.SETTING,
        options.PROFILE,
        "SCRIPT: golden, or a TOML file with the keys domain, wanted, change_turns, human and "
        "methods.",
        options.ROBOTS,
    ),
)
@click.argument("script", metavar="SCRIPT")
@click.option("--method", "methods", multiple=True, metavar="METHOD",
              help="The robot; repeatable. By default those in the script.")  # fmt: skip
@click.option(
    "--why", "show_why", is_flag=True, help="Also print how the robot valued its options."
)
@options.settings
@click.option("--profile", metavar="PROFILE",
              help="With --set: how agent state becomes costs, as in `execute`.")  # fmt: skip
@output.common_options
def command(
    script: str, methods: tuple[str, ...], show_why: bool, settings: tuple[str, ...],
    profile: str | None,
) -> int:  # fmt: skip
    """Play a scripted episode with several robots, side by side.

    The human does the same steps each time. Below each step of a robot are the goals that it then
    believes most probable. With --set, what steps cost agents in that state counts in the choice
    of hrcplan: it takes over more of what is hard for the human.
    """
    from hrcplan.studies.changed_mind import script as scripts

    if profile is not None and not settings:
        raise UsageError("--profile says what the agent state of --set costs: use them together")
    episode_script = scripts.read(script)
    narratives = scripts.episodes(episode_script, methods, settings, profile)
    if output.JSON:
        output.document(scripts.as_json(episode_script, narratives))
        return 0
    output.result(output.fold(str(episode_script.get("title", script))))
    n_columns = _n_columns(narratives, output.table_width())
    for first in range(0, len(narratives), n_columns):
        output.table(_side_by_side(narratives[first : first + n_columns]))
    if show_why:
        for episode in narratives:
            output.result("\n".join(_reasons(episode)))
    return 0


def _n_columns(narratives: Sequence[NarratedEpisode], width: int) -> int:
    """Return how many methods fit side by side so that no goal in them is cut."""
    goals = {goal for e in narratives for turn in e.turns for goal, _ in turn.top}
    names = {turn.goal for e in narratives for turn in e.turns}
    left = 5 + max(map(len, names), default=0) + 2  # the columns of turns and of goals
    column = len(_INDENT) + 5 + max(map(len, goals), default=0) + 2 + 2
    return max(1, (width - left) // column)


def _side_by_side(narratives: Sequence[NarratedEpisode]) -> Table:
    """Return a table with a row per turn and a column per method."""
    from rich.markup import escape
    from rich.table import Table

    table = Table(box=None, padding=(0, 2, 0, 0), header_style="bold")
    table.add_column("t", justify="right", no_wrap=True)
    table.add_column("goal", no_wrap=True)
    for episode in narratives:
        table.add_column(escape(episode.method))
    for t in range(max(len(episode.turns) for episode in narratives)):
        turns = [e.turns[t] if t < len(e.turns) else None for e in narratives]
        goal = next(turn.goal for turn in turns if turn is not None)
        last = next((e.turns[t - 1].goal for e in narratives if 0 < t <= len(e.turns)), None)
        table.add_row(str(t), "" if goal == last else escape(goal), *map(_cell, turns))
    return table


def _cell(turn: NarratedTurn | None) -> str:
    from rich.markup import escape

    if turn is None:
        return ""
    action = escape((turn.action or "waits").strip("()"))
    if turn.agent == "human":
        return f"[dim]human[/] {action}"
    mark = "" if turn.is_needed or turn.action is None else " [red]not needed[/]"
    goals = "\n".join(_belief_text(escape(goal), p, goal == turn.goal) for goal, p in turn.top)
    return f"[bold]robot {action}[/]{mark}\n{goals}"


def _belief_text(goal: str, probability: float, is_right: bool) -> str:
    line = f"{probability:4.0%} {goal}"
    return f"{_INDENT}[green]{line} ✓[/]" if is_right else f"{_INDENT}{line}"


def _reasons(episode: NarratedEpisode) -> list[str]:
    """Return what a method weighed before each step of the robot."""
    lines = ["", f"{episode.method}: what the robot weighed"]
    for turn in episode.turns:
        if turn.why is None:
            continue
        goals = ", ".join(f"{goal} {p:.0%}" for goal, p in turn.why.goals)
        lines.append(f"  {turn.t:3d}  believes {goals}")
        for c in turn.why.candidates:
            mark = "->" if c.action == turn.action else "  "
            helps = ", ".join(goal for goal, _ in c.helps)
            lines.append(
                f"       {mark} {c.action:28} value {c.value:6.2f}, saves {c.saves:5.2f} steps, "
                f"for {helps}"
            )
    return lines
