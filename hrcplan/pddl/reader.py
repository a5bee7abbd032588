"""Text to tree: words and groups that remember where they stand.

The reader never raises and never recurses; a fault is noted and mended, so that the faults
behind it are found in the same go.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from hrcplan.pddl.parentheses import Token, mend
from hrcplan.pddl.source import SourceText

MAX_DEPTH = 150  # whatever walks a formula recursively is safe below this
_TOKEN = re.compile(r"[()]|[^\s();]+|;[^\r\n]*")
_NOTE = re.compile(r";+[ \t]*hrcplan:[ \t]*([^\r\n;]*)", re.IGNORECASE)


class WordNode(str):
    """A lower-cased word and the offset of its first character."""

    __slots__ = ("at",)
    at: int


class GroupNode(list["ParseNode"]):
    """A parenthesised list and the offset of its opening parenthesis."""

    __slots__ = ("at",)

    def __init__(self, at: int) -> None:
        self.at = at

    @property
    def head(self) -> str:
        """The first element if it is a word, else the empty string."""
        return self[0] if self and isinstance(self[0], WordNode) else ""


ParseNode = WordNode | GroupNode


def read(source: SourceText) -> GroupNode | None:
    """Return the one ``(define …)`` group of a file, or None; faults go into ``source``."""
    nodes = read_nodes(source)
    groups = [node for node in nodes if isinstance(node, GroupNode)]
    root = next((group for group in groups if group.head == "define"), None)
    outside = next((node for node in nodes if node is not root), None)
    if outside is not None:
        message = "a file holds one (define …) and nothing outside it"
        source.error(outside.at, "outside-define", message)
    elif root is None and not source.has_errors:
        source.error(0, "empty", "the file holds no (define …)")
    return root


def read_nodes(source: SourceText) -> list[ParseNode]:
    """Return everything that a text holds side by side; faults go into ``source``."""
    return _build(mend(_tokens(source.text), source), source)


def notes(source: SourceText) -> Iterator[tuple[int, str]]:
    """Yield offset and text of every ``;; hrcplan: …`` comment."""
    for match in _NOTE.finditer(source.text):
        yield match.start(), match.group(1).strip()


def word_at(text: str, at: int) -> WordNode:
    """Return a Word that stands at offset ``at``."""
    word = WordNode(text.lower())
    word.at = at
    return word


def _tokens(text: str) -> list[Token]:
    found = ((match.group(), match.start()) for match in _TOKEN.finditer(text))
    return [token for token in found if token[0][0] != ";"]


def _build(tokens: Iterable[Token], source: SourceText) -> list[ParseNode]:
    """Return the trees of balanced tokens; a group below the deepest level becomes ``()``."""
    top = GroupNode(0)
    stack = [top]
    skipped = 0  # how deep we are in a group that is left out
    too_deep: int | None = None
    for token, at in tokens:
        if token == "(":
            if skipped or len(stack) > MAX_DEPTH:
                too_deep = at if too_deep is None else too_deep
                if not skipped:
                    stack[-1].append(GroupNode(at))
                skipped += 1
                continue
            group = GroupNode(at)
            stack[-1].append(group)
            stack.append(group)
        elif token != ")":
            if not skipped:
                stack[-1].append(word_at(token, at))
        elif skipped:
            skipped -= 1
        else:
            stack.pop()
    if too_deep is not None:
        source.error(too_deep, "too-deep", f"groups are nested deeper than {MAX_DEPTH}")
    return list(top)
