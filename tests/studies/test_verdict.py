"""Three verdicts, and how many runs would tell."""

import math

import pytest

from hrcplan.studies.changed_mind.measures import MEASURES
from hrcplan.studies.estimate import Interval, estimate
from hrcplan.studies.page import _multiplicity, html
from hrcplan.studies.study import Claim, Findings
from hrcplan.studies.verdict import BoundTest, judge


@pytest.mark.parametrize(
    ("low", "high", "holds"),
    [(1, 2, True), (0, 2, True), (-2, -1, False), (-1, 2, None), (-math.inf, math.inf, None)],
)
def test_an_interval_decides(low, high, holds):
    assert BoundTest(Interval((low + high) / 2, low, high, 9), least=0).holds is holds


def test_a_strict_bound_is_not_met_by_equality():
    equal = Interval(0.0, 0.0, 0.0, 9)
    assert BoundTest(equal, least=0).holds
    assert BoundTest(equal, least=0, is_strict=True).holds is False


def test_a_band_holds_fails_or_is_open():
    band = {"least": 45.0, "most": 55.0}
    assert BoundTest(Interval(50, 46, 54, 9), **band).holds
    assert BoundTest(Interval(60, 56, 64, 9), **band).holds is False
    assert BoundTest(Interval(50, 44, 56, 9), **band).holds is None


def test_one_failure_decides_and_one_open_test_leaves_it_open():
    good, bad, unsure = (BoundTest(Interval(m, m - 1, m + 1, 10), least=0) for m in (5, -5, 0.5))
    assert judge([good, good]) == (True, "")
    assert judge([good, bad, unsure]) == (False, "")
    assert judge([good, unsure]) == (None, " Too few runs to tell; about 40 would (an estimate).")
    for hopeless in (estimate([3]).interval, Interval(0, -1, 1, 9)):
        holds, telling = judge([BoundTest(hopeless, least=0)])
        assert holds is None
        assert "cannot be said" in telling or not hopeless.is_known


def test_no_worse_needs_a_margin():
    steps = MEASURES["total_steps"]
    assert steps.beats(Interval(0.1, 0.0, 0.2, 9), 0.25).holds
    assert steps.beats(Interval(0.5, 0.3, 0.7, 9), 0.25).holds is False
    assert steps.beats(Interval(0.1, -1.4, 1.6, 9), 0.25).holds is None  # few runs show nothing
    assert MEASURES["correct_pct"].beats(Interval(1.0, 0.5, 1.5, 9)).holds
    assert steps.beats(Interval(1.0, 0.5, 1.5, 9)).holds is False


def test_the_page_shows_three_verdicts_and_counts_its_intervals():
    claims = [Claim("one", True, "1.00 ± 0.50"), Claim("two", False, "+1.00 (0.50 to 1.50)"),
              Claim("three", None, "few")]  # fmt: skip
    about = {"options": {}, "seed": 0, "version": "1"}
    text = html("Title", about, 3, Findings("lead", claims, []))
    assert [kind in text for kind in ("claim yes", "claim no", "claim few")] == [True] * 3
    assert "2 means and differences stand here" in text
    assert "not corrected" in text
    both = '1.00 <span class="se">± 0.50</span><small>0.50 to \u22121.50</small>'
    assert _multiplicity(both).startswith("1 ")
    assert _multiplicity("0 to 10") == ""
