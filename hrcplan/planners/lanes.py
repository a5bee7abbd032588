"""Sequential plans in lanes: a partial order, then a schedule, one action per agent at a time.

The order of two steps is kept where they interfere (one writes what the other reads, or adds what
it deletes); all other orders are given up. Where a task is agent-free and a step costs the same
for every agent, the step may move to the other lane.
"""

from __future__ import annotations

import contextlib
from collections.abc import Sequence
from dataclasses import replace

from hrcplan.core.numbers import Number
from hrcplan.core.records import record
from hrcplan.errors import LimitError, UnsupportedError
from hrcplan.pddl.interference import Access, access, depends
from hrcplan.pddl.model import Action, Problem
from hrcplan.pddl.semantics import Binding, Undefined, bind, evaluate
from hrcplan.plans import EPSILON_S, Plan, PlannedAction, occupied
from hrcplan.task import Task

_Option = tuple[PlannedAction, frozenset[str]]
"""A step done by one agent, and the agents that it keeps busy."""


@record
class _Job:
    """One step: how long it lasts, what must end before it, and who could do it (with whom)."""

    action: PlannedAction
    duration: Number
    after: tuple[int, ...]
    options: tuple[_Option, ...]


def schedule(problem: Problem, plan: Plan) -> tuple[Plan, bool]:
    """Return a valid plan laid out in lanes, and whether it is the shortest for its partial order.

    Steps of a classical problem last one unit and follow each other without gaps; those of a
    temporal one keep their durations, with gaps of ``EPSILON_S`` where they follow each other.
    Steps are placed by the longest chain that hangs on them (critical-path list scheduling, optimal
    to within the bound that decides the second value: chain length or work per agent).
    """
    jobs = _jobs(problem, plan)
    gap: Number = EPSILON_S if problem.domain.is_temporal else 0
    tails = _tails(jobs)
    ends: dict[int, Number] = {}
    free: dict[str, Number] = dict.fromkeys(problem.agents, 0)
    timeline: list[PlannedAction] = []
    while len(ends) < len(jobs):
        ready = [i for i, job in enumerate(jobs) if i not in ends and ends.keys() >= set(job.after)]
        offers = (_offer(i, jobs[i], ends, free, gap, tails) for i in ready)
        start, _, i, option = min(offers)
        action, busy = jobs[i].options[option]
        ends[i] = start + jobs[i].duration
        free.update((agent, ends[i] + gap) for agent in busy)
        timeline.append(replace(action, start_s=start, duration_s=jobs[i].duration))
    timeline.sort(key=lambda a: (a.start_s, a.args))
    makespan = max(ends.values(), default=0)
    return Plan(tuple(timeline)), makespan - _bound(jobs, tails) <= gap * len(jobs)


def _offer(
    i: int, job: _Job, ends: dict[int, Number], free: dict[str, Number], gap: Number,
    tails: Sequence[Number],
) -> tuple[Number, Number, int, int]:  # fmt: skip
    """Return the earliest start of a step, as a key: earliest first, longest tail first."""
    ready = max((ends[j] + gap for j in job.after), default=0)
    starts = [
        (max([ready, *(free.get(agent, 0) for agent in busy)]), option)
        for option, (_, busy) in enumerate(job.options)
    ]
    start, option = min(starts)
    return start, -tails[i], i, option


def _jobs(problem: Problem, plan: Plan) -> list[_Job]:
    touches = [whole_access(problem, action) for action in plan.actions]
    options = _options(problem, plan)
    return [
        _Job(
            action,
            _duration(problem, problem.domain.action(action.name), action),
            tuple(j for j in range(i) if depends(problem, touches[j], touches[i])),
            options[i],
        )
        for i, action in enumerate(plan.actions)
    ]


def with_durations(problem: Problem, plan: Plan) -> Plan:
    """Return a plan in which every durative action of a free duration has its shortest one.

    Planners without time leave durations open.
    """
    schemas = {action.name: action for action in problem.domain.actions}
    return Plan(tuple(_with_duration(problem, schemas.get(a.name), a) for a in plan.actions))


