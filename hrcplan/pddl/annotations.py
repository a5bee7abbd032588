"""``;; hrcplan:`` comments of a domain or a problem: what PDDL itself cannot hold.

The grammar is five forms, with names in any case and numbers as in PDDL; a further ``;`` begins
an ordinary comment::

    ;; hrcplan: success ACTION PROBABILITY
    ;; hrcplan: range FUNCTION LOW HIGH
    ;; hrcplan: say ACTION WORDS, WORDS, …
    ;; hrcplan: call OBJECT-OR-TYPE WORDS, WORDS, …
    ;; hrcplan: show PREDICATE-OR-OBJECT-OR-TYPE WORD, WORD

The first two are simulation data and stand in a domain once per name. ``say`` and ``call`` are
words of people, may stand in problems too, and add up. ``show`` says how pages draw something:
facts of a predicate as ``place``, ``zone``, ``badge`` or ``hide``; an object, or all of a type, by
an icon and a color. A domain may ``call`` and ``show`` objects that only its problems declare.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping

from hrcplan.core.numbers import Number, to_number
from hrcplan.core.text import nearest, quote
from hrcplan.pddl.model import Domain, Note
from hrcplan.pddl.reader import notes
from hrcplan.pddl.source import SourceText
from hrcplan.pddl.wording import warn_alike

_FORMS = {
    "success": "success ACTION PROBABILITY",
    "range": "range FUNCTION LOW HIGH",
    "say": "say ACTION WORDS, WORDS, …",
    "call": "call OBJECT WORDS, WORDS, …",
    "show": "show NAME WORD, WORD",
}
_WORDING = ("say", "call")
_REPEATED = (*_WORDING, "show")
VIEWS = ("place", "zone", "badge", "hide")
COLORS = ("blue", "orange", "green", "red", "purple", "sky", "yellow", "gray")
MAX_ICON = 8  # characters

Names = Mapping[str, Collection[str] | None]
"""Names that a kind of note may have; None for any name."""


def read_notes(source: SourceText, domain: Domain) -> tuple[Note, ...]:
    """Return the notes of a domain file; one that makes no sense is a warning and left out."""
    actions = domain.schemas
    names: Names = {"success": actions, "range": domain.functions, "say": actions, "call": None,
                    "show": None}  # fmt: skip
    read = []
    once = set()
    for at, note in _parsed(source, names):
        if note.kind not in _REPEATED and (note.kind, note.name) in once:
            source.warn(at, "duplicate-note", f"a second '{note.kind}' of {quote(note.name)}")
            continue
        once.add((note.kind, note.name))
        read.append((at, note))
    warn_alike(source, domain, domain.constants, read)
    return tuple(note for _, note in read)


def read_problem_notes(
    source: SourceText, domain: Domain, objects: Mapping[str, str]
) -> tuple[Note, ...]:
    """Return the notes of a problem file: words for actions and objects; others are a warning."""
    called = [*domain.constants, *objects, *domain.types]
    read = list(_parsed(source, {"say": domain.schemas, "call": called, "show": called}))
    warn_alike(source, domain, {**domain.constants, **objects}, read, domain.notes)
    return tuple(note for _, note in read)


def check_calls(source: SourceText, domain: Domain, objects: Mapping[str, str]) -> None:
    """Warn about ``call`` notes of a domain, with the objects of its problems now known."""
    called = [*domain.constants, *objects, *domain.types]
    new = []
    for at, text in notes(source):
        kind, *words = text.lower().split() or [""]
        note = _note(kind, words) if kind in ("call", "show") else None
        shown = domain.predicates if kind == "show" else ()
        if note is not None and note.name not in called and note.name not in shown:
            _warn_unknown(source, at, note.name, [*called, *shown])
        elif note is not None and kind == "call" and note.name not in domain.constants:
            new.append((at, note))
    above = [note for note in domain.notes if note.name in domain.constants]
    warn_alike(source, domain, {**domain.constants, **objects}, new, above)


def _parsed(source: SourceText, names: Names) -> Iterator[tuple[int, Note]]:
    for at, text in notes(source):
        kind, *words = text.lower().split() or [""]
        note = _note(kind, words)
        if kind not in _FORMS:
            message = f"there is no note {quote(kind)}"
            hint = nearest(kind, _FORMS) or f"notes are: {'; '.join(_FORMS.values())}"
            source.warn(at, "unknown-note", message, hint)
        elif kind not in names:
            message = f"{quote(text)} has no effect here"
            source.warn(at, "bad-note", message, "move it to the domain")
        elif note is None:
            message = f"{quote(text)} cannot be understood"
            source.warn(at, "bad-note", message, f"write ';; hrcplan: {_FORMS[kind]}'")
        elif (known := names[kind]) is not None and note.name not in known:
            _warn_unknown(source, at, note.name, known)
        else:
            yield at, note


def _warn_unknown(source: SourceText, at: int, name: str, known: Collection[str]) -> None:
    message = f"the note names {quote(name)}, which is not declared"
    source.warn(at, "unknown-note", message, nearest(name, known))


def _note(kind: str, words: list[str]) -> Note | None:
    """Return the note that words say, or None if they do not fit its form."""
    if kind in _REPEATED:
        phrases = tuple(" ".join(p.split()) for p in " ".join(words[1:]).split(","))
        if not words or not all(phrases) or (kind == "show" and not _can_be_shown(phrases)):
            return None
        return Note(kind, words[0], phrases=phrases)
    numbers = tuple(n for n in map(to_number, words[1:]) if n is not None)
    is_valid = len(words) == len(numbers) + 1 and _is_valid(kind, numbers)
    return Note(kind, words[0], numbers) if is_valid else None


def _can_be_shown(words: tuple[str, ...]) -> bool:
    """Return whether words are a way to draw facts, or an icon, a color, or both."""
    if any(word in VIEWS for word in words):
        return len(words) == 1
    icons = [word for word in words if word not in COLORS]
    return (
        len(words) - len(icons) <= 1
        and len(icons) <= 1
        and all(len(icon) <= MAX_ICON for icon in icons)
    )


def _is_valid(kind: str, numbers: tuple[Number, ...]) -> bool:
    if kind == "success":
        return len(numbers) == 1 and 0 <= numbers[0] <= 1
    return len(numbers) == 2 and numbers[0] <= numbers[1]
