"""Kill the supervisor."""

import os
import signal
import time


def main() -> None:
    os.kill(os.getppid(), signal.SIGKILL)
    time.sleep(60)


if __name__ == "__main__":
    main()
