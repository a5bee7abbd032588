"""Print a first plan, as an anytime planner does, and never end."""

import sys
import time


def main() -> None:
    sys.stdout.write("plan 1\n")
    sys.stdout.flush()
    open("ready", "w").close()
    time.sleep(60)


if __name__ == "__main__":
    main()
