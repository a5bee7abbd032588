"""``hrcplan format``: PDDL files in one layout."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from hrcplan.cli import output
from hrcplan.core.files import write_atomically

STDIN = "-"


@click.command("format")
@click.argument("files", nargs=-1, required=True, metavar="FILE...")
@click.option("--check", "only_check", is_flag=True, help="Write nothing; exit with code 1 if a "
              "file would change.")  # fmt: skip
@output.common_options
def command(files: tuple[str, ...], only_check: bool) -> int:
    """Write domain and problem FILEs again in one layout; words and comments stay.

    FILE - is standard input, and its layout goes to standard output.
    """
    # All files are laid out before one is written: a fault leaves them all as they are.
    texts = {name: _read(name) for name in dict.fromkeys(files)}
    layouts = {name: _layout(name, text) for name, text in texts.items()}
    changed = [name for name in texts if layouts[name] != texts[name]]
    if not only_check:
        for name in changed:
            if name != STDIN:
                write_atomically(Path(name), layouts[name])
    if output.JSON:
        output.document({"files": len(texts), "changed": changed, "written": not only_check})
    elif STDIN in texts and not only_check:
        output.text(layouts[STDIN])
    else:
        verb = "would change" if only_check else "changed"
        for name in changed:
            output.result(f"{name}: {verb}")
        output.result(f"{len(texts)} file{'s' * (len(texts) != 1)}: {len(changed)} {verb}")
    return 1 if only_check and changed else 0


def _read(name: str) -> str:
    from hrcplan.core.files import read_bytes
    from hrcplan.errors import InputError, PddlError
    from hrcplan.pddl.source import MAX_BYTES, decode

    data = sys.stdin.buffer.read(MAX_BYTES + 1) if name == STDIN else read_bytes(name, MAX_BYTES)
    if len(data) > MAX_BYTES:
        message = f"standard input holds more than {MAX_BYTES >> 20} MiB"
        raise InputError(message, code="too-large")
    source = decode(name, data)
    if source.has_errors:
        raise PddlError(source.diagnostics)
    return data.decode("utf-8-sig") if source.text else source.text


def _layout(name: str, text: str) -> str:
    from hrcplan.pddl.layout import format_text

    return format_text(text, name)
