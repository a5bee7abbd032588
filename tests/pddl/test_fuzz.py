"""Mutated shipped PDDL: only typed errors come out, quickly, at places inside the file."""

import re
import tempfile
import time
from functools import cache
from pathlib import Path

from hypothesis import given, settings
from hypothesis import strategies as st

from hrcplan.errors import Diagnostic, InputError
from hrcplan.pddl import library
from hrcplan.pddl.check import check_files, load_domain, load_problem

TOKEN = re.compile(r"\s+|;[^\n]*|[()]|[^\s();]+")
SLOWEST_S = 10.0
PAIRS = [
    (library.find_domain(domain), library.find_problem(domain, problem))
    for domain in library.domain_names()
    for problem in library.problem_names(domain)[:4]
]
SPICE = (
    "( ) - -- ?x ?duration #t = and or not forall when at start object agent either number -1 1e9 "
    "1.2.3 :init :goal :action :effect :precondition :types define increase total-cost"
)
WORDS = st.sampled_from(SPICE.split())


@cache
def tokens(path: Path) -> tuple[str, ...]:
    return tuple(TOKEN.findall(path.read_text(encoding="utf-8")))


@st.composite
def mutants(draw: st.DrawFn, path: Path) -> bytes:
    """The text of a file after a few changes of its tokens, perhaps with bytes put in."""
    words = list(tokens(path))
    for _ in range(draw(st.integers(0, 4))):
        at, other = (draw(st.integers(0, len(words) - 1)) for _ in range(2))
        match draw(st.sampled_from(["delete", "duplicate", "swap", "cut", "insert"])):
            case "delete":
                del words[at]
            case "duplicate":
                words.insert(other, words[at])
            case "swap":
                words[at], words[other] = words[other], words[at]
            case "cut" if abs(other - at) < len(words) // 2:
                del words[min(at, other) : max(at, other)]
            case _:
                words.insert(at, f" {draw(WORDS)} ")
    data = "".join(words).encode()
    if draw(st.integers(0, 4)) == 0:
        place = draw(st.integers(0, len(data)))
        data = data[:place] + draw(st.binary(max_size=20)) + data[place:]
    return data


def is_inside(fault: Diagnostic, data: bytes) -> bool:
    """Whether a diagnostic's place is a character of the file, or just behind its end."""
    text = data.decode("utf-8-sig", errors="replace")
    lines = re.split(r"\r\n?|\n", text)
    return 1 <= fault.line <= len(lines) and 1 <= fault.column <= len(lines[fault.line - 1]) + 1


def loads(domain: Path, problem: Path) -> bool:
    try:
        load_problem(load_domain(domain), problem)
    except InputError:
        return False
    return True


@settings(max_examples=150)
@given(st.sampled_from(PAIRS), st.data())
def test_mutated_files_give_typed_errors_only(pair: tuple[Path, Path], data: st.DataObject) -> None:
    with tempfile.TemporaryDirectory() as folder:
        texts = [data.draw(mutants(path)) for path in pair]
        copies = [Path(folder, name) for name in ("domain.pddl", "problem.pddl")]
        for copy, text in zip(copies, texts, strict=True):
            copy.write_bytes(text)
        started = time.process_time()
        diagnostics = check_files(copies)
        assert time.process_time() - started < SLOWEST_S
        for fault in diagnostics:
            assert is_inside(fault, texts[copies.index(Path(fault.path))]), fault
            assert len(str(fault).splitlines()) == 1
        accepted = not any(d.severity == "error" for d in diagnostics)
        assert accepted == loads(*copies)


@settings(max_examples=100)
@given(st.text(alphabet="()?-=;:ab1. \n\t#é\0", max_size=200))
def test_noise_gives_typed_errors_only(text: str) -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "noise.pddl")
        path.write_text(text, encoding="utf-8")
        faults = check_files([path])
        assert faults
        assert all(is_inside(fault, path.read_bytes()) for fault in faults)
        assert not loads(path, path)
