"""Parentheses that do not match: where it went wrong, and a repair so that reading goes on.

A PDDL file has landmarks at which the depth is known: ``(define``, the head of a section such
as ``(:init``, and the keyword of an action's part such as ``:effect``. So every stretch between
two landmarks can be counted by itself, and one that does not come out even holds the fault.
Inside such a stretch a group is taken as unclosed when it is full (``(at a b (at c d)``) or when
the layout says so. A file that comes out even is never touched, however it is laid out.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from hrcplan.core.records import record
from hrcplan.pddl.source import SourceText

Token = tuple[str, int]
"""A parenthesis or a word, and its offset."""

ACTIONS = frozenset([":action", ":durative-action"])
PARTS = frozenset([":parameters", ":precondition", ":condition", ":duration", ":effect"])
SECTIONS = ACTIONS | {
    ":requirements", ":types", ":constants", ":predicates", ":functions", ":derived", ":process",
    ":event", ":constraints", ":domain", ":objects", ":init", ":goal", ":metric",
}  # fmt: skip
_INSIDE = PARTS | {":serial", ":parallel", ":vars"}  # "(" before these begins no section
_ANY_NUMBER = {"and", "or", "+", "-", "*", "/", "define", "either", "oneof", "probabilistic"}
_ONE = {"not"}
_TWO = {"=", "<", ">", "<=", ">=", "imply", "when", "forall", "exists", "over", "preference"}
_TWO |= {"assign", "increase", "decrease", "scale-up", "scale-down"}


@record
class _Stretch:
    """Tokens from one landmark to the next, and the depths at which they begin and end."""

    tokens: Sequence[Token]
    start: int
    end: int
    content: int  # the depth at which what the section or part holds is complete

    @property
    def missing(self) -> int:
        """How many ")" are missing; below zero: how many there are too many."""
        words = [text for text, _ in self.tokens]
        return self.start + words.count("(") - words.count(")") - self.end

    @property
    def is_even(self) -> bool:
        """Whether the stretch ends at its depth without ever being above it."""
        depth, floor = self.start, min(self.start, self.end)
        for text, _ in self.tokens:
            if text == "(":
                depth += 1
            elif text == ")":
                depth -= 1
                if depth < floor:
                    return False
        return depth == self.end


class _Open:
    """A group that is still open: its place, the line's indentation, and what is in it."""

    def __init__(self, at: int, line: int, indent: int) -> None:
        self.at, self.line, self.indent = at, line, indent
        self.head = self.second = self.last = ""
        self.size = 0

    def take(self, text: str) -> None:
        self.last = text
        if self.size == 0:
            self.head = text
        elif self.size == 1:
            self.second = text
        self.size += 1

    @property
    def is_full(self) -> bool:
        """Whether no further group can stand in it."""
        if not self.head or self.head[0] in ":(" or self.head in _ANY_NUMBER:
            return False
        if self.head[0] == "?":
            return self.last != "-"  # (either …) may follow in a parameter list
        if self.head == "at" and (self.second in ("start", "end") or self.second[:1].isdigit()):
            return self.size > 2
        return self.size > (self.head in _ONE) + 2 * (self.head in _TWO)


def mend(tokens: Sequence[Token], source: SourceText) -> list[Token]:
    """Return the tokens with every ``(`` closed and no ``)`` too many; faults go to ``source``."""
    output: list[Token] = []
    around: list[_Open] = []  # groups that are open across landmarks
    for stretch in _stretches(tokens):
        if stretch.is_even:
            output += stretch.tokens
        else:
            output += _Repair(stretch, around, source).run()
        if stretch.end > stretch.start:
            at = stretch.tokens[0][1]
            around.append(_Open(at, *source.position(at)))
        del around[stretch.end :]
    return output


def _stretches(tokens: Sequence[Token]) -> Iterator[_Stretch]:
    first, depth, content = 0, 0, 0
    for index, next_depth, next_content in _landmarks(tokens):
        if index > first:
            yield _Stretch(tokens[first:index], depth, next_depth, content)
        first, depth, content = index, next_depth, next_content
    yield _Stretch(tokens[first:], depth, 0, content)


