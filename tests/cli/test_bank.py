"""The bank commands: documents, words, exit codes."""

import json
import shutil
from fractions import Fraction
from pathlib import Path

import pytest

from hrcplan.validation import validate

ROOT = Path(__file__).parents[2]
INSTANCE = ROOT / "tests" / "data" / "goal-recognition" / "kitchen_generic_hyp-0_full_0"


def run(capsys, *args):
    """Return exit code, standard output and standard error of a command."""
    from hrcplan.cli import main, output

    output.JSON = output.VERBOSE = False
    with pytest.raises(SystemExit) as ended:
        main(list(map(str, args)))
    said = capsys.readouterr()
    return ended.value.code, said.out, said.err


@pytest.fixture
def bank(capsys, tmp_path):
    path = tmp_path / "two.bank"
    goals = ["--goal", "parfait-nut", "--goal", "smoothie-oat"]
    assert run(capsys, "bank", "build", "kitchen", *goals, "-o", path)[0] == 0
    return path


def test_build_and_show_say_the_same(capsys, tmp_path):
    path = tmp_path / "k.bank"
    code, out, err = run(capsys, "bank", "build", "kitchen", "-o", path, "--json")
    built = json.loads(out)
    assert (code, err) == (0, "")
    assert built == json.loads(run(capsys, "bank", "show", path, "--json")[1])
    assert (built["domain"], built["agents"], len(built["goals"])) == ("kitchen", "dropped", 30)
    assert built["build_s"] > 0
    parfait = next(goal for goal in built["goals"] if goal["name"] == "parfait-nut")
    assert parfait == {
        "name": "parfait-nut", "steps": 17, "optimal_cost": 17, "plans": "6647155200",
        "nodes": 2433, "edges": 11137, "complete": True,
    }  # fmt: skip
    text = run(capsys, "bank", "show", path)[1]
    assert "6,647,155,200" in text
    assert "30 goals, agents dropped" in text


def test_a_domain_outside_the_package(capsys, tmp_path):
    """Agents are kept where facts about them change; costs are those of the task."""
    shutil.copy(ROOT / "domains" / "transport.pddl", tmp_path / "d.pddl")
    (tmp_path / "goals").mkdir()
    shutil.copy(ROOT / "problems" / "transport" / "two-boxes.pddl", tmp_path / "goals")
    args = [tmp_path / "d.pddl", tmp_path / "goals", "-o", tmp_path / "b", "--json"]
    built = json.loads(run(capsys, "bank", "build", *args, "--bank-cost", "task")[1])
    assert built["agents"] == "kept"
    assert [(g["steps"], g["optimal_cost"], g["plans"]) for g in built["goals"]] == [(8, 24, "144")]
    more = json.loads(run(capsys, "bank", "build", *args, "--quality", "9/8")[1])
    assert more["goals"][0]["plans"] == "5520"
    other = json.loads(run(capsys, "bank", "build", *args, "--alternatives", "1.125")[1])
    assert 144 < int(other["goals"][0]["plans"]) < 5520
    few = json.loads(run(capsys, "bank", "build", *args, "--sample", "10")[1])
    assert few["goals"][0]["complete"] is False
    assert 10 <= int(few["goals"][0]["plans"]) <= 144
    assert ">= " in run(capsys, "bank", "show", tmp_path / "b")[1]


def test_a_goal_recognition_folder(capsys, tmp_path):
    args = [INSTANCE / "domain.pddl", INSTANCE, "-o", tmp_path / "b", "--json"]
    goals = json.loads(run(capsys, "bank", "build", *args)[1])["goals"]
    assert [(g["name"], g["plans"]) for g in goals] == [
        ("(made_breakfast)", "3175780608000"), ("(lunch_packed)", "30"), ("(made_dinner)", "12")
    ]  # fmt: skip


@pytest.mark.parametrize("options", [[], ["--loop-free"], ["--irredundant"]])
def test_samples_are_valid_plans(capsys, bank, options):
    code, out, _ = run(
        capsys, "bank", "sample", bank, "smoothie-oat", "-n", "4", "--seed", 3, *options
    )
    assert code == 0
    texts = [part for part in out.split("; plan") if part.strip()]
    assert len(texts) == 4
    for text in texts:
        report = validate("kitchen", "smoothie-oat", text.partition("\n")[2])
        assert report.valid
        assert report.cost is not None
    args = ["bank", "sample", bank, "smoothie-oat", "-n", "4", "--seed", "3", "--json", *options]
    found = json.loads(run(capsys, *args)[1])
    assert found["agents"] == "dropped"
    assert ["\n".join(plan["actions"]) for plan in found["plans"]] == [
        text.partition("\n")[2].strip() for text in texts
    ]
    assert found["plans"][0]["steps"][-1] == "(serve)"


