"""``check``: which domain a problem is held against, and how faults are told."""

import json
import subprocess
import sys
import time
from pathlib import Path

import pytest

from hrcplan.errors import InputError, PddlError
from hrcplan.pddl.check import CheckReport, check, check_files, load_domain, load_problem
from hrcplan.pddl.library import domain_names, find_domain, find_problem, problem_names
from hrcplan.pddl.model import Note

VALID = Path(__file__).parent / "valid"
DOMAIN = VALID / "courier.pddl"
PROBLEM = VALID / "courier-two-items.pddl"
SHIPPED = [
    (find_domain(domain), find_problem(domain, problem))
    for domain in domain_names()
    for problem in problem_names(domain)
]


@pytest.fixture
def problem(tmp_path: Path) -> Path:
    """A problem of the courier domain with nothing beside it."""
    copy = tmp_path / "problem.pddl"
    copy.write_text(PROBLEM.read_text())
    return copy


def codes(*paths: Path) -> list[tuple[str, str]]:
    return [(Path(d.path).name, d.code) for d in check_files(paths)]


def edited(path: Path, old: str, new: str, to: Path) -> Path:
    text = path.read_text()
    assert old in text
    to.write_text(text.replace(old, new))
    return to


def test_shipped_files_are_free_of_errors_and_warnings() -> None:
    assert SHIPPED
    assert check_files([path for pair in SHIPPED for path in pair]) == ()


def test_a_problem_is_checked_against_the_domain_given(problem: Path, tmp_path: Path) -> None:
    folder = tmp_path / "elsewhere"
    folder.mkdir()
    other = edited(DOMAIN, "(lies ", "(lays ", folder / "d.pddl")
    assert ("problem.pddl", "unknown-predicate") in codes(problem, other)
    assert codes(other, DOMAIN, problem) == codes(other, problem, DOMAIN)


def test_a_domain_given_wins_over_one_beside(problem: Path, tmp_path: Path) -> None:
    edited(DOMAIN, "(lies ", "(lays ", tmp_path / "beside.pddl")
    assert ("problem.pddl", "unknown-predicate") in codes(problem)
    assert codes(problem, DOMAIN) == []


def test_else_against_the_domain_of_its_name_beside_it(problem: Path, tmp_path: Path) -> None:
    assert codes(problem) == [("problem.pddl", "domain-mismatch")]
    text = ";; (define (domain wrong)\n" + DOMAIN.read_text().replace("(define", "( DEFINE ;x\n")
    (tmp_path / "a.pddl").write_text("(define (domain other))")
    (tmp_path / "z.pddl").write_text(text)
    assert codes(problem) == []


def test_else_against_the_shipped_domain(tmp_path: Path) -> None:
    copy = tmp_path / "copy.pddl"
    copy.write_text(find_problem("transport", "two-boxes").read_text())
    assert codes(copy) == []
    edited(copy, "(:domain transport)", "(:domain transprot)", copy)
    (fault,) = check_files([copy])
    assert (fault.code, fault.hint) == ("domain-mismatch", "did you mean 'transport'?")


def test_a_wrong_domain_name_does_not_hide_other_faults(problem: Path) -> None:
    edited(problem, "(:domain courier)", "(:domain courrier)", problem)
    edited(problem, "(at human desk)", "(at human dusk)", problem)
    (mismatch, fault) = check_files([problem, DOMAIN])
    assert (mismatch.code, mismatch.hint) == ("domain-mismatch", "did you mean 'courier'?")
    assert (fault.code, fault.hint) == ("unknown-object", "did you mean 'desk'?")


def test_a_faulty_domain_that_was_not_given_is_a_fault_of_the_problem(
    problem: Path, tmp_path: Path
) -> None:
    beside = edited(DOMAIN, "(:action ask", "(:action pick", tmp_path / "d.pddl")
    assert codes(problem) == [("problem.pddl", "faulty-domain")]
    faults = codes(problem, beside)
    assert ("d.pddl", "duplicate-action") in faults
    assert all(name == "d.pddl" for name, _ in faults)


def test_a_domain_in_place_of_a_problem_and_the_other_way_round() -> None:
    with pytest.raises(PddlError) as refusal:
        load_domain(PROBLEM)
    assert [d.code for d in refusal.value.diagnostics] == ["not-a-domain"]
    with pytest.raises(PddlError) as refusal:
        load_problem(load_domain(DOMAIN), DOMAIN)
    assert [d.code for d in refusal.value.diagnostics] == ["not-a-problem"]


