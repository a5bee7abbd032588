"""Chains and cliques against partial orders and plans that are listed."""

import random
from collections import Counter
from itertools import combinations, permutations

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from hrcplan.bank import BuildOptions, PlanGraph, build, orders
from hrcplan.bank.chains import Chain, Clique, Leaf, chains_and_cliques, n_added, n_orders
from hrcplan.bank.htn import decompose
from hrcplan.bank.walk import plans
from hrcplan.errors import LimitError
from hrcplan.search.packed_states import FactPacking

DEAR = 3  # a step that costs 2
N_SHAPE = {2: {0, 1}, 3: {1}}  # 0 before 2, 1 before 2 and 3


@st.composite
def partial_orders(draw, most=6):
    """Draw, for each of some numbers, all that come before it."""
    n = draw(st.integers(1, most))
    names = draw(st.permutations(range(n)))
    pairs = list(combinations(names, 2))
    chosen = draw(st.lists(st.sampled_from(pairs), unique=True)) if pairs else []
    return closed(n, chosen)


def closed(n, pairs):
    before = {i: {a for a, b in pairs if b == i} for i in range(n)}
    for _ in range(n):
        before = {i: s.union(*(before[a] for a in s)) for i, s in before.items()}
    return before


def extensions(before):
    return {
        p for p in permutations(before)
        if all(before[x] <= set(p[:i]) for i, x in enumerate(p))
    }  # fmt: skip


def task_of(before):
    """Return the PDDL of a task whose plans are the orders of a partial order."""
    actions = " ".join(
        f"(:action s{i} :parameters () :effect (d{i})"
        f" :precondition (and {' '.join(f'(d{a})' for a in sorted(earlier))}))"
        for i, earlier in before.items()
    )
    facts = " ".join(f"(d{i})" for i in before)
    return (
        f"(define (domain d) (:requirements :strips) (:predicates {facts}) {actions})",
        f"(define (problem g) (:domain d) (:init) (:goal (and {facts})))",
    )


def cost(steps):
    return sum(2 if step == DEAR else 1 for step in steps)


def graph_of(listed):
    """Return a graph of just these plans; where one can go on alike at one cost is one node."""
    prefixes = sorted(
        {p[:n] for p in listed for n in range(len(p) + 1)}, key=lambda p: (cost(p), p)
    )
    ways = {prefix: frozenset(p[len(prefix) :] for p in listed if p[: len(prefix)] == prefix)
            for prefix in prefixes}  # fmt: skip
    nodes = list(dict.fromkeys((cost(p), ways[p]) for p in prefixes))
    index = {node: i for i, node in enumerate(nodes)}
    edges = [
        (i, step, index[(paid + cost([step]), frozenset(r[1:] for r in rest if r[:1] == (step,)))])
        for i, (paid, rest) in enumerate(nodes)
        for step in sorted({r[0] for r in rest if r})
    ]
    costs = [paid for paid, _ in nodes]
    return PlanGraph(
        goal="g",
        packing=FactPacking((0,)),
        rows=np.zeros((len(nodes), 1), dtype=np.uint64),
        layers=tuple((paid, costs.index(paid)) for paid in dict.fromkeys(costs)),
        first=np.searchsorted([e[0] for e in edges], np.arange(len(nodes) + 1)).astype(np.int64),
        steps=np.array([e[1] for e in edges], dtype=np.int32),
        targets=np.array([e[2] for e in edges], dtype=np.int32),
        is_goal=np.array([() in rest for _, rest in nodes], dtype=np.bool_),
    )


def allowed(htn, kind):
    """Return every order that a tree allows for the steps of one of its kinds."""
    found, waiting = set(), [((), kind.steps)]
    while waiting:
        done, left = waiting.pop()
        if not left:
            found.add(done)
        for step in htn.available(left):
            i = left.index(step)
            waiting.append(((*done, step), left[:i] + left[i + 1 :]))
    return found


