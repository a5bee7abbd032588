"""Text to tree: words and groups that remember where they stand.

The reader never raises and never recurses; a fault is noted and mended, so that the faults
behind it are found in the same go. A text whose parentheses match is read in one pass.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Iterable, Iterator
from typing import Concatenate, ParamSpec, TypeVar

from hrcplan.core.text import quote
from hrcplan.pddl.characters import without_foreign
from hrcplan.pddl.parentheses import PARTS, SECTIONS, Token, mend
from hrcplan.pddl.source import MAX_FAULTS, SourceText

MAX_DEPTH = 1000  # whatever walks a formula recursively is safe below this
MAX_MENDED = 8 << 20  # characters: where parentheses do not match, a longer text is not read
_PLAIN_DEPTH = 100  # deeper trees need more of Python's stack than it allows by itself
_FRAMES = 12  # that one level of a formula may take
_SECTION_DEPTH = 3  # groups around the head of a section: everything, define, the section
# A group of words without a keyword is one token of a text whose parentheses match.
_FLAT = r"\(\s*+\??[^\s();:?][^\s();?]*+(?:\s++\??[^\s();?:][^\s();?]*+)*+\s*+\)"
_GROUP_OR_TOKEN = re.compile(_FLAT + r"|[()]|\?*:*[^\s();?:]+|[?:]+|;[^\r\n]*")
_TOKEN = re.compile(r"[()]|\?*[^\s();?]+|\?+|;[^\r\n]*")
_DEFINE = re.compile(r"\((?:\s|;[^\r\n]*+)*+define\b", re.IGNORECASE)
_COMMENT_OR_TEMPLATE = re.compile(r";[^\r\n]*|\{\{|\{%")
_NOTE = re.compile(r"(?<!;);++[ \t]*+hrcplan:[ \t]*+([^\r\n;]*)", re.IGNORECASE)
_BEFORE_A_WORD = frozenset(" \t\r\n\f\v()")

P = ParamSpec("P")
T = TypeVar("T")


class WordNode(str):
    """A lower-cased word and the offset of its first character."""

    __slots__ = ("at",)
    at: int


class GroupNode(list["ParseNode"]):
    """A parenthesised list and the offset of its opening parenthesis."""

    __slots__ = ("at", "text")
    at: int
    text: str  # of a `FlatNode`

    def __init__(self, at: int) -> None:
        self.at = at

    @property
    def head(self) -> str:
        """The first element if it is a word, else the empty string."""
        first = self[0] if self else ""
        return first if isinstance(first, WordNode) else ""


class FlatNode(GroupNode):
    """A group of words, kept as text until its words are asked for; then it is a `GroupNode`.

    Most groups of a file are plain facts and atoms: `words` says all about them, without places.
    """

    __slots__ = ()

    def __init__(self, at: int, text: str) -> None:
        self.at = at
        self.text = text

    def words(self) -> list[str]:
        """Return its words without their places."""
        return self.text[1:-1].split()

    def spell_out(self) -> None:
        """Become a group of words that know their places."""
        words, at = self.words(), 1
        self.__class__ = GroupNode  # type: ignore[assignment]
        for part in words:
            word = WordNode(part)
            at = self.text.find(part, at)
            word.at = self.at + at
            at += len(part)
            self.append(word)


def _spelling_out(method: Callable[Concatenate[GroupNode, P], T]) -> Callable[..., T]:
    """Return a method of lists for a group whose words are not in it yet."""

    def call(node: FlatNode, *args: P.args, **options: P.kwargs) -> T:
        for group in (node, *args):  # the other one of a comparison, too
            if isinstance(group, FlatNode):
                group.spell_out()
        return method(node, *args, **options)

    return call


_NOT_INSIDE = frozenset(["__new__", "__init__", "__getattribute__", "__class_getitem__"])
for _name, _method in vars(list).items():
    if callable(_method) and _name not in _NOT_INSIDE:
        setattr(FlatNode, _name, _spelling_out(_method))

ParseNode = WordNode | GroupNode


def read(source: SourceText) -> GroupNode | None:
    """Return the one ``(define …)`` group of a file, or None; faults go into ``source``."""
    if not source.has_errors and (_is_template(source) or not _DEFINE.search(source.text)):
        if not source.has_errors:
            _report_no_define(source)
        return None
    nodes = read_nodes(source)
    groups = [node for node in nodes if isinstance(node, GroupNode)]
    root = next((group for group in groups if group.head == "define"), None)
    outside = next((n for n in nodes if n is not root and not _is_lisp(n, source)), None)
    if outside is not None:
        word = outside if isinstance(outside, WordNode) and root is not None else None
        source.error(outside.at, "outside-define", *_outside(source.text, root is not None, word))
    elif root is None and not source.has_errors:
        source.error(0, "empty", "the file holds no (define …)")
    return root


def _is_template(source: SourceText) -> bool:
    """Whether a file has places of a template language outside comments; it is one error."""
    if "{{" not in source.text and "{%" not in source.text:
        return False
    marks = (m for m in _COMMENT_OR_TEMPLATE.finditer(source.text) if m[0][0] != ";")
    mark = next(marks, None)
    if mark is not None:
        message = f"the file is a template: {quote(mark[0])} stands for text still to be filled in"
        hint = "fill it in with its data first, and read the result"
        source.error(mark.start(), "template", message, hint)
    return mark is not None


def _report_no_define(source: SourceText) -> None:
    """Report that a file does not begin as PDDL: its parentheses are no further fault."""
    first = next((t for t in _TOKEN.finditer(source.text) if t[0][0] != ";"), None)
    if first is None:
        source.error(0, "empty", "the file holds no (define …)")
        return
    message, hint = _outside(source.text, False)
    if first[0].lower() == "define":
        hint = "write '(define', and one ')' at the end of the file"
    source.error(first.start(), "outside-define", message, hint)


def _is_lisp(node: ParseNode, source: SourceText) -> bool:
    """Whether a group is a command to the Lisp systems of old; it is a warning and ignored."""
    if not isinstance(node, GroupNode) or node.head != "in-package":
        return False
    source.warn(node.at, "outside-define", "hrcplan takes no notice of (in-package …)")
    return True


def _outside(text: str, has_define: bool, word: str | None = None) -> tuple[str, str | None]:
    """Return message and hint for a file with more than a ``(define …)``."""
    start = text.lstrip()[:20].lower()
    if "```" in text:
        return "the file holds Markdown around its PDDL", "remove the lines that begin with ```"
    if start.startswith(("<!doctype", "<html", "<?xml")):
        return "this is a web page, not PDDL", "download the raw file"
    hint = "a file begins with (define (domain NAME) or (define (problem …)"
    if has_define:
        hint = (
            "remove the rest, or write ; before its lines; a second (define …) needs its own file"
        )
    if word is not None:
        return f"{quote(word)} stands outside the (define …)", hint
    return "a file holds one (define …) and nothing outside it", hint


def read_nodes(source: SourceText) -> list[ParseNode]:
    """Return everything that a text holds side by side; faults go into ``source``."""
    text = without_foreign(source)
    try:
        return _read_even(text, source)
    except _UnevenError as uneven:
        at = uneven.at
    if len(text) > MAX_MENDED or abs(text.count("(") - text.count(")")) > 2 * MAX_FAULTS:
        message = "the parentheses do not match before this place"
        source.error(at, "unclosed", message, "the file is not read any further")
        return []
    return _build(mend(_tokens(text), source), source)


class _UnevenError(Exception):
    """The parentheses of a text do not match, or it is nested too deeply."""

    def __init__(self, at: int) -> None:
        super().__init__(at)
        self.at = at


def _read_even(text: str, source: SourceText) -> list[ParseNode]:
    """Return the trees of a text in one pass.

    Raises:
        _UnevenError: if a parenthesis is missing or one too many, a section or a part of an action
            does not stand at its depth, or the text is nested too deeply.
    """
    lower = text.lower()
    if len(lower) != len(text):  # a few letters become two: then the places would be wrong
        lower = text
    group = GroupNode(0)
    stack = [group]
    deepest = 0
    for match in _GROUP_OR_TOKEN.finditer(lower):
        token = match[0]
        if token[0] == "(":
            inner: GroupNode
            if len(token) > 1:
                inner = FlatNode(match.start(), token)
                group.append(inner)
                depth = len(stack) + 1
            else:
                inner = GroupNode(match.start())
                group.append(inner)
                stack.append(inner)
                group = inner
                depth = len(stack)
            if depth > deepest:
                deepest = depth
                if deepest > MAX_DEPTH:
                    raise _UnevenError(inner.at)
        elif token == ")":
            stack.pop()
            if not stack:
                raise _UnevenError(match.start())
            group = stack[-1]
        else:
            kind = token[0]
            if kind == ";":
                continue
            word = WordNode(token)
            word.at = match.start()
            if kind == "?":
                if word.at and text[word.at - 1] not in _BEFORE_A_WORD:
                    _report_gap(word, source)
            elif kind == ":":
                if word.at and text[word.at - 1] not in _BEFORE_A_WORD:
                    if word not in PARTS and not str(group[-1]).startswith(":"):
                        group[-1] = _joined(group[-1], word)  # a name with a colon in it
                        continue
                    _report_gap(word, source)
                if not _is_in_place(word, group, len(stack)):
                    raise _UnevenError(word.at)
            group.append(word)
    if len(stack) != 1:
        raise _UnevenError(group.at)
    _allow_depth(deepest)
    return list(group)


def _joined(start: ParseNode, rest: WordNode) -> WordNode:
    """Return two parts of one word."""
    assert isinstance(start, WordNode)
    word = WordNode(start + rest)
    word.at = start.at
    return word


def _is_in_place(word: WordNode, group: GroupNode, depth: int) -> bool:
    """Whether a keyword stands where it belongs, if it is the head of a section or of a part."""
    if word in SECTIONS and not group:
        return depth == _SECTION_DEPTH
    return word not in PARTS or not group or depth == _SECTION_DEPTH


def _report_gap(word: WordNode, source: SourceText) -> None:
    """Warn about ``pier?p`` and ``go:effect``: two words for most readers, without a space."""
    source.warn(word.at, "missing-space", f"a space is missing before {word}", "add it")


def _allow_depth(depth: int) -> None:
    """Let Python recurse as deep as a text is nested."""
    if depth > _PLAIN_DEPTH:
        sys.setrecursionlimit(max(sys.getrecursionlimit(), 1000 + _FRAMES * MAX_DEPTH))


def notes(source: SourceText) -> Iterator[tuple[int, str]]:
    """Yield offset and text of every ``;; hrcplan: …`` comment."""
    if not source.mentions("hrcplan:"):
        return
    for match in _NOTE.finditer(source.text):
        yield match.start(), match.group(1).strip()


def word_at(text: str, at: int) -> WordNode:
    """Return a Word that stands at offset ``at``."""
    word = WordNode(text.lower())
    word.at = at
    return word


def _tokens(text: str) -> list[Token]:
    tokens = ((match.group(), match.start()) for match in _TOKEN.finditer(text))
    return [token for token in tokens if token[0][0] != ";"]


def _build(tokens: Iterable[Token], source: SourceText) -> list[ParseNode]:
    """Return the trees of balanced tokens; a group below the deepest level becomes ``()``."""
    top = GroupNode(0)
    stack = [top]
    depth_skipped = 0  # how deep we are in a group that is left out
    too_deep: int | None = None
    deepest = 0
    for token, at in tokens:
        deepest = max(deepest, len(stack))
        if token == "(":
            if depth_skipped or len(stack) > MAX_DEPTH:
                too_deep = at if too_deep is None else too_deep
                if not depth_skipped:
                    stack[-1].append(GroupNode(at))
                depth_skipped += 1
                continue
            group = GroupNode(at)
            stack[-1].append(group)
            stack.append(group)
        elif token != ")":
            if not depth_skipped:
                stack[-1].append(word_at(token, at))
        elif depth_skipped:
            depth_skipped -= 1
        else:
            stack.pop()
    if too_deep is not None:
        source.error(too_deep, "too-deep", f"groups are nested deeper than {MAX_DEPTH}")
    _allow_depth(deepest)
    return list(top)
