"""Where names stand in a text: what declares them, what uses them, and how far they reach.

This works on words alone, so it also answers for a text with faults, as an editor needs it.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from enum import StrEnum

from hrcplan.core.records import record

_TOKEN = re.compile(r";[^\r\n]*|[()]|\?*[^\s();?]+|\?+")
_TIME = re.compile(r"\s+(?:start|end|all|[\d.]+)\b", re.IGNORECASE)
_NOTE = re.compile(r"hrcplan:\s*(\w+)\s+(\S+)", re.IGNORECASE)
_TYPED_SECTIONS = frozenset([":types", ":constants", ":objects", ":predicates", ":functions"])
_ACTIONS = frozenset([":action", ":durative-action", ":process", ":event"])
_CONNECTIVES = frozenset(
    ["and", "or", "not", "imply", "forall", "exists", "when", "at", "over", "=", "<", ">", "<=",
     ">=", "+", "-", "*", "/", "increase", "decrease", "assign", "scale-up", "scale-down",
     "either", "preference", "always", "sometime", "within", "at-most-once", "sometime-after",
     "sometime-before", "always-within", "hold-during", "hold-after", "is-violated", "minimize",
     "maximize", "define", "domain", "problem", "start", "end", "all", "undefined"]
)  # fmt: skip


class NameKind(StrEnum):
    """What a name stands for."""

    TYPE = "type"
    SYMBOL = "predicate or function"
    ACTION = "action"
    OBJECT = "object"
    VARIABLE = "variable"
    CALLED = "object or type, in a note"


@record
class Name:
    """A name at one place of a text.

    Attributes:
        kind: What it stands for.
        word: In lower case.
        at: Offset of its first character.
        length: Characters of the text.
        declares: Whether this place declares it.
        scope: For a variable the offset of the section it belongs to; else -1.
    """

    kind: NameKind
    word: str
    at: int
    length: int
    declares: bool
    scope: int


@dataclass(slots=True)
class _Group:
    """An open parenthesis, and what has been read behind it."""

    at: int
    words: list[str] = field(default_factory=list)


def names(text: str) -> list[Name]:
    """Return all names of a text in their order.

    >>> [(n.word, n.kind.name, n.declares) for n in names("(define (domain d) (:types box))")]
    [('box', 'TYPE', True)]
    """
    return list(_names(text))


def name_at(text: str, offset: int) -> Name | None:
    """Return the name at an offset, or directly before it; None if no name stands there."""
    for name in _names(text):
        if name.at <= offset <= name.at + name.length:
            return name
        if name.at > offset:
            break
    return None


def _names(text: str) -> Iterator[Name]:
    stack: list[_Group] = []
    after_dash = False
    for match in _TOKEN.finditer(text):
        token, at = match[0].lower(), match.start()
        if token.startswith(";"):
            yield from _noted(token, at)
        elif token == "(":
            if stack:
                stack[-1].words.append("(")
            stack.append(_Group(at))
        elif token == ")":
            if stack:
                stack.pop()
            after_dash = False
        elif token == "-":
            after_dash = True
        else:
            is_predicate = token == "at" and _TIME.match(text, match.end()) is None
            word = "at " if is_predicate else token  # the blank tells it from (at start …)
            name = _name(word, at, stack, after_dash)
            if name is not None:
                yield name
            after_dash = False
            if stack:
                stack[-1].words.append(word)


def _noted(comment: str, at: int) -> Iterator[Name]:
    """Yield the name that a note of hrcplan is about."""
    match = _NOTE.search(comment)
    if match is None:
        return
    kinds = {"say": NameKind.ACTION, "success": NameKind.ACTION, "range": NameKind.SYMBOL,
             "call": NameKind.CALLED}  # fmt: skip
    kind = kinds.get(match[1])
    if kind is not None:
        yield Name(kind, match[2], at + match.start(2), len(match[2]), False, -1)


def _name(token: str, at: int, stack: list[_Group], after_dash: bool) -> Name | None:
    section = stack[1] if len(stack) > 1 else None
    head = section.words[0] if section is not None and section.words else ""
    if token.startswith(":") or section is None:
        return None
    if token.startswith("?"):
        inside = stack[-1].words
        before = stack[-2].words[-2:-1] if len(stack) > 2 else []
        declares = head in (":predicates", ":functions") or before == [":parameters"] or (
            not inside and len(stack) > 2 and stack[-2].words[:1] in (["forall"], ["exists"])
        )  # fmt: skip
        return Name(NameKind.VARIABLE, token, at, len(token), declares, section.at)
    kind = _kind(token, head, stack, after_dash)
    if kind is None:
        return None
    word = token.rstrip()
    return Name(kind, word, at, len(word), _declares(kind, head, stack, after_dash), -1)


def _kind(token: str, head: str, stack: list[_Group], after_dash: bool) -> NameKind | None:
    inside = stack[-1].words
    if head in _ACTIONS and len(stack) == 2 and len(inside) == 1:
        return NameKind.ACTION
    if after_dash or inside[:1] == ["either"] or (head == ":types" and inside):
        return None if token in ("either", "number") else NameKind.TYPE
    if not head or _is_number(token) or (len(stack) == 2 and not inside):
        return None
    if head in (":constants", ":objects"):
        return NameKind.OBJECT if inside else None
    if len(stack) == 2 or head in (":domain", ":requirements"):
        return None
    if not inside:
        return None if token in _CONNECTIVES else NameKind.SYMBOL
    return None if inside[0] in _CONNECTIVES and inside[0] != "=" else NameKind.OBJECT


def _declares(kind: NameKind, head: str, stack: list[_Group], after_dash: bool) -> bool:
    if kind == NameKind.ACTION:
        return True
    if kind == NameKind.SYMBOL:
        return head in (":predicates", ":functions") and len(stack) == 3
    return head in _TYPED_SECTIONS and len(stack) == 2 and not after_dash


def _is_number(token: str) -> bool:
    return token[0].isdigit() or (token[0] in ".-" and token[1:2].isdigit())
