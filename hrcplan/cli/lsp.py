"""``hrcplan lsp``: the language server that editors start."""

from __future__ import annotations

import click


@click.command("lsp")
def command() -> int:
    """Serve an editor over standard input and output, as the Language Server Protocol says.

    The page on editors says how to set up VS Code, Neovim, Emacs and Helix.
    """
    from hrcplan.cli.stdio_server import end_at_signals
    from hrcplan.core.extras import require

    require("pygls", "the language server")
    from hrcplan.lsp.server import make_server

    end_at_signals()
    make_server().start_io()
    return 0
