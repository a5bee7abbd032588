"""What the large objects print is one short line, however large they are."""

from __future__ import annotations

from dataclasses import replace

import pytest

from hrcplan.bank import Bank, build_bank

LONGEST = 200


@pytest.fixture(scope="module")
def bank() -> Bank:
    return build_bank("kitchen", only=["parfait-nut", "pasta-olive"])


def test_reprs_name_the_content_and_its_size(bank: Bank) -> None:
    task, graph = bank.goals.task, bank.graphs[0]
    assert repr(bank.goals) == "<Goals kitchen: 2 goals>"
    assert repr(bank).startswith("<Bank kitchen: 2 goals, ")
    assert f"{len(bank.table)} steps" in repr(bank.table)
    assert f"{graph.n_nodes} nodes, {graph.n_edges} edges" in repr(graph)
    assert f"{len(task.facts)} facts, {len(task.actions)} actions" in repr(task)


def test_reprs_stay_short_with_long_names(bank: Bank) -> None:
    domain = replace(bank.goals.problem.domain, name="d" * 1000)
    problem = replace(bank.goals.problem, name="p" * 1000, domain=domain)
    goals = replace(bank.goals, problem=problem)
    graph = replace(bank.graphs[0], goal="g" * 1000)
    for item in (goals, replace(bank, goals=goals), graph, goals.task, bank.table):
        assert len(repr(item)) <= LONGEST
        assert "\n" not in repr(item)
