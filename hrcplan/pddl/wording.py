"""Words of ``say`` and ``call`` notes that two steps or two objects share."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

from hrcplan.core.text import quote
from hrcplan.pddl.model import Action, Domain, Note
from hrcplan.pddl.source import SourceText

_AGENT = ("agent",)


def warn_alike(
    source: SourceText,
    domain: Domain,
    objects: Mapping[str, str],
    read: Sequence[tuple[int, Note]],
    above: Iterable[Note] = (),
) -> None:
    """Warn about words that a note gives to one action or object and that mean another, too.

    Two actions read alike if they take objects of the same types, two objects if both fit one
    parameter of an action. Words that are shared otherwise do no harm: the rest of a phrase tells.
    ``above`` are notes of another file, which mean what they mean without a warning here.
    """
    if not read:
        return
    actions = {name: {_plain(name)} for name in domain.schemas}
    names = {name: {_plain(name)} for name in objects}
    phrases_of = {"say": actions, "call": names}
    for note in above:
        phrases_of.get(note.kind, {}).get(note.name, set()).update(note.phrases)
    for at, note in read:
        phrases = phrases_of.get(note.kind, {})
        if note.name not in phrases:
            continue
        for phrase in note.phrases:
            for other in _others(phrases, note.name, phrase):
                if _interchangeable(domain, objects, note, other):
                    message = f"{quote(phrase)} means {quote(note.name)} and {quote(other)}"
                    hint = "people who say it will be asked which they mean"
                    source.warn(at, "reads-alike", message, hint)
        phrases[note.name].update(note.phrases)


def _plain(name: str) -> str:
    return " ".join(name.replace("_", " ").replace("-", " ").split())


def _others(names: Mapping[str, set[str]], name: str, phrase: str) -> Iterator[str]:
    return (other for other, phrases in names.items() if other != name and phrase in phrases)


def _interchangeable(domain: Domain, objects: Mapping[str, str], note: Note, other: str) -> bool:
    if note.kind == "say":
        return _take_alike(domain, domain.action(note.name), domain.action(other))
    slots = [p.types for action in domain.actions for p in action.params]
    both = (objects[note.name], objects[other])
    return any(all(domain.is_a(name, types) for name in both) for types in slots)


def _take_alike(domain: Domain, one: Action, other: Action) -> bool:
    """Return whether the actions have equally many objects, pairwise of comparable types."""

    def slots(action: Action) -> list[tuple[str, ...]]:
        every = [p.types for p in action.params]
        return [t for t in every if not all(domain.is_a(name, _AGENT) for name in t)]

    def overlap(a: tuple[str, ...], b: tuple[str, ...]) -> bool:
        return any(domain.is_a(x, b) for x in a) or any(domain.is_a(y, a) for y in b)

    mine, theirs = slots(one), slots(other)
    return len(mine) == len(theirs) and all(map(overlap, mine, theirs))
