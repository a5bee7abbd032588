"""The laws of robot links: the simulated robot keeps them, and each is broken once."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from typing import Any

import pytest

from hrcplan.execution import events as ev
from hrcplan.execution.links import messages as msg
from hrcplan.execution.links.process import SimulatedRobot
from hrcplan.testing import check_link
from hrcplan.testing import links as laws

MOVE = ("move", ("robot", "wp0", "wp3"))


def test_the_simulated_robot_keeps_the_laws() -> None:
    check_link(SimulatedRobot, MOVE, "robot")


class Obedient:
    """A link without a program: answers at once."""

    def __init__(self) -> None:
        self.replies: list[msg.LinkMessage] = []
        self.outcomes: dict[int, str] = {}

    def start(self) -> None:
        self.replies, self.outcomes = [], {}

    def send(self, message: Mapping[str, Any]) -> bool:
        match message["do"]:
            case "begin":
                self.replies.append(msg.LinkReady())
            case "dispatch":
                self.dispatch(message)
            case "cancel":
                self.cancel(message["n"])
        return True

    def dispatch(self, message: Mapping[str, Any]) -> None:
        if message["action"] != "move":
            self.replies.append(msg.Rejected(message["n"]))
        else:
            self.end(message["n"], ev.DONE)

    def cancel(self, number: int) -> None:
        self.end(number, ev.CANCELLED)

    def end(self, number: int, outcome: str) -> None:
        self.replies.append(msg.ActionEnded(number, self.outcomes.setdefault(number, outcome)))

    def receive(self, timeout_s: float) -> Sequence[msg.LinkMessage]:
        replies, self.replies = self.replies, []
        if not replies:
            time.sleep(min(timeout_s, 0.01))
        return replies

    def close(self) -> None:
        self.replies = [msg.LinkEnded("closed")]


def test_an_obedient_link_keeps_the_laws() -> None:
    check_link(Obedient, MOVE, "robot")


class Silent(Obedient):
    def send(self, message: Mapping[str, Any]) -> bool:
        return True


class NeverEnding(Obedient):
    def end(self, number: int, outcome: str) -> None:
        self.replies.append(msg.Accepted(number))


class Fickle(Obedient):
    def dispatch(self, message: Mapping[str, Any]) -> None:
        again = message["n"] in self.outcomes
        super().dispatch(message)
        if again:
            self.replies.append(msg.ActionEnded(message["n"], ev.FAILED))


class Unstoppable(Obedient):
    def dispatch(self, message: Mapping[str, Any]) -> None:
        if message["n"] != 1:
            super().dispatch(message)

    def cancel(self, number: int) -> None:
        self.replies.append(msg.Feedback(number, "no"))


class Pretender(Obedient):
    def dispatch(self, message: Mapping[str, Any]) -> None:
        self.end(message["n"], ev.DONE)


class Fragile(Obedient):
    def dispatch(self, message: Mapping[str, Any]) -> None:
        if message["action"] != "move":
            self.replies.append(msg.LinkEnded("it cannot stand that"))
        super().dispatch(message)


class Mumbling(Obedient):
    def end(self, number: int, outcome: str) -> None:
        self.replies.append(msg.BadLine("no JSON"))


class Undead(Obedient):
    def close(self) -> None:
        self.replies = [msg.Feedback(0, "still here")]


@pytest.mark.parametrize(
    ("link", "law"),
    [
        (Silent, "does not say that it is ready"),
        (NeverEnding, "an action does not end"),
        (Fickle, "two outcomes"),
        (Unstoppable, "an action that is cancelled does not end"),
        (Pretender, "an unknown action is done"),
        (Fragile, "it ended: it cannot stand that"),
        (Mumbling, "no JSON"),
        (Undead, "it goes on after close"),
    ],
)
def test_each_law_is_broken_once(
    link: type[Obedient], law: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(laws, "READY_S", 0.1)
    monkeypatch.setattr(laws, "ANSWER_S", 0.1)
    with pytest.raises(AssertionError, match=law):
        check_link(link, MOVE, "robot", duration_s=0.05)
