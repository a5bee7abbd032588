#!/usr/bin/env python3
"""Recorded steps of real people as PDDL and traces that `hrcplan infer` reads.

    tools/real_traces.py captaincook4d tests/data/captaincook4d -o FOLDER
    tools/real_traces.py assembly101 ANNOTATIONS -o FOLDER

FOLDER gets domain.pddl, template.pddl and hyps.dat (one goal per recipe or toy), and one trace per
recording; then `hrcplan infer FOLDER FOLDER/NAME.jsonl` infers what a person makes.

captaincook4d: the folder in this repository; its README has source, license and mapping. Steps are
labels such as ``peel-garlic``; recipes share them. A step needs those before it, where all recipes
that have it agree on that.

assembly101: the CSV files of its mistake annotations (CC BY-NC 4.0: not part of this repository),
one per recording, with the columns start, end, verb, this, that, label, remark (may be missing)
and no head; the toy is the part such as a01 of the file's name. Lines with another verb than attach
and detach are left out. A goal is what most recordings of a toy attach.

With --bench METHOD what the method says of each recording is compared with what was made.
"""

from __future__ import annotations

import argparse
import csv
import json
import re
import sys
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from hrcplan.bank import Bank, Goals, build
from hrcplan.bank.ramirez_geffner import read_instance
from hrcplan.errors import HrcplanError, InputError
from hrcplan.inference import infer
from hrcplan.inference.registry import METHODS, takes_goals
from hrcplan.inference.traces import ActionTrace, TraceAction, world_sha256

COOKING = """(define (domain cooking)
  (:requirements :strips :typing :adl)
  (:types agent step)
  (:predicates (before ?p ?s - step) (done ?s - step))
  (:action do
    :parameters (?a - agent ?s - step)
    :precondition (forall (?p - step) (imply (before ?p ?s) (done ?p)))
    :effect (done ?s)))
"""
ASSEMBLY = """(define (domain assembly)
  (:requirements :strips :typing :negative-preconditions)
  (:types agent part)
  (:predicates (attached ?p ?q - part))
  (:action attach
    :parameters (?a - agent ?p ?q - part)
    :precondition (not (attached ?p ?q)) :effect (attached ?p ?q))
  (:action detach
    :parameters (?a - agent ?p ?q - part)
    :precondition (attached ?p ?q) :effect (not (attached ?p ?q))))
"""
HUMAN = "human"
FRACTIONS = (0.1, 0.2, 0.3, 0.5, 0.7, 0.9, 1.0)
TOY = re.compile(r"(?<![a-z0-9])([a-z]\d{2}[a-z]?)(?![a-z0-9])")
COLUMNS = ("start", "end", "verb", "this", "that", "label", "remark")


@dataclass(frozen=True)
class Collection:
    """Recordings of people with one domain: texts of PDDL, goals, and what each of them did."""

    domain: str
    objects: str
    init: Iterable[str]
    goals: Mapping[str, Iterable[str]]
    recordings: Mapping[str, Sequence[TraceAction]]
    truth: Mapping[str, str]

    def write(self, folder: Path) -> None:
        """Write everything into a folder."""
        folder.mkdir(parents=True, exist_ok=True)
        name = re.search(r"\(domain ([\w-]+)\)", self.domain)
        assert name is not None
        init = "\n    ".join(self.init)
        (folder / "domain.pddl").write_text(self.domain)
        (folder / "template.pddl").write_text(
            f"(define (problem people) (:domain {name[1]})\n  (:objects {self.objects})\n"
            f"  (:init {init})\n  (:goal (and <HYPOTHESIS>)))\n"
        )
        lines = (", ".join(sorted(facts)) for facts in self.goals.values())
        (folder / "hyps.dat").write_text("".join(f"{line}\n" for line in lines))
        names = list(self.goals)
        truth = {r: names.index(goal) for r, goal in self.truth.items() if goal in names}
        (folder / "truth.json").write_text(json.dumps({"goals": names, "recordings": truth}) + "\n")
        sha256 = world_sha256(read_instance(folder).goals.problem)
        for recording, actions in self.recordings.items():
            trace = ActionTrace(name[1], sha256, tuple(actions))
            (folder / f"{recording}.jsonl").write_text(trace.text())


