#!/usr/bin/env python3
"""Write further problems of a domain into a folder: goals like the given ones, by chance.

    tools/make_problems.py kitchen -n 100 --seed 7 --new-objects 10 -o kitchen-100

All of them share objects and init, so `hrcplan bank build kitchen kitchen-100` makes a bank of
them. The same arguments write the same files.
"""

import argparse
import sys
from dataclasses import replace
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from hrcplan.bank import read_goals
from hrcplan.bank.variants import vary
from hrcplan.errors import HrcplanError
from hrcplan.pddl.write import problem_text


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("domain", help="path or shipped name")
    parser.add_argument("goals", nargs="?", help="folder of problems to start from")
    parser.add_argument("-n", type=int, required=True, help="how many problems")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--new-objects", type=int, default=0, help="objects to add to the world")
    parser.add_argument("-o", "--output", type=Path, required=True, help="folder to write into")
    args = parser.parse_args()
    try:
        found = vary(
            read_goals(args.domain, args.goals), args.n, args.seed, n_objects=args.new_objects
        )
        args.output.mkdir(parents=True, exist_ok=True)
        for name, goal in zip(found.names, found.formulas, strict=True):
            problem = replace(found.problem, name=name, goal=goal)
            (args.output / f"{name}.pddl").write_text(problem_text(problem))
    except HrcplanError as error:
        print(f"error: {error}", file=sys.stderr)
        return error.exit_code
    print(f"wrote {args.n} problems to {args.output}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
