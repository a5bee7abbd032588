"""The turns of many episodes at once, where it does not matter who acts.

The rules are those of `EpisodeTurns`, and the humans are `Frontier`; a test holds both together.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hrcplan.bank import Bank
from hrcplan.core import bit_rows
from hrcplan.core.arrays import Bools, Floats, Ids, Words
from hrcplan.environments.encoding import ActionEncoding
from hrcplan.environments.frontier_table import FrontierTable
from hrcplan.episodes.courses import SPREAD, Habits
from hrcplan.episodes.turns import PATIENCE, turns_of
from hrcplan.task.batch import BatchSimulator
from hrcplan.task.steps import Step

RUNNING, REACHED, STUCK, UNFINISHED = range(4)
"""How an episode has ended, if it has."""
N_DRAWS = 3  # random numbers of a human's turn: whether to wait, whether to err, what to do


@dataclass
class BatchTurns:
    """Episodes side by side; every array has a row for each.

    Attributes:
        states: The states of the task.
        goals: The goals, in the order in which they are wanted.
        changes: The rounds at which each goal but the first begins to be wanted.
        rounds: How many rounds are over.
        n_turns: How many turns are over.
        n_waits: How many turns in a row were waits.
        caps: The number of turns after which an episode ends, but for its last round.
        endings: How each episode has ended, or `RUNNING`.
    """

    states: Words
    goals: Ids
    changes: Ids
    rounds: Ids
    n_turns: Ids
    n_waits: Ids
    caps: Ids
    endings: Ids

    @property
    def goal(self) -> Ids:
        """The goal that the human of each episode wants now."""
        place = (self.rounds[:, None] >= self.changes).sum(axis=1)
        goal: Ids = self.goals[np.arange(len(self.goals)), place]
        return goal

    @property
    def last_changes(self) -> Ids:
        """The round of the last change of each episode; 0 without one."""
        last: Ids = self.changes.max(axis=1, initial=0)
        return last


class BatchRules:
    """What a bank says of many episodes at once.

    Args:
        bank: The plans, as sequences of steps without turns.
        habits: How often goals change, and the rates of mistakes and waits.
    """

    def __init__(self, bank: Bank, habits: Habits) -> None:
        people, helpers = (mover.agents for mover in turns_of(bank).order)
        self.bank, self.habits = bank, habits
        self.simulator = BatchSimulator(bank.goals.task)
        self.frontier = FrontierTable(bank, people)
        self.actions = ActionEncoding(bank, helpers)
        self._of_robot = _Doers(bank, helpers)
        self._of_human = _Doers(bank, people)
        self._doer = np.array([step.actions[0] for step in _all_steps(bank)])
        self._robot_steps = np.array([-1, *self.actions.steps], dtype=np.int64)
        self._lengths = np.array([graph.n_steps for graph in bank.graphs], dtype=np.int64)
        self._tests = _goal_tests(bank, self.simulator)

    def begin(self, n: int, rng: np.random.Generator) -> BatchTurns:
        """Return episodes before the first turn; what is wanted is drawn as in ``draw_course``."""
        n_goals, n_changes = len(self._lengths), self.habits.changes
        goals = np.empty((n, n_changes + 1), dtype=np.int64)
        changes = np.empty((n, n_changes), dtype=np.int64)
        goals[:, 0] = rng.integers(n_goals, size=n)
        for number in range(n_changes):
            length = self._lengths[goals[:, number]]
            most = np.maximum(1, length // SPREAD if number else (length - 1) // 2)
            before = changes[:, number - 1] if number else np.zeros(n, dtype=np.int64)
            changes[:, number] = before + rng.integers(1, most + 1)
            others = rng.integers(n_goals - 1, size=n)
            goals[:, number + 1] = others + (others >= goals[:, number])
        caps = PATIENCE * self._lengths[goals].sum(axis=1) + n_changes + 1
        rounds, n_turns, n_waits, endings = (np.zeros(n, dtype=np.int64) for _ in range(4))
        states = self.simulator.initial(n)
        return BatchTurns(states, goals, changes, rounds, n_turns, n_waits, caps, endings)

    def robot_mask(self, states: Words) -> Bools:
        """Return which actions a robot can do in each state, waiting first."""
        mask = np.ones((len(states), self.actions.n_actions), dtype=np.bool_)
        self._of_robot.able(self.simulator.applicable(states), mask[:, 1:])
        return mask

    def let_robots_act(self, turns: BatchTurns, actions: Ids, acts: Bools) -> None:
        """Let the robots of some episodes act, and end the round."""
        self._do(turns, self._robot_steps[actions], acts)
        turns.rounds[acts & (turns.endings == RUNNING)] += 1

    def let_humans_act(self, turns: BatchTurns, chances: Floats) -> None:
        """Begin a round of all episodes that have not ended, and let their humans act.

        Args:
            turns: The episodes.
            chances: `N_DRAWS` random numbers for each.
        """
        self._note_reached(turns, turns.endings == RUNNING)
        acts, goal = turns.endings == RUNNING, turns.goal
        entries = np.zeros(len(goal), dtype=np.int64)
        rows = np.flatnonzero(acts)
        entries[rows] = self.frontier.entries(goal[rows], turns.states[rows])
        counts, steps = self._choices(turns.states, entries, chances[:, 2], rows)
        is_last = turns.rounds > turns.last_changes
        is_stuck = acts & is_last & (turns.n_waits > 1) & (counts == 0)
        turns.endings[is_stuck] = STUCK
        is_late = acts & ~is_stuck & (turns.n_turns >= turns.caps)
        turns.endings[is_late] = UNFINISHED
        acts &= turns.endings == RUNNING
        waits = chances[:, 0] < self.habits.wait_rate
        steps[waits] = -1
        errs = acts & ~waits & (chances[:, 1] < self.habits.mistake_rate)
        if errs.any():
            self._let_err(turns.states, entries, chances[:, 2], np.flatnonzero(errs), steps)
        self._do(turns, steps, acts)

    def _choices(self, states: Words, entries: Ids, chance: Floats, rows: Ids) -> tuple[Ids, Ids]:
        """Return how many steps each human can choose from, and which one it chooses; else -1."""
        table, n = self.frontier, len(entries)
        counts, steps = np.zeros(n, dtype=np.int64), np.full(n, -1, dtype=np.int64)
        first, count = table.first[entries[rows]], table.count[entries[rows]]
        if table.is_certain:
            place = first + (chance[rows] * count).astype(np.int64)
            chosen = np.full(len(rows), -1, dtype=np.int64)
            some = count > 0
            chosen[some] = table.steps[place[some]]
            counts[rows], steps[rows] = count, chosen
            return counts, steps
        owners = np.repeat(np.arange(len(rows)), count)
        within = np.arange(len(owners)) - np.repeat(np.cumsum(count) - count, count)
        options = table.steps[np.repeat(first, count) + within]
        matrix = np.zeros((len(rows), len(self.bank.table)), dtype=np.bool_)
        matrix[owners, options] = True
        matrix &= self._of_human.can(self.simulator.applicable(states[rows]))
        counts[rows], steps[rows] = _draw(matrix, chance[rows])
        return counts, steps

    def _let_err(self, states: Words, entries: Ids, chance: Floats, rows: Ids, steps: Ids) -> None:
        """Put in place steps that no plan of the goal has, where there are any."""
        wrong = self._of_human.can(self.simulator.applicable(states[rows]))
        wrong &= ~self.frontier.is_used[self.frontier.used[entries[rows]]]
        counts, chosen = _draw(wrong, chance[rows])
        steps[rows[counts > 0]] = chosen[counts > 0]

    def _do(self, turns: BatchTurns, steps: Ids, acts: Bools) -> None:
        """Let some episodes go on by a step, or by a wait (-1), and see whether they are over."""
        does = acts & (steps >= 0)
        actions = np.where(does, self._doer[steps], -1)
        turns.states = self.simulator.step(turns.states, actions)
        turns.n_waits = np.where(does, 0, turns.n_waits + acts)
        turns.n_turns += acts
        self._note_reached(turns, acts)

    def _note_reached(self, turns: BatchTurns, acts: Bools) -> None:
        rows = np.flatnonzero(acts & (turns.rounds >= turns.last_changes))
        reached = self.is_reached(turns.goal[rows], turns.states[rows])
        turns.endings[rows[reached]] = REACHED

    def is_reached(self, goals: Ids, states: Words) -> Bools:
        """Return for each pair of a goal and a state whether the goal holds."""
        holds = np.zeros(len(goals), dtype=np.bool_)
        for masks, values in self._tests:
            holds |= ((states & masks[goals]) == values[goals]).all(axis=1)
        return holds


class _Doers:
    """From ground actions that can be done to the steps that some agents can do."""

    def __init__(self, bank: Bank, agents: frozenset[str]) -> None:
        actions = bank.goals.task.actions
        pairs = [
            (step.index, index)
            for step in _all_steps(bank)
            for index in step.actions
            if actions[index].agent is None or actions[index].agent in agents
        ]
        self._n_steps = len(bank.table)
        columns = np.array(pairs, dtype=np.int64).reshape(-1, 2)
        self._steps, self._first = np.unique(columns[:, 0], return_index=True)
        self._columns = columns[:, 1]

    def able(self, applicable: Bools, out: Bools) -> None:
        """Write which of the agents' steps can be done: a matrix of states by these steps."""
        if len(self._columns) == len(self._steps):
            np.take(applicable, self._columns, axis=1, out=out)
        elif len(self._columns):
            own = np.take(applicable, self._columns, axis=1)
            np.logical_or.reduceat(own, self._first, axis=1, out=out)

    def can(self, applicable: Bools) -> Bools:
        """Return which steps can be done: a matrix of states by all steps."""
        own = np.zeros((len(applicable), len(self._steps)), dtype=np.bool_)
        self.able(applicable, own)
        matrix = np.zeros((len(applicable), self._n_steps), dtype=np.bool_)
        matrix[:, self._steps] = own
        return matrix


def _all_steps(bank: Bank) -> list[Step]:
    return [bank.table[step] for step in range(len(bank.table))]


def _goal_tests(bank: Bank, simulator: BatchSimulator) -> list[tuple[Words, Words]]:
    """Return masks and values of each goal, alternative by alternative; missing ones never hold."""
    tests = bank.goals.tests
    n_facts = simulator.n_facts
    alternatives: list[tuple[Words, Words]] = []
    for place in range(max(map(len, tests))):
        some = [test[place] if place < len(test) else (0, 1) for test in tests]
        masks = bit_rows.pack([mask for mask, _ in some], n_facts)
        alternatives.append((masks, bit_rows.pack([value for _, value in some], n_facts)))
    return alternatives


def _draw(matrix: Bools, chance: Floats) -> tuple[Ids, Ids]:
    """Return how many columns of each row are set, and one of them at random; -1 without any."""
    counts = matrix.sum(axis=1)
    rank = (chance * counts).astype(np.int64) + 1
    chosen = (matrix.cumsum(axis=1) >= rank[:, None]).argmax(axis=1)
    return counts, np.where(counts > 0, chosen, -1)
