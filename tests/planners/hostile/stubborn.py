"""Ignore every polite signal."""

import signal
import sys
import time


def main() -> None:
    for number in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP):
        signal.signal(number, signal.SIG_IGN)
    sys.stdout.write("not listening\n")
    sys.stdout.flush()
    open("ready", "w").close()
    time.sleep(60)


if __name__ == "__main__":
    main()
