"""Objects that can change places: nodes that are images of each other are searched once.

A *swap* exchanges pairs of objects. It is a symmetry if it turns every ground action into one of
the same cost and duration, with its conditions and effects turned the same way, and the goal into
itself. The initial state may look different: what is left to do from a node costs as much as from
its image (orbit search: Domshlak, Katz and Shleyfman, ICAPS 2012).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import combinations, count
from typing import NamedTuple

from hrcplan.core.bits import positions
from hrcplan.core.clock import check_time
from hrcplan.core.numbers import Number
from hrcplan.pddl.model import Fact, FluentKey
from hrcplan.planners.exact.frame import RunningActions, StaticMasks
from hrcplan.planners.exact.weights import Weights
from hrcplan.task import Task

MAX_SWAPS = 32
MAX_LOOKS = 200_000
"""Actions that are held against their images, in all: a second at most."""
MAX_RELATIONS = 1000
"""Facts that never change and that are looked at: who owns which tool, for example."""
_MAX_TRIES = 200

_Mapping = Mapping[str, str]
_ActionKey = tuple[str, tuple[str, ...], frozenset[tuple[FluentKey, Number]]]


class Swap(NamedTuple):
    """A symmetry: which facts change places, and the image of each action.

    ``shifts`` holds, for each distance between two such facts, a mask of the lower ones.
    """

    shifts: tuple[tuple[int, int], ...]
    actions: tuple[int, ...]

    def of_facts(self, facts: int) -> int:
        """Return the image of a set of facts.

        >>> Swap(((2, 0b01),), ()).of_facts(0b011)
        6
        """
        for distance, lower in self.shifts:
            differ = (facts >> distance ^ facts) & lower
            facts ^= differ ^ differ << distance
        return facts

    def of_running(self, running: RunningActions) -> RunningActions:
        """Return the images of running actions."""
        actions = self.actions
        return tuple(sorted([(left, actions[action]) for left, action in running]))


def representative(
    facts: int, running: RunningActions, swaps: Sequence[Swap]
) -> tuple[int, RunningActions]:
    """Return an image of a node that no swap makes smaller.

    Nodes with the same one are images of each other; some images of each other have two.
    """
    n_still = i = 0
    while n_still < len(swaps):
        swap = swaps[i]
        image = swap.of_facts(facts)
        runs = swap.of_running(running) if running and image <= facts else running
        if image < facts or (image == facts and runs < running):
            facts, running, n_still = image, runs, 0
        n_still += 1
        i = (i + 1) % len(swaps)
    return facts, running


def symmetries(
    task: Task, frame: StaticMasks, weights: Weights, deadline: float
) -> tuple[Swap, ...]:
    """Return swaps of a task, some at least of those there are.

    Raises:
        LimitError: at the deadline.
    """
    if not weights.tick and not all(weights.cost):
        return ()  # where steps cost nothing, the first of the best plans could be left out
    images = _Images(task, frame, weights, deadline)
    swaps: dict[Swap, None] = {}
    relations = _relations(task)
    for one, other in _pairs(task):
        if len(swaps) >= MAX_SWAPS or images.n_looks > MAX_LOOKS:
            break
        for mapping in _mappings(task, relations, {one: other, other: one}):
            swap = images.swap(mapping)
            if swap is not None:
                swaps[swap] = None
                break
    return tuple(swaps)


def _pairs(task: Task) -> Iterator[tuple[str, str]]:
    """Yield pairs of objects of one type that some fact names."""
    words = {word for fact in task.facts for word in fact}
    members: dict[str, list[str]] = {}
    for name, kind in task.problem.all_objects.items():
        if name in words:
            members.setdefault(kind, []).append(name)
    for names in members.values():
        yield from combinations(names, 2)


class _Literal(NamedTuple):
    """A fact that a goal wants true or false."""

    truth: int
    fact: Fact

    def image(self, mapping: _Mapping) -> _Literal:
        return _Literal(self.truth, _image(self.fact, mapping))


def _image(fact: Fact, mapping: _Mapping) -> Fact:
    return (fact[0], *[mapping.get(name, name) for name in fact[1:]])


def _mappings(task: Task, relations: Sequence[_Literal], mapping: _Mapping) -> Iterator[_Mapping]:
    """Yield extensions of a mapping that turn a goal of one alternative into itself.

    Then those that also turn the relations that never change into themselves.
    """
    goal = list[_Literal]()
    if len(task.goal) == 1:
        mask, value = task.goal[0]
        goal = [_Literal(value >> i & 1, task.facts[i]) for i in positions(mask)]
    yield from _extensions(goal, frozenset(goal), mapping, count())
    if relations:
        both = [*goal, *relations]
        yield from _extensions(both, frozenset(both), mapping, count())


def _relations(task: Task) -> list[_Literal]:
    """Return the facts about several objects that no action changes, unless they are many."""
    facts = [fact for fact in task.problem.facts if len(fact) > 2 and fact not in task.bits]
    return [_Literal(1, fact) for fact in sorted(facts)] if len(facts) <= MAX_RELATIONS else []


def _extensions(
    goal: Sequence[_Literal], literals: frozenset[_Literal], mapping: _Mapping, tries: Iterator[int]
) -> Iterator[_Mapping]:
    wrong = next((x for x in goal if x.image(mapping) not in literals), None)
    if wrong is None:
        yield mapping
        return
    for other in goal:
        more = _unified(wrong, other, mapping)
        if more is not None and next(tries) < _MAX_TRIES:
            yield from _extensions(goal, literals, more, tries)


def _unified(one: _Literal, other: _Literal, mapping: _Mapping) -> _Mapping | None:
    """Return an extended mapping that turns one literal into the other one, if there is one."""
    if one.truth != other.truth or one.fact[0] != other.fact[0]:
        return None
    more = dict(mapping)
    for name, target in zip(one.fact[1:], other.fact[1:], strict=False):
        if more.setdefault(name, target) != target or more.setdefault(target, name) != name:
            return None
    return more if len(more) > len(mapping) else None


class _Images:
    """Finds the images of facts and actions by their names, and checks that they are symmetric."""

    def __init__(self, task: Task, frame: StaticMasks, weights: Weights, deadline: float) -> None:
        self.n_looks = 0
        self._deadline = deadline
        self._task, self._frame, self._weights = task, frame, weights
        self._facts = {fact: i for i, fact in enumerate(task.facts)}
        self._actions: dict[_ActionKey, int] = {
            (a.name, a.args, frozenset(a.values.items())): a.index for a in task.actions
        }

    def swap(self, mapping: _Mapping) -> Swap | None:
        """Return the swap that a mapping of objects makes; None if it is no symmetry."""
        facts = self._of_facts(mapping)
        if facts is None:
            return None
        shifts: dict[int, int] = {}
        for i, j in enumerate(facts):
            if i < j:
                shifts[j - i] = shifts.get(j - i, 0) | 1 << i
        swap = Swap(tuple(sorted(shifts.items())), ())
        of_tests = {(swap.of_facts(mask), swap.of_facts(v)) for mask, v in self._task.goal}
        if of_tests != set(self._task.goal):
            return None
        actions = self._of_actions(mapping, swap)
        return None if actions is None else swap._replace(actions=actions)

    def _of_facts(self, mapping: _Mapping) -> list[int] | None:
        images: list[int] = []
        for fact in self._task.facts:
            image = self._facts.get(_image(fact, mapping))
            if image is None:
                return None
            images.append(image)
        return images if all(images[j] == i for i, j in enumerate(images)) else None

    def _of_actions(self, mapping: _Mapping, swap: Swap) -> tuple[int, ...] | None:
        images: list[int] = []
        for action in self._task.actions:
            check_time(self._deadline, "while looking for symmetries")
            self.n_looks += 1
            values = frozenset((_image(key, mapping), v) for key, v in action.values.items())
            args = tuple([mapping.get(name, name) for name in action.args])
            image = self._actions.get((action.name, args, values))
            if image is None or not self._is_image(action.index, image, swap):
                return None
            images.append(image)
        return tuple(images)

    def _is_image(self, one: int, other: int, swap: Swap) -> bool:
        frame, weights, of = self._frame, self._weights, swap.of_facts
        return (
            all(
                column[one] == column[other]
                for column in (frame.ticks, weights.cost, weights.share, weights.n_lanes)
            )
            and all(
                of(masks[one]) == masks[other] for masks in (frame.deletes, frame.adds, frame.late)
            )
            and all(
                {(of(mask), of(value)) for mask, value in tests[one]} == set(tests[other])
                for tests in (frame.tests, frame.over)
            )
        )
