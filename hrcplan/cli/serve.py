"""``hrcplan serve``: collaborate with a robot, and look at plans and studies, in a browser."""

from __future__ import annotations

from pathlib import Path

import rich_click as click

from hrcplan.cli import options, output
from hrcplan.core.extras import require


@click.command(
    "serve",
    epilog=options.notes(
        "The first line that is printed is the link to open; it holds the secret of this server.",
        "ADDRESS: only this machine can open the page, unless you name another one here.",
    ),
)
@click.option("--port", type=click.IntRange(1, 65535), metavar="N",
              help="The port; by default 8765, or a free one.")  # fmt: skip
@click.option("--host", default="127.0.0.1", show_default=True, metavar="ADDRESS",
              help="The address to listen at.")  # fmt: skip
@click.option("--folder", type=click.Path(path_type=Path), default=Path("hrcplan-serve"),
              show_default=True, metavar="DIR",
              help="Where journals are; the server goes on with those that it finds.")  # fmt: skip
@output.common_options
def command(port: int | None, host: str, folder: Path) -> int:
    """Serve a page in which you work together with a robot. Ctrl-C ends it."""
    for module in ("starlette", "uvicorn", "sse_starlette"):
        require(module, "the server of pages")
    from hrcplan.web.server import ServerOptions, serve

    output.LINES = output.JSON

    def say_link(link: str) -> None:
        if output.JSON:
            output.document({"url": link, "folder": str(folder)})
        else:
            output.result(link)
            output.note(f"journals are in {folder}; Ctrl-C ends the server")

    serve(ServerOptions(folder, host, port), say_link)
    return 0
