"""Characters that PDDL does not have: read as what they stand for, with one message for a kind."""

from __future__ import annotations

import re

from hrcplan.pddl.source import SourceText

# Control characters, marks that hide or reverse text, and halves of characters.
_HIDDEN = (
    r"\x00-\x08\x0e-\x1f\x7f-\x84\x86-\x9f\xad\u200b-\u200f\u202a-\u202e\u2060-\u206f"
    r"\ufeff\ufff9-\ufffb\ud800-\udfff"
)
_DASH = r"\u2010-\u2015\u2212"
_ODD_SPACE = r"\x85\xa0\u1680\u2000-\u200a\u2028\u2029\u202f\u205f\u3000"
_FOREIGN = re.compile(
    r";[^\r\n]*"  # a comment of PDDL may hold anything
    r"|(?P<comma>(?<![0-9]),|,(?![0-9]))"  # 1,5 is meant as a number
    r"|(?P<bracket>[\[\]{}])"
    r"|(?<![^\s()])(?P<comment>//[^\r\n]*|#(?!t\b)[^\r\n]*|/\*(?:[^*]|\*(?!/))*+(?:\*/)?)"
    rf"|(?P<dash>[{_DASH}])"
    rf"|(?P<space>[{_ODD_SPACE}])"
    rf"|(?P<hidden>[{_HIDDEN}])",
    re.IGNORECASE,
)
_PLAIN = re.compile(rf"(?:[^;,\[\]{{}}#/{_DASH}{_ODD_SPACE}{_HIDDEN}]++|/(?![/*])|;[^\r\n]*+)*+")
"""A text that holds nothing of that."""
_FAULTS = {
    "comma": ("comma", "PDDL has no commas", "put spaces between words"),
    "bracket": ("foreign-operator", "PDDL has no {} brackets", "write ( and )"),
    "comment": ("stray-word", "a comment of PDDL begins with ;", "write ; here"),
    "dash": ("foreign-operator", "{} is not the '-' of PDDL", "write -"),
    "hidden": ("not-printable", "the character {} is not printable", "remove it"),
    "space": ("not-printable", "the character {} is not a plain space", "write a space"),
}
"""Code, message and hint of each group of ``_FOREIGN``."""


def without_foreign(source: SourceText) -> str:
    """Return the text of a file with parentheses, dashes and spaces as PDDL has them.

    Places stay as they are. Each kind of foreign characters is one error at its first place, each
    hidden character is another one; an odd space is a warning.
    """
    text = source.text
    if _PLAIN.fullmatch(text):
        return text
    reported: set[str] = set()

    def replacement(match: re.Match[str]) -> str:
        kind, characters = match.lastgroup, match[0]
        if kind is None:
            return characters
        key = characters if kind in ("hidden", "space") else kind
        if key not in reported:
            reported.add(key)
            _report(match.start(), kind, characters, source)
        return _read_as(kind, characters)

    return _FOREIGN.sub(replacement, text)


def _report(at: int, kind: str, characters: str, source: SourceText) -> None:
    code, message, hint = _FAULTS[kind]
    name = {"dash": f"U+{ord(characters[0]):04X}", "bracket": "square or curly"}.get(kind)
    report = source.warn if kind == "space" else source.error
    report(at, code, message.format(name or f"U+{ord(characters[0]):04X}"), hint)


def _read_as(kind: str, characters: str) -> str:
    """Return what is read instead, as long as before."""
    if kind == "bracket":
        return "(" if characters in "[{" else ")"
    if kind == "dash":
        return "-"
    return characters if kind == "hidden" else " " * len(characters)
