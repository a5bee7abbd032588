"""What an editor shows of a declaration, and the sections of a file, out of the text alone."""

from __future__ import annotations

import re

from hrcplan.pddl.names import Name, NameKind

_TOKEN = re.compile(r";[^\r\n]*|[()]|[^\s();]+")
_NAMED = frozenset(
    ["domain", "problem", ":domain", ":action", ":durative-action", ":process", ":event"]
)
_PARAMETERS = re.compile(r":parameters\s*(\([^()]*(?:\([^()]*\)[^()]*)*\))", re.IGNORECASE)


def sections(text: str) -> list[tuple[int, int, str]]:
    """Return start, end and title of every section of a ``(define …)``, as in ``:action move``."""
    result: list[tuple[int, int, str]] = []
    depth, start, title = 0, 0, ""
    for match in _TOKEN.finditer(text):
        token = match[0]
        if token == "(":
            depth += 1
            if depth == 2:
                start, title = match.start(), ""
        elif token == ")":
            if depth == 2:
                result.append((start, match.end(), title))
            depth -= 1
        elif depth == 2 and not token.startswith(";"):
            if not title:
                title = token
            elif title.lower() in _NAMED:
                title = f"{title} {token}"
    return result


def signature(text: str, name: Name) -> str:
    """Return a declaration on one line: a predicate with its types, an action's parameters."""
    if name.kind == NameKind.ACTION:
        section = next((text[a:b] for a, b, _ in sections(text) if a <= name.at < b), "")
        match = _PARAMETERS.search(section)
        return f"({name.word} {match[1][1:-1].strip() if match else ''})".replace(" )", ")")
    if name.kind == NameKind.SYMBOL:
        start = text.rfind("(", 0, name.at)
        return " ".join(text[start : text.find(")", name.at) + 1].split())
    match = re.compile(r"[^()]*?-\s*(\([^)]*\)|[^\s();]+)").match(text, name.at)
    return f"{name.word} - {match[1]}" if match else name.word
