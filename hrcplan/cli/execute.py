"""``hrcplan execute``: carry a plan out in a world, replan when that is better, show it live."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import rich_click as click

from hrcplan.cli import output
from hrcplan.errors import UsageError

if TYPE_CHECKING:
    from hrcplan.execution.humans import WorldChange
    from hrcplan.pddl.model import Problem

WORLDS = ("simulated",)


@click.command("execute")
@click.argument("names", nargs=-1, required=True, metavar="DOMAIN PROBLEM")
@click.option(
    "--profile",
    "profile_name",
    default="hrcplan",
    show_default=True,
    metavar="NAME",
    help="replan-always, hrcplan, or a .toml file: when to replan, what planners are told.",
)
@click.option(
    "--human",
    default="steady",
    show_default=True,
    metavar="SPEC",
    help="steady, case1 or case2; with commas: random, attempt, before, during, after.",
)
@click.option("--world", type=click.Choice(WORLDS), default="simulated", show_default=True)
@click.option(
    "--planner",
    default="auto",
    show_default=True,
    metavar="NAME",
    help="Asked first; another one takes over if it fails.",
)
@click.option(
    "--timeout",
    type=click.FloatRange(0, min_open=True),
    default=20.0,
    show_default=True,
    metavar="S",
    help="Seconds per plan.",
)
@click.option("--no-model", is_flag=True, help="Do not use what is sensed of the human.")
@click.option(
    "--change",
    "changes",
    multiple=True,
    metavar="'F OBJ…=N@T'",
    help="At T seconds a state or fact changes: 'motivation human=9@0', 'not at a b@60'.",
)
@click.option(
    "--set",
    "settings",
    multiple=True,
    metavar="'F OBJ…=N'",
    help="Change a value of the initial state.",
)
@click.option(
    "--replan-limit",
    type=click.IntRange(0),
    default=None,
    metavar="N",
    help="Instead of the profile's.",
)
@click.option("--seed", type=int, default=1, show_default=True)
@click.option(
    "--journal",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="Write everything down, so that the run can be resumed and replayed.",
)
@click.option("--resume", is_flag=True, help="Go on with the run in the journal.")
@click.option(
    "--speed",
    type=click.FloatRange(0, min_open=True),
    default=None,
    metavar="X",
    help="Simulated seconds per second; as fast as possible if not given.",
)
@output.common_options
def command(
    names: tuple[str, ...],
    profile_name: str,
    human: str,
    world: str,
    planner: str,
    timeout: float,
    no_model: bool,
    changes: tuple[str, ...],
    settings: tuple[str, ...],
    replan_limit: int | None,
    seed: int,
    journal: Path | None,
    resume: bool,
    speed: float | None,
) -> int:
    """Carry out DOMAIN PROBLEM with a simulated human, and replan before actions fail."""
    from hrcplan.cli.arguments import problem_of, split_names
    from hrcplan.cli.live import Live
    from hrcplan.execution.execute import carry_out, make_setup

    domain, name, _ = split_names(names, 0)
    problem = problem_of(domain, name, settings)
    setup = make_setup(
        problem, profile=profile_name, human=human, model=not no_model, planner=planner, seed=seed,
        changes=[_change(text, problem) for text in changes], replan_limit=replan_limit,
        timeout_s=timeout,
    )  # fmt: skip
    live = Live(problem, speed)
    done = carry_out(setup, journal=journal, resume=resume, timeout_s=timeout,
                     watch=None if output.JSON else live.watch)  # fmt: skip
    if output.JSON:
        row = done.row
        output.document({
            "success": row.success, "ending": row.ending, "why": done.run.why or None,
            "row": row.to_json(), "measures": row.measures(), **done.timeline.to_json(),
        })  # fmt: skip
    else:
        live.finish(done.run, done.row)
    return 0 if done.row.success else 1


def _change(text: str, problem: Problem) -> WorldChange:
    from hrcplan.cli.arguments import setting
    from hrcplan.execution.worlds.simulated import FactChange, StateChange

    what, at, when = text.lower().rpartition("@")
    try:
        t = float(when)
    except ValueError:
        t = -1.0
    if not at or not 0 <= t < float("inf"):
        message = f"'{text}' does not end with @SECONDS"
        raise UsageError(message, code="bad-change", hint='as in --change "motivation human=9@0"')
    if "=" in what:
        key, value = setting(what, problem)
        return StateChange(t, {key: value})
    words = what.replace("(", " ").replace(")", " ").split()
    negated = words[:1] == ["not"]
    fact = tuple(words[1:] if negated else words)
    _check_fact(fact, problem)
    facts = frozenset({fact})
    return FactChange(t, deletes=facts) if negated else FactChange(t, adds=facts)


def _check_fact(fact: tuple[str, ...], problem: Problem) -> None:
    known = problem.domain.predicates.get(fact[0]) if fact else None
    if known is None or len(known.params) != len(fact) - 1:
        message = f"'{' '.join(fact)}' is no fact of the domain"
        hint = f"predicates: {', '.join(map(str, problem.domain.predicates.values()))}"
        raise UsageError(message, code="bad-change", hint=hint)
    for word, param in zip(fact[1:], known.params, strict=True):
        if word not in problem.objects_of(param.types):
            raise UsageError(f"'{word}' is no object for {param}", code="bad-change")