def test_a_goal_without_a_plan(capsys, tmp_path):
    shutil.copy(ROOT / "problems" / "kitchen" / "stew-bean.pddl", tmp_path)
    text = (ROOT / "problems" / "kitchen" / "stew-bean.pddl").read_text()
    other = text.replace("problem stew-bean", "problem never").replace(
        "(cooked onion)", "(cooked honey)"
    )
    (tmp_path / "never.pddl").write_text(other)
    code, out, err = run(
        capsys, "bank", "build", "kitchen", tmp_path, "-o", tmp_path / "b", "--json"
    )
    never = json.loads(out)["goals"][0]
    assert (code, never["plans"], never["optimal_cost"], never["nodes"]) == (0, "0", None, 0)
    assert "goal 'never' has no plan" in err
    assert run(capsys, "bank", "verify", tmp_path / "b")[0] == 0
    assert run(capsys, "bank", "sample", tmp_path / "b", "never")[0] == 2


def test_verify(capsys, bank):
    assert run(capsys, "bank", "verify", bank)[:2] == (0, "sound\n")
    data = bytearray(bank.read_bytes())
    data[-1] ^= 1
    bank.write_bytes(data)
    code, out, _ = run(capsys, "bank", "verify", bank, "--json")
    assert (code, json.loads(out)["valid"]) == (1, False)
    assert "checksum" in json.loads(out)["reason"]
    assert run(capsys, "bank", "verify", bank)[0] == 1
    for command in (["show"], ["sample"]):
        args = [*command, bank, *(["smoothie-oat"] if command == ["sample"] else [])]
        code, out, _ = run(capsys, "bank", *args, "--json")
        assert (code, json.loads(out)["error"]["code"]) == (3, "bank-damaged")
    bank.unlink()
    assert run(capsys, "bank", "verify", bank)[0] == 3


@pytest.mark.parametrize(
    ("args", "code", "fault"),
    [
        (["kitchen", "--quality", "0.5"], 2, None),
        (["kitchen", "--quality", "x"], 2, None),
        (["kitchen", "--quality", "1.1", "--sample", "3"], 2, "usage"),
        (["kitchen", "--goal", "stew-been"], 2, "usage"),
        (["kitchen", "nowhere"], 3, "no-folder"),
        (["kitchin"], 3, "no-file"),
        (["transport"], 3, "goals-differ"),
        (["kitchen", "--memory", "1"], 4, "memory"),
        (["kitchen", "--timeout", "0.000001"], 4, "timeout"),
    ],
)
def test_exit_codes(capsys, tmp_path, args, code, fault):
    ended, out, _ = run(capsys, "bank", "build", *args, "-o", tmp_path / "b", "--json")
    assert ended == code
    if fault is not None:
        assert json.loads(out)["error"]["code"] == fault
    assert not (tmp_path / "b").exists()


def test_a_target_that_cannot_be_written_is_refused_at_once(capsys, tmp_path):
    assert run(capsys, "bank", "build", "kitchen", "-o", tmp_path)[0] == 2
    assert run(capsys, "bank", "build", "kitchen", "-o", tmp_path / "none" / "b")[0] == 2


def test_new_problem_by_chance(capsys, tmp_path):
    def make(*args):
        return run(capsys, "new-problem", "kitchen", "--from", "stew-bean", "--name", "n", *args)

    code, out, _ = make("--vary", "--seed", "4", "--new-objects", "2")
    assert code == 0
    assert out == make("--vary", "--seed", "4", "--new-objects", "2")[1]
    assert out != make("--vary", "--seed", "5", "--new-objects", "2")[1]
    assert "(problem n)" in out
    (tmp_path / "n.pddl").write_text(out)
    args = ["kitchen", tmp_path, "-o", tmp_path / "b", "--json"]
    goal = json.loads(run(capsys, "bank", "build", *args)[1])["goals"][0]
    assert goal["steps"] == 23
    assert int(goal["plans"]) > Fraction(10**6)
    assert make()[0] == make("--vary", "--goal", "(served)")[0] == 2
