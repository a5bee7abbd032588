"""Where goals come from: folders of problems, goal recognition folders, chance."""

import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest

from hrcplan.bank import build, build_bank, from_problems, read_goals
from hrcplan.bank.ramirez_geffner import read_actions, read_instance
from hrcplan.bank.variants import vary
from hrcplan.errors import InputError, PddlError, UsageError
from hrcplan.inference import infer
from hrcplan.pddl.generate import rename, with_copy, with_goal
from hrcplan.pddl.inputs import read
from hrcplan.pddl.model import And, Atom
from hrcplan.studies import report_study
from hrcplan.task import Task

ROOT = Path(__file__).parents[2]


@pytest.fixture
def folder(tmp_path):
    shutil.copy(ROOT / "domains" / "kitchen.pddl", tmp_path)
    for name in ("parfait-nut", "smoothie-oat", "stew-bean"):
        shutil.copy(ROOT / "problems" / "kitchen" / f"{name}.pddl", tmp_path)
    return tmp_path


def test_a_folder_of_problems_in_order_of_file_names(folder):
    (folder / "stew-bean.pddl").rename(folder / "a.pddl")
    goals = read_goals(str(folder / "kitchen.pddl"), str(folder))
    assert goals.names == ("stew-bean", "parfait-nut", "smoothie-oat")
    for name, tests in zip(goals.names, goals.tests, strict=True):
        assert tests == Task(read("kitchen", name)).goal


def test_differences_between_worlds_are_named(folder):
    path = folder / "smoothie-oat.pddl"
    text = (
        path.read_text()
        .replace("(stored mango)", "")
        .replace("(= (motivation human) 1)", "(= (motivation human) 7)")
    )
    path.write_text(text.replace("blender - appliance)", "blender - appliance fig)"))
    with pytest.raises(InputError) as caught:
        read_goals(str(folder / "kitchen.pddl"), str(folder))
    error = caught.value
    assert (error.code, error.path) == ("goals-differ", str(path))
    parts = [
        "'smoothie-oat' is not in the same world as 'parfait-nut'",
        "object fig is object, there missing",
        "(stored mango) holds only in parfait-nut",
        "(motivation human) is 7, there 1",
    ]
    for part in parts:
        assert part in error.message


@pytest.mark.parametrize(
    ("old", "new", "name"),
    [
        ("(stored mango)", "(stored mango) (at 5 (not (stored mango)))", "timed initial literals"),
        ("(:goal (and", "(:goal (and (preference w (stored mango))", "preferences"),
    ],
)
def test_what_only_one_problem_has_is_named(folder, old, new, name):
    path = folder / "smoothie-oat.pddl"
    path.write_text(path.read_text().replace(old, new, 1))
    with pytest.raises(InputError, match=f"only smoothie-oat has {name}"):
        read_goals(str(folder / "kitchen.pddl"), str(folder))


def test_many_differences_are_cut(folder):
    path = folder / "smoothie-oat.pddl"
    path.write_text(path.read_text().replace("(stored ", "(available "))
    with pytest.raises(InputError, match=r"and \d+ more$"):
        read_goals(str(folder / "kitchen.pddl"), str(folder))


def test_folders_that_hold_no_goals(folder, tmp_path):
    with pytest.raises(InputError, match="there is no folder"):
        read_goals("kitchen", str(tmp_path / "none"))
    (tmp_path / "empty").mkdir()
    with pytest.raises(InputError, match="no problem in"):
        read_goals("kitchen", str(tmp_path / "empty"))
    shutil.copy(folder / "kitchen.pddl", tmp_path / "empty" / "own.pddl")
    with pytest.raises(InputError, match="no problems are shipped for domain 'own'"):
        read_goals(str(tmp_path / "empty" / "own.pddl"))
    shutil.copy(folder / "stew-bean.pddl", folder / "again.pddl")
    with pytest.raises(InputError, match="two goals are called 'stew-bean'"):
        read_goals("kitchen", str(folder))
    (folder / "again.pddl").write_text("(define (problem x) (:domain kitchen) (:goal (eaten)))")
    with pytest.raises(PddlError):
        read_goals("kitchen", str(folder))


