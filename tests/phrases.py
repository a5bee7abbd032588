"""The phrases of ``tests/data/phrases``, read in states of walks, and how well they were read."""

import random
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from pathlib import Path

from hrcplan import ground
from hrcplan.pddl.conventions import people
from hrcplan.pddl.inputs import read
from hrcplan.pddl.library import problem_names
from hrcplan.pddl.model import Problem
from hrcplan.reading import Lexicon, ReadingOutcome, Reading
from hrcplan.task import Task

FOLDER = Path(__file__).parent / "data" / "phrases"
TUNE, TEST = "tune", "test"
KITCHEN = ("kitchen", "kitchen-recipes", "kitchen-alfred")
PROBLEMS = {
    "kitchen": [f"kitchen/{name}" for name in problem_names("kitchen")],
    "transport": ["transport/two-boxes", "transport/handover", "transport/boxes-3"],
    "blocks": ["block-words"],
    "household": ["viplan_hh"],
    "werkstatt": ["werkstatt"],
}
N_STATES = 4  # in which a phrase is read
_STRAY = 0.25  # of the steps of a walk are any steps
_LENGTH = 60

Words = tuple[str, ...]


@dataclass(frozen=True)
class Saying:
    """A phrase and what it means: patterns of steps, none for no step."""

    share: str
    meanings: tuple[str, ...]
    phrase: str

    def among(self, steps: Sequence[Words]) -> frozenset[int]:
        """Return which of ``steps``, given without agents, the phrase means."""
        texts = [" ".join(step) for step in steps]
        return frozenset(
            i for i, text in enumerate(texts) if any(fnmatchcase(text, m) for m in self.meanings)
        )


@dataclass(frozen=True)
class Moment:
    """A state: what the human can do there, as said to the reader and without the agent."""

    steps: tuple[Words, ...]
    bare: tuple[Words, ...]


def sayings(name: str, share: str) -> list[Saying]:
    """Return the phrases of a file that are in a share."""
    lines = (FOLDER / f"{name}.txt").read_text().splitlines()
    parts = [[p.strip() for p in line.split("|")] for line in lines if not line.startswith("#")]
    return [
        Saying(part[0], () if part[1] == "-" else tuple(part[1].split(" / ")), part[2])
        for part in parts
        if part[0] == share
    ]


def problem_called(name: str) -> Problem:
    """Return a problem by its name in ``PROBLEMS``."""
    data = FOLDER.parent
    if name == "block-words":
        folder = data / "goal-recognition" / "block-words_p01_hyp-0_full"
        goal = (folder / "hyps.dat").read_text().splitlines()[0].replace(",", " ")
        text = (folder / "template.pddl").read_text().replace("<HYPOTHESIS>", goal)
        return read((folder / "domain.pddl").read_text(), text)
    if name == "viplan_hh":
        folder = data / "public" / "unified-planning" / name
        return read(str(folder / "domain.pddl"), str(folder / "problem.pddl"))
    if name == "werkstatt":
        return read(str(FOLDER / name / "domain.pddl"), str(FOLDER / name / "hocker.pddl"))
    return read(*name.split("/"))


def moments(problem: Problem, n_walks: int) -> list[Moment]:
    """Return states of walks that mostly do what the goal needs, some of the beginning first."""
    task = ground(problem)
    human = min(people(problem), default=None)
    needed = _needed(task)
    seen: dict[int, Moment] = {}
    for seed in range(n_walks):
        dice = random.Random(seed)
        state = task.initial
        for _ in range(_LENGTH):
            seen.setdefault(state, _moment(task, state, human))
            can = task.applicable(state)
            useful = [i for i in can if i in needed]
            if not can:
                break
            strays = not useful or dice.random() < _STRAY
            state = task.successor(state, dice.choice(can if strays else useful))
    return list(seen.values())


