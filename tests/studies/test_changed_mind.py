"""The study of changed goals runs, stops, goes on, and takes in strangers; on a small workshop."""

import json
import sqlite3
import sys
from pathlib import Path
from typing import Any

import pytest

from hrcplan.errors import InputError, UsageError
from hrcplan.studies import report_study, run_study
from hrcplan.studies.changed_mind import episodes as rows_of
from hrcplan.studies.changed_mind import scenario, script
from hrcplan.studies.study import Seed, episodes, find

NAME = "changed-mind"
WORKSHOP = Path(__file__).parent / "workshop"
TASK = {"domain": str(WORKSHOP / "domain.pddl"), "goals": str(WORKSHOP)}
QUICK = {**TASK, "methods": "recursive,hrcplan,oracle"}  # no forest is trained for them
HUMANS = ["fixed", "optimal", "suboptimal"]
METHODS = ["rhp", "recursive", "recursive-best", "cdp", "infogain", "hrcplan", "oracle"]
MEASURES = {"reached_pct", "stuck_pct", "unfinished_pct",
            "first_correct", "last_incorrect_pct", "last_incorrect_step", "correct_pct", "top3_pct",
            "wasted_robot_steps", "human_mistakes", "total_steps", "extra_steps",
            "extra_vs_oracle", "detection_delay", "false_changes", "decision_ms"}  # fmt: skip


def run(folder: Path, **options: Any) -> int:
    return run_study(NAME, folder, **{"runs": 2, "options": QUICK, **options})


def rows(folder: Path, table: str = "rows") -> list[dict[str, Any]]:
    with sqlite3.connect(folder / "rows.sqlite") as found:
        found.row_factory = sqlite3.Row
        return [dict(row) for row in found.execute(f"select * from {table}")]


def test_the_promised_cells_on_the_papers_task() -> None:
    study = find(NAME)
    cells = study.tables[0].cells(study.options)
    assert cells == [(human, method) for human in HUMANS for method in METHODS]
    assert set(study.measures) == MEASURES
    assert study.runs(study.options) == 30 * 29 * 3


def test_same_rows_whatever_the_jobs(tmp_path: Path) -> None:
    for jobs in (1, 2):
        run(tmp_path / str(jobs), jobs=jobs, runs=8)
    one, two = (tmp_path / str(jobs) / "rows.sqlite" for jobs in (1, 2))
    assert one.read_bytes() == two.read_bytes()
    assert (tmp_path / "1" / "clock.sqlite").is_file()


def test_rows_that_were_made_already_are_kept_and_none_is_made_twice(tmp_path: Path) -> None:
    run(tmp_path / "grown", limit=11)
    n_new = run(tmp_path / "grown", runs=4)
    run(tmp_path / "whole", runs=4)
    wanted = list(episodes(find(NAME), {**find(NAME).options, **QUICK}, 4))
    assert 0 < n_new < len(wanted)
    grown, whole = (tmp_path / name / "rows.sqlite" for name in ("grown", "whole"))
    assert grown.read_bytes() == whole.read_bytes()


def test_cells_are_paired(tmp_path: Path) -> None:
    """In one run every cell has the same goals; with one human also the same change and errors."""
    run(tmp_path, runs=6)
    for number in range(6):
        found = [row for row in rows(tmp_path) if row["run"] == number]
        assert len({row["first"] for row in found}) == 1
        assert len({(row["goals"], row["turns"]) for row in found if row["human"] != "fixed"}) == 1
        assert all(row["second"] is None for row in found if row["human"] == "fixed")


def test_a_trial_goes_through_all_pairs() -> None:
    bank = scenario.bank_of(TASK["domain"], TASK["goals"])
    n = len(bank.names)
    for trial in range(2):
        runs = range(trial * n * (n - 1), (trial + 1) * n * (n - 1))
        pairs = [scenario.course("optimal", bank, Seed(3, number)).goals for number in runs]
        assert len(set(pairs)) == n * (n - 1)
        assert all(first != second for first, second in pairs)


def test_the_first_change_comes_before_the_first_goal_could_be_reached() -> None:
    bank = scenario.bank_of(TASK["domain"], TASK["goals"])
    seen = set()
    for number in range(200):
        course = scenario.course("optimal", bank, Seed(0, number))
        (turn,) = course.turns
        assert 1 <= turn <= (bank.graphs[course.goals[0]].n_steps - 1) // 2
        seen.add(turn)
    assert len(seen) > 1


