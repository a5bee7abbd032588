"""A clock that no jump turns back."""

from itertools import pairwise

from hypothesis import given
from hypothesis import strategies as st

from hrcplan.core.steady_clock import SteadyClock


@given(st.lists(st.floats(-1e6, 1e6), min_size=2))
def test_it_never_goes_back_and_counts_what_went_forward(readings: list[float]) -> None:
    clock = SteadyClock(iter(readings).__next__)
    times = [clock() for _ in readings[1:]]
    assert times == sorted(times)
    forward = sum(max(0.0, b - a) for a, b in pairwise(readings))
    assert abs(times[-1] - readings[0] - forward) < 1e-3


def test_a_long_leap_counts_as_a_short_one() -> None:
    clock = SteadyClock(iter([0.0, 0.5, 9000.0, 10.0, 10.5]).__next__, most_s=1.0)
    assert [clock() for _ in range(4)] == [0.5, 1.5, 1.5, 2.0]
