"""What a problem's tasks have in common: facts and ground actions as bit positions."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence, Set
from functools import cached_property
from math import inf

from hrcplan.core.garbage import no_garbage_search
from hrcplan.core.numbers import Number
from hrcplan.core.records import record, replace
from hrcplan.errors import UnsupportedError
from hrcplan.pddl.model import TOTAL_COST, TOTAL_TIME, Constant, Expr, Fact, Problem
from hrcplan.pddl.semantics import mentions
from hrcplan.pddl.walks import compares
from hrcplan.task.actions import GroundAction, ground_actions
from hrcplan.task.changing import ValueSets, combinations, reached_values, value_fact
from hrcplan.task.conditions import Grounder, Tests, all_of, any_of
from hrcplan.task.lookup import lookup
from hrcplan.task.numbers import check_supported, numeric_effects
from hrcplan.task.reachable import EffectFacts, SchemaInstance, reachable
from hrcplan.task.transitions import BitEffect, net_effect


@record
class ActionIndex:
    """Ground actions laid out for inner loops.

    Attributes:
        runnable: The simple actions that are applicable in a state, as indices in order.
        others: The actions that are not simple.
        net_effects: What each action does in sum; None if that depends on the state.
    """

    runnable: Callable[[int], list[int]]
    others: tuple[int, ...]
    net_effects: tuple[BitEffect | None, ...]
    __eq__ = object.__eq__
    __hash__ = object.__hash__

    @classmethod
    def of(cls, actions: Sequence[GroundAction], n_facts: int) -> ActionIndex:
        """Return the index of actions that are numbered from 0."""
        rules = [(action.index, action.simple_rule) for action in actions]
        simple = [(index, rule) for index, rule in rules if rule is not None]
        others = tuple(index for index, rule in rules if rule is None)
        effects = (None if a.conditional else net_effect(a.at_start, a.at_end) for a in actions)
        return cls(lookup(n_facts, len(actions), simple), others, tuple(effects))


@record
class Grounding:
    """Facts and ground actions of a domain with objects, whatever the state, the goal, the costs.

    Attributes:
        facts: The fluents in bit order; facts that never change are compiled away.
        bits: The bit of each fluent.
        constant: The facts that hold and never change.
        value_sets: The values, in bit order, of the functions that actions change.
        movers: The instances that could change them.
        actions: The ground actions: by schema as declared, then by objects as declared.
        structure: Groundings with the same structure differ in the numbers of ``value_sets`` and in
            costs only, so what was computed for one holds for the others.
    """

    facts: tuple[Fact, ...]
    bits: Mapping[Fact, int]
    constant: Set[Fact]
    value_sets: ValueSets
    movers: tuple[SchemaInstance, ...]
    actions: tuple[GroundAction, ...]
    structure: object
    __eq__ = object.__eq__  # by identity: equal ones are many megabytes
    __hash__ = object.__hash__

    @cached_property
    def index(self) -> ActionIndex:
        """The actions, laid out for inner loops, when that is first asked for."""
        return ActionIndex.of(self.actions, len(self.facts))

    @cached_property
    def costs(self) -> tuple[tuple[tuple[Expr, ...], ...], tuple[int, ...]]:
        """The different sums that actions cost, and which of them each action costs."""
        index: dict[tuple[Expr, ...], int] = {}
        which = tuple([index.setdefault(action.costs, len(index)) for action in self.actions])
        return tuple(index), which

    def with_actions(self, actions: Sequence[GroundAction], costs: Sequence[Number]) -> Grounding:
        """Return the grounding with other actions, numbered from 0, at constant costs."""
        actions_at_cost = tuple(
            replace(action, costs=(Constant(cost),))
            for action, cost in zip(actions, costs, strict=True)
        )
        return replace(self, actions=actions_at_cost, structure=actions_at_cost)

    def initial(self, problem: Problem) -> int:
        """Return the initial state of a problem."""
        keys = (k for k in self.value_sets if k in problem.values)
        return self.state_of([*problem.facts, *(value_fact(k, problem.values[k]) for k in keys)])

    def state_of(self, facts: Iterable[Fact]) -> int:
        """Return the state in which exactly these facts hold; constant facts are ignored."""
        return sum({1 << self.bits[fact] for fact in facts if fact in self.bits})

    def goal(self, problem: Problem) -> Tests:
        """Return a problem's goal as alternatives.

        There are alternatives for every combination of the changing values that the goal names.

        Raises:
            UnsupportedError: if bits cannot hold the goal.
        """
        grounder = Grounder(problem, self.bits, self.constant)
        looked_at = mentions(problem.goal, {}, problem) if compares(problem.goal) else ()
        names = {key for is_fact, key in looked_at if not is_fact}
        if not names.isdisjoint([(TOTAL_COST,), (TOTAL_TIME,)]):
            message = "the goal looks at the cost or time of the plan"
            raise UnsupportedError(message, hint="enhsp and kairos plan with such numbers")
        alternatives: list[Tests] = []
        for choice in combinations(names & self.value_sets.keys(), self.value_sets):
            bits = (grounder.bit(value_fact(key, value)) for key, value in choice.items())
            goal = grounder.tests(problem.goal, {}, {**problem.values, **choice})
            alternatives.append(all_of([goal, *(((bit, bit),) for bit in bits)]))
        return any_of(alternatives)


@no_garbage_search()
def ground(problem: Problem, deadline: float = inf) -> Grounding:
    """Return the grounding of a problem by relaxed reachability.

    Raises:
        UnsupportedError: if an action changes a number that is neither total-cost nor agent state,
            or an agent-state function has more than 16 reachable values.
        LimitError: if there are too many ground actions, or at the deadline (a time of
            ``time.monotonic()``).
    """
    check_supported(problem.domain)
    schema_instances, reachable_facts = reachable(problem, deadline)
    fluents = _fluents(problem, schema_instances, reachable_facts)
    constant = problem.facts.difference(fluents)
    plain_bits = {fact: i for i, fact in enumerate(fluents)}
    value_sets = reached_values(Grounder(problem, plain_bits, constant), schema_instances)
    facts = (*fluents, *(value_fact(key, value) for key in value_sets for value in value_sets[key]))
    bits = {fact: i for i, fact in enumerate(facts)}
    actions = ground_actions(
        Grounder(problem, bits, constant), schema_instances, value_sets, deadline
    )
    return Grounding(
        facts, bits, constant, value_sets,
        movers=tuple(i for i in schema_instances if any(numeric_effects(i.action))),
        actions=actions, structure=actions,
    )  # fmt: skip


def _fluents(
    problem: Problem, schema_instances: Iterable[SchemaInstance], reachable_facts: Set[Fact]
) -> list[Fact]:
    """Return the reachable facts that do not hold all the time."""
    deletes = {
        action.name: [EffectFacts(action, e, problem) for e in action.effects if e.kind == "delete"]
        for action in problem.domain.actions
    }
    deletable: set[Fact] = set()
    for instance in schema_instances:
        for facts in deletes[instance.action.name]:
            deletable.update(facts.of(instance.args))
    return sorted(reachable_facts & deletable | reachable_facts - problem.facts)
