"""Every key of every JSON document is in ``docs/reference/json.md``, with its type."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

from hrcplan.bank import Bank, build_bank
from hrcplan.bank.store import save
from hrcplan.cli.main import main
from hrcplan.studies import run_study
from tests import schema
from tests.episodes.test_own_goals import GOALS, LAMPS, ROOMS, TWO
from tests.studies.test_switch import small_benchmark

ROOT = Path(__file__).resolve().parent.parent
SECTIONS = schema.sections("json.md")
BAD = "(define (problem x) (:domain transport) (:objects a - wpp) (:goal (at human nowhere)))"
NIGHT = """(define (domain night) (:requirements :timed-initial-literals :durative-actions)
  (:predicates (dark) (asleep)) (:durative-action sleep :duration (= ?duration 8)
  :condition (at start (dark)) :effect (at end (asleep))))"""
TONIGHT = """(define (problem tonight) (:domain night) (:init (at 9 (dark))) (:goal (asleep))
  (:metric minimize (total-time)))"""
CLOSE = "0: (move human wp1 wp4) [50]\n50.0001: (grasp human blue wp4) [50]\n"
SEEN = """(get human yogurt)
(get human berries)
(turn_on human blender)
(pour human yogurt glass)
(pour human berries glass)
(get human oats)
(pour human oats glass)
(fly human away)
"""
# Sections of the page, and the commands that fill them; {w} is a folder with files.
COMMANDS = {
    "plan": [
        ["plan", "transport/two-boxes"],
        ["plan", "kitchen/parfait-fruit", "--planner", "fast-downward", "--lanes"],
    ],
    "validate": [
        ["validate", "transport/two-boxes", "{w}/good.plan"],
        ["validate", "transport/two-boxes", "{w}/bad.plan"],
        ["validate", "transport/two-boxes", "{w}/close.plan"],
    ],
    "check": [["check", "{w}/bad.pddl"]],
    "format": [["format", "{w}/bad.pddl"]],
    "allocation": [["allocation", "transport/two-boxes", "motivation human"]],
    "execute": [
        ["execute", "transport/two-boxes", "--human", "partly-cooperative", "--seed", "5",
         "--journal", "{w}/run.jsonl"],
        ["execute", "transport/two-boxes", "--change", "motivation human=2@0"],
        ["execute", "{w}/night.pddl", "{w}/tonight.pddl"],
    ],
    "collaborate": [["collaborate", "kitchen", "{w}/goals"]],
    "replay": [["replay", "{w}/run.jsonl"]],
    "bank build and bank show": [
        ["bank", "build", "kitchen", "{w}/goals", "-o", "{w}/k.bank"],
        ["bank", "show", "{w}/k.bank"],
    ],
    "bank show --allocation": [["bank", "show", "{w}/k.bank", "--allocation"]],
    "bank show --htn": [["bank", "show", "{w}/k.bank", "--htn", "parfait-fruit"]],
    "bank sample": [["bank", "sample", "{w}/k.bank", "parfait-fruit", "-n", "2"]],
    "bank verify": [["bank", "verify", "{w}/k.bank"]],
    "infer": [
        ["infer", "{w}/k.bank", "{w}/seen.txt"],
        ["infer", "{w}/lamps.bank", "{w}/lamps.txt", "--goals-per", "human"],
    ],
    "study run": [
        ["study", "run", "changed-mind", "--goals", "{w}/goals", "--method", "hrcplan",
         "--limit", "4", "-o", "{w}/rows"],
        ["study", "run", "failure-anticipation", "--limit", "1", "-o", "{w}/claims"],
    ],
    "study report": [
        ["study", "report", "{w}/rows"],
        ["study", "report", "{w}/claims"],
    ],
    "score": [
        ["score", "{w}/traces"],
        ["score", "{w}/traces/inference/yard/suboptimal/recursive/00000.jsonl"],
    ],
    "study play": [["study", "play", "golden", "--method", "hrcplan", "--why"]],
    "planners": [["planners"]],
    "doctor": [["doctor"]],
    "new-problem": [
        ["new-problem", "transport", "--from", "two-boxes", "--goal", "(box-at green wp5)",
         "--name", "n", "-o", "{w}/n.pddl"],
    ],
    "Errors": [["plan", "transport", "no-such-problem"], ["check", "--nonsense"],
               ["validate", "transport/two-boxes", "{w}/cut.plan"]],
}  # fmt: skip

# Commands that read lines and print one document a line: a session, and one that reaches a goal.
SESSIONS = {
    "collaborate": [
        "get yogurt\nnonsense\nundo\nstate motivation human 8\nwhy\ngoals\nsteps\nstate\nquit\n",
        "get glass\nget yogurt\npour yogurt glass\n" + 9 * "\nyes\n1\nyes\n",
    ],
}  # fmt: skip

# Sections with documents that contain themselves: which part of a path may be repeated.
NESTED = {"bank show --htn": r"(\.tree)(?:\.(?:chain|clique)\[\])+"}


def two_humans(folder: Path) -> Bank:
    """Return the bank of a few goals of two humans, out of files in a folder."""
    (folder / "goals").mkdir(parents=True)
    (folder / "domain.pddl").write_text(LAMPS)
    rooms = ROOMS.replace("HUMANS", TWO[0]).replace("STATE", TWO[1])
    for name, goal in GOALS.items():
        (folder / "goals" / f"{name}.pddl").write_text(rooms.format(name=name, goal=goal))
    return build_bank(folder / "domain.pddl", folder / "goals")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    work = tmp_path_factory.mktemp("json")
    (work / "bad.pddl").write_text(BAD)
    (work / "seen.txt").write_text(SEEN)
    (work / "night.pddl").write_text(NIGHT)
    (work / "tonight.pddl").write_text(TONIGHT)
    (work / "good.plan").write_text("")
    (work / "bad.plan").write_text("(move human wp1 wp2)")
    (work / "close.plan").write_text(CLOSE)
    (work / "cut.plan").write_text("0: (move human wp1 wp4) [50")
    (work / "goals").mkdir()
    save(two_humans(work / "lamps"), work / "lamps.bank")
    (work / "lamps.txt").write_text("(light ann a)\n(go bob c b)\n")
    for name in ("parfait-fruit", "parfait-nut", "smoothie-berry"):
        text = (ROOT / "problems" / "kitchen" / f"{name}.pddl").read_text("utf-8")
        (work / "goals" / f"{name}.pddl").write_text(text)
    return work


@pytest.fixture(scope="module")
def written(folder: Path) -> dict[str, list[Any]]:
    """Return what the commands print that write the files of the others."""
    sections = ("execute", "bank build and bank show", "study run")
    found = {section: documents(section, folder) for section in sections}
    with small_benchmark(folder):
        options = {"methods": "recursive"}
        run_study("switch", folder / "switch", options=options, traces=folder / "traces")
        return {**found, "score": documents("score", folder)}


def documents(section: str, folder: Path) -> list[Any]:
    """Return what the commands of a section print."""
    found = []
    for session in SESSIONS.get(section, []):
        line = [word.replace("{w}", str(folder)) for word in COMMANDS[section][0]]
        result = CliRunner().invoke(main, [*line, "--json"], input=session, standalone_mode=False)
        found += [json.loads(text) for text in result.stdout.splitlines()]
    if found:
        return found
    for words in COMMANDS[section]:
        line = [word.replace("{w}", str(folder)) for word in words]
        result = CliRunner().invoke(main, [*line, "--json"], standalone_mode=False)
        try:
            found.append(json.loads(result.stdout))
        except json.JSONDecodeError:
            assert section == "Errors", f"{line}: {result.output}"
    return found


def test_every_section_of_the_page_is_looked_at() -> None:
    assert set(SECTIONS) == set(COMMANDS)


@pytest.mark.parametrize("section", COMMANDS)
def test_documents_have_the_keys_of_the_page(
    section: str, folder: Path, written: dict[str, list[Any]]
) -> None:
    found = written.get(section) or documents(section, folder)
    schema.check(found, SECTIONS[section], NESTED.get(section))
