"""The words of a problem: what its actions, objects and types are called."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from hrcplan.pddl.model import Action, Domain, Problem
from hrcplan.reading.tokens import split, weight

Phrase = tuple[str, ...]
Phrases = Mapping[str, tuple[Phrase, ...]]
WordsByInitial = Mapping[str, tuple[str, ...]]
_AGENT = ("agent",)
_TELLS = 0.9  # weight of a word that can stand for a name of several words


@dataclass(frozen=True)
class Lexicon:
    """What people can call actions and objects: names of the PDDL, and its notes.

    ``slots`` are the objects that each parameter of an action can be, agents left out. ``telling``
    are parts of objects' names that no other object has: one of them is enough; ``hinting`` are
    words that one action alone has; ``names`` are the names of one word that actions have in the
    PDDL. The words are those of the phrases by their first letter; words for types name no object,
    unless it is the only one of the type.
    """

    actions: Phrases
    objects: Phrases
    agents: frozenset[str]
    slots: Mapping[str, tuple[frozenset[str], ...]]
    telling: frozenset[str]
    hinting: frozenset[str]
    names: frozenset[str]
    action_words: WordsByInitial
    object_words: WordsByInitial
    type_words: WordsByInitial
    words: frozenset[str]

    def weight(self, word: str) -> float:
        """Return how much a word tells, 0 to 1: the name of an action tells, however short."""
        return 1.0 if word in self.names else weight(word)


def make_lexicon(problem: Problem) -> Lexicon:
    """Return the words for the actions and objects of a problem.

    A name counts as its parts (``serving-spoon``: serving, spoon; ``wp3``: wp, 3). Notes ``say``
    and ``call`` add to it.
    """
    domain = problem.domain
    actions = {action.name: {split(action.name)} for action in domain.actions}
    objects = {name: {split(name)} for name in problem.all_objects}
    types = {name: {split(name)} for name in domain.types}
    telling = _telling(objects)
    for note in (*domain.notes, *problem.notes):
        groups = {"say": (actions,), "call": (objects, types)}.get(note.kind, ())
        for group in groups:
            if note.name in group:
                group[note.name].update(map(split, note.phrases))
    for name, phrases in types.items():
        only = problem.objects_of((name,))
        if len(only) == 1:
            objects[only[0]].update(phrases)
    words = _words([*actions.values(), *objects.values(), *types.values()])
    return Lexicon(
        _sorted(actions),
        _sorted(objects),
        frozenset(problem.agents),
        {action.name: _slots(problem, action) for action in domain.actions},
        telling,
        _telling(actions),
        frozenset(name for name in domain.schemas if split(name) == (name,)),
        _by_initial(_words(actions.values())),
        _by_initial(_words(objects.values())),
        _by_initial(_words(types.values())),
        frozenset(words),
    )


def _telling(names: Mapping[str, set[Phrase]]) -> frozenset[str]:
    owners = Counter(word for phrases in names.values() for word in set(_words([phrases])))
    return frozenset(w for w, n in owners.items() if n == 1 and weight(w) >= _TELLS)


def _words(groups: Iterable[Iterable[Phrase]]) -> list[str]:
    return [word for phrases in groups for phrase in phrases for word in phrase]


def _sorted(names: Mapping[str, set[Phrase]]) -> Phrases:
    """Return the phrases with the longest first; names of signs only have none."""
    return {
        name: tuple(sorted(filter(None, phrases), key=lambda p: (-len(p), p)))
        for name, phrases in names.items()
    }


def _slots(problem: Problem, action: Action) -> tuple[frozenset[str], ...]:
    types = [p.types for p in action.params if not _is_agent(problem.domain, p.types)]
    return tuple(frozenset(problem.objects_of(some)) for some in types)


def _is_agent(domain: Domain, types: tuple[str, ...]) -> bool:
    return all(domain.is_a(name, _AGENT) for name in types)


def _by_initial(words: Iterable[str]) -> WordsByInitial:
    groups = defaultdict(list)
    for word in sorted(set(words)):
        groups[word[0]].append(word)
    return {initial: tuple(group) for initial, group in groups.items()}