def _landmarks(tokens: Sequence[Token]) -> Iterator[tuple[int, int, int]]:
    """Yield index, depth before it, and depth of completed content, of every landmark."""
    in_define = in_action = False
    previous = ""
    for index, (text, _) in enumerate(tokens):
        if text[0] == ":" and in_define:
            word = text.lower()
            if previous != "(":
                if in_action:
                    yield index, 2, 2
            elif word not in _INSIDE:
                yield index - 1, 1, 2 if word == ":goal" else 1
                in_action = word in ACTIONS
        elif previous == "(" and text.lower() == "define":
            yield index - 1, 0, 0
            in_define, in_action = True, False
        previous = text


class _Repair:
    """One stretch that does not come out even, token by token."""

    def __init__(self, stretch: _Stretch, around: Sequence[_Open], source: SourceText) -> None:
        self.stretch = stretch
        self.around = around
        self.source = source
        self.depth = stretch.start
        self.missing = stretch.missing
        self.stack: list[_Open] = []
        self.out: list[Token] = []
        self.line = 0
        self.indent = 0
        self.next_line = 0

    def run(self) -> list[Token]:
        tokens = self.stretch.tokens
        last_content = max((i for i, (text, _) in enumerate(tokens) if text != ")"), default=-1)
        for index, (text, at) in enumerate(tokens):
            leads = self._move_to(at)
            if text == "(":
                self._open(at, leads)
            elif text == ")":
                self._close(at, leads, index < last_content)
            else:
                self._take(text)
                self.out.append((text, at))
        while self.depth > self.stretch.end:
            self._report_unclosed()
        return self.out

    def _move_to(self, at: int) -> bool:
        """Keep line and indentation; return whether the token at ``at`` leads its line."""
        if at < self.next_line:
            return False
        self.line, self.indent = self.source.position(at)
        self.next_line = self.source.line_end(at)
        return True

    def _open(self, at: int, leads: bool) -> None:
        while self.missing > 0 and self._next_cannot_belong(leads):
            self._report_unclosed()
        self._take("(")
        self.stack.append(_Open(at, self.line, self.indent))
        self.depth += 1
        self.out.append(("(", at))

    def _close(self, at: int, leads: bool, more_follows: bool) -> None:
        while self.missing > 0 and leads and self._is_left_of_innermost:
            self._report_unclosed()
        early = self.missing < 0 and more_follows and self.depth - 1 <= self.stretch.content
        if early or self.depth - 1 < self.stretch.end:
            self.missing += 1
            self.source.error(at, "stray-parenthesis", "this ')' is one too many", "remove it")
        else:
            self._end_group(at)

    def _end_group(self, at: int) -> None:
        self.out.append((")", at))
        self.depth -= 1
        if self.stack:
            self.stack.pop()

    def _take(self, text: str) -> None:
        if self.stack:
            self.stack[-1].take(text.lower())

    @property
    def _innermost(self) -> _Open:
        return self.stack[-1] if self.stack else self.around[self.depth - 1]

    @property
    def _is_left_of_innermost(self) -> bool:
        return self.depth > self.stretch.end and self.indent < self._innermost.indent

    def _next_cannot_belong(self, leads: bool) -> bool:
        """Whether the group that begins here is not part of the innermost one."""
        if not self.stack or self.stack[-1].head.startswith(":"):
            return False  # anything may stand in a section or an action's part
        group = self.stack[-1]
        base = self.stack[0].indent
        is_outdented = leads and group.line < self.line and base < group.indent >= self.indent
        return group.is_full or is_outdented

    def _report_unclosed(self) -> None:
        at = self._innermost.at
        message = f"this '(' is never closed; its ')' is missing at or before line {self.line}"
        self.source.error(at, "unclosed", message, "add a ')'")
        self.missing -= 1
        self._end_group(at)
