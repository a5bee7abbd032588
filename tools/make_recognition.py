#!/usr/bin/env python3
"""Write instances of goal recognition that no planner has a part in, with or without changes.

    tools/make_recognition.py SETS.toml -n 8 --seed 1 -o FOLDER [--changes] [--only NAME ...]

Each table of SETS.toml names a problem (its domain beside it), the predicates that goals are of,
and how many facts a goal has; see tests/data/recognition/instances.toml. An instance begins after a
random walk; its goals are sets of facts that hold after other random walks, and one of them is
drawn. The observed actions are drawn uniformly from all its optimal plans. With --changes the
actions are those of one goal up to a turn drawn uniformly, and then those of an optimal plan of
another goal from there; ``change.json`` says which and when, and as many instances have no change.

A change leaves a trace: the run has at least two actions more than an optimal plan of its last
goal.

The format is that of Ramírez and Geffner. The same arguments write the same files.
"""

from __future__ import annotations

import argparse
import json
import random
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import numpy as np

from hrcplan import read
from hrcplan.bank.construct import optimal_graph
from hrcplan.bank.graph import PlanGraph
from hrcplan.bank.search import BuildLimits
from hrcplan.bank.walk import Sampler
from hrcplan.core.toml import read_toml
from hrcplan.errors import HrcplanError, LimitError
from hrcplan.pddl.model import TRUE, Fact, Problem
from hrcplan.pddl.write import domain_text, problem_text
from hrcplan.task import Task
from hrcplan.task.conditions import Test
from hrcplan.task.steps import StepTable

MOST_STEPS, LEAST_DETOUR = 40, 2
WALK_BEFORE, WALK_TO_GOALS, MAX_TRIES = 12, 400, 400
LIMITS = BuildLimits(mib=128)


@dataclass(frozen=True)
class GoalSource:
    """A world, and what goals in it look like: one table of the file."""

    problem: Problem
    predicates: frozenset[str]
    n_facts: int
    objects: frozenset[str]
    hidden: frozenset[str]
    n_goals: int = 10
    least_steps: int = 5
    most_shared: int = 99

    def is_goal_fact(self, fact: Fact) -> bool:
        """Return whether a goal may hold this fact."""
        return fact[0] in self.predicates and (not self.objects or fact[1] in self.objects)


def sources(
    path: Path, n_facts: int | None, limits: Mapping[str, int]
) -> Iterator[tuple[str, GoalSource]]:
    """Yield the worlds of a file by name."""
    for name, table in read_toml(path, "bad-sets").items():
        problem = read(str(path.parent / f"{name}.pddl"), str(path.parent / table["problem"]))
        words = (frozenset(table.get(key, ())) for key in ("goals", "only", "hidden"))
        predicates, objects, hidden = words
        size = n_facts or table["facts"]
        yield name, GoalSource(problem, predicates, size, objects, hidden, **limits)


class World:
    """One instance's world: where it begins, and goals with their plans."""

    def __init__(self, source: GoalSource, rng: random.Random) -> None:
        task = Task(source.problem)
        self.source, self.rng = source, rng
        begin = self._walk(task, task.initial, rng.randrange(WALK_BEFORE))
        static = source.problem.facts - set(task.facts)
        facts = static | task.facts_of(begin)
        self.problem = replace(source.problem, name="instance", facts=facts, goal=TRUE)
        self.task = Task(self.problem)
        self.table = StepTable(self.task)
        self.goals = self._goals()

    def _walk(self, task: Task, state: int, n: int) -> int:
        for _ in range(n):
            options = task.applicable(state)
            if not options:
                break
            state = task.successor(state, self.rng.choice(options))
        return state

    def _goals(self) -> list[tuple[frozenset[Fact], PlanGraph]]:
        """Return goals that need some steps, none within another."""
        goals: list[tuple[frozenset[Fact], PlanGraph]] = []
        before = self.task.facts_of(self.task.initial)
        for _ in range(MAX_TRIES):
            if len(goals) == self.source.n_goals:
                break
            end = self._walk(self.task, self.task.initial, self.rng.randrange(WALK_TO_GOALS))
            options = sorted(filter(self.source.is_goal_fact, self.task.facts_of(end) - before))
            if len(options) < self.source.n_facts:
                continue
            facts = frozenset(self.rng.sample(options, self.source.n_facts))
            shared = [len(facts & other) for other, _ in goals]
            if any(n > self.source.most_shared or facts <= other or other <= facts
                   for n, (other, _) in zip(shared, goals, strict=True)):  # fmt: skip
                continue
            graph = self.graph(facts, self.task.initial)
            if graph is not None and self.source.least_steps <= graph.steps_left[0] <= MOST_STEPS:
                goals.append((facts, graph))
        return goals

    def test(self, facts: frozenset[Fact]) -> Test:
        """Return a goal as a test of states."""
        bits = sum(1 << self.task.bits[fact] for fact in facts)
        return bits, bits

    def graph(self, facts: frozenset[Fact], state: int) -> PlanGraph | None:
        """Return the optimal plans of a goal from a state; None if they are too many, or none."""
        try:
            graph = optimal_graph(self.table, (self.test(facts),), state, limits=LIMITS)
        except LimitError:
            return None
        return graph if graph.n_nodes else None

    def plan(self, graph: PlanGraph) -> list[int]:
        """Return the steps of a plan drawn uniformly."""
        rng = np.random.default_rng(self.rng.randrange(1 << 32))
        return [step for step in Sampler(graph).draw(1, rng)[0].tolist() if step >= 0]

    def observed(self, steps: Sequence[int]) -> str:
        """Return the text of the steps that are observed."""
        names = (self.table[step] for step in steps)
        return "".join(f"{step}\n" for step in names if step.words[0] not in self.source.hidden)


