"""How long the commands take, in bare Python starts."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

from rows import Row, interleaved, milliseconds, timed

N_ROUNDS = 9
MOST = {
    "ground('transport', 'two-boxes')": 12,  # less than 0.2 s on an idle machine
    "hrcplan --help": 8,
    "hrcplan plan transport/two-boxes": 12,
}


def rows() -> Iterator[Row]:
    """Yield the medians of the commands and their ratios to ``python -c pass``."""
    script = Path(sys.executable).with_name("hrcplan")
    hrcplan = [str(script)] if script.exists() else [sys.executable, "-m", "hrcplan"]
    load = "from hrcplan import ground; ground('transport', 'two-boxes')"
    commands = {
        "python -c pass": [sys.executable, "-c", "pass"],
        "ground('transport', 'two-boxes')": [sys.executable, "-c", load],
        "hrcplan --help": [*hrcplan, "--help"],
        "hrcplan plan transport/two-boxes": [*hrcplan, "plan", "transport/two-boxes"],
    }
    with TemporaryDirectory() as folder:
        # Compiled files are kept, as after any first call, but not in the checkout.
        env = {k: v for k, v in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"}
        env["PYTHONPYCACHEPREFIX"] = folder
        runs = {name: partial(timed, partial(_call, args, env)) for name, args in commands.items()}
        for run in runs.values():
            run()
        found = interleaved(runs, N_ROUNDS)
    bare = found.pop("python -c pass")
    yield Row("python -c pass", milliseconds(bare))
    for name, seconds in found.items():
        compared = f"{seconds / bare:.1f} bare starts"
        goal = f"<= {MOST[name]} bare starts"
        yield Row(name, milliseconds(seconds), compared, goal, seconds > MOST[name] * bare)


def _call(args: list[str], env: dict[str, str]) -> None:
    subprocess.run(args, env=env, check=True, capture_output=True)
