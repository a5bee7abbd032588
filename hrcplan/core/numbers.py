"""Exact numbers: integers and fractions, never floats."""

from __future__ import annotations

import re
from fractions import Fraction

Number = int | Fraction

_NUMBER = re.compile(r"[+-]?([0-9]{1,150}(\.[0-9]{0,30})?|\.[0-9]{1,30})(e[+-]?[0-9]{1,2})?")


def exact(number: Number | float | str) -> Number:
    """Return a number without rounding, as an ``int`` if it is whole.

    A float stands for its binary value; text is a decimal or a fraction.

    Raises:
        ValueError: if text is no number, or a float is ``nan``.
        OverflowError: if a float is infinite.

    >>> exact(Fraction(4, 2)), exact(0.5), exact("1/3")
    (2, Fraction(1, 2), Fraction(1, 3))
    """
    if isinstance(number, int):
        return number
    value = number if isinstance(number, Fraction) else Fraction(number)
    return int(value) if value.denominator == 1 else value


def number_text(value: Number) -> str:
    """Return a number as PDDL writes it: exact where the decimal ends, else 12 digits.

    >>> number_text(Fraction(17, 100)), number_text(3)
    ('0.17', '3')
    """
    if isinstance(value, int) or value.denominator == 1:
        return str(int(value))
    whole, decimals = divmod(round(abs(value) * 10**12), 10**12)
    return f"{'-' if value < 0 else ''}{whole}.{decimals:012}".rstrip("0").rstrip(".")


def to_number(word: str) -> Number | None:
    """Return the exact number that a word spells, or None.

    >>> to_number("0.5"), to_number("10"), to_number("5."), to_number("1.2.3")
    (Fraction(1, 2), 10, 5, None)
    """
    return exact(word) if _NUMBER.fullmatch(word) else None
