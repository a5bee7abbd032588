"""The measures of a study: their names in text, tables and plots, and numbers as text."""

from __future__ import annotations

from dataclasses import dataclass

from hrcplan.studies.estimate import Interval, MeanEstimate
from hrcplan.studies.verdict import BoundTest


@dataclass(frozen=True, slots=True)
class Measure:
    """One measure, defined once for claims, tables and plots.

    Attributes:
        name: In a sentence: ``assigned to the human``.
        label: Above a column or a panel; ``|`` marks where the line may break.
        unit: Of its values, such as ``%`` or ``per run``.
        more_is_better: None where neither direction is better.
        suffix: The unit behind a number in a sentence; by default the unit.
    """

    name: str
    label: str
    unit: str
    more_is_better: bool | None = False
    suffix: str | None = None

    @property
    def head(self) -> str:
        """The head of a table column, as HTML.

        >>> Measure("first right guess", "first|right guess", "timesteps").head
        'first<br>right guess<small>timesteps</small>'
        """
        return f"{self.label.replace('|', '<br>')}<small>{self.unit}</small>"

    @property
    def directed_head(self) -> str:
        """The head of a column of differences: it also says which direction is better."""
        direction = {True: "more is better", False: "less is better", None: ""}
        return f"{self.head}<small>{direction[self.more_is_better]}</small>"

    @property
    def title(self) -> str:
        """The title of a plot's panel, with its unit, in two lines."""
        words = self.label.replace("|", "\n")
        if self.unit.startswith("per "):
            return f"{words}\n{self.unit}"
        return f"{words} (%)" if self.unit == "%" and "\n" in words else f"{words}\n({self.unit})"

    def amount(self, text: str) -> str:
        """Return a number with its unit, for a sentence."""
        suffix = self.unit if self.suffix is None else self.suffix
        return f"{text} {suffix}".rstrip()

    def interval(self, e: MeanEstimate) -> Interval:
        """Return the 95 % interval of a mean; that of a share lies within 0 to 100 %.

        >>> Measure("right", "right", "%").interval(MeanEstimate(99.0, 2.0, 9)).high
        100.0
        """
        is_share = self.unit.startswith("%")
        return e.interval.clipped(0.0, 100.0) if is_share and e.is_known else e.interval

    def span(self, e: MeanEstimate) -> tuple[float, float]:
        """Return the ends of the interval for a plot; both are the mean where it is not known."""
        interval = self.interval(e)
        return (interval.low, interval.high) if e.is_known else (e.mean, e.mean)

    def beats(self, difference: Interval, margin: float | None = None) -> BoundTest:
        """Return the test that a difference is better than 0, or not worse by a margin or more.

        >>> Measure("steps", "steps", "timesteps").beats(Interval(-1, -2, -0.5, 9)).holds
        True
        """
        least = 0.0 if margin is None else -margin
        gain = difference if self.more_is_better else difference.negative
        return BoundTest(gain, least=least, is_strict=margin is None)

    def verdict(self, difference: Interval) -> str:
        """Return whether a difference is wholly ``better`` or ``worse`` than 0, or nothing.

        >>> Measure("right guesses", "right guesses", "%", True).verdict(Interval(1, 0.5, 1.5, 9))
        'better'
        """
        if self.more_is_better is None or not (
            difference.is_above_zero or difference.is_below_zero
        ):
            return ""
        return "better" if difference.is_above_zero == self.more_is_better else "worse"


def number(value: float, digits: int = 2) -> str:
    """Return a number with a true minus, and none before zero.

    >>> number(-0.001), number(-1.5)
    ('0.00', '\u22121.50')
    """
    text = f"{value:.{digits}f}"
    return text.lstrip("-") if float(text) == 0 else text.replace("-", "\u2212")


def with_sign(value: float) -> str:
    """Return a difference with its sign.

    >>> with_sign(0.25), with_sign(-0.25)
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


def interval_text(interval: Interval) -> str:
    """Return a difference and its interval as text.

    >>> interval_text(Interval(1.0, 0.5, 1.5, 9))
    '+1.00 (0.50 to 1.50)'
    """
    return f"{with_sign(interval.mean)} ({ends(interval)})"


def mean_text(e: MeanEstimate) -> str:
    """Return a mean and its standard error as text.

    >>> mean_text(MeanEstimate(1.5, 0.25, 9))
    '1.50 ± 0.25'
    >>> mean_text(MeanEstimate(1.5, 0.0, 1))
    '1.50'
    """
    return number(e.mean) + (f" ± {number(e.se)}" if e.is_known else "")


def difference_text(e: MeanEstimate) -> str:
    """Return a mean difference with its sign, and its standard error.

    >>> difference_text(MeanEstimate(1.5, 0.25, 9))
    '+1.50 ± 0.25'
    """
    return with_sign(e.mean) + (f" ± {number(e.se)}" if e.is_known else "")


def mean_html(e: MeanEstimate) -> str:
    """Return a mean and its standard error as HTML."""
    error = f' <span class="se">± {number(e.se)}</span>' if e.is_known else ""
    return number(e.mean) + error
