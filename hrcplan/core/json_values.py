"""The type of what a JSON or TOML document holds."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TypeAlias

JsonValue: TypeAlias = (
    "str | int | float | bool | Sequence[JsonValue] | Mapping[str, JsonValue] | None"
)
"""A value of a JSON document. Read `Any` only where the keys of a document were checked before."""
