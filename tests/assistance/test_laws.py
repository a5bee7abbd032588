"""The laws of assistants, kept by ours in worlds of both kinds, and broken on purpose."""

from dataclasses import dataclass, field, replace
from itertools import pairwise

import numpy as np
import pytest

from hrcplan.assistance import ASSISTANTS
from hrcplan.assistance.expected_help import ExpectedHelp
from hrcplan.assistance.step_values import StepValues
from hrcplan.bank.progress import ProgressTracker
from hrcplan.core.deprecation import OldNameWarning
from hrcplan.inference.classifier.forest import ForestBelief
from hrcplan.inference.exact import ExactBelief
from hrcplan.testing import check_assistant, check_belief

NAMES = ["recursive", "recursive-best", "cdp", "infogain", "hrcplan", "oracle"]


def runs(bank, walk):
    """Return plans of every goal, plans that turn to another, and walks without a purpose."""
    plans = [next(bank.plans(goal)) for goal in range(len(bank.names))]
    turned = [(*a[:2], *b) for a, b in pairwise(plans)]
    return [*plans, *(possible(bank, run) for run in turned), *(walk(bank, s, 5) for s in range(3))]


def possible(bank, steps):
    state, found = bank.initial, []
    for step in steps:
        after = bank.table.successor(state, step)
        if after not in (None, state):
            state = after
            found.append(step)
    return tuple(found)


@pytest.mark.parametrize("world", ["workshop", "hall"])
@pytest.mark.parametrize("name", NAMES)
def test_every_assistant_keeps_the_laws(request, walk, world, name):
    bank = request.getfixturevalue(world)
    assert (bank.agents == "kept") == (world == "hall")
    kind = ASSISTANTS.find(name)
    small = {"belief": ForestBelief(bank, n_samples=3000, n_trees=10)}
    assistant = kind(bank, **(small if name in ("cdp", "infogain") else {}))
    check_assistant(assistant, bank, runs(bank, walk))


@pytest.mark.parametrize("world", ["workshop", "hall"])
def test_the_robot_has_something_to_do(request, world):
    """Else the laws of choices would be kept by doing nothing."""
    bank = request.getfixturevalue(world)
    for kind in (ASSISTANTS.find(name) for name in NAMES[:2]):
        assistant = kind(bank)
        firsts = [next(bank.plans(goal))[0] for goal in range(len(bank.names))]
        states = [assistant.observe(assistant.start(), step) for step in firsts]
        assert any(assistant.choose(state) is not None for state in states)


@pytest.mark.parametrize("world", ["workshop", "hall"])
def test_what_a_step_is_worth_does_not_depend_on_what_was_asked_before(request, walk, world):
    bank = request.getfixturevalue(world)
    even = np.ones(len(bank.names))

    def worth(step_values, steps):
        progress = step_values.tracker.start
        for step in steps:
            progress, _ = step_values.tracker.follow(progress, step)
        can = bank.table.applicable(progress.world)
        return step_values.expected_saving(progress, step_values.next_steps(progress), can, even)[
            0
        ].tolist()

    used = StepValues(ProgressTracker(bank))
    for seed in range(40):
        steps = walk(bank, seed, 4 + seed % 4)
        assert worth(used, steps) == worth(StepValues(ProgressTracker(bank)), steps)


@dataclass
class Loose:
    """A state that can be written to; what it says of the world may be wrong."""

    inner: object
    world: int
    notes: list = field(default_factory=list)
    ignored: str | None = None


class Broken:
    """A good assistant in a coat, out of which holes are cut below."""

    def __init__(self, bank):
        self.bank, self.inner, self.names = bank, ExpectedHelp(bank), bank.names
        self.n_asked = 0

    def start(self):
        inner = self.inner.start()
        return Loose(inner, inner.world)

    def observe(self, state, step, *, robot=False):
        inner = self.inner.observe(state.inner, step, robot=robot)
        return Loose(inner, inner.world, list(state.notes))

    def posterior(self, state):
        return self.inner.posterior(state.inner)

    def choose(self, state):
        return self.inner.choose(state.inner)


class NotSummingToOne(Broken):
    def posterior(self, state):
        return super().posterior(state) / 2


class Impossible(Broken):
    def choose(self, state):
        return self.bank.table.find(("seal", "blue"))  # which is shut


