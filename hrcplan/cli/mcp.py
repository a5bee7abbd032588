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
    import shutil
    import tempfile

    from hrcplan.cli.stdio_server import end_at_signals
    from hrcplan.core.extras import require

    require("mcp", "the server for language models")
    from hrcplan.mcp.server import make_server

    with tempfile.TemporaryDirectory(prefix="hrcplan-mcp-") as inputs:
        end_at_signals(lambda: shutil.rmtree(inputs, ignore_errors=True))
        make_server(folders or [Path.cwd()], inputs).run("stdio")
    return 0
