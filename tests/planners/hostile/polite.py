"""Note an interrupt in a file, print a last plan when asked to end."""

import signal
import sys
import time


def main() -> None:
    signal.signal(signal.SIGINT, lambda *_: open("interrupted", "w").close())
    signal.signal(signal.SIGTERM, lambda *_: sys.exit("last plan"))
    sys.stdout.write("ready\n")
    sys.stdout.flush()
    open("ready", "w").close()
    while True:
        time.sleep(60)


if __name__ == "__main__":
    main()
