"""``hrcplan execute``: carry a plan out in a world, replan when that is better, show it live."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import rich_click as click

from hrcplan.cli import output
from hrcplan.errors import UsageError

if TYPE_CHECKING:
    from hrcplan.execution.humans import Change
    from hrcplan.execution.journal import Setting, Writer
    from hrcplan.pddl.model import Problem

WORLDS = ("simulated",)


@click.command("execute")
@click.argument("names", nargs=-1, required=True, metavar="DOMAIN PROBLEM")
@click.option("--profile", "profile_name", default="hrcplan", show_default=True, metavar="NAME",
              help="paper, hrcplan, or a .toml file: when to replan, what planners are told.")
@click.option("--human", default="steady", show_default=True, metavar="SPEC",
              help="steady, case1 or case2; with commas: random, attempt, before, during, after.")
@click.option("--world", type=click.Choice(WORLDS), default="simulated", show_default=True)
@click.option("--planner", default="auto", show_default=True, metavar="NAME",
              help="Asked first; another one takes over if it fails.")
@click.option("--timeout", type=click.FloatRange(0, min_open=True), default=20.0,
              show_default=True, metavar="S", help="Seconds per plan.")
@click.option("--no-model", is_flag=True, help="Do not use what is sensed of the human.")
@click.option("--change", "changes", multiple=True, metavar="'F OBJ…=N@T'",
              help="At T seconds a state or fact changes: 'motivation human=9@0', 'not at a b@60'.")
@click.option("--set", "settings", multiple=True, metavar="'F OBJ…=N'",
              help="Change a value of the initial state.")
@click.option("--replan-limit", type=click.IntRange(0), default=None, metavar="N",
              help="Instead of the profile's.")
@click.option("--seed", type=int, default=1, show_default=True)
@click.option("--journal", type=click.Path(path_type=Path), metavar="FILE",
              help="Write everything down, so that the run can be resumed and replayed.")
@click.option("--resume", is_flag=True, help="Go on with the run in the journal.")
@click.option("--speed", type=click.FloatRange(0, min_open=True), default=None, metavar="X",
              help="Simulated seconds per second; as fast as possible if not given.")
@output.common_options
def command(
    names: tuple[str, ...], profile_name: str, human: str, world: str, planner: str,
    timeout: float, no_model: bool, changes: tuple[str, ...], settings: tuple[str, ...],
    replan_limit: int | None, seed: int, journal: Path | None, resume: bool, speed: float | None,
) -> int:
    """Carry out DOMAIN PROBLEM with a simulated human, and replan before actions fail."""
    from hrcplan.agents import profile
    from hrcplan.cli.arguments import problem_of, split_names
    from hrcplan.execution.humans import nature_for, spec_of
    from hrcplan.execution.journal import Setting
    from hrcplan.execution.replanner import Replanner
    from hrcplan.execution.simulate import Spec, make_engine

    if resume and journal is None:
        raise UsageError("--resume needs --journal FILE")
    domain, name, _ = split_names(names, 0)
    problem = problem_of(domain, name, settings)
    chosen = profile(profile_name).limited_to(replan_limit)
    engine = make_engine(problem, chosen, not no_model,
                         Replanner(problem, (planner,), timeout))
    spec = spec_of(human, Spec(domain, name, seed=seed, model=not no_model))
    nature = nature_for(spec, engine, [_change(text, problem) for text in changes])
    setting = Setting(problem, chosen, not no_model, nature, (planner,))
    setting, writer = _journal(journal, resume, setting)
    return _carry_out(setting, writer, Replanner(setting.problem, setting.planners, timeout), speed)


def _journal(
    path: Path | None, resume: bool, setting: Setting
) -> tuple[Setting, Writer | None]:
    """Return the setting of the run (a resumed one brings its own) and its journal."""
    from hrcplan.execution.journal import Writer, read_journal

    if path is None:
        return setting, None
    if not resume or not path.exists():
        return setting, Writer.begin(path, setting)
    known = read_journal(path)
    if known.is_empty:
        path.unlink()  # killed before the first line was complete
        return setting, Writer.begin(path, setting)
    found = known.setting()
    if (found.problem.name, found.problem.domain.name) != (
        setting.problem.name, setting.problem.domain.name,
    ):  # fmt: skip
        message = f"the journal is of {found.problem.domain.name}/{found.problem.name}"
        raise UsageError(message, path=str(path))
    return found, Writer.resume(known)


def _change(text: str, problem: Problem) -> Change:
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


def _carry_out(
    setting: Setting, writer: Writer | None, replanner: Any, speed: float | None
) -> int:
    from hrcplan.cli.live import Live
    from hrcplan.execution.simulate import make_engine
    from hrcplan.execution.timeline import Timeline

    engine = make_engine(setting.problem, setting.profile, setting.sensing, replanner)
    timeline = Timeline()
    live = Live(setting.problem, engine.monitor.agents.robots, speed)

    def watch(run: Any, event: Any, commands: Any) -> None:
        timeline.watch(run, event, commands)
        if not output.JSON:
            live.watch(run, event, commands, repeated=writer is not None and writer.is_repeating)

    run = engine.run(setting.nature, writer, watch)
    row = engine.row(run)
    if writer is not None:
        writer.close(row)
    if output.JSON:
        output.document({
            "success": row.success, "ending": row.ending, "why": run.why or None,
            "row": row.to_json(), "measures": row.measures(), **timeline.to_json(),
        })  # fmt: skip
    else:
        live.finish(run, row)
    return 0 if row.success else 1
