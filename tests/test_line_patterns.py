"""No line of a plan, of observations or of a planner's output takes more than linear time."""

from __future__ import annotations

import time
from contextlib import suppress

import pytest

from hrcplan.bank.ramirez_geffner import read_actions
from hrcplan.errors import PlanFormatError
from hrcplan.pddl.inputs import read
from hrcplan.pddl.model import Problem
from hrcplan.plans import find_plans, parse_plan
from hrcplan.plans.logs import read_plan

N = 100_000
LONG = [
    *("(" + " " * N + "x", " " * N + "x", "(" * N, "1" * N, "1:" * N, "0:" + " " * N + "x"),
    *("(a)" + " " * N + "x", "(a)[" + " " * N, "(a) [1" + " " * N + "x", "[" * N, "\n" * N + "x"),
    *("(a) [" + "d:" * N, "(a) [1;" + "x" * N, "(a) [1];" + ";" * N, "." * N + "x", "[." * N),
    *("-" * N, "- " * N, "--" + " " * N, "step" * N, "a " * N, " (1" * N, "[d" + " " * N),
]


@pytest.fixture(scope="module")
def problem() -> Problem:
    return read("transport", "two-boxes")


def test_long_lines_take_linear_time(problem: Problem) -> None:
    begin = time.process_time()
    for text in LONG:
        with suppress(PlanFormatError):
            parse_plan(text)
        list(find_plans(f"(move human wp1 wp4)\n{text}", problem))
        with suppress(PlanFormatError):
            read_plan(f"(move human wp1 wp4)\n{text}", problem)
        read_actions(text, problem)
    # Linear: about a second. Quadratic: many minutes.
    assert time.process_time() - begin < 30


def test_spaces_and_comments_are_still_read() -> None:
    assert (
        str(parse_plan(" 0.5 :  (  move a  b )  [ 2.0 ] ; so\n")) == "0.500: (move a b) [2.000]\n"
    )
    assert read_actions("0.0: (a)[1.5]\n  2 : (b)\nc [1] ; x") == (("a",), ("b",), ("c",))
