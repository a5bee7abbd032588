"""Close both outputs, go on for a while, and exit with a code of its own."""

import os
import time


def main() -> None:
    os.close(1)
    os.close(2)
    time.sleep(0.2)
    os._exit(3)


if __name__ == "__main__":
    main()
