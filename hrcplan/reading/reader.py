"""A text as a distribution over the steps that are possible now, and what to do about it."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import StrEnum

from hrcplan.reading.lexicon import Lexicon
from hrcplan.reading.mentions import Mention, Mentions, find_mentions
from hrcplan.reading.negations import GRAMMAR, REVERSALS, denies
from hrcplan.reading.tokens import split

MAX_OPTIONS = 4
MAX_WORDS = 40
ACT = 0.75
"""Probability from which a reading is acted on."""
_ACTION, _MORE_WORDS, _PART = 5.0, 0.7, 2.0
_OBJECT, _PART_OF_OBJECT = 4.0, 3.0
_OTHER_ACTION, _OTHER_OBJECT, _ODD_OBJECT = 3.0, 3.0, 0.7
_UNNAMED = 0.3
_ORDER = 1.0
_NONE = 2.0  # score of "no step at all"
_CLEAR = 0.5  # weight of words by which an action counts as named
_HINT = 0.4  # share of another action's name that makes a question
_CONTENT = 4  # letters of a word that may name something
_LEAST_PART = 0.35  # share of an object's name that is worth a question
_SURE = 0.8  # similarity from which a name is acted on
_LEAST = 0.9  # score of a step that is worth a question
_MOST_PRIOR = 1.5
_NEAR = 3.0  # options lie at most so far below the best step


class ReadingOutcome(StrEnum):
    """What to do with a text."""

    ACT = "act"
    ASK = "ask"
    REFUSE = "refuse"


@dataclass(frozen=True, slots=True)
class Reading:
    """What a text means among some steps.

    ``step`` is the index of the step to act on, else None. ``options`` are the likeliest steps with
    their probabilities, at most four, the best first: those to ask about. ``none`` is the
    probability that no step is meant.
    """

    outcome: ReadingOutcome
    step: int | None
    options: tuple[tuple[int, float], ...]
    none: float


_NOTHING = Reading(ReadingOutcome.REFUSE, None, (), 1.0)


def read_words(
    lexicon: Lexicon,
    text: str,
    steps: Sequence[Sequence[str]],
    prior: Sequence[float] | None = None,
) -> Reading:
    """Return which of ``steps`` a person means by ``text``.

    Args:
        lexicon: The words of the problem.
        text: What was said; anything beyond 400 characters or 40 words is not read.
        steps: The steps that the person can do now: ``(action, *objects)``, with agents or not.
        prior: The probability of each step before anything was said. Its square root is used, and
            within bounds: it decides between steps that the words leave equal.

    Raises:
        ValueError: if ``prior`` has another length than ``steps``.
    """
    if prior is not None and len(prior) != len(steps):
        raise ValueError(f"{len(steps)} steps with a prior of {len(prior)}")
    tokens = split(text)[:MAX_WORDS]
    if not tokens or not steps or denies(text, lexicon.words):
        return _NOTHING
    mentions = find_mentions(lexicon, tokens)
    scorer = _Scorer(lexicon, mentions, tokens)
    scores = [scorer.score(step) for step in steps]
    if not scorer.names_something:
        return _NOTHING
    if prior is not None:
        scores = [score + _bounded(p, len(steps)) for score, p in zip(scores, prior, strict=True)]
    return _decide(scorer, steps, scores)


def _bounded(probability: float, n: int) -> float:
    """Return the logarithm of the root of how much likelier than others a step is, bounded."""
    root = math.log(max(probability * n, 1e-9)) / 2
    return max(-_MOST_PRIOR, min(_MOST_PRIOR, root))


def _decide(scorer: _Scorer, steps: Sequence[Sequence[str]], scores: Sequence[float]) -> Reading:
    best = max(scores)
    weights = [math.exp(score - best) for score in scores]
    none = math.exp(_NONE - best)
    total = sum(weights) + none
    order = sorted(range(len(steps)), key=lambda i: (-weights[i], i))
    near = [i for i in order[:MAX_OPTIONS] if scores[i] > max(best - _NEAR, _LEAST)]
    if not near:
        return _NOTHING
    options = tuple((i, weights[i] / total) for i in near)
    first, probability = options[0]
    if probability >= ACT and scorer.is_sure(steps[first]):
        return Reading(ReadingOutcome.ACT, first, options, none / total)
    return Reading(ReadingOutcome.ASK, None, options, none / total)


class _Scorer:
    """Scores of steps for one text: what is named of them, less what else is named."""

    def __init__(self, lexicon: Lexicon, mentions: Mentions, tokens: Sequence[str]) -> None:
        self.lexicon = lexicon
        self.mentions = mentions
        self.tokens = tokens
        self.actions = {
            name: m for name, m in mentions.actions.items() if m.whole and m.weight >= _CLEAR
        }
        self.hints = [m for m in mentions.actions.values() if m.tells and not m.whole]
        self.objects = {
            name: m
            for name, m in mentions.objects.items()
            if m.whole and name not in lexicon.agents
        }

    @property
    def names_something(self) -> bool:
        """Whether an action is named, or an object by enough of its words."""
        parts = (
            mention.share
            for name, mention in self.mentions.objects.items()
            if mention.weight >= _CLEAR and name not in self.lexicon.agents
        )
        return bool(self.actions or self.objects) or max(parts, default=0) >= _LEAST_PART

    def score(self, step: Sequence[str]) -> float:
        """Return the evidence for a step; only differences to others and to ``_NONE`` matter."""
        others = (
            _OTHER_OBJECT if self._fits(name, step) else _ODD_OBJECT
            for name in self._other_objects(step)
        )
        rival = _OTHER_ACTION * max(self._rivals(step), default=0.0)
        return self._action(step[0]) + self._objects(step) - sum(others) - rival

    def is_sure(self, step: Sequence[str]) -> bool:
        """Return whether to do a step without asking: its action is named, and no other object.

        Where no object is named, a word that says nothing may be one. Without a word for the
        action, or if it is the word for an object, all that is said has to be names of the step.
        """
        if self._rivals(step) or any(self._fits(o, step) for o in self._other_objects(step)):
            return False
        named = [self.mentions.objects[name] for name in set(step[1:]) & self.objects.keys()]
        if any(mention.share < _SURE for mention in named) or not all(self._in_order(step)):
            return False
        action = self.actions.get(step[0])
        rest = set(range(self.mentions.n)) - self._explained(step) - self.mentions.other
        if any(m.share >= _HINT and rest.issuperset(m.at) for m in self.hints):
            return False
        if any(self.tokens[i] in REVERSALS for i in rest):
            return False
        unread = [self.tokens[i] for i in rest]
        if action is None or self._explained_by_objects(step).issuperset(action.explains):
            return bool(named) and not unread
        if self.lexicon.slots[step[0]] and not named and self.objects:
            return False
        is_open = not named and any(len(w) >= _CONTENT or w not in GRAMMAR for w in unread)
        return action.share >= _SURE and not (is_open and self.lexicon.slots[step[0]])

    def _fits(self, name: str, step: Sequence[str]) -> bool:
        return any(name in slot for slot in self.lexicon.slots.get(step[0], ()))

    def _explained(self, step: Sequence[str]) -> frozenset[int]:
        action = self.mentions.actions.get(step[0])
        places = frozenset[int]() if action is None else action.explains
        return places | self._explained_by_objects(step)

    def _explained_by_objects(self, step: Sequence[str]) -> frozenset[int]:
        mentions = [self.mentions.objects.get(name) for name in step[1:]]
        return frozenset().union(*(m.explains for m in mentions if m is not None))

    def _other_objects(self, step: Sequence[str]) -> Iterator[str]:
        explained = self._explained_by_objects(step)
        for name, mention in self.objects.items():
            if name not in step[1:] and not explained.issuperset(mention.at):
                yield name

    def _rivals(self, step: Sequence[str]) -> list[float]:
        """Return how much the words of other actions tell that the step does not explain.

        Of two names that share a word the longer counts: "add water" is more than "add to".
        """
        explained = self._explained(step)
        own = self.actions.get(step[0])

        def size(mention: Mention) -> int:
            return sum(len(self.tokens[i]) for i in mention.at)

        return [
            mention.weight
            for name, mention in self.actions.items()
            if name != step[0] and not explained.issuperset(mention.at)
            if own is None or not set(own.at) & set(mention.at) or size(mention) > size(own)
        ]

    def _in_order(self, step: Sequence[str]) -> list[bool]:
        """Return of each two objects that could change places whether they are named in order."""
        names = [name for name in step[1:] if name not in self.lexicon.agents]
        slots = self.lexicon.slots.get(step[0], ())
        both = list(zip(names, slots, strict=False))
        return [
            self.objects[one].at[0] < self.objects[other].at[0]
            for i, (one, slot) in enumerate(both)
            for other, other_slot in both[i + 1 :]
            if {one, other} <= self.objects.keys() and one in other_slot and other in slot
        ]

    def _action(self, name: str) -> float:
        mention = self.mentions.actions.get(name)
        if mention is None:
            return 0.0
        if not mention.whole:
            return _PART * mention.share * mention.weight
        more = _MORE_WORDS * sum(map(self.lexicon.weight, (self.tokens[i] for i in mention.at[1:])))
        return (_ACTION * mention.weight + more) * mention.share

    def _objects(self, step: Sequence[str]) -> float:
        total = 0.0
        for name in step[1:]:
            mention = self.mentions.objects.get(name)
            if mention is None:
                total -= 0.0 if name in self.lexicon.agents else _UNNAMED
            elif mention.whole:
                total += _OBJECT * mention.share
            else:
                total += _PART_OF_OBJECT * mention.share
        return total + _ORDER * sum(1 if right else -1 for right in self._in_order(step))
