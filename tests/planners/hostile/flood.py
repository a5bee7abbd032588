"""Write to the given file descriptor without end."""

import os
import sys


def main() -> None:
    while True:
        os.write(int(sys.argv[1]), b"x" * 65536)


if __name__ == "__main__":
    main()
