"""The way in: ``hrcplan``, or ``python -m hrcplan``."""

from __future__ import annotations

import gc
import os
import sys

INTERRUPTED = 130
GC_THRESHOLD = 100_000
"""How many new objects begin a search for garbage: imports alone make so many that they last."""


def run() -> None:
    """Run the command line; Ctrl-C while it is being imported is no traceback."""
    gc.set_threshold(GC_THRESHOLD)
    try:
        from hrcplan.cli import main
    except KeyboardInterrupt:
        sys.stderr.write("error: interrupted\n")
        os._exit(INTERRUPTED)
    try:
        main()
    finally:
        if "kairos" not in sys.modules:  # it would report its own objects as leaks
            gc.freeze()  # the process ends: its last search for garbage, 30 ms, would find nothing


def _leave_current_folder() -> None:
    """Take the current folder, which ``-m`` puts first, from where modules are looked for.

    It may hold anything, such as a ``numpy.py``. If hrcplan itself is there, it stays.
    """
    ours = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
    if not sys.flags.safe_path and sys.path[:1] == [os.getcwd()] != [ours]:
        del sys.path[0]


if __name__ == "__main__":
    _leave_current_folder()
    run()