def test_several_changes_are_to_other_goals_and_in_order() -> None:
    bank = scenario.bank_of(TASK["domain"], TASK["goals"])
    for number in range(50):
        course = scenario.course("3 changes", bank, Seed(0, number))
        assert len(course.goals) == 4
        assert all(a != b for a, b in zip(course.goals, course.goals[1:], strict=False))
        assert list(course.turns) == sorted(set(course.turns))


def test_rows_of_an_earlier_version_are_still_reported(tmp_path: Path) -> None:
    """They lack what was added since; how an episode ended is known, its length was its cost."""
    run(tmp_path, runs=3)
    added = ("reached_pct", "stuck_pct", "unfinished_pct", "unreachable_pct", "played_steps")
    with sqlite3.connect(tmp_path / "rows.sqlite") as old:
        for table in find(NAME).tables:
            for name in added:
                old.execute(f"alter table {table.name} drop column {name}")
        old.execute("update rows set ending = 'stuck' where run = 0 and method = 'oracle'")
    found = report_study(tmp_path)
    shares = {
        row["cell"]["method"]: row["measures"]["reached_pct"]["mean"] for row in found["rows"]
    }
    assert shares["hrcplan"] == 100
    assert shares["oracle"] < 100
    assert "rows are of an earlier version" in (tmp_path / "report.html").read_text()


def test_measures_agree_with_one_another(tmp_path: Path) -> None:
    run(tmp_path, runs=10)
    for row in rows(tmp_path):
        assert row["ending"] == "reached"
        shares = ("reached_pct", "stuck_pct", "unfinished_pct", "unreachable_pct")
        assert [row[name] for name in shares] == [100, 0, 0, 0]
        assert row["played_steps"] == row["total_steps"]
        assert 0 <= row["correct_pct"] <= row["top3_pct"] <= 100
        assert row["last_incorrect_step"] <= row["total_steps"]
        assert row["extra_vs_oracle"] <= row["extra_steps"] or row["human_mistakes"] == 0
        if row["method"] == "oracle":
            assert row["extra_vs_oracle"] == row["wasted_robot_steps"] == row["first_correct"] == 0
        if row["human"] == "fixed":
            assert row["extra_steps"] >= 0
            assert row["detection_delay"] == 0


def test_every_method_runs_and_reports_its_promised_figures(tmp_path: Path) -> None:
    """Also those that learn: on goals as few as these a forest is trained in seconds."""
    run_study(NAME, tmp_path, runs=1, options=TASK)
    document = report_study(tmp_path)
    assert json.loads((tmp_path / "report.json").read_text()) == document
    assert [row["cell"] for row in document["rows"]] == [
        {"human": human, "method": method} for human in HUMANS for method in METHODS
    ]
    for row in document["rows"]:
        assert set(row["measures"]) == MEASURES
        assert all(set(figure) == {"mean", "se"} for figure in row["measures"].values())
        assert row["measures"]["decision_ms"]["mean"] >= 0
        assert all(f["mean"] is not None or f["se"] is None for f in row["measures"].values())
    assert "<script" not in (tmp_path / "report.html").read_text()


