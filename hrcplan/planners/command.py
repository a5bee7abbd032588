"""Any program as a planner: ``cmd:popf {domain} {problem}``.

Its standard output, and the plan file if the command names ``{plan}``, are searched for plans
(``plans/logs.py``). Anytime planners print several; the best valid one counts.
"""

from __future__ import annotations

import os
import re
import shlex
import shutil
from collections.abc import Iterable, Iterator
from pathlib import Path
from tempfile import NamedTemporaryFile, TemporaryDirectory

from hrcplan.core.numbers import Number
from hrcplan.errors import MissingPlannerError, PlannerError, UsageError
from hrcplan.pddl.constructs import ALL
from hrcplan.pddl.model import Problem
from hrcplan.planners.contract import Answer, Capabilities, Request, Status
from hrcplan.planners.handover import Handover
from hrcplan.planners.process import FinishedProcess, ProcessEnd, ProcessLimits, run, text_of
from hrcplan.plans import Plan, find_plans
from hrcplan.validation import objective, validate

_NO_PLAN = re.compile(r"(?i)goal can be simplified to FALSE|problem proven unsolvable")
_EMPTY = re.compile(r"(?i)goal can be simplified to TRUE|empty plan solves it")
_SIGNAL = 128
_CRASHED = (1, 2, 126, 127)  # other exit codes are a planner's way to say why it has no plan


class CommandPlanner:
    """A command line with ``{domain}`` and ``{problem}``, perhaps ``{plan}`` and ``{timeout}``."""

    def __init__(self, command: str) -> None:
        try:
            self._words = shlex.split(command)
        except ValueError as error:
            raise UsageError(f"cmd:{command} is no command line: {error}") from None
        if not all(any(part in w for w in self._words) for part in ("{domain}", "{problem}")):
            hint = "for example cmd:popf {domain} {problem}"
            raise UsageError(f"cmd:{command} needs {{domain}} and {{problem}}", hint=hint)
        self.card = Capabilities(
            f"cmd:{command}",
            "a program of your own",
            temporal=True,
            numeric=True,
            constructs=ALL,
            metric="none",
            needs=self._words[0],
            licence="the program's own",
        )

    def missing(self) -> str | None:
        """Return that the program is not there; None if it is."""
        if shutil.which(self._words[0]) is None:
            return f"there is no program '{self._words[0]}'"
        return None

    def solve(self, request: Request) -> Answer:
        """Return the best valid plan that the program prints, also if its time runs out.

        Raises:
            MissingPlannerError: if there is no such program.
            PlannerError: if it crashes without a plan.
        """
        missing = self.missing()
        if missing is not None:
            raise MissingPlannerError(f"{self.card.name}: {missing}")
        problem = request.problem
        handover = Handover.of(problem)
        with TemporaryDirectory(prefix="hrcplan-") as folder:
            cwd = Path(folder)
            for name, text in zip(("domain", "problem"), handover.texts, strict=True):
                (cwd / f"{name}.pddl").write_text(text, encoding="utf-8")
            limits = ProcessLimits(request.time_left_s, request.memory_bytes)
            process = run(list(self._argv(cwd, limits.time_s)), cwd=cwd, limits=limits)
            texts = [process.stdout, *_plan_files(cwd, limits.output_bytes)]
        answers = (plan for text in texts for plan in find_plans(text, handover.problem))
        plans = [handover.restored(plan) for plan in answers]
        return self._answer(problem, process, plans)

    def _argv(self, cwd: Path, time_s: float) -> Iterator[str]:
        """Yield the words of the command; files of the caller's folder get their whole path."""
        names = {name: str(cwd / f"{name}.pddl") for name in ("domain", "problem")}
        names |= {"plan": str(cwd / "plan"), "timeout": str(max(1, round(time_s)))}
        for position, word in enumerate(self._words):
            for name, value in names.items():
                word = word.replace(f"{{{name}}}", value)
            is_file = os.path.isfile(word) and (position > 0 or "/" in word)
            yield str(Path(word).absolute()) if is_file else word

    def _answer(self, problem: Problem, process: FinishedProcess, plans: list[Plan]) -> Answer:
        name, output = self.card.name, process.stdout + process.stderr
        if process.end is ProcessEnd.MISSING:
            raise MissingPlannerError(f"{name} cannot be started: {process.stderr.strip()}")
        nothing_to_do = process.code == 0 or _EMPTY.search(output) is not None
        if not plans and nothing_to_do and validate(problem, Plan()).valid:
            plans = [Plan()]
        if plans:
            return Answer(Status.SOLVED, best_of(problem, plans))
        if process.end is not ProcessEnd.EXITED:
            return Answer(Status.UNSOLVED, note=f"stopped: {process.end.value}")
        if _NO_PLAN.search(output):
            return Answer(Status.UNSOLVABLE)
        lines = [line.strip() for line in output.splitlines() if line.strip()]
        last = " / ".join(lines[-3:])[-300:]
        if process.code is None or process.code < 0 or _is_crash(process.code):
            raise PlannerError(f"{name} ended with exit code {process.code}: {last}")
        if process.code != 0:
            return Answer(Status.UNSOLVED, note=f"no plan, exit code {process.code}: {last}")
        message = f"{name} ended without an error, but no plan could be read in its output"
        hint = f"the output is in {_save(output)}" if lines else "it printed nothing"
        raise PlannerError(message, code="plan-not-read", hint=hint)


def _is_crash(code: int) -> bool:
    """Whether an exit code says that a program failed; shells add 128 to a signal's number."""
    return code in _CRASHED or code > _SIGNAL


def _plan_files(folder: Path, most_bytes: int) -> list[str]:
    """Return the plan files of a planner, oldest first; together no more than ``most_bytes``."""
    texts: list[tuple[int, str]] = []
    for path in folder.glob("plan*"):
        text = text_of(path, most_bytes)
        if text is not None:
            stat = path.lstat()
            most_bytes -= stat.st_size
            texts.append((stat.st_mtime_ns, text))
    return [text for _, text in sorted(texts, key=lambda item: item[0])]


def _save(output: str) -> str:
    """Return the path of a new file with the output of a planner."""
    with NamedTemporaryFile(
        "w", prefix="hrcplan-output-", suffix=".log", delete=False, errors="replace"
    ) as file:
        file.write(output)
    return file.name


def best_of(problem: Problem, plans: Iterable[Plan]) -> Plan:
    """Return the best valid plan by hrcplan's own semantics; the last one if none is valid."""
    best: tuple[Number, Plan] | None = None
    last = Plan()
    for last in plans:
        report = validate(problem, last)
        if not report.valid:
            continue
        value = objective(problem, report) or 0
        value = -value if problem.maximize else value
        # Of equally good plans the last: anytime planners improve something they know.
        if best is None or value <= best[0]:
            best = value, last
    return last if best is None else best[1]
