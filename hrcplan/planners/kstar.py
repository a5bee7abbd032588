"""K* (Katz and Lee, AAAI/IJCAI 2020-2023) in a child process: the k cheapest plans, listed.

Its wheel is under the GPL, so it is looked up and run, never imported.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory

from hrcplan.core.extras import missing as missing_package
from hrcplan.core.json_values import DOCUMENT_FAULTS, json_of
from hrcplan.core.records import record
from hrcplan.errors import LimitError, MissingPlannerError, PlannerError, UnsupportedError
from hrcplan.planners.lowering import Lowering
from hrcplan.planners.process import FinishedProcess, ProcessEnd, ProcessLimits, run
from hrcplan.task import GroundAction

# As its own front end calls it: symmetries off the time limit, all orders of a plan listed.
_SYMMETRIES = (
    "sym=structural_symmetries(time_bound=0,search_symmetries=oss,"
    "stabilize_initial_state=false,keep_operator_symmetries=true)"
)
_SEARCH = (
    "kstar({heuristic}(transform=undo_to_origin()), {bounds}, find_unordered_plans=false, "
    "dump_plan_files=false, json_file_to_dump=plans.json, symmetries=sym)"
)
_UNSOLVABLE = 12  # its code for "searched everything and found no plan"


@record
class Listed:
    """Plans as ground actions, the cheapest first; ``complete`` if there are no others."""

    plans: tuple[tuple[GroundAction, ...], ...]
    complete: bool


def missing() -> str | None:
    """Return what is not installed; None if all is."""
    return missing_package("kstar_planner")


def list_plans(
    lowering: Lowering, limits: ProcessLimits, *, n: int | None = None, quality: float | None = 1.0
) -> Listed:
    """Return the cheapest plans of a lowered task.

    Args:
        lowering: The task.
        limits: What the child process may use.
        n: How many plans; all within ``quality`` if None.
        quality: The largest multiple of the optimal cost; any cost if None.

    Raises:
        ValueError: if there is neither a number nor a quality.
        MissingPlannerError: if the wheel is not installed.
        UnsupportedError: if costs exceed 32 bits.
        LimitError: if time or memory runs out.
        PlannerError: if it crashes, or names actions that there are not.
    """
    if n is None and quality is None:
        raise ValueError("a number of plans or a quality is needed")
    spec = find_spec("kstar_planner")
    if spec is None or spec.origin is None:
        raise MissingPlannerError(f"plans cannot be listed: {missing()}")
    if not lowering.fits_32_bits:
        message = f"costs in whole numbers (times {lowering.scale}) exceed 32-bit integers"
        raise UnsupportedError(message, hint="--bank-cost steps")
    # An alternative goal becomes an axiom, with which only blind search is admissible.
    plain = not lowering.conditional and "(or " not in lowering.problem_text
    bounds = [f"k={n}"] if n is not None else []
    bounds += [f"q={quality}"] if quality is not None else []
    heuristic = "lmcut" if plain else "blind"
    search = _SEARCH.format(heuristic=heuristic, bounds=", ".join(bounds))
    build = Path(spec.origin).parent / "builds" / "release" / "bin"
    with TemporaryDirectory(prefix="hrcplan-") as folder:
        cwd = Path(folder)
        (cwd / "domain.pddl").write_text(lowering.domain_text, encoding="utf-8")
        (cwd / "problem.pddl").write_text(lowering.problem_text, encoding="utf-8")
        argv = [sys.executable, "-P", "-m", "kstar_planner.driver.main", "--build", str(build),
                "domain.pddl", "problem.pddl",
                "--translate-options", "--invariant-generation-max-time", "0",
                "--search-options", "--symmetries", _SYMMETRIES, "--search", search]  # fmt: skip
        process = run(argv, cwd=cwd, limits=limits)
        plans = tuple(_plans(lowering, cwd / "plans.json", process))
    return Listed(plans, n is None or len(plans) < n)


def _plans(
    lowering: Lowering, path: Path, process: FinishedProcess
) -> Iterator[tuple[GroundAction, ...]]:
    if process.end in (ProcessEnd.TIMEOUT, ProcessEnd.MEMORY, ProcessEnd.OUTPUT):
        message = f"K* reached its limit ({process.end.value}) before it had listed the plans"
        raise LimitError(message, code=process.end.value, hint="a smaller --sample")
    if process.code == _UNSOLVABLE:
        return
    if not path.is_file() or not path.stat().st_size:
        last = (process.stderr or process.stdout).strip().splitlines()[-1:]
        raise PlannerError(f"K* gave no answer (exit code {process.code}): {' '.join(last)}")
    try:
        for plan in json_of(path.read_bytes())["plans"]:
            yield tuple(lowering.actions[word.split()[0]] for word in plan["actions"])
    except DOCUMENT_FAULTS as error:
        raise PlannerError(f"K* answered what cannot be read: {error!r}") from None
