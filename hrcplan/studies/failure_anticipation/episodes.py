"""The episodes of the study: one simulated run, one replanned plan, or one run shown in full."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass, field, fields, replace
from functools import lru_cache
from typing import Any

from hrcplan.agents.memory import Memory
from hrcplan.execution import MEASURES, Engine, Outcome, Spec, engine_for
from hrcplan.execution import events as ev
from hrcplan.execution.run import Run
from hrcplan.execution.simulate import forget, nature_of
from hrcplan.execution.worlds.simulated import Nature, StateChange
from hrcplan.pddl.model import FluentKey
from hrcplan.pddl.semantics import LiftedState
from hrcplan.plans import Plan, PlannedAction
from hrcplan.studies.failure_anticipation import scenario
from hrcplan.studies.study import Cell, StudyOptions, StudyRow

_COUNTS = tuple(field.name for field in fields(Outcome))
_DRAWN = ("element", "value", "change_s")
COLUMNS = (*_COUNTS, *(name for name in MEASURES if name not in _COUNTS), *_DRAWN)
SHARES = ("n_human", "n_robot", "cost")
TOLD = ("ending", "replans", "bars", "plans")


def simulate(kind: str, options: StudyOptions, cell: Cell, seed: str) -> StudyRow:
    """Return the row of one simulated run: its counts, its measures, and what chance drew."""
    case, name = map(str, cell)
    spec = scenario.spec(scenario.methods(kind, options)[name], case, options, seed)
    return row_of(spec)


def swept(options: StudyOptions, cell: Cell, seed: str) -> StudyRow:
    """Return the row of one simulated run of the sweeps."""
    _make_room_for(cell)
    return row_of(scenario.swept(options, cell, seed))


@lru_cache(maxsize=1)
def _make_room_for(cell: Cell) -> None:
    """Free what the cell before this one kept: each plans for a problem of its own."""
    forget()


def row_of(spec: Spec) -> StudyRow:
    """Return the row of one simulated run."""
    engine = engine_for(spec)
    nature = nature_of(spec, engine)
    outcome = engine.outcome(engine.run(nature))
    chance_columns: StudyRow = dict.fromkeys(_DRAWN)
    for change in nature.changes:
        for key, value in change.values.items():
            chance_columns = {"element": " ".join(key), "value": float(value), "change_s": change.t}
    return {**outcome.to_json(), **outcome.measures(), **chance_columns}


def allocation(options: StudyOptions, cell: Cell, seed: str) -> StudyRow:
    """Return who does what in the plan after a change: a point of Figure 5."""
    profile, at, value = str(cell[0]), int(cell[1]), int(cell[2])
    engine = engine_for(replace(_plain(options), profile=profile))
    monitor = engine.monitor
    key = scenario.element("allocation", options, human_elements(engine))
    before = state_at(engine, starts_of_human(engine)[at])
    planner_values = monitor.profile.planner_values(monitor.model.agents, {key: value}, Memory())
    facts = monitor.model.actions.changing(before)
    answer = engine.planner.answer(ev.AskPlan(0.0, facts, before.values, planner_values))
    actions = () if answer.plan is None else answer.plan.actions
    n_human = sum(is_human(engine, action) for action in actions)
    cost = None if answer.metric is None else float(answer.metric)
    return {"n_human": n_human, "n_robot": len(actions) - n_human, "cost": cost}


def allocation_cells(options: StudyOptions) -> list[Cell]:
    """Return profile, number of the human's action before which the change comes, and value."""
    settings = scenario.data()["allocation"]
    n_actions = len(starts_of_human(engine_for(_plain(options))))
    return [
        (profile, at, value)
        for profile in settings["profiles"]
        for at in range(n_actions)
        for value in range(settings["most"] + 1)
    ]


def example_cells(options: StudyOptions) -> list[Cell]:
    """Return the variants of the illustrative example; none where the human does nothing."""
    if not starts_of_human(engine_for(_plain(options))):
        return []
    return [(variant["name"],) for variant in scenario.data()["example"]["variants"]]


def example(options: StudyOptions, cell: Cell, seed: str) -> StudyRow:
    """Return one variant of the illustrative example: every action carried out, every plan."""
    settings = scenario.data()["example"]
    variant = next(v for v in settings["variants"] if v["name"] == cell[0])
    changes = {key: value for key, value in variant.items() if key != "name"}
    engine = engine_for(replace(_plain(options), **changes))
    starts = starts_of_human(engine)
    key = scenario.element("example", options, human_elements(engine))
    change = StateChange(starts[min(settings["action"], len(starts)) - 1], {key: settings["value"]})
    film = Film(engine)
    run = engine.run(Nature(seed, (change,)), watch=film)
    return {
        "ending": run.ending or "",
        "replans": run.counts.n_replans,
        "bars": json.dumps(film.bars),
        "plans": json.dumps(film.plans),
    }


@dataclass
class Film:
    """Watches a run: ``bars`` are the actions carried out, ``plans`` when and why plans changed."""

    engine: Engine
    bars: list[dict[str, Any]] = field(default_factory=list)
    plans: list[dict[str, Any]] = field(default_factory=list)
    _open: dict[int, dict[str, Any]] = field(default_factory=dict)

    def __call__(self, run: Run, event: ev.Event, commands: tuple[ev.Command, ...]) -> None:
        """Take down one step of the monitor."""
        if isinstance(event, ev.Ended) and event.number in self._open:
            self._open.pop(event.number).update(end_s=event.t, outcome=event.outcome)
        for command in commands:
            if isinstance(command, ev.Adopt):
                self.plans.append({"t": command.t, "why": command.why})
            elif isinstance(command, ev.Dispatch):
                bar = {
                    "agent": command.agent, "action": command.action, "args": command.args[1:],
                    "start_s": command.t, "end_s": command.t + command.duration_s, "outcome": "",
                }  # fmt: skip
                self._open[command.number] = bar
                self.bars.append(bar)


def _plain(options: StudyOptions) -> Spec:
    return Spec(domain=options["domain"], problem=options["problem"])


def human_elements(engine: Engine) -> list[FluentKey]:
    """Return the elements of agent state that are not a robot's."""
    agents = engine.monitor.model.agents
    return [key for key in agents.low if key[1] not in agents.robots]


def is_human(engine: Engine, action: PlannedAction) -> bool:
    """Whether an action is done by an agent that takes no commands."""
    step = engine.model.actions.step(action)
    return step is not None and engine.model.is_human(step.agent)


def starts_of_human(engine: Engine) -> list[float]:
    """Return when the human's actions begin in the first plan."""
    return list(_starts(engine))


def _starts(engine: Engine) -> Iterator[float]:
    for action in (engine.first_plan() or Plan()).actions:
        if is_human(engine, action):
            yield float(action.start_s or 0)


def state_at(engine: Engine, t: float) -> LiftedState:
    """Return the state of the first plan when what had begun before ``t`` has ended."""
    acting = engine.monitor.model.actions
    state = acting.initial()
    for action in (engine.first_plan() or Plan()).actions:
        step = acting.step(action)
        if step is None or float(action.start_s or 0) >= t - ev.INSTANT_S:
            continue
        duration = action.duration_s or 0
        state, _ = acting.begin(state, step, duration)
        state = acting.finish(state, step, duration)
    return state
