"""Where the steps of a turn-taking episode happen: the worlds by name."""

from __future__ import annotations

from hrcplan.bank import Bank
from hrcplan.core.registry import Registry
from hrcplan.episodes.episode import TurnWorld

WORLDS: Registry[[Bank], TurnWorld] = Registry(
    "world",
    {
        "simulated": "hrcplan.episodes.episode:SimulatedTurns",
        "pddlgym": "hrcplan.episodes.pddlgym_world:PddlgymWorld",
    },
    "hrcplan.worlds",
    TurnWorld,
)