def table(path: Path) -> list[dict[str, str]]:
    """Return the lines of a CSV file with a head."""
    with path.open(newline="", encoding="utf-8") as lines:
        return list(csv.DictReader(lines))


def numbered(labels: Iterable[str]) -> list[str]:
    """Return labels in which the second of a kind is called ``label-2``, and so on.

    >>> numbered(["add-salt", "mix-bowl", "add-salt"])
    ['add-salt', 'mix-bowl', 'add-salt-2']
    """
    counts: Counter[str] = Counter()
    names = []
    for label in labels:
        counts[label] += 1
        names.append(label if counts[label] == 1 else f"{label}-{counts[label]}")
    return names


def closure(steps: Sequence[str], edges: Iterable[tuple[str, str]]) -> dict[str, set[str]]:
    """Return for each step all that have to be done before it."""
    before: dict[str, set[str]] = {step: set() for step in steps}
    pairs = list(edges)
    for _ in steps:
        for a, b in pairs:
            before[b] |= before[a] | {a}
    return before


def captaincook4d(folder: Path) -> Collection:
    """Return the recordings of CaptainCook4D, as they are in this repository."""
    labels = {row["step"]: row["label"] for row in table(folder / "mapping.csv")}
    needs: dict[str, dict[str, set[str]]] = {}
    for row in table(folder / "graphs.csv"):
        steps = row["steps"].split()
        before = closure(steps, (tuple(edge.split(">")) for edge in row["edges"].split()))  # type: ignore[misc]
        order = sorted(steps, key=lambda step: (len(before[step]), int(step)))
        name = dict(zip(order, numbered(labels[step] for step in order), strict=True))
        needs[row["recipe"]] = {name[s]: {name[p] for p in before[s]} for s in steps}
    rows = table(folder / "recordings.csv")
    recordings = {row["recording"]: _cooked(row, labels) for row in rows}
    every = {step for recipe in needs.values() for step in recipe}
    every |= {action.args[1] for actions in recordings.values() for action in actions}
    init = [
        f"(before {p} {step})"
        for step in sorted(every)
        for p in sorted(_agreed([r[step] for r in needs.values() if step in r]))
    ]
    goals = {recipe: [f"(done {step})" for step in steps] for recipe, steps in needs.items()}
    objects = f"{HUMAN} - agent {' '.join(sorted(every))} - step"
    truth = {row["recording"]: row["recipe"] for row in rows}
    return Collection(COOKING, objects, init, goals, recordings, truth)


def _agreed(needs: Sequence[set[str]]) -> set[str]:
    return set.intersection(*needs) if needs else set()


def _cooked(row: Mapping[str, str], labels: Mapping[str, str]) -> list[TraceAction]:
    names = numbered(labels[step] for step in row["steps"].split())
    starts = map(float, row["starts_s"].split())
    return [
        TraceAction(t, HUMAN, "do", (HUMAN, name)) for t, name in zip(starts, names, strict=True)
    ]


def assembly101(folder: Path) -> Collection:
    """Return the recordings that are annotated in a folder.

    Raises:
        InputError: if a file has other columns, or no file names a toy.
    """
    recordings: dict[str, list[TraceAction]] = {}
    ends: dict[str, list[set[tuple[str, str]]]] = {}
    truth: dict[str, str] = {}
    for path in sorted(folder.glob("*.csv")):
        toy = TOY.search(path.stem.lower())
        if toy is None:
            continue
        actions = list(_assembled(path))
        recordings[path.stem], truth[path.stem] = actions, toy[1]
        ends.setdefault(toy[1], []).append(_attached(actions))
    if not recordings:
        raise InputError(f"'{folder}' has no CSV file that names a toy", code="no-recordings")
    goals = {
        toy: [f"(attached {p} {q})" for p, q in sorted(_most(pairs))] for toy, pairs in ends.items()
    }
    parts = {part for actions in recordings.values() for one in actions for part in one.args[1:]}
    objects = f"{HUMAN} - agent {' '.join(sorted(parts))} - part"
    goals = {toy: goal for toy, goal in goals.items() if goal}
    return Collection(ASSEMBLY, objects, (), goals, recordings, truth)


