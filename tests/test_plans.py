"""Plan texts: what is read, what is refused and where, and that writing loses nothing."""

from __future__ import annotations

from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hrcplan.errors import PlanFormatError
from hrcplan.pddl.inputs import read
from hrcplan.plans import (
    Plan,
    PlannedAction,
    format_plan,
    format_plansys2,
    lane,
    occupied,
    parse_plan,
    seconds_text,
)

WORDS = st.from_regex(r"[a-z][a-z0-9_-]{0,8}", fullmatch=True)
MICROSECONDS = st.integers(0, 10**12).map(lambda n: Fraction(n, 10**6))
SEQUENTIAL = st.builds(PlannedAction, WORDS, st.lists(WORDS, max_size=4).map(tuple))
TIMED = st.builds(
    PlannedAction,
    WORDS,
    st.lists(WORDS, max_size=4).map(tuple),
    MICROSECONDS,
    st.one_of(st.none(), MICROSECONDS),
)


@given(st.one_of(st.lists(SEQUENTIAL, max_size=6), st.lists(TIMED, max_size=6)))
def test_what_is_written_is_read_back(actions: list[PlannedAction]) -> None:
    plan = Plan(tuple(sorted(actions, key=lambda a: a.start_s or 0)))
    assert parse_plan(format_plan(plan)) == plan
    assert str(plan) == format_plan(plan)


@given(st.text(max_size=80))
def test_any_text_is_a_plan_or_a_typed_error(text: str) -> None:
    try:
        plan = parse_plan(text)
    except PlanFormatError as error:
        line = error.line
    else:
        line = 1
        assert parse_plan(format_plan(plan)) == plan
    assert line in range(1, len(text.splitlines()) + 2)


def test_comments_case_blanks_and_order() -> None:
    text = (
        "; cost = 3\n\n  50.001 : ( GRASP Human  blue ) [ 50 ] ; then\r\n0: (move human wp1)[5e1]\n"
    )
    first, second = parse_plan(text).actions
    assert first == PlannedAction("move", ("human", "wp1"), 0, 50)
    assert second == PlannedAction("grasp", ("human", "blue"), Fraction(50001, 1000), 50)


def test_equal_times_keep_the_order_of_the_file() -> None:
    plan = parse_plan("1: (b)\n0: (z)\n0: (a)\n1: (a)\n")
    assert [a.name for a in plan.actions] == ["z", "a", "b", "a"]


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("(move a b)\nmove a b\n", 2),
        ("(move a b\n", 1),
        ("()\n", 1),
        ("(a) b\n", 1),
        ("1. go a b\n", 1),
        ("(a)\n0.5:\n", 2),
        ("; fine\n(a)\n((a))\n", 3),
        ("0.5: (a) [1]\n(b)\n", 2),
        ("(a)\n0: (b)\n", 2),
        ("-1: (a)\n", 1),
        ("0: (a) [-1]\n", 1),
        ("0: (a) [x]\n", 1),
        ("nan: (a)\n", 1),
        ("inf: (a)\n", 1),
        ("1e999: (a)\n", 1),
        ("(a) [5]\n", 1),
    ],
)
def test_the_first_wrong_line_is_named(text: str, line: int) -> None:
    with pytest.raises(PlanFormatError) as caught:
        parse_plan(text, "some.plan")
    assert (caught.value.path, caught.value.line) == ("some.plan", line)


def test_the_column_of_a_fault_is_that_of_the_text_that_is_no_action() -> None:
    with pytest.raises(PlanFormatError) as caught:
        parse_plan("(go a b)\n  go b c\n")
    assert (caught.value.line, caught.value.column) == (2, 3)


GO = (PlannedAction("go", ("a", "b")), PlannedAction("go", ("b", "c")))


@pytest.mark.parametrize(
    "text",
    [
        "(go a b) (go b c)",
        "(go\n a\n b)\n(go b c)",
        "1. (GO A B)\n2. (GO B C)\n",
        "1) go(a, b)\n2) go(b, c)",
        "1 (go a b)\n2 (go b c)",
        "- (go a b)\n- (go b c)",
        "go(a,b), go(b,c)",
    ],
)
def test_lists_and_function_style_are_plans(text: str) -> None:
    assert parse_plan(text).actions == GO


def test_a_duration_may_stand_as_lpg_writes_it() -> None:
    first, second = parse_plan("0.0: (A) [D:5.00; C:0.10] ; first\n6: (B) [5.0000])").actions
    assert (first.duration_s, second.duration_s) == (5, 5)


def test_a_long_line_is_not_quoted_in_full() -> None:
    with pytest.raises(PlanFormatError) as caught:
        parse_plan("x" * 2_000_000)
    assert len(str(caught.value)) < 300


def test_empty_text_is_the_empty_plan() -> None:
    assert parse_plan("; nothing to do\n\n") == Plan()
    assert format_plan(Plan()) == ""


def test_makespan_is_the_end_of_the_last_action() -> None:
    plan = parse_plan("0: (a) [5]\n2: (b) [1]\n4.5: (c)\n")
    assert plan.makespan_s == 5
    assert [a.end_s for a in plan.actions] == [5, 3, Fraction(9, 2)]
    assert parse_plan("(a)").makespan_s is None
    assert parse_plan("(a)").actions[0].end_s is None


@pytest.mark.parametrize(
    ("seconds", "text"),
    [(0, "0.000"), (50, "50.000"), (Fraction(1, 1000), "0.001"), (Fraction(1, 10**6), "0.000001")],
)
def test_seconds_have_three_decimals_or_as_many_as_they_need(seconds: Fraction, text: str) -> None:
    assert seconds_text(seconds) == text


def test_lanes_and_who_is_kept_busy() -> None:
    problem = read("transport", "two-boxes")
    take = PlannedAction("take", ("robot", "green", "human", "wp2"))
    assert lane(take.args, problem) == "robot"
    assert occupied(take, problem) == {"robot", "human"}
    assert occupied(PlannedAction("move", ("human", "wp1", "wp2")), problem) == {"human"}
    assert lane(("wp1",), problem) is None


def test_plans_for_plansys2_have_times_on_every_line() -> None:
    durative = parse_plan("0: (move a) [50]\n60.5: (look a)")
    assert format_plansys2(durative) == "0.000: (move a) [50.000]\n60.500: (look a) [0.001]\n"
    assert parse_plan(format_plansys2(durative)).actions[0] == durative.actions[0]