def test_a_problem_for_another_domain_is_refused() -> None:
    with pytest.raises(PddlError) as refusal:
        load_problem(load_domain(find_domain("transport")), PROBLEM)
    assert refusal.value.code == "domain-mismatch"


def test_the_report_as_json_has_the_promised_keys(tmp_path: Path) -> None:
    faulty = edited(DOMAIN, "(at start (at ?a ?from))", "(at start (att ?a))", tmp_path / "d.pddl")
    document = json.loads(json.dumps(check([faulty, PROBLEM]).to_json()))
    assert document == {
        "files": 2,
        "diagnostics": [
            {
                "path": str(faulty),
                "line": 24,
                "column": 18,
                "severity": "error",
                "code": "unknown-predicate",
                "message": "predicate 'att' is not declared",
                "hint": "did you mean 'at'?",
            }
        ],
    }


def test_the_report_as_text_has_one_line_per_fault_and_lists_the_notes() -> None:
    report = check([DOMAIN, PROBLEM, Path("none.pddl")])
    assert report.has_errors
    assert list(report.lines()) == [
        "none.pddl:1:1: error[no-file]: there is no file none.pddl",
        f"{DOMAIN}: note: success ask 0.8",
        f"{DOMAIN}: note: range effort 0 10",
    ]


def test_a_report_with_warnings_only_has_no_errors(tmp_path: Path) -> None:
    warned = edited(DOMAIN, ":durative-actions)", ":durative-actions :x)", tmp_path / "d.pddl")
    report = check([warned])
    assert [d.severity for d in report.diagnostics] == ["warning"]
    assert not report.has_errors
    assert load_domain(warned).requirements[-1] == ":x"
    assert CheckReport(0, (), ()).has_errors is False


def test_notes_are_values_of_the_domain() -> None:
    domain = load_domain(DOMAIN)
    assert domain.notes[1] == Note("range", "effort", (0, 10))
    assert float(domain.success("ask")) == 0.8
    assert domain.success("go") == 1
    assert domain.value_range("effort") == (0, 10)
    assert domain.value_range("distance") is None


def test_an_unreadable_neighbour_is_passed_over(problem: Path, tmp_path: Path) -> None:
    (tmp_path / "folder.pddl").mkdir()
    (tmp_path / "broken.pddl").symlink_to("nowhere.pddl")
    (tmp_path / "noise.pddl").write_bytes(bytes(range(256)))
    assert codes(problem) == [("problem.pddl", "domain-mismatch")]


def test_missing_names_are_input_errors_with_a_hint() -> None:
    with pytest.raises(InputError) as refusal:
        find_domain("transprot")
    assert refusal.value.hint == "did you mean 'transport'?"
    with pytest.raises(InputError) as refusal:
        find_problem("transport", "two-boxen")
    assert refusal.value.hint == "did you mean 'two-boxes'?"


def test_loading_imports_nothing_heavy() -> None:
    program = (
        "import sys; from hrcplan.pddl.check import load_domain, load_problem;"
        f"load_problem(load_domain({str(DOMAIN)!r}), {str(PROBLEM)!r});"
        "print([m for m in ('rapidfuzz', 'numpy', 'unified_planning') if m in sys.modules])"
    )
    shown = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    assert shown.stdout.strip() == "[]"


def test_twenty_thousand_facts_are_read_in_seconds(tmp_path: Path) -> None:
    n = 142
    places = [f"place-{i}" for i in range(n)]
    pairs = [(a, b) for a in places for b in places if a != b]
    facts = "\n".join(f"(road {a} {b}) (= (distance {a} {b}) 5)" for a, b in pairs[:10_000])
    path = tmp_path / "large.pddl"
    path.write_text(
        f"(define (problem large) (:domain courier)\n(:objects robot - agent {' '.join(places)}"
        f" - place)\n(:init (at robot depot) (= (effort robot) 1)\n{facts})\n"
        "(:goal (at robot place-1)))"
    )
    started = time.process_time()
    assert codes(DOMAIN, path) == []
    assert time.process_time() - started < 20
