"""Start a daemon; then kill or stop as many processes above this one as told, the highest first."""

import os
import signal
import sys
import time


def main() -> None:
    number, levels, marker = signal.Signals[sys.argv[1]], int(sys.argv[2]), sys.argv[3]
    if os.fork() == 0:
        os.setsid()
        if os.fork() == 0:
            os.execlp("sh", "sh", "-c", f"sleep 60; : {marker}")
        os._exit(0)
    os.wait()
    ancestors = [os.getpid()]
    for _ in range(levels):
        with open(f"/proc/{ancestors[-1]}/stat", encoding="utf-8") as file:
            ancestors.append(int(file.read().rpartition(")")[2].split()[1]))
    for pid in reversed(ancestors[1:]):
        os.kill(pid, number)
    time.sleep(60)


if __name__ == "__main__":
    main()
