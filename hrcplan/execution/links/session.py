"""A conversation with one link: it begins, may be lost and begin again, and ends."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Mapping, Sequence

from hrcplan.core.json_values import JsonValue
from hrcplan.errors import PlannerError, UsageError
from hrcplan.execution.links import RobotLink
from hrcplan.execution.links import messages as msg
from hrcplan.execution.links.clock import RunClock
from hrcplan.execution.model import ExecutionModel

READY_S = 10.0  # how long a link may take to start
MAX_RESTARTS = 3
MAX_INBOX = 10_000  # messages that are taken in at a time


class LinkSession:
    """Speaks with a link about one problem.

    Attributes:
        served: The agents whose actions the link carries out.
        is_lost: Whether the link has ended for good.
    """

    def __init__(self, link: RobotLink, model: ExecutionModel, clock: RunClock) -> None:
        self.served = frozenset(model.agents.robots)
        self.is_lost = False
        self._link, self._model, self._clock = link, model, clock
        self._inbox: deque[msg.LinkMessage] = deque()
        self._n_restarts = 0

    def start(self) -> None:
        """Start the link, and wait until it is ready.

        Raises:
            PlannerError: if the program is missing, ends at once, or does not say that it is ready.
            UsageError: if it takes actions of agents that the problem has not.
        """
        self._link.start()
        self.send({
            "do": "begin", "link": 1, "agents": sorted(self._model.agents.robots),
            "actions": [action.name for action in self._model.problem.domain.actions],
            "speed": self._clock.speed,
        })  # fmt: skip
        until = self._clock.real_s + READY_S
        while (left_s := until - self._clock.real_s) > 0:
            for message in self._link.receive(left_s):
                if isinstance(message, msg.LinkEnded):
                    raise PlannerError(f"the robot's program ended: {message.why}", code="robot")
                if isinstance(message, msg.LinkReady):
                    self._serve(message.agents)
                    return
        message_text = f"the robot's program does not say that it is ready within {READY_S:g} s"
        hint = 'it prints {"event": "ready"} when it can take actions'
        raise PlannerError(message_text, code="robot", hint=hint)

    def _serve(self, agents: Sequence[str]) -> None:
        unknown = sorted(set(agents) - set(self._model.problem.agents))
        if unknown:
            message = f"the robot's program takes actions of {', '.join(unknown)}: no agents here"
            raise UsageError(message, hint=f"agents: {', '.join(self._model.problem.agents)}")
        self.served = frozenset(agents) or frozenset(self._model.agents.robots)

    def restart(self) -> str | None:
        """Start a link again that has ended; return why that cannot be done, or None."""
        self._n_restarts += 1
        fault = f"it ended {self._n_restarts} times"
        if self._n_restarts <= MAX_RESTARTS:
            try:
                self.start()
            except (PlannerError, UsageError) as error:
                fault = error.message
            else:
                return None
        self.is_lost = True
        return fault

    def send(self, message: Mapping[str, JsonValue]) -> bool:
        """Send a message; return whether it could be sent."""
        return self._link.send(message)

    def wait(self, seconds: float) -> None:
        """Return when a message has come, or after a time."""
        if not self._inbox and not self.is_lost:
            self._inbox.extend(self._link.receive(seconds))

    def messages(self) -> Iterator[msg.LinkMessage]:
        """Yield all messages that have come, also those that come meanwhile."""
        for _ in range(MAX_INBOX):
            self.wait(0.0)
            if not self._inbox:
                return
            message = self._inbox.popleft()
            yield message
            if isinstance(message, msg.LinkEnded):
                return

    def observe(self, seconds: float) -> msg.FactsObserved | None:
        """Ask what is true now, and return the answer if it comes in time."""
        if not self.send({"do": "observe"}):
            return None
        until = self._clock.real_s + seconds
        others: list[msg.LinkMessage] = []
        answer: msg.FactsObserved | None = None
        while answer is None and (left_s := until - self._clock.real_s) > 0:
            for message in self._link.receive(left_s):
                if isinstance(message, msg.FactsObserved) and answer is None:
                    answer = message
                    continue
                others.append(message)
                if isinstance(message, msg.LinkEnded):
                    until = 0.0
        self._inbox.extend(others)
        return answer

    def close(self) -> None:
        """End the conversation and the link."""
        self.send({"do": "end"})
        self._link.close()
