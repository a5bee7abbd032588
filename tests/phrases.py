"""The phrases of ``tests/data/phrases``, read in states of walks, and how well they were read."""

import random
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from fnmatch import fnmatchcase
from pathlib import Path

from hrcplan import ground
from hrcplan.pddl.conventions import people
from hrcplan.pddl.inputs import read
from hrcplan.pddl.library import find_goals, problem_names
from hrcplan.pddl.model import Problem
from hrcplan.reading import Lexicon, Reading, ReadingOutcome, make_lexicon
from hrcplan.task import Task

FOLDER = Path(__file__).parent / "data" / "phrases"
TUNE, TEST, LATER = "tune", "test", "later"
KITCHEN = ("kitchen", "kitchen-recipes", "kitchen-alfred")
OTHERS = ("transport", "blocks", "household", "werkstatt", "flat", "yard")
_LENGTH = 60
_STRAY = 0.25  # of the steps of a walk are any steps
N_WALKS = {"flat": 40, "yard": 20}  # by domain; else 6 of each problem
_N_STATES = 4  # in which a phrase is read

Words = tuple[str, ...]
Read = Callable[[Lexicon, str, Sequence[Words]], Reading]


@dataclass(frozen=True)
class Saying:
    """A phrase and what it means: patterns of steps, none for no step."""

    meanings: tuple[str, ...]
    phrase: str

    def means(self, step: Words) -> bool:
        """Return whether the phrase means a step, given without agents."""
        return any(fnmatchcase(" ".join(step), meaning) for meaning in self.meanings)


@dataclass(frozen=True)
class Moment:
    """What a human can do in a state: as said to the reader, and without agents."""

    lexicon: Lexicon
    steps: tuple[Words, ...]
    bare: tuple[Words, ...]


@dataclass(frozen=True)
class Trial:
    """One reading, and which of the steps were meant: none if none of them is possible."""

    saying: Saying
    moment: Moment
    meant: frozenset[int]
    reading: Reading

    @property
    def is_right(self) -> bool:
        """Whether the likeliest step is meant, or nothing would be done where nothing is meant."""
        if not self.meant:
            return not self.is_acted
        return any(i in self.meant for i, _ in self.reading.options[:1])

    @property
    def is_acted(self) -> bool:
        """Whether a step would be done without a question."""
        return self.reading.outcome is ReadingOutcome.ACT

    @property
    def is_wrong(self) -> bool:
        """Whether another step than the one meant, or one of several, would be done unasked."""
        return self.is_acted and self.meant != {self.reading.step}

    @property
    def is_offered(self) -> bool:
        """Whether a question names a step that is meant."""
        named = {i for i, _ in self.reading.options}
        return self.reading.outcome is ReadingOutcome.ASK and bool(self.meant & named)

    @property
    def can_be_meant(self) -> bool:
        """Whether this is no reading of a step which the state does not allow."""
        return bool(self.meant) or not self.saying.meanings


def sayings(name: str, share: str) -> list[Saying]:
    """Return the phrases of a file that are in a share."""
    lines = (FOLDER / f"{name}.txt").read_text().splitlines()
    rows = [[p.strip() for p in line.split("|")] for line in lines if not line.startswith("#")]
    return [
        Saying(() if meaning == "-" else tuple(meaning.split(" / ")), phrase)
        for part, meaning, phrase in rows
        if part == share
    ]


def problems_of(name: str) -> list[Problem]:
    """Return the problems whose states the phrases of a file are about."""
    data = FOLDER.parent
    match name:
        case "blocks":
            folder = data / "goal-recognition" / "block-words_p01_hyp-0_full"
            goal = (folder / "hyps.dat").read_text().splitlines()[0].replace(",", " ")
            text = (folder / "template.pddl").read_text().replace("<HYPOTHESIS>", goal)
            return [read((folder / "domain.pddl").read_text(), text)]
        case "household":
            folder = data / "public" / "unified-planning" / "viplan_hh"
            return [read(str(folder / "domain.pddl"), str(folder / "problem.pddl"))]
        case "werkstatt":
            folder = FOLDER / name
            return [read(str(folder / "domain.pddl"), str(folder / "hocker.pddl"))]
        case "flat":
            return [read("household", "party")]
        case "yard":
            return [read("transport", str(find_goals("transport-goals") / "together.pddl"))]
        case "transport":
            return [read(name, problem) for problem in ("two-boxes", "handover", "boxes-3")]
    return [read("kitchen", problem) for problem in problem_names("kitchen")]


def names_only(problem: Problem) -> Problem:
    """Return a problem without notes."""
    return replace(problem, notes=(), domain=replace(problem.domain, notes=()))


def moments(problem: Problem, n_walks: int) -> list[Moment]:
    """Return states of walks that do what the goal may need, and now and then something else."""
    task = ground(problem)
    lexicon = make_lexicon(problem)
    human = min(people(problem), default=None)
    needed = _needed(task)
    seen: dict[int, Moment] = {}
    for seed in range(n_walks):
        dice = random.Random(seed)
        state = task.initial
        for _ in range(_LENGTH):
            can = task.applicable(state)
            mine = [task.actions[i] for i in can if task.actions[i].agent in (None, human)]
            steps = tuple((action.name, *action.args) for action in mine)
            seen.setdefault(state, Moment(lexicon, steps, tuple(a.step for a in mine)))
            useful = [i for i in can if i in needed]
            if not can:
                break
            strays = not useful or dice.random() < _STRAY
            state = task.successor(state, dice.choice(can if strays else useful))
    return list(seen.values())


def _needed(task: Task) -> frozenset[int]:
    """Return the actions that may be needed for the goal: those that add what it or they need."""
    wanted = 0
    for test in task.goal:
        wanted |= test[1]
    needed: set[int] = set()
    while new := {a.index for a in task.actions if a.adds & wanted} - needed:
        needed |= new
        for i in new:
            for test in task.actions[i].start:
                wanted |= test[1]
    return frozenset(needed)


def trials(
    sayings: Sequence[Saying], scenes: Sequence[Moment], read_words: Read
) -> Iterator[Trial]:
    """Yield readings of phrases: each in four states in which it means a step, and in another."""
    every = {step for moment in scenes for step in moment.bare}
    for k, saying in enumerate(sayings):
        meant = {step for step in every if saying.means(step)}
        order = random.Random(k).sample(scenes, len(scenes))
        fit = [m for m in order if not meant.isdisjoint(m.bare)]
        others = [m for m in order if meant.isdisjoint(m.bare)]
        assert bool(fit) == bool(saying.meanings), f"no state allows {saying}"
        for moment in [*fit[:_N_STATES], *others[: 1 if fit else _N_STATES]]:
            reading = read_words(moment.lexicon, saying.phrase, moment.steps)
            indices = frozenset(i for i, step in enumerate(moment.bare) if step in meant)
            yield Trial(saying, moment, indices, reading)
