"""``hrcplan infer`` as a user calls it."""

import json
import re
import tarfile

import pytest
from click.testing import CliRunner

from hrcplan import infer
from hrcplan.bank import build
from hrcplan.bank.store import save
from hrcplan.cli import main
from hrcplan.core.deprecation import OldNameWarning
from hrcplan.errors import UsageError
from hrcplan.plans import Plan, PlannedAction

KEYS = {"goals", "posterior", "changed", "changes", "ignored", "method", "note", "humans"}
ACTIONS = """\
; comments and empty lines are no observations

(GET HUMAN LENTILS)
(get robot pan)
(fly human moon)
(get human pizza)
(get lentils)
0.000: (get human yogurt) [1.000]
(get human mango)
(get human glass)
(get human eating-spoon)
"""


def call(*words, code=0):
    found = CliRunner().invoke(main, ["infer", *map(str, words)])
    assert found.exit_code == code, found.output
    return found


@pytest.fixture(scope="module")
def files(kitchen, tmp_path_factory):
    folder = tmp_path_factory.mktemp("infer")
    names = ["stew-lentil", "pasta-bean", "parfait-mango", "smoothie-mango"]
    save(build(kitchen.goals.only(names)), folder / "some.bank")
    (folder / "actions.txt").write_text(ACTIONS)
    return folder


def test_json_of_a_bank(files):
    found = json.loads(call(files / "some.bank", files / "actions.txt", "--json").stdout)
    assert found.keys() == KEYS
    assert found["method"] == "switching"
    assert found["goals"] == ["stew-lentil", "pasta-bean", "parfait-mango", "smoothie-mango"]
    rows = found["posterior"]
    assert len(rows) == 10
    assert rows[0] == [0.25] * 4
    assert all(sum(row) == pytest.approx(1) for row in rows)
    assert rows[1][0] > 0.8
    assert [i["at"] for i in found["ignored"]] == [2, 3, 4]
    reasons = [i["reason"] for i in found["ignored"]]
    assert reasons[0].startswith("there is no action 'fly'")
    assert reasons[1] == "there is no object 'pizza'"
    assert reasons[2] == "no agent can do this step here"
    assert rows[1] == rows[2] == rows[3] == rows[4] == rows[5]  # the robot's step is no evidence
    assert rows[-1][2] == max(rows[-1])
    assert [change["at"] for change in found["changes"]] == [5]


@pytest.mark.parametrize("method", ["exact", "recursive", "cost"])
def test_other_methods_on_a_bank(files, method):
    words = (files / "some.bank", files / "actions.txt", "--json", "--method", method)
    found = json.loads(call(*words).stdout)
    assert found["method"] == method
    assert len(found["posterior"]) == 10
    assert len({len(row) for row in found["posterior"]}) == 1
    assert found["posterior"][1][0] == max(found["posterior"][1])


def test_methods_with_plan_graphs_on_a_folder(instances):
    folder = instances / "easy-ipc-grid_p5-5-5_hyp-0_full"
    found = infer(str(folder), method="exact")
    assert len(found.posterior) == 7
    assert max(found.posterior[-1]) == found.posterior[-1][0]


def test_table_shows_changes_and_reasons(files):
    text = call(files / "some.bank", files / "actions.txt").stdout
    lines = text.splitlines()
    assert sum("goal change" in line for line in lines) == 1
    assert sum("[ignored:" in line for line in lines) == 3
    assert "0.25 each of 4 goals" in lines[1]


def test_long_names_are_numbered_and_listed(instances):
    text = call(instances / "block-words_p01_hyp-0_full").stdout
    assert "goal 1: (CLEAR D),(ONTABLE W),(ON D R),(ON R A),(ON A W)" in text


@pytest.mark.parametrize("form", ["png", "svg"])
def test_picture(files, tmp_path, form):
    target = tmp_path / f"posterior.{form}"
    call(files / "some.bank", files / "actions.txt", "--plot", target)
    data = target.read_bytes()
    assert data.startswith(b"\x89PNG") if form == "png" else b"stew-lentil" in data
    again = tmp_path / f"again.{form}"
    call(files / "some.bank", files / "actions.txt", "--plot", again)
    assert again.read_bytes() == data


