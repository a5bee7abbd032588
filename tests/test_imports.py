"""What a command loads: the quick ones stay quick only while nothing heavy hides on their way."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

# unified-planning alone costs more than a second; numpy is the largest part of a bare start.
HEAVY = {"unified_planning", "sklearn", "matplotlib", "scipy", "networkx", "pandas"}
# Under the GPL: these run in child processes and are never imported.
GPL = {"fast_downward", "up_fast_downward", "kstar_planner", "symk", "up_symk", "pyperplan"}

# Runs `hrcplan ARGS...` as the console script does, then writes what was loaded.
PROBE = """
import json, sys
report = sys.argv.pop(1)
code = None
try:
    from hrcplan.cli import main
    sys.argv[0] = "hrcplan"
    main()
except SystemExit as end:
    code = end.code
loaded = sorted({name.partition(".")[0] for name in sys.modules})
with open(report, "w") as file:
    json.dump({"code": code, "loaded": loaded}, file)
"""


def loaded_by(tmp_path: Path, *args: str) -> set[str]:
    """Return the top-level modules that `hrcplan ARGS...` leaves loaded, once it has succeeded."""
    report = tmp_path / "loaded.json"
    run = subprocess.run(
        [sys.executable, "-c", PROBE, report, *args],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert report.exists(), run.stderr
    answer = json.loads(report.read_text())
    assert answer["code"] in (0, None), run.stderr
    assert "hrcplan" in answer["loaded"]
    return set(answer["loaded"])


def test_help_loads_no_numpy(tmp_path: Path) -> None:
    assert not loaded_by(tmp_path, "--help") & (HEAVY | GPL | {"numpy"})


def test_a_task_is_grounded_without_what_only_others_need() -> None:
    """Each of these is a part of the time that a small task takes as a whole process."""
    public = Path(__file__).parent / "data" / "public" / "whitemech-pddl" / "storage"
    code = """import sys
from hrcplan import Task, read
print(len(Task(read(*sys.argv[1:])).actions))
print(*sorted({"numpy", "dataclasses", "inspect", "pathlib", "json", "click"} & {*sys.modules}))"""
    argv = [sys.executable, "-I", "-c", code, public / "domain.pddl", public / "problem.pddl"]
    run = subprocess.run(argv, capture_output=True, text=True, timeout=60, check=True)
    n_actions, *loaded = run.stdout.split()
    assert int(n_actions) > 0
    assert loaded == []


def test_plan_and_validate_load_nothing_heavy(tmp_path: Path) -> None:
    plan = tmp_path / "two-boxes.plan"
    assert not loaded_by(tmp_path, "plan", "transport/two-boxes", "-o", str(plan)) & (HEAVY | GPL)
    loaded = loaded_by(tmp_path, "validate", "transport/two-boxes", str(plan))
    assert not loaded & (HEAVY | GPL)


def test_check_loads_nothing_heavy(tmp_path: Path) -> None:
    domain = Path(__file__).parents[1] / "domains" / "transport.pddl"
    assert not loaded_by(tmp_path, "check", str(domain)) & (HEAVY | GPL)


def test_execute_loads_nothing_heavy(tmp_path: Path) -> None:
    assert not loaded_by(tmp_path, "execute", "transport/two-boxes") & (HEAVY | GPL)


def test_collaborate_loads_nothing_heavy(tmp_path: Path) -> None:
    words = ("collaborate", "kitchen", "--human", "simulated", "--seed", "1")
    assert not loaded_by(tmp_path, *words) & (HEAVY | GPL)


@pytest.mark.parametrize("module", ["hrcplan", "hrcplan.pytest_plugin"])
def test_import_is_light(module: str) -> None:
    """The plugin loads in every pytest run of whoever has hrcplan installed."""
    code = f"import json, sys, {module}; print(json.dumps(sorted(sys.modules)))"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    loaded = {name.partition(".")[0] for name in json.loads(run.stdout)}
    assert not loaded & (HEAVY | GPL | {"numpy", "rich", "click"})
