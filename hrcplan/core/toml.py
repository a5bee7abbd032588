"""TOML files of users: read whole, or refused by an error that names the file."""

from __future__ import annotations

import tomllib
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
    except RecursionError:
        reason = "its values are nested too deep"
    except ValueError as error:  # also a number of too many digits
        reason = cut(harmless(str(error)), _MAX_REASON)
    name = harmless(str(path))
    raise InputError(f"{name} is no TOML: {reason}", code=code, path=name)