def test_wrong_calls(files, tmp_path):
    bank, actions = files / "some.bank", files / "actions.txt"
    call(bank, code=3)  # no ACTIONS beside a bank
    call(bank, tmp_path / "none.txt", code=3)
    call(tmp_path / "none.bank", actions, code=3)
    call(tmp_path, actions, code=3)  # a folder without template.pddl
    call(actions, actions, code=3)  # not a bank
    call(bank, actions, "--method", "magic", code=2)
    call(bank, actions, "--method", "no.such:Class", code=2)
    call(bank, actions, "--plot", tmp_path / "x.bmp", code=2)
    error = json.loads(call(bank, actions, "--method", "exat", "--json", code=2).stdout)["error"]
    assert (error["code"], error["hint"]) == ("unknown-method", "did you mean 'exact'?")


def test_a_belief_from_elsewhere(kitchen, monkeypatch, tmp_path):
    (tmp_path / "elsewhere.py").write_text(
        "import numpy as np\n"
        "class State:\n    world, ignored = 0, None\n"
        "class Last:\n"
        "    def __init__(self, bank): self.names = bank.names\n"
        "    def start(self): return State()\n"
        "    def observe(self, state, step, *, robot=False): return state\n"
        "    def posterior(self, state): return np.eye(len(self.names))[-1]\n"
    )
    monkeypatch.syspath_prepend(str(tmp_path))
    found = infer(kitchen, [("get", "human", "lentils")], method="elsewhere:Last")
    assert [row[-1] for row in found.posterior] == [1.0, 1.0]
    with pytest.raises(UsageError, match="has no 'First'"):
        infer(kitchen, [], method="elsewhere:First")


def test_actions_without_agents_where_agents_matter(hall):
    """Where plans say who acts, an action without an agent is the human's, if one can do it."""
    found = infer(hall, [("go", "ann", "b", "a"), ("take", "cup", "a")], method="exact")
    assert found.ignored == ()
    assert found.posterior[-1][0] > 0.4
    named = infer(hall, [("go", "ann", "b", "a"), ("take", "ann", "cup", "a")], method="exact")
    assert named.posterior == found.posterior


def test_actions_in_every_form(kitchen, tmp_path):
    words = ("get", "human", "yogurt"), ("get", "human", "mango")
    text = "(get human yogurt)\n(GET human mango)"
    (tmp_path / "actions.txt").write_text(text)
    plan = Plan(tuple(PlannedAction(name, tuple(args)) for name, *args in words))
    expected = infer(kitchen, words)
    assert expected.ignored == ()
    path, mixed = tmp_path / "actions.txt", ["(get human yogurt)", words[1]]
    for actions in (text, text.splitlines(), plan, plan.actions, path, str(path), mixed):
        assert infer(kitchen, actions) == expected


@pytest.mark.parametrize(
    ("actions", "message"),
    [
        ([3], "3 is not an action"),
        ([("get", 3)], "is not an action"),
        (["(get human yogurt) (get human mango)\n(wait)"], "is not one action"),
        ([""], "'' is not one action"),
        (7, "7 is not a list of actions"),
        ([None], "None is not an action"),
    ],
)
def test_what_is_no_action(kitchen, actions, message):
    with pytest.raises(UsageError, match=re.escape(message)) as error:
        infer(kitchen, actions)
    assert error.value.code == "bad-action"


def test_what_is_no_source_of_goals():
    with pytest.raises(UsageError, match="from a bank, goals, or a path"):
        infer(3, ["(get human yogurt)"])


def test_a_belief_from_goals_of_an_earlier_version(kitchen, monkeypatch, tmp_path):
    (tmp_path / "earlier.py").write_text(
        "from hrcplan.inference.recognition.cost import CostBelief\n"
        "class Earlier:\n"
        "    takes_goals = True\n"
        "    def __init__(self, goals):\n"
        "        inner = CostBelief(goals)\n"
        "        self.names, self.table, self.start = inner.names, inner.steps, inner.start\n"
        "        self.observe, self.posterior = inner.observe, inner.posterior\n"
        "    def start(self): pass\n"
        "    def observe(self): pass\n"
        "    def posterior(self): pass\n"
    )
    monkeypatch.syspath_prepend(str(tmp_path))
    some = kitchen.goals.only(["stew-lentil", "pasta-bean"])
    with pytest.warns(OldNameWarning, match="'table' is deprecated; its name is 'steps'"):
        found = infer(some, ["(get human lentils)"], method="earlier:Earlier")
    assert found.posterior == infer(some, ["(get human lentils)"], method="cost").posterior