def _assembled(path: Path) -> Iterable[TraceAction]:
    with path.open(newline="", encoding="utf-8") as lines:
        for number, row in enumerate(csv.reader(lines), start=1):
            if len(row) < len(COLUMNS) - 1:
                message = f"a line has {len(row)} columns, not {', '.join(COLUMNS)}"
                raise InputError(message, code="bad-csv", path=str(path), line=number)
            start, _, verb, this, that = (cell.strip().lower() for cell in row[:5])
            if verb in ("attach", "detach"):
                p, q = sorted(re.sub(r"[^a-z0-9]+", "-", part) for part in (this, that))
                yield TraceAction(float(start), HUMAN, verb, (HUMAN, p, q))


def _attached(actions: Iterable[TraceAction]) -> set[tuple[str, str]]:
    pairs: set[tuple[str, str]] = set()
    for action in actions:
        pair = (action.args[1], action.args[2])
        pairs = pairs | {pair} if action.action == "attach" else pairs - {pair}
    return pairs


def _most(ends: Sequence[set[tuple[str, str]]]) -> set[tuple[str, str]]:
    counts = Counter(pair for pairs in ends for pair in pairs)
    return {pair for pair, n in counts.items() if 2 * n > len(ends)}


def bench(folder: Path, method: str, every: int) -> None:
    """Print how often the goal is right by prefix, and what is reported that was not.

    Args:
        folder: What `Collection.write` has written.
        method: A method of ``infer``.
        every: Look at every such recording only.
    """
    instance = read_instance(folder)
    source: Bank | Goals = instance.goals
    if not takes_goals(METHODS.find(method)):
        source = build(instance.goals)
    right: dict[float, list[float]] = {f: [] for f in FRACTIONS}
    n_steps = n_ignored = n_changes = n_out_of_order = 0
    recordings = json.loads((folder / "truth.json").read_text())["recordings"]
    recordings = dict(list(recordings.items())[::every])
    for recording, true in recordings.items():
        inference = infer(source, folder / f"{recording}.jsonl", method)
        n = len(inference.actions)
        for f, rows in right.items():
            row = inference.posterior[max(1, round(f * n))]
            rows.append((row[true] == max(row)) / row.count(max(row)))
        n_steps += n
        n_ignored += len(inference.ignored)
        n_changes += bool(inference.changes)
        n_out_of_order += bool(inference.ignored or inference.note)
    shares = "  ".join(f"{f}: {sum(rows) / len(rows):.2f}" for f, rows in right.items())
    print(f"{method}, {len(recordings)} recordings: right goal {shares}")
    print(f"a change is reported in {n_changes / len(recordings):.0%}; steps without effect: "
          f"{n_ignored / n_steps:.1%}; recordings with a step that could not be done, or was "
          f"preceded by unobserved ones: {n_out_of_order / len(recordings):.0%}")  # fmt: skip


READERS = {"captaincook4d": captaincook4d, "assembly101": assembly101}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("kind", choices=READERS)
    parser.add_argument("folder", type=Path)
    parser.add_argument("-o", "--output", type=Path, required=True)
    parser.add_argument("--bench", metavar="METHOD")
    parser.add_argument("--every", type=int, default=1, help="look at every N-th recording")
    args = parser.parse_args()
    try:
        READERS[args.kind](args.folder).write(args.output)
        if args.bench:
            bench(args.output, args.bench, args.every)
    except HrcplanError as error:
        print(error.message, file=sys.stderr)
        return error.exit_code
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
