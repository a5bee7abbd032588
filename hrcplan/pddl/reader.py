"""Text to tree: words and groups that remember where they stand.

The reader never raises and never recurses. Unbalanced parentheses are reported where they
went wrong (by sections and by indentation) and repaired, so that the faults behind them are
found in the same go.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from hrcplan.pddl.source import Source, quote

MAX_DEPTH = 300
SECTIONS = frozenset(
    ":requirements :types :constants :predicates :functions :action :durative-action :derived "
    ":process :event :constraints :domain :objects :init :goal :metric :length".split()
)
_TOKEN = re.compile(r";[^\n]*|[()]|[^\s();]+")


class Word(str):
    """A lower-cased word and the offset of its first character."""

    __slots__ = ("at",)
    at: int


class Group(list["Node"]):
    """A parenthesised list, the offsets of its parentheses, and its line's indentation."""

    __slots__ = ("at", "end", "indent")

    def __init__(self, at: int, indent: int = 0) -> None:
        super().__init__()
        self.at = at
        self.end = at
        self.indent = indent

    @property
    def head(self) -> str:
        """The first element if it is a word, else the empty string."""
        return self[0] if self and isinstance(self[0], Word) else ""


Node = Word | Group


def read(source: Source) -> Group | None:
    """Return the one ``(define …)`` group of a file, or None; faults go into ``source``."""
    reader = _Reader(source)
    for match in _TOKEN.finditer(source.text):
        token = match.group()
        if token[0] != ";":
            reader.take(token, match.start())
        if reader.gave_up:
            return None
    return reader.finish()


def notes(source: Source) -> Iterator[tuple[int, str]]:
    """Yield offset and text of every ``;; hrcplan: …`` comment."""
    for match in re.finditer(r";+[ \t]*hrcplan:[ \t]*([^\n]*)", source.text):
        yield match.start(), match.group(1).strip()


class _Reader:
    """A stack of open groups, and the first sign that one of them lacks its end."""

    def __init__(self, source: Source) -> None:
        self.source = source
        self.stack: list[Group] = []
        self.root: Group | None = None
        self.suspect: Group | None = None
        self.stray: int | None = None  # a ")" too many, if more text follows it
        self.gave_up = False
        self.seen = 0
        self.line_start = 0
        self.indent = 0

    def take(self, token: str, at: int) -> None:
        leads = self._begin_line(at)
        if token == ")":
            self._close(at, leads)
            return
        self._reopen_after_stray(at)
        if leads:
            self._suspect_by_indentation(at)
        if token == "(":
            self._open(at)
        else:
            self._word(token, at)

    def finish(self) -> Group | None:
        if self.stack and not self.gave_up:
            self._report_unclosed(self.stack[-1])
            self.root = self.stack[0]
        elif self.stray is not None:
            self._report_stray(self.stray)
        if self.root is None and not self.source.has_errors:
            self.source.error(0, "empty", "the file holds no (define …)")
        return self.root

    def _begin_line(self, at: int) -> bool:
        """Update the indentation; return whether the token at ``at`` is first on its line."""
        start = self.source.text.rfind("\n", self.seen, at) + 1
        leads = start > 0 or self.seen == 0
        if leads:
            self.line_start = start
            self.indent = at - start
        self.seen = at + 1
        return leads

    def _open(self, at: int) -> None:
        group = Group(at, self.indent)
        if self.stack:
            self.stack[-1].append(group)
        elif self.root is not None:
            self.source.error(at, "trailing-text", "there is text after the (define …)")
        if len(self.stack) >= MAX_DEPTH:
            self.source.error(at, "too-deep", f"groups are nested deeper than {MAX_DEPTH}")
            self.gave_up = True
        self.stack.append(group)

    def _word(self, token: str, at: int) -> None:
        word = Word(token.lower())
        word.at = at
        if not self.stack:
            self.source.error(at, "stray-word", f"{quote(token)} stands outside (define …)")
            return
        group = self.stack[-1]
        if word in SECTIONS and not group and len(self.stack) > 2:
            self._report_unclosed(self.stack[-2])
            self._close_down_to_sections(group)
        elif word[0] == ":" and group and not group.head.startswith(":"):
            self.suspect = self.suspect or group
        self.stack[-1].append(word)

    def _close_down_to_sections(self, section: Group) -> None:
        self.stack[-2].pop()
        for group in self.stack[1:-1]:
            group.end = section.at
        self.stack[1:] = [section]
        self.stack[0].append(section)

    def _close(self, at: int, leads: bool) -> None:
        if not self.stack:
            if self.stray is None:
                self.stray = at
            elif self.stray != at:
                self._report_stray(self.stray)
                self.stray = at
            return
        if leads and len(self.stack) > 1 and self.indent < self.stack[-1].indent:
            self.suspect = self.suspect or self.stack[-1]
        group = self.stack.pop()
        group.end = at
        if len(self.stack) == 1:
            self.suspect = None  # the section ended in order
        if not self.stack and self.root is None:
            self.root = group

    def _reopen_after_stray(self, at: int) -> None:
        """Take back the ")" that closed (define …) although more sections follow."""
        if self.stack or self.root is None:
            return
        if not self.source.text.startswith("(:", at):
            return
        self._report_stray(self.root.end if self.stray is None else self.stray)
        self.stray = None
        self.stack = [self.root]
        self.root = None

    def _suspect_by_indentation(self, at: int) -> None:
        group = self.stack[-1] if len(self.stack) > 1 else None
        if group is not None and self.indent <= group.indent and group.at < self.line_start:
            self.suspect = self.suspect or group

    def _report_unclosed(self, group: Group) -> None:
        group = self.suspect or group
        self.suspect = None
        self.source.error(group.at, "unclosed", "this '(' is never closed", "add a ')'")

    def _report_stray(self, at: int) -> None:
        self.source.error(at, "stray-parenthesis", "this ')' closes nothing", "remove it")