def holds_an_n(before):
    def free(a, b):
        return a not in before[b] and b not in before[a]

    return any(
        a in before[c] and b in before[c] and b in before[d]
        and free(a, b) and free(c, d) and free(a, d)
        for a, b, c, d in permutations(before, 4)
    )  # fmt: skip


@settings(max_examples=60)
@given(before=partial_orders())
def test_what_it_allows_are_plans_and_only_an_n_costs_any(before, read_world):
    graph = build(read_world(*task_of(before))).graphs[0]
    wanted = extensions(before)
    assert set(plans(graph)) == wanted
    htn = decompose(graph)
    (kind,) = htn.kinds
    assert (kind.exact, htn.exact, htn.complete) == (True, True, True)
    assert htn.plans == kind.plans == len(wanted)
    orders_ = allowed(htn, kind)
    assert len(orders_) == htn.orders
    assert all(graph.is_goal[graph.after(order)] for order in orders_)
    assert (htn.added > 0) == holds_an_n(before)
    assert (orders_ == wanted) == (not htn.added)


def reference(before, steps):
    """The rule as it is written, over all sets; trees as nested tuples."""
    if len(steps) == 1:
        return min(steps)

    def free(a, b):
        return a not in before[b] and b not in before[a]

    def parts(linked):
        left, found = set(steps), []
        while left:
            part = {min(left)}
            while more := {b for a in part for b in left - part if linked(a, b)}:
                part |= more
            left -= part
            found.append(part)
        return found

    apart = parts(lambda a, b: not free(a, b))
    if len(apart) > 1:
        return ("any", 0, *(reference(before, part) for part in apart))
    rows = parts(free)
    if len(rows) > 1:
        rows.sort(key=lambda part: len(before[min(part)] & steps))
        return ("order", 0, *(reference(before, part) for part in rows))
    cuts = []
    for size in range(1, len(steps)):
        for first in map(set, combinations(sorted(steps), size)):
            if all(before[x] & steps <= first for x in first):
                added = sum(free(a, b) for a in first for b in steps - first)
                cuts.append((added, size, sorted(first)))
    added, _, first = min(cuts)
    children = []
    for part in (set(first), steps - set(first)):
        tree = reference(before, part)
        chain = isinstance(tree, tuple) and tree[0] == "order"
        children += tree[2:] if chain else [tree]
        added += tree[1] if chain else 0
    return ("order", added, *children)


def as_tuples(node):
    if isinstance(node, Leaf):
        return node.step
    name = "order" if isinstance(node, Chain) else "any"
    return (name, len(node.added), *map(as_tuples, node.children))


@settings(max_examples=150)
@given(before=partial_orders(most=9))
def test_the_rule_is_the_stated_one(before):
    masks = {i: sum(1 << a for a in earlier) for i, earlier in before.items()}
    tree = chains_and_cliques((1 << len(before)) - 1, masks, range(len(before)))
    assert as_tuples(tree) == reference(before, set(before))


def test_an_n():
    masks = {i: sum(1 << a for a in N_SHAPE.get(i, ())) for i in range(4)}
    tree = chains_and_cliques(15, masks, range(4))
    assert tree == Chain(
        (Leaf(1, 2), Clique((Chain((Leaf(0, 1), Leaf(2, 4)), 5), Leaf(3, 8)), 13)), 15, ((1, 0),)
    )
    assert (n_orders(tree), n_added(tree)) == (3, 1)
    assert len(extensions(closed(4, [(0, 2), (1, 2), (1, 3)]))) == 5


def copies(plan):
    """Name the times that a step is done apart: from the last, as (step, times still to come)."""
    return [(step, plan[i + 1 :].count(step)) for i, step in enumerate(plan)]


plan_sets = st.sets(
    st.lists(st.integers(0, 3), max_size=5).map(tuple), min_size=1, max_size=12
).map(lambda found: {p for p in found if not any(p != q and p == q[: len(p)] for q in found)})