def _unchanged(world: World) -> tuple[str, int, dict[str, int | None]]:
    true = world.rng.randrange(len(world.goals))
    observed = world.observed(world.plan(world.goals[true][1]))
    return observed, true, {"at": None, "from": true, "to": true}


def _changed(world: World) -> tuple[str, int, dict[str, int | None]] | None:
    """Return a run in which the goal changes; None if the change leaves no trace."""
    first, second = world.rng.sample(range(len(world.goals)), 2)
    plan = world.plan(world.goals[first][1])
    at = world.rng.randrange(2, len(plan) - 1)
    state = world.task.initial
    for step in plan[:at]:
        after = world.table.successor(state, step)
        assert after is not None
        state = after
    graph = world.graph(world.goals[second][0], state)
    direct = world.goals[second][1].steps_left[0]
    if graph is None or at + graph.steps_left[0] < direct + LEAST_DETOUR:
        return None
    steps = plan[:at] + world.plan(graph)
    n_seen = world.observed(steps[:at]).count("\n")
    return world.observed(steps), second, {"at": n_seen, "from": first, "to": second}


def write(folder: Path, world: World, observed: str, true: int) -> None:
    """Write the files of one instance."""
    folder.mkdir(parents=True, exist_ok=True)
    lines = [", ".join(f"({' '.join(fact)})" for fact in sorted(facts)) for facts, _ in world.goals]
    template = problem_text(world.problem).replace("(:goal (and))", "(:goal (and <HYPOTHESIS>))")
    texts = {
        "domain.pddl": domain_text(world.problem.domain), "template.pddl": template,
        "hyps.dat": "\n".join(lines) + "\n", "real_hyp.dat": lines[true] + "\n",
        "obs.dat": observed,
    }  # fmt: skip
    for name, text in texts.items():
        (folder / name).write_text(text)


def make(source: GoalSource, seed: str, changes: bool, folder: Path) -> None:
    """Write one instance, and with changes also the run of its world that has none."""
    for attempt in range(MAX_TRIES):
        world = World(source, random.Random(f"{seed} {attempt}"))
        if len(world.goals) < source.n_goals // 2:
            continue
        runs = {"": _unchanged(world)} if not changes else {
            "-unchanged": _unchanged(world), "-changed": _changed(world),
        }  # fmt: skip
        if any(run is None or not run[0] for run in runs.values()):
            continue
        for suffix, run in runs.items():
            assert run is not None
            place = folder.with_name(folder.name + suffix)
            write(place, world, run[0], run[1])
            if changes:
                (place / "change.json").write_text(json.dumps(run[2]) + "\n")
        return
    raise SystemExit(f"no instance of {source.problem.domain.name} with goals that fit")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("sets", type=Path)
    parser.add_argument("-n", type=int, default=8, help="instances of each domain")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--goals", type=int, default=10, help="goals of an instance, at most")
    parser.add_argument("--facts", type=int, help="facts of a goal, instead of those of the file")
    parser.add_argument("--steps", type=int, default=5, help="least steps of a goal's plan")
    parser.add_argument("--shared", type=int, default=99, help="most facts that two goals share")
    parser.add_argument("--only", action="append", help="one domain; may be repeated")
    parser.add_argument("--changes", action="store_true", help="runs with and without a change")
    parser.add_argument("-o", "--output", type=Path, required=True)
    args = parser.parse_args()
    limits = {"n_goals": args.goals, "least_steps": args.steps, "most_shared": args.shared}
    try:
        for name, source in sources(args.sets, args.facts, limits):
            for i in range(args.n) if not args.only or name in args.only else ():
                make(
                    source, f"{args.seed} {name} {i}", args.changes, args.output / name / f"{i:02}"
                )
                print(name, i, flush=True)
    except HrcplanError as error:
        print(error.message, file=sys.stderr)
        return error.exit_code
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
