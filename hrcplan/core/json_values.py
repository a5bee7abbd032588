"""The type of what a JSON or TOML document holds, and how it is read."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any, TypeAlias

JsonValue: TypeAlias = (
    "str | int | float | bool | Sequence[JsonValue] | Mapping[str, JsonValue] | None"
)
"""A value of a JSON document. Read `Any` only where the keys of a document were checked before."""

DOCUMENT_FAULTS = (LookupError, TypeError, ValueError, AttributeError, ArithmeticError,
                   RecursionError)  # fmt: skip
"""What the reading of a document raises that does not say what it should."""


def json_of(text: str | bytes) -> Any:
    """Return the value of a JSON document.

    Raises:
        ValueError: if it is none, no UTF-8, or nested too deep.

    >>> json_of('{"a": [1]}')
    {'a': [1]}
    """
    try:
        return json.loads(text)
    except RecursionError:
        raise ValueError("its values are nested too deep") from None
