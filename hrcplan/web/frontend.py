"""The files of the front end: plain modules, for the server and for pages in one file."""

from __future__ import annotations

from pathlib import Path

_FOLDER = Path(__file__).with_name("static")
FRONTEND = {path.name: path.read_text(encoding="utf-8") for path in sorted(_FOLDER.iterdir())}
"""The text of each file by its name."""
