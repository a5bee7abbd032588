"""``hrcplan study rehearse`` and ``collect``: studies with participants."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

import click

from hrcplan.cli import output
from hrcplan.cli.serve import require_web

if TYPE_CHECKING:
    from hrcplan.web.trials.collect import Collected


@click.command("rehearse")
@click.argument("file", metavar="FILE", type=click.Path(path_type=Path))
@click.option("--participants", "n", type=click.IntRange(1, 64), default=8, show_default=True,
              metavar="N", help="How many simulated participants, all at once.")  # fmt: skip
@click.option("-o", "--output", "folder", required=True, metavar="DIR",
              type=click.Path(file_okay=False, path_type=Path),
              help="Write their rows, traces and answers to this folder.")  # fmt: skip
@output.common_options
def rehearse(file: Path, n: int, folder: Path) -> int:
    """Let simulated participants go through the study in FILE, from consent to the last page.

    They use a server of their own, over the network, as people do. Nothing of them is left but what
    is in DIR.
    """
    require_web()
    from hrcplan.web.server import PageService, ServerOptions
    from hrcplan.web.trials.collect import collect
    from hrcplan.web.trials.study_file import read_study_file

    study = read_study_file(file)
    with (
        tempfile.TemporaryDirectory() as place,
        PageService(ServerOptions(Path(place), study=study)) as service,
    ):
        outcome = service.rehearse(n)
        assert service.desk is not None
        done = collect(service.desk, folder)
    p95 = outcome.percentile(0.95)
    if output.JSON:
        output.document({
            "finished": outcome.finished, "participants": n, "trials": done.trials,
            "answers": len(outcome.answers_s), "p95_s": round(p95, 4), "folder": str(folder),
        })  # fmt: skip
    else:
        n_answers = len(outcome.answers_s)
        output.result(
            f"{outcome.finished} of {n} simulated participants came to the end; {n_answers} "
            f"answers, 95 % of them within {1000 * p95:.0f} ms"
        )
        _say(done, folder)
    return 0 if outcome.finished == n else 1


@click.command("collect")
@click.argument("file", metavar="FILE", type=click.Path(path_type=Path))
@click.option("--folder", "data", type=click.Path(path_type=Path), default=Path("hrcplan-serve"),
              show_default=True, metavar="DIR", help="The folder of the server.")  # fmt: skip
@click.option("-o", "--output", "folder", required=True, metavar="DIR",
              type=click.Path(file_okay=False, path_type=Path),
              help="Write rows, traces and answers to this folder.")  # fmt: skip
@output.common_options
def collect_command(file: Path, data: Path, folder: Path) -> int:
    """Write what participants of the study in FILE did: rows.sqlite, traces and CSV files."""
    from hrcplan.web.banks import Banks
    from hrcplan.web.sessions import Sessions
    from hrcplan.web.trials.collect import collect
    from hrcplan.web.trials.study_file import read_study_file
    from hrcplan.web.trials.trial_desk import TrialDesk

    sessions = Sessions(data / "sessions", Banks(), lambda: None)
    done = collect(TrialDesk(read_study_file(file), data, sessions), folder)
    if output.JSON:
        output.document({"participants": done.participants, "complete": done.complete,
                         "trials": done.trials, "folder": str(folder)})  # fmt: skip
    else:
        _say(done, folder)
    return 0


def _say(done: Collected, folder: Path) -> None:
    output.result(
        f"{done.participants} participants ({done.complete} complete), {done.trials} trials in "
        f"{folder}; next: hrcplan study report {folder}"
    )
