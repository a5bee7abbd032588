"""Stand in for hrcplan: run a program under the guard, and say how that went.

Arguments: a file for the outcome, then the program. With FORK=yes in the environment, another
thread forks a copy of this process as soon as the program says that it runs.
"""

import os
import sys
import threading
import time
from pathlib import Path

from hrcplan.planners.process import ProcessLimits, run


def fork_once(ready: Path) -> None:
    while not ready.exists():
        time.sleep(0.01)
    if os.fork() == 0:
        time.sleep(60)
        os._exit(0)


def main() -> None:
    outcome = Path(sys.argv[1])
    if os.environ.get("FORK"):
        threading.Thread(target=fork_once, args=(outcome.with_name("ready"),), daemon=True).start()
    try:
        finished = run(sys.argv[2:], cwd=outcome.parent, limits=ProcessLimits(time_s=30))
    except KeyboardInterrupt:
        outcome.write_text("KeyboardInterrupt")
        raise
    outcome.write_text(str(finished))


if __name__ == "__main__":
    main()
