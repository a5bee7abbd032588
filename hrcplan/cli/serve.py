"""``hrcplan serve``: collaborate with a robot, and look at plans and studies, in a browser."""

from __future__ import annotations

from pathlib import Path

import click

from hrcplan.cli import options, output
from hrcplan.core.extras import require


@click.command(
    "serve",
    epilog=options.notes(
        "The first line that is printed is the link to open; it holds the secret of this server.",
        "ADDRESS: only this machine can open the page, unless you name another one here.",
    ),
)
@click.argument("files", nargs=-1, type=click.Path(path_type=Path), metavar="[FILE]...")
@click.option("--port", type=click.IntRange(1, 65535), metavar="N",
              help="The port; by default 8765, or a free one.")  # fmt: skip
@click.option("--host", default="127.0.0.1", show_default=True, metavar="ADDRESS",
              help="The address to listen at.")  # fmt: skip
@click.option("--folder", type=click.Path(path_type=Path), default=Path("hrcplan-serve"),
              show_default=True, metavar="DIR",
              help="Where journals are; the server goes on with those that it finds.")  # fmt: skip
@click.option("--study", type=click.Path(path_type=Path), metavar="FILE",
              help="Also run a study with participants; FILE says which.")  # fmt: skip
@output.common_options
def command(
    files: tuple[Path, ...], port: int | None, host: str, folder: Path, study: Path | None
) -> int:
    """Serve a page in which you work together with a robot. Ctrl-C ends it.

    Each FILE can be looked at there: a journal, a plan, a bank, an allocation diagram, the
    folder of a study, or a folder of such files.
    """
    require_web()
    from hrcplan.web.looks import look_files
    from hrcplan.web.server import PageService, ServerOptions
    from hrcplan.web.trials.study_file import read_study_file

    output.LINES = output.JSON
    trial_study = None if study is None else read_study_file(study)
    with PageService(ServerOptions(folder, host, port, trial_study, look_files(files))) as service:
        if output.JSON:
            output.document({"url": service.link, "folder": str(folder),
                             "participants": service.invitation})  # fmt: skip
        else:
            output.result(service.link)
            if service.invitation is not None:
                output.result(f"participants: {service.invitation}")
            output.note(f"journals are in {folder}; Ctrl-C ends the server")
        service.run()
    return 0


def require_web() -> None:
    """Return if the packages of the server are installed.

    Raises:
        UsageError: with the command that installs them, if they are missing.
    """
    for module in ("starlette", "uvicorn", "sse_starlette"):
        require(module, "the server of pages")
