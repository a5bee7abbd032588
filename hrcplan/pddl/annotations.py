"""``;; hrcplan:`` comments of a domain: simulation data that PDDL cannot hold.

The grammar is two forms, with names in any case and numbers as in PDDL; a further ``;`` begins
an ordinary comment::

    ;; hrcplan: success ACTION PROBABILITY
    ;; hrcplan: range FUNCTION LOW HIGH
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping

from hrcplan.core.numbers import Number, to_number
from hrcplan.core.text import nearest, quote
from hrcplan.pddl.model import Note
from hrcplan.pddl.reader import notes
from hrcplan.pddl.source import SourceText

_FORMS = {"success": "success ACTION PROBABILITY", "range": "range FUNCTION LOW HIGH"}


def read_notes(
    source: SourceText, actions: Collection[str], functions: Collection[str]
) -> tuple[Note, ...]:
    """Return the notes of a domain file; one that makes no sense is a warning and left out."""
    names = {"success": actions, "range": functions}
    notes: dict[tuple[str, str], Note] = {}
    for at, note in _notes_of(source, names):
        if (note.kind, note.name) in notes:
            source.warn(at, "duplicate-note", f"a second '{note.kind}' of {quote(note.name)}")
        else:
            notes[note.kind, note.name] = note
    return tuple(notes.values())


def refuse_notes(source: SourceText) -> None:
    """Warn about notes in a problem file, where nothing reads them."""
    for at, text in notes(source):
        source.warn(at, "bad-note", f"{quote(text)} has no effect here", "move it to the domain")


def _notes_of(
    source: SourceText, names: Mapping[str, Collection[str]]
) -> Iterator[tuple[int, Note]]:
    for at, text in notes(source):
        kind, *words = text.lower().split() or [""]
        numbers = tuple(n for n in map(to_number, words[1:]) if n is not None)
        if kind not in _FORMS:
            message = f"there is no note {quote(kind)}"
            hint = nearest(kind, _FORMS) or f"notes are: {'; '.join(_FORMS.values())}"
            source.warn(at, "unknown-note", message, hint)
        elif len(words) != len(numbers) + 1 or not _is_valid(kind, numbers):
            message = f"{quote(text)} cannot be understood"
            source.warn(at, "bad-note", message, f"write ';; hrcplan: {_FORMS[kind]}'")
        elif words[0] not in names[kind]:
            message = f"the note names {quote(words[0])}, which is not declared"
            source.warn(at, "unknown-note", message, nearest(words[0], names[kind]))
        else:
            yield at, Note(kind, words[0], numbers)


def _is_valid(kind: str, numbers: tuple[Number, ...]) -> bool:
    if kind == "success":
        return len(numbers) == 1 and 0 <= numbers[0] <= 1
    return len(numbers) == 2 and numbers[0] <= numbers[1]
