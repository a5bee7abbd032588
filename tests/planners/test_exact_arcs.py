"""Distances in a complete graph equal those of relaxing every edge until nothing changes."""

import random
import time

import pytest

from hrcplan.planners.exact.arcs import Arcs
from hrcplan.planners.exact.graph import FAR, Graph
from hrcplan.task import Task
from hrcplan.task.ground import ground

LATER = time.monotonic() + 1000
ROAD = """
(define (domain road) (:requirements :typing :durative-actions :negative-preconditions)
  (:types agent place - object)
  (:predicates (at ?a - agent ?p - place) (next ?p ?q - place) (seen ?p - place))
  (:durative-action go :parameters (?a - agent ?p ?q - place) :duration (= ?duration 1)
    :condition (and (at start (at ?a ?p)) (over all (next ?p ?q)))
    :effect (and (at start (not (at ?a ?p))) (at end (at ?a ?q))))
  (:durative-action look :parameters (?a - agent ?p - place) :duration (= ?duration 2)
    :condition (over all (at ?a ?p)) :effect (at end (seen ?p))))
"""
ONE_WAY = """
(define (problem one-way) (:domain road) (:objects ann bob - agent a b c d - place)
  (:init (at ann a) (at bob b) (next a b) (next b c) (next c b) (next c d))
  (:goal (and (seen a) (seen d))))
"""


def edges_of(graph: Graph, task: Task) -> list[tuple[int, int, int]]:
    return [
        (source, *pair)
        for source in range(len(graph.states))
        for pair in zip(*[iter(graph.edges(task, source))] * 2, strict=True)
    ]


def relaxed(edges: list[tuple[int, int, int]], weights: list[int], least: list[int]) -> list[int]:
    """Return the distances that no edge makes smaller."""
    while True:
        before = list(least)
        for source, action, target in edges:
            least[source] = min(least[source], least[target] + weights[action])
        if least == before:
            return least


@pytest.mark.parametrize("names", [("transport", "two-boxes"), (ROAD, ONE_WAY)])
def test_distances(names: tuple[str, str]) -> None:
    task, graph, chance = ground(*names), Graph(), random.Random(1)
    assert graph.complete(task, 10_000, LATER)
    n_states, n_actions = len(graph.states), len(task.actions)
    edges, arcs = edges_of(graph, task), Arcs(task, graph)
    goals = [i for i, state in enumerate(graph.states) if task.is_goal(state)]
    by_agent = {agent: chance.randrange(9) for agent in task.problem.agents}
    for weights in (
        [1] * n_actions,
        [by_agent[action.args[0]] for action in task.actions],
        [chance.randrange(3) for _ in range(n_actions)],  # of one kind, different weights; some 0
        [by_agent[action.args[0]] + 2 for action in task.actions],
    ):
        least = [0 if i in goals else FAR for i in range(n_states)]
        nearest = [min(d, FAR) for d in relaxed(edges, weights, least)]
        assert arcs.distances(weights, goals, LATER) == nearest


def test_a_graph_that_has_grown() -> None:
    task, graph = ground(ROAD, ONE_WAY), Graph()
    beyond = task.with_facts(task.problem.facts - {("at", "ann", "a")} | {("at", "ann", "d")})
    assert graph.complete(beyond, 10_000, LATER)
    arcs, n_before = Arcs(task, graph), len(graph.states)
    weights = [1] * len(task.actions)
    assert len(arcs.distances(weights, [0], LATER)) == n_before
    assert graph.complete(task, 10_000, LATER)
    assert len(arcs.distances(weights, [0], LATER)) == len(graph.states) > n_before
