"""Start a daemon: double fork, own session, nothing open. Then exit, or hang if told so."""

import os
import sys
import time


def main() -> None:
    if os.fork() == 0:
        os.setsid()
        if os.fork() == 0:
            os.closerange(0, 64)
            open("ready", "w").close()
            time.sleep(60)
        os._exit(0)
    os.wait()
    os.write(1, b"daemon runs\n")
    if "hang" in sys.argv:
        time.sleep(60)


if __name__ == "__main__":
    main()
