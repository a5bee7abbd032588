"""Exact numbers: integers and fractions, never floats, and within bounds.

No number that a file names, or a plan computes, may take all of the machine.
"""

from __future__ import annotations

import re
from decimal import Decimal
from fractions import Fraction
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from hrcplan.core.json_values import JsonValue

Number = int | Fraction

_TEXT_DECIMALS = 12
_FRACTION = re.compile(r"[+-]?\d{1,9999}(/\d{1,9999}|(\.\d{1,999})?(e[+-]?\d{1,3})?)", re.ASCII)

_MAX_DIGITS = 150  # of a whole number
_NUMBER = re.compile(
    r"[+-]?(([0-9]{1,150}(\.[0-9]{0,30})?|\.[0-9]{1,30})(e[+-]?[0-9]{1,2})?"
    r"|[0-9]{0,150}\.[0-9]{31,129})"  # as the writer spells out small numbers
)


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
    """Return a number as messages show it: in decimals, at most 12 after the point.

    >>> number_text(Fraction(17, 100)), number_text(3)
    ('0.17', '3')
    """
    return decimal_of(value)


def to_number(word: str) -> Number | None:
    """Return the exact number that a word spells, or None.

    >>> to_number("0.5"), to_number("10"), to_number("5."), to_number("1.2.3")
    (Fraction(1, 2), 10, 5, None)
    """
    if word.isdecimal() and word.isascii() and len(word) <= _MAX_DIGITS:
        return int(word)
    return exact(word) if _NUMBER.fullmatch(word) else None


def fraction_of(text: JsonValue) -> Fraction | None:
    """Return the number that a text such as ``1.25``, ``5/4`` or ``1e3`` spells, or None.

    >>> fraction_of("5/4"), fraction_of("1e999999999"), fraction_of("1/0"), fraction_of([])
    (Fraction(5, 4), None, None, None)
    >>> fraction_of("1" + 5000 * "0") == 10**5000
    True
    """
    if not isinstance(text, str) or not _FRACTION.fullmatch(text.strip().lower()):
        return None
    whole, _, divisor = text.partition("/")
    try:
        return Fraction(int_of(whole), int_of(divisor)) if divisor else Fraction(Decimal(text))
    except (ValueError, ZeroDivisionError):
        return None


def int_of(text: str) -> int:
    """Return the whole number that digits spell, also where ``int`` refuses so many.

    Raises:
        ValueError: if they spell none.
    """
    return int(text) if len(text) < 1000 else int(Decimal(text))


def int_text(value: int, separator: str = "") -> str:
    """Return the digits of a whole number, also where ``str`` refuses so many.

    >>> len(int_text(10**5000)), int_text(-12345, ",")
    (5001, '-12,345')
    """
    return format(Decimal(value), f"{separator}f")


def nearest_float(value: int | Fraction) -> int | float:
    """Return the float nearest to a number, or the nearest whole number where there is no float.

    >>> nearest_float(Fraction(1, 4)), nearest_float(Fraction(10**400 * 2 + 1, 2)) == 10**400
    (0.25, True)
    """
    try:
        return float(value)
    except OverflowError:
        return round(value)


def decimal_of(value: int | Fraction, places: int = _TEXT_DECIMALS) -> str:
    """Return a number in decimals without zeros at the end, rounded to ``places``.

    >>> decimal_of(Fraction(1, 3)), decimal_of(Fraction(-5, 2)), decimal_of(7)
    ('0.333333333333', '-2.5', '7')
    """
    if value.denominator == 1:
        return int_text(value.numerator)
    digits = round(abs(value) * 10**places)
    whole, decimals = divmod(digits, 10**places)
    sign = "-" if value < 0 and digits else ""
    return f"{sign}{int_text(whole)}.{decimals:0{places}}".rstrip("0").rstrip(".")