@pytest.fixture
def corridor(tmp_path):
    """A recognition folder: from m one door leads to l, another one to r and on to k."""
    parts = {
        "domain.pddl": """(define (domain corridor) (:predicates (here ?p) (door ?a ?b))
 (:action walk :parameters (?a ?b) :precondition (and (here ?a) (door ?a ?b))
  :effect (and (here ?b) (not (here ?a)))))""",
        "template.pddl": """(define (problem h) (:domain corridor) (:objects m l r k)
 (:init (here m) (door m l) (door m r) (door r k)) (:goal (and <HYPOTHESIS>)))""",
        "hyps.dat": "(here l)\n(here k)\n",
        "obs.dat": "(walk m r)\n(walk r k)\n",
    }
    for name, text in parts.items():
        (tmp_path / name).write_text(text)
    return tmp_path


@pytest.mark.parametrize(
    "text",
    [
        "0: (WALK m r)\n1: (walk r k)",
        "2.001: (walk r k) [2]\n0.000: (walk m r) [2.000]",
        "1. (walk m r)\n2. (walk r k)",
        "walk(m, r)\nwalk(r, k)",
        "(walk m r) (walk\n  r k)",
        "walk m r\nwalk r k",
        "found legal plan as follows\n\nstep 0: WALK M R\n     1: WALK R K\n\ntime spent: 0",
    ],
)
def test_observations_as_planners_write_them(corridor, text):
    (corridor / "obs.dat").write_text(text)
    found = infer(corridor)
    assert found.actions == ("(walk m r)", "(walk r k)")
    assert found.ignored == ()
    assert found.posterior[-1][1] > 0.9


def test_facts_are_observations_of_what_was_done_unseen(corridor):
    (corridor / "obs.dat").write_text("(here r)\n0.5: (not (here r))\n(here k)\n(here moon)\n")
    found = infer(corridor)
    assert [row.index(max(row)) for row in found.posterior[1:]] == [1, 1, 1, 1]
    reasons = [ignored.reason for ignored in found.ignored]
    assert reasons == ["this was so before", "no action changes this fact"]
    actions = infer(corridor, "(walk m r) (walk r k)")
    assert found.posterior[1] == actions.posterior[1]


def test_a_fact_that_takes_several_actions(corridor):
    found = infer(corridor, "(here k)")
    assert found.posterior[-1][1] > 0.8
    assert found.note == "1 action must have happened unobserved"
    assert infer(corridor, "(here m)").ignored[0].reason == "this was so before"
    assert infer(corridor, "(here l) (here k)").ignored[0].reason.startswith("no agent can")


def test_methods_with_plan_graphs_take_no_facts(corridor):
    (corridor / "obs.dat").write_text("(here r)\n")
    found = call(corridor, "--method", "exact", code=3)
    assert "obs.dat: the observations are facts such as (here r)" in found.stderr
    (corridor / "obs.dat").write_text("(walk m r)\n(here r)\n(run r k)")
    reasons = [ignored.reason for ignored in infer(corridor, method="exact").ignored]
    assert reasons == ["this is a fact, not an action", "there is no action 'run'"]


def test_an_old_limit_of_time_is_named(corridor):
    assert "deprecated" in call(corridor, "--timeout", "2").stderr


@pytest.mark.parametrize("text", ["(run m r)", "nothing of this kind", '{"actions": []}'])
def test_observations_without_any_action_are_bad_input(corridor, text):
    (corridor / "obs.dat").write_text(text)
    assert "no observation is an action of domain 'corridor'" in call(corridor, code=3).stderr


def test_archives_are_to_be_unpacked(corridor):
    for mode in ("w", "w:gz", "w:bz2", "w:xz"):
        packed = corridor / "p01.tar"
        with tarfile.open(packed, mode) as archive:
            archive.add(corridor / "domain.pddl")
        for words in ((packed,), (corridor, packed)):
            assert "unpack it first" in call(*words, code=3).stderr


def test_infer_says_that_actions_are_declared_more_than_once(corridor):
    domain = corridor / "domain.pddl"
    again = "(:action walk :parameters (?p) :precondition (here ?p) :effect (not (here ?p)))"
    domain.write_text(domain.read_text()[:-1] + again + ")")
    assert "declared more than once" in call(corridor).stdout