@st.composite
def shuffled(draw):
    """Draw most of the orders of a few steps: what looks like a partial order, and may be none."""
    steps = draw(st.lists(st.integers(0, 3), min_size=2, max_size=4))
    every = sorted(set(permutations(steps)))
    return set(draw(st.lists(st.sampled_from(every), min_size=max(1, len(every) - 3), unique=True)))


# These meet at the end, from layers of different cost.
@example(listed={(0, 0, 1, 3, 3), (0, 0, 3, 3, 0)})
@settings(max_examples=300)
@given(listed=plan_sets | shuffled())
def test_any_plans_at_all(listed):
    graph = graph_of(listed)
    assert set(plans(graph)) == listed
    htn = decompose(graph)
    kinds = {}
    for plan in listed:
        kinds.setdefault(tuple(sorted(plan)), []).append(plan)
    ranked = sorted(kinds, key=lambda k: (cost(k), len(k), sorted(Counter(k).items())))
    assert [kind.steps for kind in htn.kinds] == ranked
    for kind in htn.kinds:
        same = kinds[kind.steps]
        before = {
            x: {a for a in copies(same[0])
                if all(copies(p).index(a) < copies(p).index(x) for p in same)}
            for x in copies(same[0])
        }  # fmt: skip
        n_extensions = len(extensions(before))
        assert kind.plans == len(same)
        assert kind.exact == (n_extensions == len(same))
        assert (kind.orders == n_extensions) == (not kind.added)
        if len(htn.kinds) == 1:
            assert len(allowed(htn, kind)) == kind.orders
            assert not kind.exact or allowed(htn, kind) <= listed
    assert htn.exact == all(kind.exact for kind in htn.kinds)


@settings(max_examples=60)
@given(before=partial_orders(), seed=st.integers(0, 99), data=st.data())
def test_choices_end_in_a_plan_whoever_else_takes_part(before, seed, data):
    graph = graph_of(extensions(before))
    htn, rng = decompose(graph), random.Random(seed)
    left, last, node = set(before), None, 0
    while left:
        other = data.draw(st.booleans())
        step = (
            rng.choice(list(graph.next(node))) if other else htn.choose(left, last, rng.randrange)
        )
        assert other or step in htn.available(left)
        node = graph.next(node)[step]
        left.remove(step)
        last = last if other else step
    assert graph.is_goal[node]
    assert htn.choose(left, last, rng.randrange) is None
    assert htn.available(left) == ()


def test_what_was_begun_is_finished():
    """0 before 1, and 2 before 3, have nothing to do with each other."""
    htn = decompose(graph_of(extensions(closed(4, [(0, 1), (2, 3)]))))
    asked = []

    def pick(n):
        asked.append(n)
        return n - 1

    assert htn.available({0, 1, 2, 3}) == (0, 2)
    assert htn.choose({0, 1, 2, 3}, None, pick) == 2
    assert htn.choose({0, 1, 3}, 2, pick) == 3
    assert asked == [2]
    assert htn.choose({1, 2, 3}, 0, pick) == 1
    assert htn.choose({2, 3}, 1, pick) == 2  # there is nothing to choose from
    assert asked == [2]
    assert htn.choose({0, 7}, None, pick) is None
    assert htn.available({0, 7}) == ()


def test_two_kinds():
    """Either 0 before 1 or 2 before 3, with 4 at any time."""
    one, other = ({tuple(4 if x == 2 else x + shift for x in p)
                   for p in extensions(closed(3, [(0, 1)]))} for shift in (0, 2))  # fmt: skip
    htn = decompose(graph_of(one | other))
    assert (len(htn.kinds), htn.exact, htn.plans, htn.orders) == (2, True, 6, 6)
    assert htn.available([0, 1, 4]) == (0, 4)
    assert htn.available([1]) == (1,)
    assert htn.available([4]) == (4,)
    assert htn.available([0, 2]) == ()
    assert htn.choose([4], None, lambda n: n - 1) == 4
    assert htn.choose([0, 2], None, lambda n: 0) is None
    assert htn.choose([3, 4], 2, lambda n: 0) == 3


