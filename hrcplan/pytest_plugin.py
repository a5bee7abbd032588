"""A pytest plugin: plans in tests, and every problem file a test case by itself.

``assert_valid_plan(domain, problem, plan)`` and the fixture ``hrcplan_plan(domain, problem)`` are
for your tests. Every file ``problems/**/*.pddl`` that pytest comes across is collected: it must
have no faults, and a valid plan must be found for it (``hrcplan = false`` in the pytest
configuration turns that off).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from hrcplan.planners.solve import Result
    from hrcplan.validation import Report

TIMEOUT_S = 60.0


def assert_valid_plan(domain: str, problem: str, plan: str) -> Report:
    """Return the replay of a plan (text or path); fail with the first wrong step.

    Raises:
        AssertionError: if the plan is invalid.
    """
    from hrcplan.testing import check_plan

    return check_plan(domain, problem, plan)


@pytest.fixture
def hrcplan_plan() -> Callable[..., Result]:
    """A function ``(domain, problem, **options)`` that returns a checked result of planning."""
    from hrcplan.pddl.inputs import read
    from hrcplan.planners.solve import solve

    def plan(domain: str, problem: str, **options: Any) -> Result:
        return solve(read(str(domain), str(problem)), **options)

    return plan


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add ``--hrcplan-timeout`` and the setting ``hrcplan``."""
    parser.getgroup("hrcplan").addoption(
        "--hrcplan-timeout", type=float, default=TIMEOUT_S, metavar="S",
        help="seconds for the plan of each problem file",
    )  # fmt: skip
    parser.addini("hrcplan", "collect problems/**/*.pddl as tests", type="bool", default=True)


def pytest_collect_file(file_path: Path, parent: pytest.Collector) -> ProblemFile | None:
    """Collect a problem file below a folder ``problems``."""
    setting = parent.config.getini("hrcplan")
    if setting and file_path.suffix == ".pddl" and "problems" in file_path.parts[:-1]:
        return ProblemFile.from_parent(parent, path=file_path)
    return None


class ProblemFile(pytest.File):
    """One problem file: two test cases; a domain file in its folder: one."""

    def collect(self) -> Iterator[pytest.Item]:
        """Yield the check, and the plan unless the file is a domain."""
        from hrcplan.pddl.check import kind_of

        yield CheckItem.from_parent(self, name="check")
        if kind_of(self.path) != "domain":
            yield PlanItem.from_parent(self, name="plan")


class _Item(pytest.Item):
    def reportinfo(self) -> tuple[Path, int, str]:
        """Return where the case comes from."""
        return self.path, 0, f"{self.path.parent.name}/{self.path.stem}: {self.name}"

    def repr_failure(
        self, excinfo: pytest.ExceptionInfo[BaseException], style: str | None = None
    ) -> str:
        """Return the message without a traceback: the file is at fault, not the code."""
        return str(excinfo.value)


class CheckItem(_Item):
    """The file has no errors."""

    def runtest(self) -> None:
        """Fail with every error."""
        from hrcplan.pddl.check import check_files

        errors = [str(d) for d in check_files([self.path]) if d.severity == "error"]
        if errors:
            pytest.fail("\n".join(errors), pytrace=False)


class PlanItem(_Item):
    """A valid plan is found."""

    def runtest(self) -> None:
        """Fail if no planner finds a plan in time."""
        from hrcplan.pddl.inputs import read
        from hrcplan.planners.solve import solve

        timeout = self.config.getoption("--hrcplan-timeout")
        result = solve(read(self.path), timeout_s=timeout, any_plan=True)
        if result.plan is None:
            pytest.fail(f"{result.status.value} after {result.wall_s:.1f} s", pytrace=False)
