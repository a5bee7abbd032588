"""Tables of keys in the reference, compared with documents that hrcplan has written."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

REFERENCE = Path(__file__).resolve().parent.parent / "docs" / "reference"
TYPES: dict[str, tuple[type, ...]] = {
    "str": (str,), "bool": (bool,), "int": (int,), "number": (int, float), "list": (list,),
    "json": (str,), "object": (), "any": (object,),
}  # fmt: skip
KEY = re.compile(r"^\| `([^`]+)` \| (\w+) \| (.*) \|$", re.MULTILINE)


@dataclass(frozen=True)
class Key:
    """A row of a table: where the key stands, its type, and whether it may be null."""

    path: str
    kind: str
    meaning: str

    @property
    def may_be_null(self) -> bool:
        """Whether the text speaks of null, or of the text of another key that does."""
        return "null" in self.meaning

    def matches(self, path: str) -> bool:
        """Whether a path of a document is this key; ``{name}`` stands for any name."""
        return bool(re.fullmatch(re.sub(r"\\\{\w+\\\}", r"[^.\\[]+", re.escape(self.path)), path))

    def fault(self, value: Any) -> str | None:
        """Return why a value is not of the key's type; None if it is."""
        if value is None:
            return None if self.may_be_null else "is null"
        if not isinstance(value, TYPES[self.kind]):
            return f"is {value!r}, not a {self.kind}"
        is_stray_bool = isinstance(value, bool) and self.kind not in ("bool", "any")
        return "is a bool" if is_stray_bool else None


def sections(page: str) -> dict[str, list[Key]]:
    """Return the keys of each section of a page of the reference that has a table of them."""
    parts = re.split(r"^## (.+)$", (REFERENCE / page).read_text("utf-8"), flags=re.MULTILINE)[1:]
    tables = {title: [Key(*row) for row in KEY.findall(body)]
              for title, body in zip(parts[::2], parts[1::2], strict=True)}  # fmt: skip
    return {title: keys for title, keys in tables.items() if keys}


def flat(value: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    """Yield every path of a document with its value; lists and their entries too."""
    if isinstance(value, dict):
        for key, below in value.items():
            yield from flat(below, f"{path}.{key}" if path else key)
        return
    yield path, value
    if isinstance(value, list):
        for below in value:
            yield from flat(below, f"{path}[]")


def check(documents: Iterable[Any], keys: list[Key], nested: str | None = None) -> None:
    """Test that documents have the keys of a table, with values of their types, and all of them.

    Args:
        documents: What hrcplan has written.
        keys: The keys of the table.
        nested: A pattern of what may be repeated in a path, in documents that contain themselves.
    """
    used: set[Key] = set()
    for document in documents:
        for path, value in flat(document):
            if nested is not None:
                path = re.sub(nested, r"\1", path)
            _check(path, value, keys, used)
    absent = [key.path for key in keys if key not in used]
    assert not absent, f"never written: {absent}"


def _check(path: str, value: Any, keys: list[Key], used: set[Key]) -> None:
    key = next((key for key in keys if key.matches(path)), None)
    assert key is not None, f"{path} is not in the reference"
    used.add(key)
    fault = key.fault(value)
    assert fault is None, f"{path} {fault}"
    if key.kind == "json" and value is not None:
        for below, inner in flat(json.loads(value), path):
            if below != path:
                _check(below, inner, keys, used)
