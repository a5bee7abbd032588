"""Every exception that hrcplan raises on purpose, sorted by what the caller can do about it.

::

    HrcplanError
    ├── UsageError            exit 2: the call itself is wrong (unknown name, bad option)
    │   └── UnsupportedError  exit 2: this planner or representation cannot hold this task
    ├── InputError            exit 3: a file has to be mended
    │   ├── PddlError         every fault found in PDDL files
    │   └── PlanFormatError   a text that is no plan
    ├── LimitError            exit 4: time or memory ran out
    └── PlannerError          exit 5: a planner is missing, crashed, or gave a wrong answer
        ├── MissingPlannerError
        └── CostGuardError    planner and hrcplan disagree about a cost

"Unsolvable", "no plan in time" and "plan invalid" are results, not exceptions.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

from hrcplan.core.records import record


@record
class Diagnostic:
    """One fault in a file: where it is (1-based, in characters), what it is, what to do."""

    path: str
    line: int
    column: int
    severity: str
    code: str
    message: str
    hint: str | None = None

    def __str__(self) -> str:
        """Return ``path:line:col: error[code]: message``, with the hint in parentheses.

        >>> print(Diagnostic("d.pddl", 3, 7, "error", "unknown-type", "no type 'bx'", "box?"))
        d.pddl:3:7: error[unknown-type]: no type 'bx' (box?)
        """
        hint = f" ({self.hint})" if self.hint else ""
        place = f"{self.path}:{self.line}:{self.column}"
        return f"{place}: {self.severity}[{self.code}]: {self.message}{hint}"


class HrcplanError(Exception):
    """Base of all errors raised on purpose; carries a code, and a place and hint if known."""

    exit_code: ClassVar[int] = 1
    default_code: ClassVar[str] = "error"

    def __init__(
        self,
        message: str,
        *,
        code: str | None = None,
        path: str | None = None,
        line: int | None = None,
        column: int | None = None,
        hint: str | None = None,
    ) -> None:
        super().__init__(message)
        self.message = message
        self.code = code or self.default_code
        self.path = path
        self.line = line
        self.column = column
        self.hint = hint


class UsageError(HrcplanError):
    """The call is wrong: an unknown name, a bad option, a value out of range."""

    exit_code = 2
    default_code = "usage"


class UnsupportedError(UsageError):
    """A planner, or the bit representation, cannot hold this task; the message says why."""

    default_code = "unsupported"


class InputError(HrcplanError):
    """A file is missing, unreadable, or does not say what it should."""

    exit_code = 3
    default_code = "bad-input"


class PddlError(InputError):
    """PDDL files with errors; ``diagnostics`` holds all of them, the message the first."""

    default_code = "bad-pddl"

    def __init__(self, diagnostics: Sequence[Diagnostic]) -> None:
        errors = [d for d in diagnostics if d.severity == "error"]
        first = errors[0]
        rest = f" (and {len(errors) - 1} more)" if len(errors) > 1 else ""
        super().__init__(
            first.message + rest,
            code=first.code,
            path=first.path,
            line=first.line,
            column=first.column,
            hint=first.hint,
        )
        self.diagnostics = tuple(errors)


class PlanFormatError(InputError):
    """A text that is not a plan in IPC format."""

    default_code = "bad-plan"


class LimitError(HrcplanError):
    """Time or memory ran out before there was an answer."""

    exit_code = 4
    default_code = "limit"


class PlannerError(HrcplanError):
    """A planner crashed, or what it answered cannot be true."""

    exit_code = 5
    default_code = "planner-crashed"


class MissingPlannerError(PlannerError):
    """A planner that is not installed; the hint says what to install."""

    default_code = "planner-missing"


class CostGuardError(PlannerError):
    """A planner's cost, metric or claim differs from hrcplan's own semantics."""

    default_code = "cost-guard"
