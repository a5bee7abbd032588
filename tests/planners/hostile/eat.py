"""Use so many megabytes, in the last of so many generations of children, and hang."""

import os
import sys
import time


def main() -> None:
    megabytes, generations = int(sys.argv[1]), int(sys.argv[2])
    for _ in range(generations):
        if os.fork():
            os.wait()
            return
        os.setsid()
    held = [b"x" * (1 << 20) for _ in range(megabytes)]
    os.write(1, b"full\n")
    time.sleep(60)
    del held


if __name__ == "__main__":
    main()
