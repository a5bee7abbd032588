"""A robot that is a program in any language: ``cmd:PROGRAM``. It speaks JSON lines.

The program receives the task once, and then, whenever it is asked, everything that was done so far;
so it needs no memory of its own. One line each way:

    {"kind": "task", "domain": PDDL, "problems": {GOAL: PDDL, ...}, "goals": [...], "robots": [...]}
    {"kind": "ask", "history": [{"agent": "human", "action": "(get human oats)"}, ...],
     "options": ["(get robot pan)", ...]}
    {"posterior": [0.5, 0.5], "action": "(get robot pan)", "declared": 0}

The last one is the program's answer to ``ask``: a probability for each goal, one of the options or
null to wait, and how many changes of goal it has declared so far.
"""

from __future__ import annotations

import json
import shlex
import shutil
import time
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from hrcplan.bank import Bank
from hrcplan.core.arrays import Floats
from hrcplan.core.json_values import DOCUMENT_FAULTS
from hrcplan.core.text import cut, harmless
from hrcplan.errors import LimitError, MissingPlannerError, PlannerError, UsageError
from hrcplan.inference.belief import IMPOSSIBLE
from hrcplan.pddl.conventions import people, robots
from hrcplan.pddl.write import domain_text, problem_text
from hrcplan.planners.line_process import LineProcess

ANSWER_S = 60.0  # how long a program may think about one answer
N_ANSWERS = 256  # that are remembered


@dataclass(frozen=True, slots=True)
class CommandState:
    """The state of a `CommandAssistant`: what was done; the program says the rest when asked."""

    robot: CommandAssistant = field(compare=False, repr=False)
    world: int
    history: tuple[tuple[str, str], ...] = ()
    ignored: str | None = None

    @property
    def n_declared(self) -> int:
        """How many changes of goal the program has declared."""
        return self.robot.answer(self).n_declared


@dataclass(frozen=True, slots=True)
class CommandAnswer:
    """What a program says in a state: posterior, step and number of declared changes."""

    posterior: Floats
    step: int | None
    n_declared: int


class CommandAssistant:
    """A program that is asked for the goal and for the robot's step.

    Args:
        command: The program and its arguments, as one text.
        bank: The plans; the program sees the PDDL only.

    Raises:
        UsageError: if the command is none.
    """

    def __init__(self, command: str, bank: Bank) -> None:
        try:
            self._argv = shlex.split(command)
        except ValueError as error:
            raise UsageError(f"cmd:{command} is no command line: {error}") from None
        if not self._argv:
            raise UsageError("cmd: needs a program", hint='for example "cmd:python3 robot.py"')
        self.bank, self.names, self._name = bank, bank.names, f"cmd:{command}"
        problem = bank.goals.problem
        self._robots, self._people = robots(problem), people(problem)
        self._program: LineProcess | None = None
        self._lines: list[str] = []
        self._answers: dict[tuple[tuple[str, str], ...], CommandAnswer] = {}

    def start(self) -> CommandState:
        """Return the state before anything was done."""
        return CommandState(self, self.bank.initial)

    def observe(self, state: CommandState, step: int, *, robot: bool = False) -> CommandState:
        """Return the state after one more step, done by the human or by the robot."""
        agents = self._robots if robot else self._people
        table, task = self.bank.table, self.bank.goals.task
        index = table.doer(state.world, step, agents)
        if index is None:
            return replace(state, ignored=IMPOSSIBLE)
        action = task.actions[index]
        agent = action.agent or (next(iter(agents)) if len(agents) == 1 else "")
        entry = agent, f"({' '.join((action.name, *action.args))})"
        return CommandState(self, task.successor(state.world, index), (*state.history, entry))

    def posterior(self, state: CommandState) -> Floats:
        """Return the probability of each goal that the program says."""
        return self.answer(state).posterior

    def choose(self, state: CommandState) -> int | None:
        """Return the step that the program says, or None to wait."""
        return self.answer(state).step

    def answer(self, state: CommandState) -> CommandAnswer:
        """Return what the program says in a state; it is asked once.

        Raises:
            MissingPlannerError: if there is no such program.
            PlannerError: if it ends, or its answer makes no sense.
            LimitError: if it does not answer in time.
        """
        if state.history not in self._answers:
            while len(self._answers) >= N_ANSWERS:
                del self._answers[next(iter(self._answers))]
            self._answers[state.history] = self._asked(state)
        return self._answers[state.history]

    def _asked(self, state: CommandState) -> CommandAnswer:
        table = self.bank.table
        can = table.able(state.world, table.applicable(state.world), self._robots)
        options = {self._text(state.world, step): step for step in can}
        history = [{"agent": agent, "action": action} for agent, action in state.history]
        line = self._reply({"kind": "ask", "history": history, "options": list(options)})
        try:
            answer = json.loads(line)
            posterior = np.array(answer["posterior"], dtype=np.float64)
            action, declared = answer["action"], answer.get("declared", 0)
            is_whole = type(declared) is int and declared >= 0
            is_one = posterior.shape == (len(self.names),) and bool((posterior >= 0).all())
            if not is_one or not np.isfinite(posterior).all() or not is_whole:
                raise ValueError("one probability for each goal, and a number of changes, are due")
            if action is not None and action not in options:
                raise ValueError(f"'{action}' is none of the options")
            return CommandAnswer(posterior, None if action is None else options[action], declared)
        except DOCUMENT_FAULTS as error:
            shown = cut(harmless(line), 120)
            message = f"{self._name} answers {shown}: {type(error).__name__}: {error}"
            raise PlannerError(message, code="bad-answer") from None

    def _text(self, world: int, step: int) -> str:
        index = self.bank.table.doer(world, step, self._robots)
        assert index is not None
        action = self.bank.goals.task.actions[index]
        return f"({' '.join((action.name, *action.args))})"

    def _reply(self, question: Mapping[str, Any]) -> str:
        """Return the next line of the program after a question."""
        if self._program is None:
            self._program = self._started()
        if not self._program.write_line(json.dumps(question)):
            raise self._broken(self._program, "it does not read what it is asked")
        until = time.monotonic() + ANSWER_S
        while not self._lines and self._program.ending is None:
            left_s = until - time.monotonic()
            if left_s <= 0:
                message = f"{self._name} has not answered within {ANSWER_S:g} s"
                raise LimitError(message, code="no-answer")
            self._lines += [one or "" for one in self._program.read_lines(left_s)]
        if not self._lines:
            raise self._broken(self._program, "it ended")
        return self._lines.pop(0)

    def _started(self) -> LineProcess:
        if shutil.which(self._argv[0]) is None:
            raise MissingPlannerError(f"there is no program '{self._argv[0]}'")
        try:
            program = LineProcess(self._argv, cwd=Path.cwd())
        except OSError as error:
            raise PlannerError(f"{self._name} cannot be started: {error}") from None
        problem, formulas = self.bank.goals.problem, self.bank.goals.formulas
        problems = {
            name: problem_text(replace(problem, name=name, goal=goal))
            for name, goal in zip(self.names, formulas, strict=True)
        }
        task = {
            "kind": "task", "domain": domain_text(problem.domain), "problems": problems,
            "goals": list(self.names), "robots": sorted(self._robots),
        }  # fmt: skip
        program.write_line(json.dumps(task))
        return program

    def _broken(self, program: LineProcess, why: str) -> PlannerError:
        words = [program.ending or "", *program.last_words.splitlines()[-1:]]
        details = ": ".join(word for word in words if word)
        message = f"{self._name}: {why}" + (f" ({details})" if details else "")
        return PlannerError(message, code="robot-ended")