def test_a_strangers_robot_and_human_join(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "mine.py").write_text(
        "from hrcplan.assistance.oracle import Oracle\n"
        "from hrcplan.episodes.humans import Frontier\n"
        "class Robot(Oracle):\n"
        "    def choose(self, state):\n"
        "        return None\n"
        "class Human(Frontier):\n"
        "    def choose(self, graph, node, steps, last, draw):\n"
        "        return steps[0]\n"
    )
    monkeypatch.syspath_prepend(str(tmp_path))
    options = {**TASK, "methods": "oracle,mine:Robot", "humans": "optimal,mine:Human"}
    run(tmp_path / "out", options=options, limit=8)
    found = {(row["human"], row["method"]): row for row in rows(tmp_path / "out")}
    assert set(found) == {(h, m) for h in ("optimal", "mine:Human")
                          for m in ("oracle", "mine:Robot")}  # fmt: skip
    # A robot that only waits leaves every step to the human, and every second turn is lost.
    idle = found["optimal", "mine:Robot"]
    assert idle["total_steps"] > found["optimal", "oracle"]["total_steps"]
    assert idle["robot_waits"] > 0


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"methods": "papre"}, "no method 'papre'"),
        ({"humans": "optimall"}, "no human 'optimall'"),
        ({"chooser": "nobody:Human"}, "no module 'nobody'"),
        ({"world": "real"}, "no world 'real'"),
        ({"colour": "red"}, "no option 'colour'"),
    ],
)
def test_unknown_parts_are_named_before_anything_runs(
    tmp_path: Path, options: dict[str, str], message: str
) -> None:
    with pytest.raises(UsageError, match=message):
        run(tmp_path / "out", options={**QUICK, **options})
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("goals", "old", "new", "message"),
    [
        (["desk"], "", "", "two"),
        (["desk", "table"], "(painted top)", "(joined top legs)", "no plan, or holds"),
        (["desk", "table"], "robot human - agent", "robot - agent", "no human"),
        (["desk", "table"], "(controllable robot)", "(controllable robot) (controllable human)",
         "no human"),
        (["desk", "table"], "(controllable robot)", "", "no robot"),
    ],
)  # fmt: skip
def test_what_is_nothing_to_study_is_told_before_anything_is_made(
    tmp_path: Path, goals: list[str], old: str, new: str, message: str
) -> None:
    for goal in goals:
        text = (WORKSHOP / f"{goal}.pddl").read_text()
        (tmp_path / f"{goal}.pddl").write_text(text.replace(old, new).replace("robot", "ann"))
    options = {**QUICK, "goals": str(tmp_path)}
    with pytest.raises(UsageError, match=message):
        run_study(NAME, tmp_path / "out", options=options)
    assert not (tmp_path / "out").exists()


def test_names_of_the_study_may_have_commas() -> None:
    options = {**find(NAME).options, "methods": "oracle,rhp, in order", "humans": "optimal"}
    scenario.check(options)
    assert scenario.cells("variants", options)[0] == ("optimal", "rhp, in order")


def test_the_clock_is_measured_but_never_part_of_the_rows(tmp_path: Path) -> None:
    run(tmp_path)
    assert "decision_ms" not in rows(tmp_path)[0]
    assert "decision_ms" not in rows_of.COLUMNS
    before = report_study(tmp_path)["rows"][0]["measures"]["decision_ms"]["mean"]
    (tmp_path / "clock.sqlite").unlink()
    assert before > 0
    assert report_study(tmp_path)["rows"][0]["measures"]["decision_ms"]["mean"] is None


def test_a_change_that_is_never_declared_is_late_to_the_end(tmp_path: Path) -> None:
    """Recursive Bayes declares no changes: its delay is all that is left, and not nought."""
    run(tmp_path)
    cells = {tuple(r["cell"].values()): r["measures"] for r in report_study(tmp_path)["rows"]}
    assert cells["optimal", "recursive"]["detection_delay"]["mean"] > 0
    assert cells["optimal", "oracle"]["detection_delay"]["mean"] == 0


@pytest.mark.skipif(sys.version_info >= (3, 12), reason="pddlgym has no wheels from 3.12 on")
def test_pddlgym_gives_the_same_rows(tmp_path: Path) -> None:
    options = {"methods": "oracle", "humans": "suboptimal"}
    for world in ("simulated", "pddlgym"):
        run(tmp_path / world, options={**options, "world": world}, limit=6)
    assert rows(tmp_path / "simulated") == rows(tmp_path / "pddlgym")


# Scripts.


def test_the_golden_episode_of_our_method() -> None:
    """Figure 4: yogurt and glass are fetched, the change is noticed, oats and fruit follow."""
    (played,) = script.episodes(script.read("golden"), ["hrcplan"])
    done = [(turn.agent, turn.action) for turn in played.turns]
    assert done[:6] == [
        ("human", "(get berries)"),
        ("robot", "(get yogurt)"),
        ("human", "(turn_on blender)"),
        ("robot", "(get glass)"),
        ("human", "(pour yogurt glass)"),
        ("robot", "(get oats)"),
    ]
    assert {name for name, _ in played.turns[3].top[:2]} == {"smoothie-berry", "smoothie-oat"}
    assert all("parfait-fruit" in dict(turn.top) for turn in played.turns[4:])
    assert [turn.n_declared for turn in played.turns][:7] == [0, 0, 0, 0, 0, 0, 1]
    assert all(turn.is_needed for turn in played.turns)
    assert played.ending == "reached"