def test_a_step_that_is_done_twice():
    htn = decompose(graph_of({(5, 2, 5)}))
    assert htn.kinds[0].steps == (2, 5, 5)
    assert htn.available([5, 2, 5]) == (5,)
    assert htn.available([5, 2]) == (2,)
    assert htn.available([5, 5, 5]) == ()


def test_the_cheapest_kinds_come_first_and_some_are_left_out(monkeypatch):
    listed = {(3, 3), (0, 1, 2), (2, 1, 0), (1, 2)}
    graph = graph_of(listed)
    assert [k.steps for k in decompose(graph).kinds] == [(1, 2), (0, 1, 2), (3, 3)]
    monkeypatch.setattr(orders, "MAX_KINDS", 2)
    few = decompose(graph)
    assert ([k.steps for k in few.kinds], few.complete) == ([(1, 2), (0, 1, 2)], False)
    assert (few.plans, [k.plans for k in few.kinds]) == (4, [1, 2])
    monkeypatch.setattr(orders, "step_multisets", lambda graph: None)
    assert decompose(graph).kinds == few.kinds
    monkeypatch.setattr(orders, "MAX_LISTED", 1)
    assert [k.steps for k in decompose(graph).kinds] == [(1, 2)]


def test_too_many_ways(monkeypatch):
    """0 and 1 lead to one node, which has to be looked at as two."""
    graph = graph_of({(0, 1), (0, 0), (1, 1), (1, 0)})
    assert decompose(graph).orders == 4
    monkeypatch.setattr(orders, "MAX_PLACES", 3)
    with pytest.raises(LimitError, match="too many ways"):
        decompose(graph)


def test_more_steps_than_a_word_has_bits(read_world):
    before = closed(70, [])
    before |= {i: {i - 1} for i in range(70) if i % 35}
    htn = decompose(build(read_world(*task_of(before))).graphs[0])
    assert (htn.exact, htn.added, len(htn.kinds[0].root.children)) == (True, 0, 2)
    assert htn.orders == htn.plans > 1 << 64


def test_nothing_to_do_and_nothing_that_can_be_done(read_world):
    domain, _ = task_of({0: set()})
    domain = domain.replace(":strips", ":adl").replace("(d0))", "(d0) (e))", 1)
    problem = "(define (problem {}) (:domain d) (:init) (:goal {}))"
    bank = build(read_world(domain, problem.format("a", "(and)"), problem.format("b", "(e)")))
    idle, never = map(decompose, bank.graphs)
    assert (len(idle.kinds), idle.plans, idle.orders, idle.exact) == (1, 1, 1, True)
    assert (never.kinds, never.plans, never.orders) == ((), 0, 0)
    for htn in (idle, never):
        assert htn.available([]) == htn.available([0]) == ()
        assert htn.choose([], None, len) is htn.choose([0], None, len) is None


def test_bounded_banks_too(read_world):
    """With steps to spare a plan can do a step again, and its kind has more than one node's."""
    bank = build(read_world(*task_of(closed(3, [(0, 2)]))), BuildOptions(quality=2))
    htn = decompose(bank.graphs[0])
    assert sum(kind.plans for kind in htn.kinds) == htn.plans
    assert htn.kinds[0].steps == (0, 1, 2)


def test_every_recipe_of_the_kitchen(kitchen):
    rng = random.Random(1)
    for graph in kitchen.graphs:
        htn = decompose(graph)
        assert (len(htn.kinds), htn.exact, htn.complete) == (1, True, True)
        assert htn.plans == graph.plans == htn.kinds[0].plans
        assert htn.added > 0
        assert 1000 < htn.orders < htn.plans
        left, last, node = set(graph.used_steps), None, 0
        for turn in range(graph.n_steps):
            if turn % 2:
                step = rng.choice(list(graph.next(node)))
            else:
                step = last = htn.choose(left, last, rng.randrange)
            assert turn % 2 or step in htn.available(left)
            node = graph.next(node)[step]
            left.remove(step)
        assert graph.is_goal[node]
