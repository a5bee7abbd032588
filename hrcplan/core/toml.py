"""TOML files of users: read whole, or refused by an error that names the file."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from hrcplan.core.files import read_bytes
from hrcplan.core.text import cut, harmless
from hrcplan.errors import InputError

MAX_BYTES = 1 << 20
_MAX_REASON = 160


def read_toml(path: Path, code: str) -> dict[str, Any]:
    """Return the tables of a TOML file.

    Args:
        path: The file.
        code: The code of the error if it is no TOML.

    Raises:
        InputError: if the file is missing, too large, or no TOML.
    """
    try:
        return tomllib.loads(read_bytes(path, MAX_BYTES).decode())
    except tomllib.TOMLDecodeError as error:
        place = re.search(r" \(at line (\d+), column (\d+)\)", str(error))
        line, column = map(int, place.groups()) if place else (None, None)
        reason = cut(harmless(str(error)), _MAX_REASON)
        name = harmless(str(path))
        message = f"{name} is no TOML: {reason}"
        raise InputError(message, code=code, path=name, line=line, column=column) from None
    except RecursionError:
        reason = "its values are nested too deep"
    except ValueError as error:  # also a number of too many digits
        reason = cut(harmless(str(error)), _MAX_REASON)
    name = harmless(str(path))
    raise InputError(f"{name} is no TOML: {reason}", code=code, path=name)


def line_of(text: str, keys: Sequence[str | int]) -> int:
    r"""Return the line of a TOML text in which a value stands, as far as that can be seen.

    Args:
        text: The TOML text.
        keys: The way to the value: names of keys, and places in arrays of tables.

    >>> line_of("[a]\nb = 1\n[[c]]\nd = 2\n[[c]]\nd = 3", ["c", 1, "d"])
    6
    """
    lines, line, first = text.splitlines(), 1, 0
    rest = list(keys)
    while rest:
        key, place = rest.pop(0), 0
        if rest and isinstance(rest[0], int):
            place = int(rest.pop(0))
        headers = [n for n in range(first, len(lines)) if _header(str(key)).match(lines[n])]
        if headers:
            first = headers[min(place, len(headers) - 1)]
            line = first + 1
            continue
        for n_more in range(len(rest), -1, -1):  # dotted keys: a.b.c = 1
            dotted = r"[\"']?\s*\.\s*[\"']?".join(re.escape(str(k)) for k in [key, *rest[:n_more]])
            entry = re.compile(rf"(?:\s*|.*[{{,.]\s*)[\"']?{dotted}[\"']?\s*[=.]")
            entries = [n for n in range(first, len(lines)) if entry.match(lines[n])]
            if entries:
                first, line, rest = entries[0], entries[0] + 1, rest[n_more:]
                break
        else:
            break
    return line


def _header(key: str) -> re.Pattern[str]:
    """Return what the header of a table, or of an array of tables, looks like."""
    return re.compile(rf"\s*\[+\s*(?:.*[.\s\"'])?{re.escape(key)}[\"']?\s*(?:\.[^\]]*)?\]")
