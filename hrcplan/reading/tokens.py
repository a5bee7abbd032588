"""Text as words that can be compared: folded, split, and alike or not, in any language."""

from __future__ import annotations

import re
import unicodedata

from rapidfuzz.distance import OSA

MAX_CHARACTERS = 400
"""A longer text is read up to here: people do not say a step in more."""
MIN_STEM = 3  # letters that two forms of a word must share at least
MAX_ENDING = 4  # letters that an inflection may add
MAX_LOSS = 2  # letters of a word that a form may lack: "hol" of "holen"
_LONG_STEM = 5
_VOWELS = frozenset("aeiou")
# Ideographs are words by themselves, as nothing separates them; digits stand apart from letters.
_IDEOGRAPH = "\u3040-\u30ff\u3400-\u9fff\uf900-\ufaff"
_WORD = re.compile(rf"[{_IDEOGRAPH}]|\d+|[^\W\d_{_IDEOGRAPH}]+")


def fold(text: str) -> str:
    """Return ``text`` without case and accents.

    >>> fold("Purée, STRASSE straße")
    'puree, strasse strasse'
    """
    marked = unicodedata.normalize("NFKD", text[:MAX_CHARACTERS].casefold())
    return "".join(c for c in marked if not unicodedata.combining(c))


def split(text: str) -> tuple[str, ...]:
    """Return the words of a text or of a PDDL name, folded.

    >>> split("Turn_on wp3, l'huile!")
    ('turn', 'on', 'wp', '3', 'l', 'huile')
    """
    return tuple(_WORD.findall(fold(text)))


def similarity(token: str, word: str) -> float:
    """Return how surely a token is a form of a word, 0 to 1.

    Equal words have 1. Two forms of one word share its beginning: one is the other with an ending,
    or their endings differ. Longer words may have a typing mistake. The first letter must be right.

    >>> similarity("grabbed", "grab"), similarity("taking", "take"), similarity("berry", "berries")
    (0.9, 0.85, 0.9)
    >>> similarity("cinamon", "cinnamon"), similarity("salad", "salt")
    (0.875, 0.0)
    """
    if token == word:
        return 1.0
    if token[0] != word[0] or token.isdigit():
        return 0.0
    stems = _inflected(_stem(token), _stem(word))
    return max(_inflected(token, word), stems, _mistyped(token, word))


def _stem(word: str) -> str:
    return f"{word[:-1]}i" if word[-1] == "y" else word  # berry, berries; fry, fried


def _inflected(token: str, word: str) -> float:
    shared = next(
        (i for i, (a, b) in enumerate(zip(token, word, strict=False)) if a != b),
        min(len(token), len(word)),
    )
    rests = token[shared:], word[shared:]
    if shared < MIN_STEM or max(map(len, rests)) > MAX_ENDING:
        return 0.0
    if not all(rests):
        most = MAX_LOSS if rests[1] else shared + 1  # getting: get, t, ing
        return 0.9 if max(map(len, rests)) <= most else 0.0
    if rests[1] in _VOWELS or shared >= _LONG_STEM:
        return 0.85
    return 0.7 if shared > MIN_STEM and len(rests[1]) <= MIN_STEM else 0.0


def _mistyped(token: str, word: str) -> float:
    size = max(len(token), len(word))
    allowed = 0 if size <= 4 else 1 if size < 8 else 2
    if abs(len(token) - len(word)) > allowed or allowed == 0:
        return 0.0
    distance = OSA.distance(token, word, score_cutoff=allowed)
    return 1 - distance / size if distance <= allowed else 0.0


def weight(word: str) -> float:
    """Return how much a word tells, 0 to 1: words such as "in" stand in most sentences.

    >>> weight("in"), weight("mix"), weight("pour")
    (0.3, 0.9, 1.0)
    """
    if not word.isascii() or word.isdigit():
        return 1.0
    return (0.0, 0.1, 0.3, 0.9)[len(word)] if len(word) < 4 else 1.0
