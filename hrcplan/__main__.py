"""``python -m hrcplan``."""

from hrcplan.cli import main

if __name__ == "__main__":
    main()
