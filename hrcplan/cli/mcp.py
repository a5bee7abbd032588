"""``hrcplan mcp``: tools for language models."""

from __future__ import annotations

from pathlib import Path

import click


@click.command("mcp")
@click.argument(
    "folders",
    nargs=-1,
    metavar="[FOLDER...]",
    type=click.Path(exists=True, file_okay=False, path_type=Path),
)
def command(folders: tuple[Path, ...]) -> int:
    """Serve check, plan, validate, allocation and infer to a language model.

    The Model Context Protocol is spoken over standard input and output. Files are read from the
    FOLDERs only, by default from the current one; nothing is written there.
    """
    from hrcplan.core.extras import require

    require("mcp", "the server for language models")
    from hrcplan.mcp.server import make_server

    make_server(folders or [Path.cwd()]).run("stdio")
    return 0