def _moment(task: Task, state: int, human: str | None) -> Moment:
    actions = [task.actions[i] for i in task.applicable(state)]
    mine = [a for a in actions if a.agent in (None, human)]
    return Moment(tuple((a.name, *a.args) for a in mine), tuple(a.step for a in mine))


def _needed(task: Task) -> frozenset[int]:
    """Return the actions that may be needed for the goal: those that add what it or they need."""
    wanted = sum(test[1] for test in task.goal)
    needed: set[int] = set()
    while True:
        new = {a.index for a in task.actions if a.adds & wanted} - needed
        if not new:
            return frozenset(needed)
        needed |= new
        for i in new:
            for test in task.actions[i].start:
                wanted |= test[1]


@dataclass(frozen=True)
class Score:
    """How often a reading was right, asked, refused, or wrong without asking.

    ``wrong`` counts steps that were acted on and not meant. ``impossible`` are readings of phrases
    that mean a step which the state does not allow; only wrong ones are counted there.
    """

    n: int
    right: int
    asked: int
    offered: int
    wrong: int
    impossible: int
    wrong_impossible: int
    misses: tuple[str, ...]

    @property
    def right_share(self) -> float:
        return self.right / self.n

    @property
    def wrong_share(self) -> float:
        return (self.wrong + self.wrong_impossible) / (self.n + self.impossible)

    @property
    def right_or_asked_share(self) -> float:
        return (self.right + self.offered) / self.n


Read = Callable[[Lexicon, str, Sequence[Words]], Reading]


def trial(
    name: str,
    share: str,
    lexicons: dict[str, Lexicon],
    scenes: dict[str, list[Moment]],
    read_it: Read,
) -> Score:
    """Read the phrases of a file, each in up to four states in which it means something."""
    count: Counter[str] = Counter()
    misses = []
    for k, saying in enumerate(sayings(name, share)):
        for problem, moment, possible in _occasions(saying, scenes, k):
            meant = saying.among(moment.bare)
            reading = read_it(lexicons[problem], saying.phrase, moment.steps)
            verdict = _judge(reading, meant, bool(saying.meanings))
            if not possible:
                count["impossible"] += 1
                count["wrong_impossible"] += reading.outcome is ReadingOutcome.ACT
            else:
                count["n"] += 1
                count[verdict] += 1
            if verdict != "right" and (possible or reading.outcome is ReadingOutcome.ACT):
                shown = [" ".join(moment.bare[i]) + f" {p:.2f}" for i, p in reading.options]
                wanted = " / ".join(saying.meanings) or "-"
                misses.append(
                    f"{verdict}{'' if possible else ' (impossible)'}: {saying.phrase!r} = {wanted} ({len(meant)}): {shown} none {reading.none:.2f}"
                )
    return Score(
        count["n"], count["right"], count["asked"] + count["offered"], count["offered"],
        count["wrong"], count["impossible"], count["wrong_impossible"], tuple(misses),
    )  # fmt: skip


def _occasions(
    saying: Saying, scenes: dict[str, list[Moment]], k: int
) -> Iterator[tuple[str, Moment, bool]]:
    """Yield states in which the phrase means a step, spread over the problems, and one of others."""
    every = [(name, moment) for name, some in scenes.items() for moment in some]
    random.Random(k).shuffle(every)
    fits = [(n, m) for n, m in every if not saying.meanings or saying.among(m.bare)]
    assert fits, saying
    for name, moment in fits[:N_STATES]:
        yield name, moment, True
    if saying.meanings:
        for name, moment in [(n, m) for n, m in every if not saying.among(m.bare)][:1]:
            yield name, moment, False


def _judge(reading: Reading, meant: frozenset[int], means: bool) -> str:
    if reading.outcome is ReadingOutcome.ACT:
        return "right" if meant == {reading.step} else "wrong"
    if reading.outcome is ReadingOutcome.REFUSE:
        return "refused" if means else "right"
    offered = bool(meant & {i for i, _ in reading.options})
    if offered and len(meant) > 1:
        return "right"
    return "offered" if offered else "asked"
