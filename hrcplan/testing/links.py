"""Laws of robot links."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence

from hrcplan.core.json_values import JsonValue
from hrcplan.execution import events as ev
from hrcplan.execution.links import RobotLink
from hrcplan.execution.links import messages as msg

READY_S = 10.0
ANSWER_S = 5.0

ActionCall = tuple[str, tuple[str, ...]]
"""An action and its arguments, as in ``("move", ("robot", "wp0", "wp3"))``."""


def check_link(
    make: Callable[[], RobotLink], action: ActionCall, agent: str, duration_s: float = 0.2
) -> None:
    """Test the laws of robot links, with an action that the robot can carry out now and again.

    A link says that it is ready. It answers a dispatch, and ends every action with one outcome.
    A dispatch of the same number is the same action: it is not carried out twice. An action that is
    cancelled ends, too. An action that the robot has not is refused or fails, and does no harm to
    the next one. What it says are messages. After ``close`` it has ended, and it can start again.

    Args:
        make: Returns a link (see `hrcplan.execution.links.RobotLink`).
        action: The action and its arguments.
        agent: Who does it.
        duration_s: How long it is to take, in real seconds.

    Raises:
        AssertionError: if a law is broken.
    """
    link = make()
    try:
        for _ in range(2):
            _check_run(_Talk(link), action, agent, duration_s)
            link.close()
            last = link.receive(0.1)
            has_ended = bool(last) and isinstance(last[-1], msg.LinkEnded)
            assert has_ended, "it goes on after close"
    finally:
        link.close()


class _Talk:
    """A conversation with a link that has just started; remembers every outcome."""

    def __init__(self, link: RobotLink) -> None:
        self.link = link
        self.outcomes: dict[int, list[str]] = {}

    def say(self, **message: JsonValue) -> None:
        assert self.link.send(message), f"it does not take {message}"

    def hear(self, seconds: float, until: Callable[[msg.LinkMessage], bool]) -> bool:
        """Return whether a message comes in time."""
        end_s = time.monotonic() + seconds
        while (left_s := end_s - time.monotonic()) > 0:
            for message in self.link.receive(left_s):
                assert not isinstance(message, msg.BadLine), message
                assert not isinstance(message, msg.LinkEnded), f"it ended: {message.why}"
                if isinstance(message, msg.ActionEnded):
                    self.outcomes.setdefault(message.number, []).append(message.outcome)
                if until(message):
                    return True
        return False

    def has_ended(self, number: int, seconds: float) -> bool:
        """Return whether an action has ended, or ends in time."""
        return number in self.outcomes or self.hear(
            seconds, lambda m: isinstance(m, msg.ActionEnded | msg.Rejected) and m.number == number
        )


def _check_run(talk: _Talk, action: ActionCall, agent: str, duration_s: float) -> None:
    name, args = action

    def dispatch(number: int, name: str = name, args: Sequence[str] = args) -> None:
        order: Mapping[str, JsonValue] = {
            "n": number, "agent": agent, "action": name, "args": list(args),
            "duration_s": duration_s, "limit_s": 3 * duration_s,
        }  # fmt: skip
        talk.say(do="dispatch", **order)

    talk.link.start()
    talk.say(do="begin", link=1, agents=[agent], actions=[name], speed=1.0)
    is_ready = talk.hear(READY_S, lambda m: isinstance(m, msg.LinkReady))
    assert is_ready, f"it does not say that it is ready within {READY_S:g} s"
    dispatch(0)
    assert talk.has_ended(0, 3 * duration_s + ANSWER_S), "an action does not end"
    dispatch(0)
    talk.hear(2 * duration_s, lambda m: False)
    assert len(set(talk.outcomes.get(0, ()))) <= 1, "an action has two outcomes"
    dispatch(1)
    talk.say(do="cancel", n=1)
    assert talk.has_ended(1, ANSWER_S), "an action that is cancelled does not end"
    dispatch(2, "no-such-action", ("nothing",))
    assert talk.has_ended(2, 3 * duration_s + ANSWER_S), "an unknown action is not answered"
    assert ev.DONE not in talk.outcomes.get(2, ()), "an unknown action is done"
    dispatch(3)
    assert talk.has_ended(3, 3 * duration_s + ANSWER_S), "after a refusal an action does not end"
