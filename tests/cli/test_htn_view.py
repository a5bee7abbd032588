"""``hrcplan bank show --htn``: trees of chains and cliques, in words and as a document."""

import json

import pytest

from hrcplan.bank import build_bank, orders, save
from hrcplan.bank.htn import decompose


def run(capsys, *args):
    from hrcplan.cli import main, output

    output.JSON = output.VERBOSE = False
    with pytest.raises(SystemExit) as ended:
        main(list(map(str, args)))
    said = capsys.readouterr()
    return ended.value.code, said.out, said.err


@pytest.fixture(scope="module")
def kitchen():
    return build_bank("kitchen", only=["parfait-nut", "stew-bean"])


@pytest.fixture(scope="module")
def kitchen_file(kitchen, tmp_path_factory):
    path = tmp_path_factory.mktemp("banks") / "kitchen.bank"
    save(kitchen, path)
    return path


def leaves(tree):
    if "step" in tree:
        return [tree["step"]]
    return [step for child in tree.get("chain", tree.get("clique")) for step in leaves(child)]


def test_the_view_of_a_recipe(capsys, kitchen, kitchen_file):
    args = ["bank", "show", kitchen_file, "--htn", "parfait-nut"]
    code, out, err = run(capsys, *args)
    assert (code, err) == (0, "")
    graph = kitchen.graphs[kitchen.goal_index("parfait-nut")]
    htn = decompose(graph)
    assert out.startswith("parfait-nut: 17 steps, 6,647,155,200 plans\n")
    assert f"allow {htn.orders:,} of them (26.02%)" in out
    assert f"+ {htn.added} order constraints that plans do not have" in out
    assert "├─ in any order\n" in out
    assert "├─ (get nuts) → (pour nuts glass)\n" in out
    assert out.endswith("\n└─ (serve)\n")
    shown = json.loads(run(capsys, *args, "--json")[1])
    tree = shown["kinds"][0].pop("tree")
    alike = {"plans": "6647155200", "htn_plans": str(htn.orders), "exact": True, "added": htn.added}
    assert shown == {
        "goal": "parfait-nut", "steps": 17, **alike, "complete": True, "kinds": [alike]
    }  # fmt: skip
    assert sorted(leaves(tree)) == sorted(str(kitchen.table[s]) for s in graph.used_steps)
    added = tree["chain"][0]["clique"][0]["added"]
    assert len(added) == htn.added
    assert ["(get glass)", "(get nuts)"] in added


def test_the_view_of_an_unknown_goal(capsys, kitchen_file):
    args = ["bank", "show", kitchen_file, "--htn", "parfait-nuts"]
    code, out, err = run(capsys, *args)
    assert (code, out) == (2, "")
    assert "no goal 'parfait-nuts'" in err
    assert "parfait-nut'" in err
    fault = json.loads(run(capsys, *args, "--json")[1])["error"]
    assert fault["code"] == "unknown-goal"


NO_ORDER = """(define (domain d) (:requirements :adl) (:predicates (a) (b) (c) (left) (goal) (far))
    (:action a :parameters () :precondition (and) :effect (a))
    (:action b :parameters () :precondition (and) :effect (b))
    (:action c :parameters () :precondition (or (a) (b)) :effect (c))
    (:action l :parameters () :precondition (c) :effect (left))
    (:action r :parameters () :precondition (c) :effect (left))
    (:action end :parameters () :precondition (and (a) (b) (c) (left)) :effect (goal)))"""


def test_the_view_of_what_is_no_partial_order(capsys, tmp_path, monkeypatch):
    """c comes after a or after b; then l or r."""
    problem = "(define (problem {}) (:domain d) (:init) (:goal ({})))"
    (tmp_path / "d.pddl").write_text(NO_ORDER)
    (tmp_path / "goals").mkdir()
    for name, goal in (("g", "goal"), ("never", "far")):
        (tmp_path / "goals" / f"{name}.pddl").write_text(problem.format(name, goal))
    save(build_bank(str(tmp_path / "d.pddl"), str(tmp_path / "goals")), tmp_path / "b")
    args = ["bank", "show", tmp_path / "b", "--htn"]
    out = run(capsys, *args, "g")[1]
    assert "chains and cliques allow" in out
    assert "24 orders, which need not all be plans" in out
    assert "either 1 of 2: " in out
    assert "only" not in out
    shown = json.loads(run(capsys, *args, "g", "--json")[1])
    assert (shown["exact"], len(shown["kinds"])) == (False, 2)
    assert sum(int(kind["plans"]) for kind in shown["kinds"]) == int(shown["plans"])
    monkeypatch.setattr(orders, "MAX_KINDS", 1)
    assert "only 1 of the sets of steps is shown" in run(capsys, *args, "g")[1]
    code, out, err = run(capsys, *args, "never")
    assert (code, out) == (0, "never: 0 steps, 0 plans\n")
    assert "goal 'never' has no plan" in err


def test_the_words_of_the_view():
    from hrcplan.bank import htn_view as view

    assert view._counts_text(3, 3, True) == "all of them"
    assert view._counts_text(1, 4, True) == "1 of them (25.00%)"
    assert view._counts_text(2, 10**9, True) == "2 of them (2e-09)"
    assert view._constraints(1) == "+ 1 order constraint that plans do not have"