def _with_duration(problem: Problem, schema: Action | None, action: PlannedAction) -> PlannedAction:
    if schema is None or not schema.durative or action.duration_s is not None:
        return action
    binding = bind(schema, action.args, problem)
    if isinstance(binding, str) or any(op == "=" for op, _ in schema.durations):
        return action  # validation says what is wrong, or evaluates the duration there
    with contextlib.suppress(Undefined):
        return replace(action, duration_s=shortest_duration(problem, schema, binding))
    return action


def shortest_duration(problem: Problem, schema: Action, binding: Binding) -> Number:
    """Return the shortest duration of an action that is allowed in the initial state.

    Raises:
        Undefined: if it depends on a function without a value.
    """
    values = [(op, evaluate(expr, problem.values, binding)) for op, expr in schema.durations]
    least = [value for op, value in values if op in ("=", ">=")]
    most = [value for op, value in values if op == "<="]
    return max(least) if least else min(most, default=0)


def _duration(problem: Problem, schema: Action, action: PlannedAction) -> Number:
    if not schema.durative:
        return 1
    if action.duration_s is not None:
        return action.duration_s
    return shortest_duration(problem, schema, _binding(schema, action, problem))


def _binding(schema: Action, action: PlannedAction, problem: Problem) -> dict[str, str]:
    binding = bind(schema, action.args, problem)
    assert not isinstance(binding, str)
    return dict(binding)


def whole_access(problem: Problem, action: PlannedAction) -> Access:
    """Return what a whole action reads and writes, but for the total-cost that it adds."""
    schema = problem.domain.action(action.name)
    binding = _binding(schema, action, problem)
    start, end = (access(problem, schema, binding, when) for when in ("start", "end"))
    over = access(problem, schema, binding, "all")
    return Access(*(a | b | c for a, b, c in zip(start, over, end, strict=True)))


def _options(problem: Problem, plan: Plan) -> list[tuple[_Option, ...]]:
    own = [((action, occupied(action, problem)),) for action in plan.actions]
    if len(problem.agents) < 2 or problem.domain.is_temporal:
        return list(own)
    try:
        task = Task(problem)
    except (UnsupportedError, LimitError):
        return list(own)  # steps stay with their agents: no bits hold this task
    if not task.is_agent_free:
        return list(own)
    by_step: dict[tuple[str, ...], list[int]] = {}
    for ground in task.actions:
        by_step.setdefault(ground.step, []).append(ground.index)
    choices: list[tuple[_Option, ...]] = []
    for action, own_option in zip(plan.actions, own, strict=True):
        mine = task.find(action.name, action.args)
        alike = [
            i for i in by_step[task.actions[mine[0]].step] if task.costs[i] == task.costs[mine[0]]
        ] if mine else []  # fmt: skip
        others = [PlannedAction(task.actions[i].name, task.actions[i].args) for i in alike]
        choices.append(tuple((o, occupied(o, problem)) for o in others) or own_option)
    return choices


def _tails(jobs: Sequence[_Job]) -> list[Number]:
    """Return for each step the length of the longest chain that begins with it."""
    tails: list[Number] = [job.duration for job in jobs]
    for i in reversed(range(len(jobs))):
        for j in jobs[i].after:
            tails[j] = max(tails[j], jobs[j].duration + tails[i])
    return tails


def _bound(jobs: Sequence[_Job], tails: Sequence[Number]) -> Number:
    """Return a makespan that no schedule of these steps beats: chains, and work per agent."""
    agents = {agent for job in jobs for _, busy in job.options for agent in busy}
    lane_times = [
        sum(job.duration for job in jobs if all(agent in busy for _, busy in job.options))
        for agent in agents
    ]
    work = sum(job.duration * min(len(busy) for _, busy in job.options) for job in jobs)
    spread = -(-work // len(agents)) if agents and isinstance(work, int) else 0
    return max([0, *tails, *lane_times, spread])