class Idle(Broken):
    def choose(self, state):
        table = self.bank.table
        steps = range(len(table))
        idle = (s for s in steps if table.successor(state.world, s) == state.world)
        return next(idle, super().choose(state))


class Unknown(Broken):
    def choose(self, state):
        return len(self.bank.table)


class Fickle(Broken):
    def choose(self, state):
        self.n_asked += 1
        return None if self.n_asked % 2 else super().choose(state)


class Writing(Broken):
    def choose(self, state):
        state.world ^= 1
        return super().choose(state)


class Convinced(Broken):
    def choose(self, state):
        state.notes.append("seen")
        return super().choose(state)

    def posterior(self, state):
        found = super().posterior(state)
        return np.eye(len(found))[0] if state.notes else found


class Lost(Broken):
    def observe(self, state, step, *, robot=False):
        return replace(state) if robot else super().observe(state, step)


class Distracted(Broken):
    """Its choice is that of the state it saw last."""

    def observe(self, state, step, *, robot=False):
        self.latest = super().observe(state, step, robot=robot)
        return self.latest

    def choose(self, state):
        return super().choose(getattr(self, "latest", state))


class Learning(Broken):
    """It does nothing every other time that it is started."""

    n_starts = 0

    def start(self):
        self.n_starts += 1
        return super().start()

    def choose(self, state):
        return None if self.n_starts % 2 else super().choose(state)


class Moody(Convinced):
    """What it believes depends on how often it was asked before the robot's step."""

    def observe(self, state, step, *, robot=False):
        found = super().observe(state, step, robot=robot)
        return replace(found, notes=["odd"]) if robot and self.n_asked % 2 == 0 else found

    def choose(self, state):
        self.n_asked += 1
        return Broken.choose(self, state)


@pytest.mark.parametrize(
    ("kind", "message"),
    [
        (NotSummingToOne, "the posterior sums to 0.5"),
        (Impossible, "cannot do .seal blue."),
        (Idle, "or it changes nothing"),
        (Unknown, "there is no step"),
        (Fickle, "the same state is answered differently"),
        (Writing, "choosing has changed the state"),
        (Convinced, "choosing has changed what is believed"),
        (Lost, "does not know what state"),
        (Distracted, "what was asked in between"),
        (Learning, "a second walk is answered differently"),
        (Moody, "a second walk differs"),
    ],
)
def test_every_law_can_be_broken(workshop, walk, kind, message):
    with pytest.raises(AssertionError, match=message):
        check_assistant(kind(workshop), workshop, runs(workshop, walk))


def test_the_coat_itself_has_no_holes(workshop, walk):
    check_assistant(Broken(workshop), workshop, runs(workshop, walk))


def test_steps_that_have_become_impossible_are_left_out(workshop):
    """The robot packs or seals meanwhile; the human's script does not break."""
    seal, unfold = (workshop.table.find((word, "red")) for word in ("seal", "unfold"))
    check_assistant(Broken(workshop), workshop, [(unfold, seal, unfold, seal)])


def test_what_is_no_belief(workshop):
    with pytest.raises(AssertionError, match="Loose has no names, start, observe, posterior"):
        check_belief(Loose(None, 0), [])
    with pytest.raises(AssertionError, match="has no choose"):
        check_assistant(ExactBelief(workshop), workshop, [])


class Told(Broken):
    """Written for version 0.1, where ``inform`` was called ``told``."""

    def told(self, state, goal):
        return Loose(state.inner, state.world, [*state.notes, goal])


def test_an_assistant_of_an_earlier_version_still_works(workshop, walk):
    with pytest.warns(OldNameWarning, match="'told' is deprecated; its name is 'inform'"):
        check_assistant(Told(workshop), workshop, [walk(workshop, 1, 3)])


def test_names_of_an_earlier_version_still_work(workshop):
    robot = ExpectedHelp(workshop)
    state = robot.start()
    with pytest.warns(OldNameWarning) as warned:
        following = robot.outlook.wanted(state.track)
    assert {str(w.message).rpartition(" ")[2] for w in warned} == {
        "'step_values'", "'next_steps'", "'progress'"}  # fmt: skip
    assert following.steps.tolist() == robot.step_values.next_steps(state.progress).steps.tolist()
