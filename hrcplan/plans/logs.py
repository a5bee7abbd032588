"""Plans in the output of planners: POPF, OPTIC, TFD, LPG, FF, Fast Downward, ENHSP and others.

A log mixes plans with other lines. Actions are recognized by their names, which the domain
declares; a line without an action ends a plan.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator

from hrcplan.core.text import type_text
from hrcplan.errors import PlanFormatError
from hrcplan.pddl.model import Problem
from hrcplan.pddl.source import read_text
from hrcplan.plans.documents import plain_text
from hrcplan.plans.model import Plan, PlannedAction
from hrcplan.plans.text import parse_plan

# "step    0: GO A B" and "        1: GO B C" of FF; "STEP 2: go(a,b) go(b,c)" of Madagascar.
# "1. go a b" of a list, "- go a b" of another one.
_NUMBER = re.compile(r"(?:step\b\s*)?\d+\s*(?::|[.)](?=\s))\s*|[-*•]\s+")
_WORDS = re.compile(r"[^\s()\[\]:;,]+(?:\s+[^\s()\[\]:;,]+)*")
# "go a b" and "0.5: go a b [5]", if these are an action and objects.
_BARE = re.compile(
    r"(?P<start>\d+(?:[.,]\d+)?s?\s*:)?\s*(?P<words>[^\s()\[\]:;,]+(?:(?:\s*,\s*|\s+)[^\s()\[\]:;,]+)*)"
    r"\s*(?:\[(?P<duration>[^\[\]]+)\])?"
)
_COMMENT = re.compile(r";[^\n]*")
_PRICE = re.compile(r"\s\(\d+\)$")  # "go a b (1)" of Fast Downward
_OF_A_LOG = re.compile(
    r"waiting|plan(?:\b|_)|(?:\b|_)(?:solution|cost|time|search|heuristic|states|steps)(?:\b|_)|^```|^[^a-z]+$"
)
# What ENHSP prints between actions, and the last action that FF adds to a plan.
_NO_ACTION = re.compile(r"(?<!-)-{2,}+\s*+waiting\s*+--|\breach-goal\b")


def find_plans(text: str, problem: Problem) -> Iterator[Plan]:
    """Yield every plan in a planner's output, in the order of the text.

    Plans of a classical domain have no times: some planners print the position of a step as one.
    """
    for actions in _blocks(text, _Steps(problem, text)):
        has_times = any(action.start_s is not None for action in actions)
        if has_times and problem.domain.is_temporal:
            if all(action.start_s is not None for action in actions):
                yield Plan(tuple(sorted(actions, key=lambda a: a.start_s or 0)))
        else:
            yield Plan(tuple(PlannedAction(a.name, a.args) for a in actions))


def read_plan(text: str, problem: Problem, path: str = "<plan>") -> tuple[Plan, int]:
    """Return the plan in a text, which may be a planner's log, and how many plans are in there.

    Of several plans the last one is returned: planners print improvements one after the other.

    Raises:
        PlanFormatError: if the text is neither a plan nor a log with one, with the place of the
            first line that is no action.
    """
    try:
        return parse_plan(text, path), 1
    except PlanFormatError as error:
        plans = plans_of_log(text, problem)
        if not plans:
            raise error from None
        return plans[-1], len(plans)


def plans_of_log(text: str, problem: Problem) -> list[Plan]:
    """Return the plans in a planner's log; none if a line names an action and is no action.

    Such a line is a fault of a plan, not a line of a log.
    """
    return list(find_plans(text, problem)) if _is_log(text, problem) else []


def as_plan(plan: Plan | str | os.PathLike[str], problem: Problem | None = None) -> Plan:
    """Return a `Plan` as it is, and the plan of a text or of a file.

    A string is text if it holds a parenthesis or a line break, or is blank; else it is a path.
    With a problem, the text may be a planner's log.

    Raises:
        PlanFormatError: if the text is no plan.
        InputError: if the file is missing or unreadable.
        TypeError: if it is something else.

    >>> as_plan("(move human wp1 wp2)").actions[0].args
    ('human', 'wp1', 'wp2')
    """
    if isinstance(plan, Plan):
        return plan
    if not isinstance(plan, (str, os.PathLike)):
        raise TypeError(f"a plan is a Plan, its text, or a file's path, not {type_text(plan)}")
    path = "<plan>"
    if isinstance(plan, str) and (not plan.strip() or any(c in plan for c in "(\n")):
        text = plan
    else:
        path = os.fspath(plan)
        text = read_text(path)
    return parse_plan(text, path) if problem is None else read_plan(text, problem, path)[0]


def _blocks(text: str, steps: _Steps) -> Iterator[list[PlannedAction]]:
    """Yield the actions of lines that follow each other."""
    block: list[PlannedAction] = []
    for line in (*plain_text(text).lower().splitlines(), ""):
        actions = steps.on_line(line.strip())
        if actions:
            block += actions
        elif block and not _NO_ACTION.search(line):
            yield block
            block = []


class _Steps:
    """What a problem's actions look like in a text."""

    def __init__(self, problem: Problem, text: str) -> None:
        self.names = {action.name for action in problem.domain.actions}
        self._arity = {action.name: len(action.params) for action in problem.domain.actions}
        self._objects = problem.all_objects
        # Among actions with parentheses a line without them is a fault.
        self._is_bare = "(" not in _COMMENT.sub("", text)

    def on_line(self, line: str) -> tuple[PlannedAction, ...]:
        """Return the actions on a line; none if there is anything else on it."""
        number = _NUMBER.match(line)
        rest = line[number.end() :] if number else line
        for text in dict.fromkeys((line, rest)):
            try:
                actions = parse_plan(text).actions
            except PlanFormatError:
                continue
            if actions and all(action.name in self.names for action in actions):
                return actions
        price = _PRICE.search(line)
        bare = rest if number else line[: price.start()] if price else ""
        words = bare.split() if _WORDS.fullmatch(bare) else []
        if words and words[0] in self.names:
            return (PlannedAction(words[0], tuple(words[1:])),)
        return self._without_parentheses(line) if self._is_bare else ()

    def _without_parentheses(self, line: str) -> tuple[PlannedAction, ...]:
        """Return the action of a line such as ``0.5: go a b [5]``, if it names what is declared."""
        match = _BARE.fullmatch(line.strip("\"'"))
        words = match["words"].replace(",", " ").split() if match else [""]
        fits = len(words) - 1 == self._arity.get(words[0]) and self._objects.keys() >= {*words[1:]}
        if not match or not fits:
            return ()
        duration = f"[{match['duration']}]" if match["duration"] else ""
        try:
            return parse_plan(f"{match['start'] or ''}({' '.join(words)}){duration}").actions
        except PlanFormatError:
            return ()


def _is_log(text: str, problem: Problem) -> bool:
    """Return whether all lines without an action speak of something else than actions."""
    steps = _Steps(problem, text)
    lines = [line.strip() for line in plain_text(text).lower().splitlines() if line.strip()]
    rest = [line for line in lines if not steps.on_line(line)]
    if any(not steps.names.isdisjoint(re.findall(r"[^\s()\[\]:;,]+", line)) for line in rest):
        return False
    return not rest or any(_OF_A_LOG.search(line) for line in rest)
