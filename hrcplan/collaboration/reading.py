"""The interface of readers: what a person says, to the action that is meant.

`read_exactly` takes an action's own words, `reader_of` free text, too.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

from hrcplan.collaboration.events import ACT, ASK, NONE
from hrcplan.pddl.model import Problem
from hrcplan.reading import ReadingOutcome, make_lexicon, read_words

MAX_OPTIONS = 4
ActionWords = tuple[str, ...]
"""A ground action: its name and its objects."""


@dataclass(frozen=True, slots=True)
class StepReading:
    """What was understood: ``act`` (one option), ``ask`` (which of the options?), or ``none``."""

    outcome: str
    options: tuple[ActionWords, ...] = ()


class Reader(Protocol):
    """Finds the action that a person means."""

    def __call__(
        self, text: str, steps: Sequence[ActionWords], prior: Mapping[ActionWords, float]
    ) -> StepReading:
        """Return what a text means.

        Args:
            text: What was said.
            steps: The ground actions that the person could begin now.
            prior: How probable each of them is, as far as the belief says.
        """


def read_exactly(
    text: str, steps: Sequence[ActionWords], prior: Mapping[ActionWords, float]
) -> StepReading:
    """Return the action that a text names in PDDL: with or without parentheses and agent.

    >>> read_exactly("get yogurt", [("get", "human", "yogurt")], {})
    StepReading(outcome='act', options=(('get', 'human', 'yogurt'),))
    """
    words = tuple(text.lower().replace("(", " ").replace(")", " ").split())
    fitting = [step for step in steps if words in (step, (step[0], *step[2:]))]
    if not fitting or not words:
        return StepReading(NONE)
    if len(fitting) == 1:
        return StepReading(ACT, (fitting[0],))
    likeliest = sorted(fitting, key=lambda step: -prior.get(step, 0.0))
    return StepReading(ASK, tuple(likeliest[:MAX_OPTIONS]))


def named_agent(text: str, problem: Problem) -> str | None:
    """Return the agent that a text names as the one who acts; None if it names none.

    It is the first word (``bob: wash``, ``bob washes``), or the second of an action in PDDL. In
    other places an agent's name may be an object: "hand bob the soup".
    """
    words = text.lower().replace("(", " ").replace(")", " ").split()
    if not words:
        return None
    agents = {*problem.agents} - problem.domain.schemas.keys()
    if words[0].rstrip(":,") in agents:
        return words[0].rstrip(":,")
    schema = problem.domain.schemas.get(words[0])
    is_whole = schema is not None and len(words) == len(schema.params) + 1 > 1
    return words[1] if is_whole and words[1] in agents else None


def reader_of(problem: Problem) -> Reader:
    """Return the reader of a problem: exact words first, then free text (`hrcplan.reading`)."""
    lexicon = make_lexicon(problem)

    def read(
        text: str, steps: Sequence[ActionWords], prior: Mapping[ActionWords, float]
    ) -> StepReading:
        exact = read_exactly(text, steps, prior)
        if exact.outcome != NONE or not steps:
            return exact
        chances = [prior.get(step, 0.0) for step in steps] if prior else None
        reading = read_words(lexicon, text, steps, chances)
        if reading.outcome is ReadingOutcome.ACT and reading.step is not None:
            return StepReading(ACT, (steps[reading.step],))
        if reading.outcome is ReadingOutcome.ASK:
            return StepReading(ASK, tuple(steps[i] for i, _ in reading.options))
        return StepReading(NONE)

    return read
