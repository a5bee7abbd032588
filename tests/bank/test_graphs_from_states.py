"""Graphs from other states are remembered, up to a number of nodes, and are always the same."""

import pytest

from hrcplan.bank import bank as module
from hrcplan.bank import build_bank


def test_what_is_remembered_is_bounded(monkeypatch: pytest.MonkeyPatch) -> None:
    bank = build_bank("kitchen", only=["parfait-nut", "parfait-apple"])
    states = [bank.table.successor(bank.initial, step) for step in range(6)]
    wanted = [bank.graph_from(0, state).plans for state in states if state is not None]
    most = 2 * max(bank.graph_from(0, state).n_nodes for state in states if state is not None)
    bank._graphs.clear()
    monkeypatch.setattr(module, "MAX_REROOTED", most)
    for _ in range(2):
        found = []
        for state in states:
            if state is not None:
                found.append(bank.graph_from(0, state).plans)
                assert sum(graph.n_nodes + 1 for graph in bank._graphs.values()) <= most
        assert found == wanted
    assert 0 < len(bank._graphs) < len(set(states))


def test_a_graph_that_is_remembered_is_not_made_again() -> None:
    bank = build_bank("kitchen", only=["parfait-nut"])
    state = bank.table.successor(bank.initial, bank.table.find(("get", "nuts")))
    assert state is not None
    assert bank.graph_from(0, state) is bank.graph_from(0, state)
