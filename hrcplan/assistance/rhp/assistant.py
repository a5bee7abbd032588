"""The assistant of the changed-mind paper: candidate sequences, declared changes, trees.

Ghose, Gitelson et al., "I've Changed My Mind" (RA-L 2025), sections III and IV-C, as printed; what
the text leaves open is decided below.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from hrcplan.assistance.assistant import ValueAssistant
from hrcplan.assistance.bigrams import BANK, N_PLANS, PLAUSIBLE, Bigrams
from hrcplan.assistance.explanation import StepChoice
from hrcplan.assistance.imagined_steps import BRANCHING
from hrcplan.assistance.rhp.consistency import Consistency, Subset
from hrcplan.assistance.rhp.sampled import Sampled
from hrcplan.assistance.rhp.set_posterior import SetPosterior
from hrcplan.assistance.rhp.subsequence import Subsequence
from hrcplan.assistance.rhp.tree import DEPTH, Field, RecedingHorizonTree, TreeRoot
from hrcplan.bank import Bank
from hrcplan.bank.progress import Progress
from hrcplan.core.arrays import Floats, Rows
from hrcplan.core.bits import positions
from hrcplan.core.deprecation import Renamed
from hrcplan.errors import UsageError
from hrcplan.inference.belief import IMPOSSIBLE, Belief, BeliefState, SetBelief, TracksProgress
from hrcplan.inference.classifier.forest import ForestBelief
from hrcplan.inference.probabilities import weights_to_posterior
from hrcplan.pddl.conventions import people

N_SEQUENCES = 3
MAX_REMEMBERED = 20_000
GoalBelief = Belief[Any] | SetBelief
UNFIT, NOT_THE_GUESS = "unfit", "not-the-guess"
CHANGE, ASIDE = "change", "aside"
NO_WAITING = -np.inf  # what it is worth to wait: "neither agent can wait" (section VI)


@dataclass(frozen=True, slots=True)
class RhpState:
    """The state of `RecedingHorizonPlanner`.

    Attributes:
        progress: The progress of the goals.
        sequences: The candidate sequences C_h: what the human may have done for its goal.
        plausible: For each of them the goals that it is consistent with, as bits.
        human: All that the human has done.
        robot: What the robot has done since the last declared change (H_r).
        n_declared: How many changes of goal were declared.
        belief: The state of a belief that follows all steps; None if it looks at sets of steps.
        ignored: Why the last observation had no effect; None if it had one.
    """

    progress: Progress
    sequences: tuple[tuple[int, ...], ...]
    plausible: tuple[int, ...]
    human: tuple[int, ...] = ()
    robot: tuple[int, ...] = ()
    n_declared: int = 0
    belief: BeliefState | None = None
    ignored: str | None = None

    @property
    def world(self) -> int:
        """The state of the task, as bits."""
        return self.progress.world

    @property
    def last(self) -> int | None:
        """The last step of the human."""
        return self.human[-1] if self.human else None

    track = Renamed("progress")


class RecedingHorizonPlanner(ValueAssistant[RhpState]):
    """Infers the goal from consistent sequences of steps, and plans a few steps ahead.

    Args:
        bank: The plans.
        belief: The goal belief. A `SetBelief` is evaluated once for each candidate sequence
            together with the robot's steps, and the posteriors are averaged; ``"presence"`` is the
            exact one. Any other belief is updated step by step. By default the forest of the
            changed-mind paper, which takes a minute to train.
        n_sequences: The number of candidate sequences after a change (j).
        branching: The number of steps tried at each depth of a tree (b).
        depth: The depth of a tree (d).
        consistency: ``subset``, ``subsequence``, ``sampled``, or an object (see consistency.py).
        bigrams: Whose plans the 2-grams count: ``bank`` for all, ``plausible`` for the goals that
            the sequences are consistent with.
        declares: When a change is declared: if the history fits no goal (``unfit``), or already if
            it does not fit the goal that was the likeliest before (``not-the-guess``).
        odd_steps: What a step is that fits no goal even alone: a ``change``, or set ``aside``.
        n_sampled: The number of plans sampled for each goal.
        seed: The seed of all samples.

    Raises:
        UsageError: if an option has an unknown value, or ``belief`` is no belief.
    """

    needs_training = True

    def __init__(
        self, bank: Bank, belief: GoalBelief | str | None = None, *, n_sequences: int = N_SEQUENCES,
        branching: int = BRANCHING, depth: int = DEPTH,
        consistency: str | Consistency = "subset", bigrams: str = BANK,
        declares: str = UNFIT, odd_steps: str = CHANGE,
        n_sampled: int = N_PLANS, seed: int = 0,
    ) -> None:  # fmt: skip
        if bigrams not in (BANK, PLAUSIBLE):
            raise UsageError(f"there are no 2-grams '{bigrams}'", hint=f"{BANK} or {PLAUSIBLE}")
        if declares not in (UNFIT, NOT_THE_GUESS):
            hint = f"{UNFIT} or {NOT_THE_GUESS}"
            raise UsageError(f"changes cannot be declared '{declares}'", hint=hint)
        if odd_steps not in (CHANGE, ASIDE):
            raise UsageError(f"an odd step cannot be '{odd_steps}'", hint=f"{CHANGE} or {ASIDE}")
        self._by_guess, self._sets_aside = declares == NOT_THE_GUESS, odd_steps == ASIDE
        self.belief = _belief(bank, belief, seed)
        tracker = self.belief.tracker if isinstance(self.belief, TracksProgress) else None
        super().__init__(bank, tracker)
        self.n_sequences = n_sequences
        self.consistency = _consistency(bank, consistency, n_sampled, seed)
        grams = Bigrams(bank, n_sampled, seed)
        self.tree = RecedingHorizonTree(
            self.step_values, grams, people(bank.goals.problem), branching, depth
        )
        self._by_plausible = bigrams == PLAUSIBLE
        self._label = self.tracker.combined_graph.label
        # How many goals have a step in their plans: its generality (III-D1).
        self.generality: list[int] = self.tracker.combined_graph.needs.sum(axis=0).tolist()
        self._fields: dict[int, Field] = {}
        self._predictions: dict[bytes, Floats] = {}

    def start(self) -> RhpState:
        """Return the state before anything was done: one empty sequence, any goal."""
        belief = None if isinstance(self.belief, SetBelief) else self.belief.start()
        return RhpState(self.tracker.start, ((),), (self.consistency.everything,), belief=belief)

    def observe(self, state: RhpState, step: int, *, robot: bool = False) -> RhpState:
        """Return the state after one more step, done by the human or by the robot."""
        move = self.tracker.follow(state.progress, step)
        if move is None:
            return replace(state, ignored=IMPOSSIBLE)
        belief = state.belief
        if not isinstance(self.belief, SetBelief):
            belief = self.belief.observe(belief, step, robot=robot)
        next_state = replace(state, progress=move[0], belief=belief, ignored=None)
        if robot:
            return replace(next_state, robot=(*state.robot, step))
        return self._watch(next_state, step, self._fitting(state))

    def _fitting(self, state: RhpState) -> int:
        """Return the goals, as bits, of which the next history fits one if nothing has changed."""
        if self._by_guess and state.human:
            return 1 << int(self.posterior(state).argmax())
        return self.consistency.everything

    def _watch(self, state: RhpState, step: int, fitting: int) -> RhpState:
        """Return the state after a human step: it is added to all sequences (III-C).

        Those that fit no goal are dropped; a change is only declared if none is left.
        """
        human = (*state.human, step)
        longer = [(*sequence, step) for sequence in state.sequences]
        by_sequence = ((sequence, self.consistency.goals(sequence)) for sequence in longer)
        consistent = [(sequence, goals) for sequence, goals in by_sequence if goals & fitting]
        if consistent:
            sequences, plausible = zip(*consistent, strict=True)
            return replace(state, human=human, sequences=sequences, plausible=plausible)
        if self._sets_aside and not self.consistency.goals((step,)):
            return replace(state, human=human)
        sequences, plausible = self._afresh(state.human, step)
        return replace(
            state, human=human, sequences=sequences, plausible=plausible, robot=(),
            n_declared=state.n_declared + 1,
        )  # fmt: skip

    def _afresh(
        self, earlier: Sequence[int], step: int
    ) -> tuple[tuple[tuple[int, ...], ...], tuple[int, ...]]:
        """Return the sequences after a change, out of all that the human ever did (III-D1)."""
        worth = [self.generality[self._label[s]] for s in earlier]
        sequences = self.consistency.largest(earlier, step, worth, self.n_sequences)
        if not sequences:
            # Not even the latest step alone fits a goal, as after a mistake that no goal has any
            # use for. It tells nothing, so that all goals stay plausible until the next step.
            return ((step,),), (self.consistency.everything,)
        return tuple(sequences), tuple(self.consistency.goals(sequence) for sequence in sequences)

    def posterior(self, state: RhpState) -> Floats:
        """Return the probability of each goal, in order: the mean over the sequences."""
        if not isinstance(self.belief, SetBelief):
            return self.belief.posterior(state.belief)
        rows = np.zeros((len(state.sequences), max(self._label, default=-1) + 1), dtype=np.uint8)
        for row, sequence in zip(rows, state.sequences, strict=True):
            row[[self._label[step] for step in (*sequence, *state.robot)]] = 1
        by_sequence = self._predict(self.belief, rows)
        return weights_to_posterior(by_sequence.mean(axis=0))

    def _predict(self, belief: SetBelief, rows: Rows) -> Floats:
        """Return the posterior of each row; those of earlier calls are remembered."""
        keys = [row.tobytes() for row in rows]
        new = [i for i, key in enumerate(keys) if key not in self._predictions]
        if new:
            if len(self._predictions) >= MAX_REMEMBERED:
                self._predictions.clear()
                new = list(range(len(rows)))
            for i, posterior in zip(new, belief.posteriors(rows[new]), strict=True):
                self._predictions[keys[i]] = posterior
        return np.stack([self._predictions[key] for key in keys])

    def options(self, state: RhpState) -> StepChoice:
        """Return the steps that the robot could do now; the worth of one is its branch's cost."""
        root = TreeRoot(
            state.progress,
            state.last,
            tuple(self.field(goals) for goals in state.plausible),
            state.plausible if self._by_plausible else (),
            lambda: self.posterior(state),
        )
        costs = sorted(self.tree.costs(root).items())
        choice = StepChoice(
            tuple(step for step, _ in costs), tuple(float(-cost) for _, cost in costs), NO_WAITING
        )
        return self.in_turn(choice, state)

    def field(self, goals: int) -> Field:
        """Return the sum of the attractor fields of goals, given as bits (III-B2)."""
        field = self._fields.get(goals)
        if field is None:
            if len(self._fields) >= MAX_REMEMBERED:
                self._fields.clear()
            field = self.tracker.combined_graph.needs[list(positions(goals))].sum(axis=0).tolist()
            self._fields[goals] = field
        return field


def _consistency(bank: Bank, kind: str | Consistency, n_plans: int, seed: int) -> Consistency:
    if not isinstance(kind, str):
        return kind
    makers: dict[str, Callable[[], Consistency]] = {
        "subset": lambda: Subset(bank),
        "subsequence": lambda: Subsequence(bank),
        "sampled": lambda: Sampled(bank, n_plans, seed),
    }
    if kind not in makers:
        names = ", ".join(makers)
        raise UsageError(f"there is no consistency '{kind}'", hint=f"one of {names}")
    return makers[kind]()


def _belief(bank: Bank, belief: GoalBelief | str | None, seed: int) -> GoalBelief:
    if belief is None:
        return ForestBelief(bank, seed)
    if belief == "presence":
        return SetPosterior(bank)
    if isinstance(belief, (SetBelief, Belief)):
        return belief
    hint = "a name ('presence'), a Belief, or a SetBelief: see hrcplan/inference/belief.py"
    raise UsageError(f"{belief!r} is no belief", code="not-a-belief", hint=hint)
