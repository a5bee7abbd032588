"""Which actions and objects a text names, and where."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from hrcplan.reading.lexicon import Lexicon, Phrase, Phrases, WordsByInitial
from hrcplan.reading.tokens import similarity, weight

MAX_GAP = 6  # words between two words of an action: "turn the heat of the stove down"
MAX_OBJECT_GAP = 2  # "spoon for eating"
_PART_TELLS = 0.8  # share of a name that a telling part of it counts as
_CLOSE = 0.05  # likenesses to one word that differ less compete

WordPlaces = Mapping[str, Sequence[tuple[int, float]]]
"""For each word of the lexicon the places where a text has it, with the similarities there."""


@dataclass(frozen=True, slots=True)
class Mention:
    """How a text names an action or an object.

    ``share`` is how much of the name is there, 0 to 1, ``whole`` whether all of it is, ``tells``
    whether it has a word of no other name, ``weight`` how much its words say. ``at`` are the places
    of the name, ``explains`` those of all names.
    """

    share: float
    whole: bool
    tells: bool
    weight: float
    at: tuple[int, ...]
    explains: frozenset[int]


NamesMentions = Mapping[str, Mention]


@dataclass(frozen=True, slots=True)
class Mentions:
    """What a text of ``n`` words names; ``other`` are places that only a type's name explains."""

    n: int
    actions: NamesMentions
    objects: NamesMentions
    other: frozenset[int]


def find_mentions(lexicon: Lexicon, tokens: Sequence[str]) -> Mentions:
    """Return the actions and objects that the words of a text name, in whole or in part."""
    types = _places(lexicon.type_words, tokens)
    places = _places(lexicon.action_words, tokens, every=True)
    actions = _named(lexicon.actions, places, lexicon.hinting, lexicon.weight)
    places = _places(lexicon.object_words, tokens)
    objects = _named(lexicon.objects, places, lexicon.telling)
    return Mentions(
        len(tokens),
        _without(actions, objects),
        _without(objects, actions),
        frozenset(at for some in types.values() for at, _ in some),
    )


def _without(mentions: NamesMentions, others: NamesMentions) -> NamesMentions:
    """Return the mentions whose words do not name something else better: "blender" is no blend."""
    better = [(other.share, set(other.at)) for other in others.values() if other.whole]
    return {
        name: m
        for name, m in mentions.items()
        if not any(share > m.share and at.issuperset(m.at) for share, at in better)
    }


def _places(words: WordsByInitial, tokens: Sequence[str], every: bool = False) -> WordPlaces:
    """Return where words are in a text.

    A token means the words that it is most like, or ``every`` word that it is a form of: "adding"
    is "add", even if some action is "start adding"; but no "potato" is a "pot".
    """
    places = defaultdict(list)
    for at, token in enumerate(tokens):
        likeness = {w: similarity(token, w) for w in words.get(token[0], ())}
        joined = f"{token}{tokens[at + 1]}" if at + 1 < len(tokens) else token
        best = max(likeness.values(), default=0.0)
        for word, value in likeness.items():
            if value > (0 if every else max(0, best - _CLOSE)):
                places[word].append((at, value))
            elif word == joined:
                places[word].append((at, 1.0))
    return places


def _named(
    phrases_of: Phrases,
    places: WordPlaces,
    telling: frozenset[str],
    weigh_action: Callable[[str], float] | None = None,
) -> NamesMentions:
    """Return what is named: actions in order, objects in any order or by a telling part."""
    matches = {
        name: [m for phrase in phrases for m in _matches(phrase, places, telling, weigh_action)]
        for name, phrases in phrases_of.items()
        if any(word in places for phrase in phrases for word in phrase)
    }
    wholes = [set(m.at) for some in matches.values() for m in some if m.whole]
    named = {}
    for name, some in matches.items():
        # "olive oil" names oil and no olives: what lies within a longer name is not named.
        whole = [m for m in some if m.whole and not any(set(m.at) < other for other in wholes)]
        best = max(whole or some, key=_rank, default=None)
        if best is not None and best.whole <= bool(whole):
            explains = frozenset(at for m in (whole or [best]) for at in m.at)
            named[name] = replace(best, explains=explains)
    return named


def _rank(mention: Mention) -> tuple[bool, float, float, int]:
    return mention.whole, mention.share * mention.weight, mention.share, len(mention.at)


def _matches(
    phrase: Phrase,
    places: WordPlaces,
    telling: frozenset[str],
    weigh_action: Callable[[str], float] | None,
) -> Iterator[Mention]:
    """Yield the ways in which a text holds a phrase, one for each place where it can begin."""
    in_order = weigh_action is not None
    starts = places.get(phrase[0], ()) if in_order else ()
    starts = starts or [place for word in phrase for place in places.get(word, ())]
    size = sum(map(len, phrase))
    for start, _ in starts:
        similarities, at = _align(phrase, places, start, in_order)
        there = {word: s for word, s in zip(phrase, similarities, strict=True) if s}
        if there:
            share = sum(len(word) * s for word, s in there.items()) / size
            part = max((s for word, s in there.items() if word in telling), default=0.0)
            whole = all(similarities)
            if part and not (whole or in_order):
                share, whole = max(share, _PART_TELLS * part), True
            weighs = max(map(weigh_action or weight, there))
            yield Mention(share, whole, part > 0, weighs, tuple(at), frozenset(at))


def _align(
    phrase: Phrase, places: WordPlaces, start: int, in_order: bool
) -> tuple[list[float], list[int]]:
    """Return for each word of a phrase how like it the text's word is, and the places of these."""
    at: list[int] = []
    similarities = []
    gap = MAX_GAP if in_order else MAX_OBJECT_GAP
    for word in phrase:
        near = at[-1] if at else start
        least = near if in_order else near - gap - 1
        can = [
            (abs(i - near), -value, i)
            for i, value in places.get(word, ())
            if i not in at and least <= i <= near + gap + 1
        ]
        if can:
            _, value, place = min(can)
            at.append(place)
            similarities.append(-value)
        else:
            similarities.append(0.0)
    return similarities, at
