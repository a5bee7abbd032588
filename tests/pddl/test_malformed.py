"""Every fault of every malformed file is found, at its line, and nothing else is.

The files say themselves what is expected: ``;; expect: CODE…`` at the end of the faulty line.
"""

import re
import time
from pathlib import Path

import pytest

from hrcplan.errors import Diagnostic, InputError, PddlError
from hrcplan.pddl.check import check, check_files, load_domain, load_problem

HERE = Path(__file__).parent
DOMAIN = HERE / "valid" / "courier.pddl"
MALFORMED = sorted((HERE / "malformed").glob("*.pddl"))
LONGEST_QUOTE = 200


def expected(path: Path) -> list[tuple[int, str]]:
    found = []
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1):
        mark = re.search(r";; expect: (.*)$", line)
        found += [(number, code) for code in (mark[1].split() if mark else ())]
    return sorted(found)


def found(path: Path) -> list[tuple[int, str]]:
    """Line and code of every fault; faults of one kind in one line count once."""
    return sorted({(d.line, d.code) for d in check([DOMAIN, path]).diagnostics})


@pytest.mark.parametrize("path", MALFORMED, ids=lambda path: path.stem)
def test_every_fault_is_found_at_its_line_and_no_other(path: Path) -> None:
    assert expected(path), "the file does not say what is wrong with it"
    assert found(path) == expected(path)


@pytest.mark.parametrize("path", MALFORMED, ids=lambda path: path.stem)
def test_loading_refuses_what_check_refuses(path: Path) -> None:
    diagnostics = check_files([DOMAIN, path])
    errors = tuple(d for d in diagnostics if d.severity == "error")
    assert refused(path) == errors


def refused(path: Path) -> tuple[Diagnostic, ...]:
    try:
        if path.stem.startswith("problem-"):
            load_problem(load_domain(DOMAIN), path)
        else:
            load_domain(path)
    except PddlError as refusal:
        return refusal.diagnostics
    return ()


def test_there_are_many_malformed_files_and_one_has_many_faults() -> None:
    assert len(MALFORMED) >= 45
    assert len({code for _, code in expected(HERE / "malformed" / "many-faults.pddl")}) >= 6


def only_fault(path: Path) -> tuple[int, int, str]:
    (diagnostic,) = check_files([path])
    assert diagnostic.severity == "error"
    return diagnostic.line, diagnostic.column, diagnostic.code


TEXT = "(define (domain d)\n  (:predicates (p)) ; é\n  (:action a :parameters () :effect (p)))\n"
ENCODED = {
    "latin-1": (TEXT.encode("latin-1"), (2, 23, "not-utf-8")),
    "utf-16": (TEXT.encode("utf-16"), (1, 1, "utf-16")),
    "binary with many zeros": (b"HRCPBANK" + bytes(3) + b"\1" + bytes(200), (1, 9, "binary")),
    "utf-16 without mark": (TEXT.encode("utf-16-le"), (1, 1, "utf-16")),
    "NUL": (TEXT.encode().replace(b"(p))", b"(p\0))", 1), (2, 18, "binary")),
    "binary": (bytes(range(256)) * 20, (1, 1, "binary")),
    "binary without NUL": (bytes(range(128, 256)) * 20, (1, 1, "not-utf-8")),
    "empty": (b"", (1, 1, "empty")),
    "only a mark": (b"\xef\xbb\xbf", (1, 1, "empty")),
}


@pytest.mark.parametrize("name", ENCODED)
def test_what_is_not_utf_8_text_is_one_fault_at_its_place(name: str, tmp_path: Path) -> None:
    data, fault = ENCODED[name]
    path = tmp_path / "d.pddl"
    path.write_bytes(data)
    assert only_fault(path) == fault


def test_a_stray_byte_does_not_hide_the_other_faults(tmp_path: Path) -> None:
    path = tmp_path / "d.pddl"
    path.write_bytes(TEXT.replace(":effect (p)", ":effect (q)").encode("latin-1"))
    assert found(path) == [(2, "not-utf-8"), (3, "unknown-predicate")]


def test_a_folder_and_a_missing_file_are_faults(tmp_path: Path) -> None:
    assert only_fault(tmp_path) == (1, 1, "is-folder")
    assert only_fault(tmp_path / "none.pddl") == (1, 1, "no-file")
    for path in (tmp_path, tmp_path / "none.pddl"):
        with pytest.raises(InputError):
            load_domain(path)


def test_deep_nesting_is_refused_once_and_the_rest_is_read(tmp_path: Path) -> None:
    deep = "(and " * 5000 + "(p)" + ")" * 5000
    path = tmp_path / "d.pddl"
    path.write_text(
        f"(define (domain d) (:predicates (p))\n(:action a :parameters () :precondition {deep}"
        "\n:effect (q)))"
    )
    assert found(path) == [(2, "too-deep"), (3, "unknown-predicate")]


@pytest.mark.parametrize(
    ("inside", "code"),
    [
        ("(q" + f"{' x':20}" * 100_000 + ")", "unknown-predicate"),
        ("(" + "x" * 2_000_000 + ")", "unknown-predicate"),
        ("x" * 2_000_000, "not-a-condition"),
        ("(p ?" + "x" * 2_000_000 + ")", "wrong-arity"),
        ("(and" + f"{' (p)':20}" * 100_000, "unclosed"),
    ],
    ids=["words", "predicate", "word", "variable", "unclosed"],
)
def test_a_line_of_two_megabytes_is_quoted_in_part_only(
    inside: str, code: str, tmp_path: Path
) -> None:
    path = tmp_path / "d.pddl"
    path.write_text(
        "(define (domain d) (:predicates (p)) "
        f"(:action a :parameters () :precondition {inside} :effect (p)))"
    )
    started = time.process_time()
    diagnostics = check_files([path])
    assert time.process_time() - started < 60  # quadratic work would take hours
    assert code in {d.code for d in diagnostics}
    assert all(len(d.message) + len(d.hint or "") <= LONGEST_QUOTE for d in diagnostics)