def test_some_goals_only():
    goals = read_goals("kitchen").only(["stew-bean", "parfait-nut"])
    assert goals.names == ("stew-bean", "parfait-nut")
    assert [g.goal for g in build(goals).graphs] == ["stew-bean", "parfait-nut"]
    with pytest.raises(UsageError, match="no goal 'stew-been'"):
        goals.only(["stew-been"])


FOLDERS = {
    "block-words_p01_hyp-0_full": (21, 8, 0),
    "easy-ipc-grid_p5-5-5_hyp-0_full": (5, 6, 0),
    "kitchen_generic_hyp-0_full_0": (3, 4, 1),
    "logistics_p01_hyp-3_full": (10, 20, 3),
}


@pytest.mark.parametrize("name", FOLDERS)
def test_goal_recognition_folders(name, instances):
    found = read_instance(instances / name)
    assert (len(found.goals), len(found.observations), found.true_goal) == FOLDERS[name]
    lines = [line.strip() for line in (instances / name / "hyps.dat").read_text().splitlines()]
    assert list(found.goals.names) == [line for line in lines if line]
    task, state = found.goals.task, found.goals.task.initial
    for words in found.observations:
        (action,) = task.find(words[0], words[1:])
        assert task.is_applicable(state, action)
        state = task.successor(state, action)
    if "kitchen" not in name:  # whose activities are not observed
        assert found.goals.is_reached(found.true_goal, state)


def test_actions_declared_more_than_once_are_told_apart(instances):
    goals = read_instance(instances / "kitchen_generic_hyp-0_full_0").goals
    names = {action.name for action in goals.problem.domain.actions}
    for name, given in goals.aliases.items():
        assert given[0] == name
        assert names.issuperset(given)
        assert len(set(given)) == len(given) > 1
    assert goals.aliases["activity-make-tea"] == (
        "activity-make-tea", "activity-make-tea-2", "activity-make-tea-3"
    )  # fmt: skip


@pytest.fixture
def grid(instances, tmp_path):
    return Path(shutil.copytree(instances / "easy-ipc-grid_p5-5-5_hyp-0_full", tmp_path / "grid"))


def test_untidy_goal_recognition_folders(grid):
    lines = (grid / "hyps.dat").read_text().splitlines()
    text = "\n\n".join(line.upper().replace(",", " ,  ") for line in lines)
    (grid / "hyps.dat").write_text(text + "\n \n")
    (grid / "template.pddl").write_text(
        (grid / "template.pddl").read_text().replace("<HYPOTHESIS>", "<hypothesis>")
    )
    (grid / "obs.dat").unlink()
    (grid / "real_hyp.dat").unlink()
    found = read_instance(grid)
    assert (len(found.goals), found.observations, found.true_goal) == (5, (), None)
    assert [g.plans for g in build(found.goals).graphs] == [1, 2, 2, 2, 1]


@pytest.mark.parametrize(
    ("file", "text", "message", "line"),
    [
        ("hyps.dat", "(at nowhere)\n", "takes 2 arguments", 1),
        ("hyps.dat", "\n(at place_0\n", "never closed", 2),
        ("hyps.dat", "\n \n", "lists no goal", None),
        ("template.pddl", "(define (problem p))", "no <HYPOTHESIS>", None),
        ("real_hyp.dat", "(at-robot place_1_1)", "true goal is not among", None),
        ("domain.pddl", None, "there is no file", None),
    ],
)
def test_faults_of_goal_recognition_folders(grid, file, text, message, line):
    if text is None:
        (grid / file).unlink()
    else:
        (grid / file).write_text(text)
    with pytest.raises(InputError, match=message) as caught:
        read_instance(grid)
    assert caught.value.line == line
    assert file in str(caught.value.path) or caught.value.path == str(grid)


def test_actions_of_a_text():
    assert read_actions("(A b C) ; x\n\n d e\n(f)\n;(g)") == (("a", "b", "c"), ("d", "e"), ("f",))


