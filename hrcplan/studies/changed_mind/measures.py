"""What the measures are called, in which unit they are, and which way is better."""

from __future__ import annotations

from dataclasses import dataclass

from hrcplan.studies.estimate import Interval


@dataclass(frozen=True, slots=True)
class Measure:
    """A measure in words; ``more_is_better`` is None where neither way is."""

    name: str
    head: str
    unit: str
    more_is_better: bool | None = False

    def verdict(self, difference: Interval) -> str:
        """Return whether a difference is wholly ``better`` or ``worse`` than 0, or nothing.

        >>> MEASURES["correct_pct"].verdict(Interval(1.0, 0.5, 1.5, 9))
        'better'
        """
        if self.more_is_better is None or not (
            difference.is_above_zero or difference.is_below_zero
        ):
            return ""
        return "better" if difference.is_above_zero == self.more_is_better else "worse"


MEASURES = {
    "first_correct": Measure("first right guess", "first<br>right guess", "timesteps"),
    "last_incorrect_step": Measure("last wrong guess", "last<br>wrong guess", "timesteps"),
    "last_incorrect_pct": Measure("last wrong guess", "last<br>wrong guess", "% of episode"),
    "correct_pct": Measure("right guesses", "right<br>guesses", "%", True),
    "top3_pct": Measure("right goal among three", "among first<br>three", "%", True),
    "detection_delay": Measure("delay of detection", "delay of<br>detection", "timesteps"),
    "false_changes": Measure("false changes", "false<br>changes", "per episode"),
    "false_before": Measure(
        "false changes before the first", "before the<br>first true one", "per episode"
    ),
    "n_detected": Measure("changes detected", "changes<br>detected", "per episode", True),
    "wasted_robot_steps": Measure("wasted robot steps", "wasted<br>robot steps", "per episode"),
    "human_mistakes": Measure("human's mistakes", "human's<br>mistakes", "per episode", None),
    "robot_waits": Measure("robot's waits", "robot's<br>waits", "per episode", None),
    "total_steps": Measure("total steps", "total<br>steps", "timesteps"),
    "extra_steps": Measure("extra steps", "extra<br>steps", "timesteps"),
    "extra_vs_oracle": Measure("more than the oracle", "more than<br>the oracle", "timesteps"),
}
DECLARED = ("detection_delay", "n_detected", "false_changes", "false_before")
"""Measures of declared changes: a method that declares none has no value there."""


def head(measure: str) -> str:
    """Return the head of a measure's column, as HTML."""
    found = MEASURES[measure]
    return f"{found.head}<small>{found.unit}</small>"


def number(value: float, digits: int = 2) -> str:
    """Return a number with a true minus, and none before zero.

    >>> number(-0.001), number(-1.5)
    ('0.00', '\u22121.50')
    """
    text = f"{value:.{digits}f}"
    return text.lstrip("-") if float(text) == 0 else text.replace("-", "\u2212")


def signed(value: float) -> str:
    """Return a difference with its sign.

    >>> signed(0.25), signed(-0.25)
    ('+0.25', '\u22120.25')
    """
    return f"+{number(value)}" if float(f"{value:.2f}") > 0 else number(value)


def ends(interval: Interval) -> str:
    """Return the ends of an interval in words.

    >>> ends(Interval(1.0, 0.5, 1.5, 9)), ends(Interval(1.0, -float("inf"), float("inf"), 1))
    ('0.50 to 1.50', 'unknown')
    """
    if not interval.is_known:
        return "unknown"
    return f"{number(interval.low)} to {number(interval.high)}"


def shown(interval: Interval) -> str:
    """Return a difference and its interval as text.

    >>> shown(Interval(1.0, 0.5, 1.5, 9))
    '+1.00 (0.50 to 1.50)'
    """
    return f"{signed(interval.mean)} ({ends(interval)})"
