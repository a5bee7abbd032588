"""Scripted episodes: the same human with several robots, turn by turn.

A script is a TOML file; ``golden.toml`` in this folder is one, with comments.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from hrcplan.agents.profile import agent_values
from hrcplan.assistance import ASSISTANTS, Assistant, Explains, Explanation
from hrcplan.bank import Bank
from hrcplan.core.text import nearest
from hrcplan.core.toml import read_toml
from hrcplan.episodes.episode import EpisodeTurn, play
from hrcplan.episodes.humans import Course, Scripted
from hrcplan.errors import InputError
from hrcplan.inference.belief import S, n_declared
from hrcplan.studies.changed_mind import scenario
from hrcplan.studies.study import present_name

SHIPPED = ("golden",)
TOP = 3
_LISTS = {"wanted": str, "change_turns": int, "human": str, "methods": str}
_TEXTS = ("title", "domain", "goals")
_NEEDED = ("domain", *_LISTS)


@dataclass(frozen=True, slots=True)
class NarratedTurn:
    """One turn of a scripted episode: what was done, and what the robot thinks after it.

    ``top`` are the likeliest goals with their probabilities; ``why`` says what the robot weighed
    before its own step, where its method can say that.
    """

    t: int
    agent: str
    action: str | None
    goal: str
    is_needed: bool
    top: tuple[tuple[str, float], ...]
    n_declared: int
    why: Explanation | None = None


@dataclass(frozen=True, slots=True)
class NarratedEpisode:
    """A scripted episode with one method, from its first turn to its last."""

    method: str
    turns: tuple[NarratedTurn, ...]
    ending: str


def read(name: str) -> Mapping[str, Any]:
    """Return a script: a shipped one by its name, or a file.

    Raises:
        InputError: if it is missing or is not a script.
    """
    path = scenario.HERE / f"{name}.toml" if name in SHIPPED else Path(name)
    try:
        script = read_toml(path, "bad-script")
    except InputError as error:
        error.hint = error.hint or f"shipped: {', '.join(SHIPPED)}"
        raise
    if missing := [key for key in _NEEDED if key not in script]:
        raise InputError(f"the script lacks '{missing[0]}'", code="bad-script", path=name)
    if fault := _fault(script):
        raise InputError(fault, code="bad-script", path=name)
    return script


def _fault(script: Mapping[str, Any]) -> str | None:
    """Return what is wrong with the values of a script, if anything is."""
    for key, kind in _LISTS.items():
        value = script[key]
        if not isinstance(value, list) or any(type(one) is not kind for one in value):
            return f"{key} is a list of {'numbers' if kind is int else 'texts'}"
    for key in _TEXTS:
        if not isinstance(script.get(key, ""), str):
            return f"{key} is a text"
    turns = script["change_turns"]
    if len(script["wanted"]) != len(turns) + 1:
        return "change_turns has one number less than wanted has goals"
    if turns != sorted({*turns, 0})[1:]:
        return "change_turns rise from 1"
    return None if script["methods"] else "methods names none"


def episodes(
    script: Mapping[str, Any], methods: Sequence[str] = (), settings: Sequence[str] = (),
    profile: str | None = None,
) -> list[NarratedEpisode]:  # fmt: skip
    """Return the episodes of a script, one for each method.

    Args:
        script: What ``read`` returns.
        methods: Names of methods, if not those that the script names.
        settings: The agents' state, such as ``motivation human=8``: what steps cost the robots.
        profile: How agent state becomes costs, as in ``execute``; as it is by default.

    Raises:
        UsageError: if there is no such method, or it has no use for agent state.
        InputError: if the script names a goal or a step that there is not.
    """
    task = str(script["domain"]), str(script.get("goals", ""))
    bank = scenario.bank_of(*task)
    goals = tuple(_goal(bank, goal) for goal in script["wanted"])
    course = Course(goals, tuple(script["change_turns"]), seed=str(script.get("seed", "")))
    steps = [_step(bank, text) for text in script["human"]]
    names = methods or script["methods"]
    present_names = [present_name(name, scenario.RENAMED) for name in names]
    for name in present_names if not methods else ():
        if name not in scenario.data()["methods"]:
            ASSISTANTS.find_listed(name)  # a script must not choose which code runs
    values = agent_values(bank.goals.problem, settings, profile)
    robots = {
        method: scenario.robot_at_prices(method, bank, values) if settings
        else scenario.robot(method, *task)
        for method in present_names
    }  # fmt: skip
    return [_play(name, robot, bank, course, steps) for name, robot in robots.items()]


def _goal(bank: Bank, name: str) -> int:
    if name not in bank.names:
        hint = nearest(name, bank.names) or f"goals: {', '.join(bank.names)}"
        raise InputError(f"there is no goal '{name}'", code="unknown-goal", hint=hint)
    return bank.names.index(name)


def _step(bank: Bank, text: str) -> int:
    step = bank.table.find(text.strip().strip("()").lower().split())
    if step is None:
        raise InputError(f"there is no step '{text}'", code="unknown-step")
    return step


def _play(
    name: str, robot: Assistant[S], bank: Bank, course: Course, steps: Sequence[int]
) -> NarratedEpisode:
    turns: list[NarratedTurn] = []
    state = robot.start()

    def watch(turn: EpisodeTurn, after: S) -> None:
        nonlocal state
        reasons = None
        if not turn.is_human and isinstance(robot, Explains):
            reasons = robot.explain(state)
        turns.append(_narrate(turn, robot, bank, after, reasons))
        state = after

    record = play(bank, Scripted(bank, course, steps), robot, course, watch=watch)
    return NarratedEpisode(name, tuple(turns), record.ending)


def _narrate(
    turn: EpisodeTurn, robot: Assistant[S], bank: Bank, state: S, reasons: Explanation | None
) -> NarratedTurn:
    posterior = robot.posterior(state)
    order = sorted(range(len(posterior)), key=lambda goal: -posterior[goal])[:TOP]
    return NarratedTurn(
        turn.t,
        "human" if turn.is_human else "robot",
        None if turn.step is None else str(bank.table[turn.step]),
        bank.names[turn.goal],
        turn.is_needed,
        tuple((bank.names[goal], float(posterior[goal])) for goal in order),
        n_declared(state),
        reasons,
    )


def as_json(script: Mapping[str, Any], narratives: Sequence[NarratedEpisode]) -> dict[str, Any]:
    """Return the document of ``study play``."""
    return {
        "title": script.get("title", ""),
        "wanted": list(script["wanted"]),
        "episodes": [
            {"method": e.method, "ending": e.ending, "turns": list(_turns(e))} for e in narratives
        ],
    }


def _turns(episode: NarratedEpisode) -> Iterator[dict[str, Any]]:
    for turn in episode.turns:
        reasons = turn.why
        yield {
            "t": turn.t,
            "agent": turn.agent,
            "action": turn.action,
            "goal": turn.goal,
            "needed": turn.is_needed,
            "top": [{"goal": goal, "probability": p} for goal, p in turn.top],
            "declared": turn.n_declared,
            "why": None if reasons is None else {
                "goals": [{"goal": goal, "probability": p} for goal, p in reasons.goals],
                "candidates": [
                    {"action": c.action, "value": c.value, "saves": c.saves,
                     "helps": [goal for goal, _ in c.helps]}
                    for c in reasons.candidates
                ],
            },
        }  # fmt: skip