def test_copies_of_objects():
    problem = read("kitchen", "stew-bean")
    more = with_copy(problem, "beans", "peas")
    assert more.all_objects["peas"] == "ingredient"
    assert ("goes-in", "peas", "pan") in more.facts
    assert more.values["capacity", "robot", "peas"] == problem.values["capacity", "robot", "beans"]
    assert problem.facts < more.facts
    assert (
        build(from_problems([replace(more, goal=rename(more.goal, {"beans": "peas"}))]))
        .graphs[0]
        .plans
        == build(from_problems([problem])).graphs[0].plans
    )


def test_renamed_formulas():
    problem = read("kitchen", "stew-bean")
    every = "(forall (?i - ingredient) (in ?i pan))"
    text = f"(and (not (stored oats)) (or (in oats pan) {every}) (not (= oats milk)))"
    goal = with_goal(problem, text, "g").goal
    assert str(rename(goal, {"oats": "nuts"})) == str(
        with_goal(problem, text.replace("oats", "nuts"), "g").goal
    )


def test_goals_of_two_domains_of_one_name_are_refused():
    one, other = read("kitchen", "pasta-bean"), read("kitchen", "pasta-tomato")
    fewer = replace(other, domain=replace(other.domain, actions=other.domain.actions[1:]))
    with pytest.raises(InputError, match="another domain that is called kitchen"):
        from_problems([one, fewer])


def test_variants_are_as_the_goals_they_come_from(kitchen):
    found = vary(kitchen.goals, 40, seed=3, n_objects=4)
    bank = build(found)
    steps = [graph.used_steps for graph in bank.graphs]
    assert len(found.problem.objects) == len(kitchen.goals.problem.objects) + 4
    assert {17 <= graph.n_steps <= 23 for graph in bank.graphs} == {True}
    assert min(graph.plans for graph in bank.graphs) > 10**6
    assert not any(a <= b for i, a in enumerate(steps) for j, b in enumerate(steps) if i != j)
    assert found.formulas == vary(kitchen.goals, 40, seed=3, n_objects=4).formulas
    assert found.formulas[:3] != vary(kitchen.goals, 3, seed=4, n_objects=4).formulas


def test_where_there_are_no_more_variants(read_world):
    world = read_world(
        """(define (domain d) (:requirements :strips) (:predicates (have ?x))
        (:action take :parameters (?x) :precondition (and) :effect (have ?x)))""",
        """(define (problem g) (:domain d) (:objects a b c) (:init) (:goal (have a)))""",
    )
    found = vary(world, 2, seed=0)
    assert {str(goal) for goal in found.formulas} == {"(have b)", "(have c)"}
    with pytest.raises(UsageError, match="only 2 of 3 variants"):
        vary(world, 3, seed=0)
    nowhere = replace(world, formulas=(And((Atom("have", ("z",)),)),))
    with pytest.raises(UsageError, match="none of the goals"):
        vary(nowhere, 1, seed=0)


def test_the_tool_writes_a_folder_that_is_a_bank(tmp_path):
    def make(name, seed):
        args = ["kitchen", "-n", "3", "--seed", seed, "--new-objects", "2", "-o", tmp_path / name]
        tool = ROOT / "tools" / "make_problems.py"
        subprocess.run([sys.executable, tool, *map(str, args)], check=True, capture_output=True)
        return {p.name: p.read_text() for p in (tmp_path / name).iterdir()}

    first = make("one", 5)
    assert first == make("two", 5) != make("three", 6)
    bank = build_bank("kitchen", str(tmp_path / "one"))
    assert bank.names == ("variant-1", "variant-2", "variant-3")
    assert min(graph.plans for graph in bank.graphs) > 10**6


@pytest.mark.parametrize("name", ["x" * 300, "a\0b"])
@pytest.mark.parametrize(
    "use",
    [
        lambda name: read_goals("kitchen", name),
        lambda name: infer(name, [("get", "human", "yogurt")]),
        lambda name: infer("kitchen", name),
        report_study,
    ],
    ids=["goals", "bank", "observations", "rows"],
)
def test_a_name_that_no_file_can_have_is_an_input_error(use, name):
    with pytest.raises(InputError):
        use(name)
