"""One layout for PDDL files: indentation, spaces and closing parentheses; words and comments stay.

A group that stands on one line stays there if it fits; a group with line breaks inside keeps its
first words on its line and gives every part a line of its own. In sections that are lists
(``:objects``, ``:init``, …) the lines of the author stay, because they group what belongs together.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field

from hrcplan.errors import InputError, PddlError
from hrcplan.pddl.reader import read_nodes
from hrcplan.pddl.source import SourceText

WIDTH = 120
_STEP = 2
_MOST_ROUNDS = 8
"""A group that is broken because it is too long may be laid out differently the next time."""
_MAX_DEPTH = 150  # the writer is recursive
_LISTS = frozenset([":types", ":constants", ":objects", ":predicates", ":functions", ":init"])
_WITH_GROUP = frozenset(["define", "forall", "exists", "when", ":derived"])
_TOKEN = re.compile(r";[^\r\n]*|[()]|[^\s();]+")


@dataclass(slots=True)
class _Part:
    """A word, a comment, or a group (with ``parts``), and what stood before it."""

    text: str
    n_breaks: int  # line breaks before it, at most two
    gap: int  # blanks before it
    parts: list[_Part] | None = None
    length: int = 0  # characters on one line
    is_broken: bool = field(default=False)  # line breaks or comments inside

    @property
    def is_comment(self) -> bool:
        return self.text.startswith(";")


def format_text(text: str, path: str = "PDDL") -> str:
    r"""Return a text in the layout of hrcplan; the order of words and comments does not change.

    Formatting the result again changes nothing.

    Args:
        text: A domain or problem.
        path: Its file, for messages.

    Raises:
        PddlError: if parentheses do not match.
        InputError: if it is nested more than 150 levels deep.

    >>> print(format_text("(define(domain d)\n(:predicates(p ?x)\n ( q ) ) ; two\n)"), end="")
    (define (domain d)
      (:predicates
        (p ?x)
        (q))  ; two
    )
    """
    source = SourceText(path, text)
    read_nodes(source)
    faults = [fault for fault in source.diagnostics if fault.severity == "error"]
    if faults:
        raise PddlError(faults)
    for _ in range(_MOST_ROUNDS):
        writer = _Writer()
        for part in _parts(text, path):
            writer.begin(part, 0)
            writer.write(part, 0, 0)
        if writer.text() == text or not writer.has_broken_group:
            return writer.text()
        text = writer.text()
    return text


def _parts(text: str, path: str) -> list[_Part]:
    top: list[_Part] = []
    open_groups: list[_Part] = []
    end = 0
    for match in _TOKEN.finditer(text):
        between = text[end : match.start()]
        n_breaks = min(2, len(re.findall(r"\r\n?|\n", between)))
        gap = len(between) - max(between.rfind("\n"), between.rfind("\r")) - 1
        end = match.end()
        if match[0] == ")":
            _close(open_groups)
            continue
        part = _Part(match[0].rstrip(), n_breaks if top or open_groups else 0, gap)
        part.length = len(part.text)
        (open_groups[-1].parts if open_groups else top).append(part)  # type: ignore[union-attr]
        if match[0] == "(":
            part.parts = []
            open_groups.append(part)
            if len(open_groups) > _MAX_DEPTH:
                message = f"the file is nested more than {_MAX_DEPTH} levels deep"
                raise InputError(f"{message}: it is not formatted", path=path, code="too-deep")
    return top


def _close(open_groups: list[_Part]) -> None:
    group = open_groups.pop()
    parts = group.parts or []
    group.length = 2 + sum(part.length for part in parts) + max(0, len(parts) - 1)
    n_first = _n_head(parts) if _is_hugged(parts) else len(parts)
    group.is_broken = any(p.is_comment or p.is_broken for p in parts) or any(
        p.n_breaks for p in parts[1:n_first]
    )


class _Writer:
    """Lines of text; the last one is still open."""

    def __init__(self) -> None:
        self._lines = [""]
        self.has_broken_group = False  # one that stood on one line, but is too long for that

    def text(self) -> str:
        return "\n".join(line.rstrip() for line in self._lines).strip("\n") + "\n"

    def begin(self, part: _Part, indent: int) -> None:
        """Begin the line of a part, after the blank line that stood before it."""
        if part.is_comment and part.n_breaks == 0 and self._lines[-1].strip():
            self._lines[-1] += " " * max(2, part.gap)
            return
        if part.n_breaks == 2 and self._lines[-1].strip():
            self._lines.append("")
        if self._lines[-1].strip() or len(self._lines) > 1 or part.n_breaks == 2:
            self._lines.append("")
        self._lines[-1] = " " * indent

    def add(self, text: str) -> None:
        self._lines[-1] += text

    def write(self, part: _Part, indent: int, n_closing: int) -> None:
        """Write a part at the end of the last line; lines inside it are indented from ``indent``.

        Args:
            part: What is written.
            indent: Where the line of the part begins.
            n_closing: Parentheses that will follow it.
        """
        if part.parts is None:
            self.add(part.text)
        elif not part.is_broken and self._fits(part, n_closing):
            self.add(_inline(part))
        else:
            self.has_broken_group |= not part.is_broken
            self._write_group(part.parts, indent, n_closing)

    def _fits(self, part: _Part, n_closing: int) -> bool:
        return len(self._lines[-1]) + part.length + n_closing <= WIDTH

    def _write_group(self, parts: list[_Part], indent: int, n_closing: int) -> None:
        self.add("(")
        n_head = _n_head(parts)
        for number, part in enumerate(parts[:n_head]):
            self.add(" " if number else "")
            self.write(part, indent, 0)
        rest = parts[n_head:]
        if _is_hugged(parts):
            self.add(" ")
            self.write(rest[0], indent, n_closing + 1)
        elif parts and (parts[0].text.lower() in _LISTS or _is_plain(parts)):
            self._write_list(rest, indent + _STEP, n_closing + 1, is_new=n_head > 0)
        else:
            self._write_lines(rest, indent + _STEP, n_closing + 1)
        if parts and parts[-1].is_comment:
            self._lines.append(" " * indent)
        self.add(")")

    def _write_list(self, parts: list[_Part], indent: int, n_closing: int, is_new: bool) -> None:
        """Write parts on the lines on which they stood; what is too long goes to the next line."""
        for number, part in enumerate(parts):
            is_last = number == len(parts) - 1
            stays = part.n_breaks == 0 and (number > 0 or not is_new)
            if stays and not part.is_comment and self._fits(part, 1 + n_closing * is_last):
                self.add(" " if number else "")
            else:
                self.begin(part, indent)
            self.write(part, indent, n_closing if is_last else 0)

    def _write_lines(self, parts: list[_Part], indent: int, n_closing: int) -> None:
        """Write every part on a line of its own, a keyword with its value."""
        is_value = False
        for number, part in enumerate(parts):
            if is_value and not part.is_comment:
                self.add(" ")
            else:
                self.begin(part, indent)
            is_last = number == len(parts) - 1
            self.write(part, indent, n_closing if is_last else 0)
            is_value = part.parts is None and part.text.startswith(":")


def _is_hugged(parts: list[_Part]) -> bool:
    """Whether a broken group ends with a group on its first line, as ``(:goal (and`` does."""
    n_head = _n_head(parts)
    is_last = n_head == len(parts) - 1 and parts[-1].parts is not None
    return is_last and n_head > 0 and parts[0].text.lower() != "define"


def _n_head(parts: list[_Part]) -> int:
    """Return how many of the first parts of a broken group stay on its first line."""
    if not parts or parts[0].parts is not None or parts[0].is_comment or _is_plain(parts):
        return 0
    if parts[0].text.lower() in _LISTS:
        return 1
    n_words = 1
    while n_words < len(parts) and _is_head_word(parts[n_words]):
        n_words += 1
    has_group = n_words < len(parts) and parts[n_words].parts is not None
    if has_group and n_words == 1 and parts[0].text.lower() in _WITH_GROUP:
        return n_words + (not parts[n_words].is_broken)
    return n_words


def _is_head_word(part: _Part) -> bool:
    is_word = part.parts is None and not part.is_comment
    return is_word and part.n_breaks == 0 and not part.text.startswith(":")


def _is_plain(parts: list[_Part]) -> bool:
    """Whether a group holds words only, as a list of variables or of requirements does."""
    return all(part.parts is None for part in parts)


def _inline(part: _Part) -> str:
    return "".join(_pieces(part))


def _pieces(part: _Part) -> Iterator[str]:
    if part.parts is None:
        yield part.text
        return
    yield "("
    for number, inner in enumerate(part.parts):
        if number:
            yield " "
        yield from _pieces(inner)
    yield ")"