def test_the_golden_episode_beside_recursive_bayes() -> None:
    ours, theirs = script.episodes(script.read("golden"), ["hrcplan", "recursive"])
    assert [t.action for t in ours.turns if t.agent == "human"][:2] == [
        t.action for t in theirs.turns if t.agent == "human"
    ][:2]
    assert len(ours.turns) < len(theirs.turns)


def test_what_is_hard_for_the_human_counts_in_a_scripted_episode() -> None:
    golden, state = script.read("golden"), ["motivation human=8"]
    (plain,) = script.episodes(golden, ["hrcplan"])
    (priced,) = script.episodes(golden, ["hrcplan"], state, "hrcplan")
    values = [e.turns[1].why.candidates[0].value for e in (plain, priced) if e.turns[1].why]
    assert values[1] > 2 * values[0]
    with pytest.raises(UsageError, match="without prices"):
        script.episodes(golden, ["oracle"], state)


SCRIPT = "domain = 'x'\nwanted = {}\nchange_turns = {}\nhuman = {}\nmethods = {}\n"


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ("", "lacks 'domain'"),
        ("domain = ", "no TOML"),
        (None, "there is no file"),
        (SCRIPT.format("['a']", [1], [], "['oracle']"), "one number less"),
        (SCRIPT.format("'a'", [], [], "['oracle']"), "wanted is a list of texts"),
        (SCRIPT.format("['a', 'b']", 5, [], "['oracle']"), "change_turns is a list of numbers"),
        (SCRIPT.format("['a', 'b']", ["x"], [], "['oracle']"), "change_turns is a list of numbers"),
        (SCRIPT.format("['a', 'b']", [1], [1], "['oracle']"), "human is a list of texts"),
        (SCRIPT.format("['a', 'b', 'c']", [5, 2], [], "['oracle']"), "rise from 1"),
        (SCRIPT.format("['a', 'b']", [-1], [], "['oracle']"), "rise from 1"),
        (SCRIPT.format("['a', 'b']", [1], [], "[]"), "names none"),
    ],
)
def test_what_is_no_script_is_refused(tmp_path: Path, change: str | None, message: str) -> None:
    path = tmp_path / "mine.toml"
    if change is not None:
        path.write_text(change)
    with pytest.raises(InputError, match=message):
        script.read(str(path))


def test_a_script_of_another_domain(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(
        f"domain = '{TASK['domain']}'\ngoals = '{TASK['goals']}'\nmethods = ['oracle']\n"
        "wanted = ['desk', 'table']\nchange_turns = [1]\nhuman = ['(fetch drawer)']\n"
    )
    (played,) = script.episodes(script.read(str(path)))
    assert played.turns[0].action == "(fetch drawer)"
    assert {turn.goal for turn in played.turns} == {"desk", "table"}
    path.write_text(path.read_text().replace("drawer", "drwaer"))
    with pytest.raises(InputError, match="no step"):
        script.episodes(script.read(str(path)))
    path.write_text(path.read_text().replace("table", "tabel"))
    with pytest.raises(InputError, match="no goal 'tabel'"):
        script.episodes(script.read(str(path)))


def test_names_of_earlier_versions_still_work() -> None:
    study = find(NAME)
    with pytest.warns(DeprecationWarning, match="'rhp,oracle'"):
        options = study.with_defaults({"methods": "paper,oracle"})
    assert scenario.cells("rows", options)[:2] == [("fixed", "rhp"), ("fixed", "oracle")]
    rows = [{"human": "optimal", "method": name, "run": 0} for name in ("paper", "paper, in order")]
    current = study.present_rows(study.tables[0], rows)
    assert [row["method"] for row in current] == ["rhp", "rhp, in order"]


def test_bank_options_are_passed_on(tmp_path: Path) -> None:
    plain, more = (
        scenario.bank_of(TASK["domain"], TASK["goals"], quality) for quality in ("", "6/5")
    )
    assert all(a.plans <= b.plans for a, b in zip(plain.graphs, more.graphs, strict=True))
    assert more.recipe.quality > plain.recipe.quality
    run(tmp_path / "more", runs=1, options={**QUICK, "quality": "1.2"})
    assert report_study(tmp_path / "more")["about"]["options"]["quality"] == "1.2"
    with pytest.raises(UsageError, match="no multiple"):
        run(tmp_path / "bad", options={**QUICK, "quality": "much"})
    with pytest.raises(UsageError, match="exclude"):
        run(tmp_path / "bad", options={**QUICK, "quality": "2", "alternatives": "2"})
