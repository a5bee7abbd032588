"""Banks and assistants that the sessions of one server share: each is made once."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from hrcplan.assistance.assistant import Assistant
from hrcplan.assistance.registry import ASSISTANTS
from hrcplan.bank import Bank
from hrcplan.bank.sources import goals_named
from hrcplan.collaboration.adviser import Adviser
from hrcplan.collaboration.collaborate import bank_for
from hrcplan.collaboration.events import AskReading, AskStep, Chosen, Read
from hrcplan.collaboration.setup import CollaborationSetup
from hrcplan.errors import HrcplanError
from hrcplan.execution import events as ev


@dataclass
class SharedBank:
    """A bank and its assistants.

    Attributes:
        bank: The bank.
        lock: Is held while an assistant works: caches of assistants are not made for threads.
    """

    bank: Bank
    lock: threading.RLock = field(default_factory=threading.RLock)
    _assistants: dict[str, Assistant[Any]] = field(default_factory=dict)
    _making: threading.Lock = field(default_factory=threading.Lock)

    def assistant(self, method: str) -> Assistant[Any]:
        """Return the assistant of a name, made at its first use."""
        with self._making:
            if method not in self._assistants:
                self._assistants[method] = ASSISTANTS.make(method, self.bank)
            return self._assistants[method]

    def prepare(self, method: str) -> None:
        """Make an assistant while people look at the page: they need not wait for it later."""

        def make() -> None:
            with contextlib.suppress(HrcplanError):  # the session that asks for it says so
                assistant = self.assistant(method)
                with self.lock:
                    assistant.choose(assistant.start())  # what is computed once is computed now

        if method not in self._assistants and len(self.bank.names) > 1:
            threading.Thread(target=make, daemon=True).start()

    def adviser(self, setup: CollaborationSetup) -> Adviser:
        """Return the adviser of one collaboration."""
        return SharedAdviser(setup, self)


class SharedAdviser(Adviser):
    """An adviser whose assistant other collaborations use, too."""

    def __init__(self, setup: CollaborationSetup, shared_bank: SharedBank) -> None:
        super().__init__(setup, shared_bank.bank, lambda _: shared_bank.assistant(setup.method))
        self._lock = shared_bank.lock

    def answer(self, ask: ev.AskPlan | AskStep | AskReading) -> ev.Planned | Chosen | Read:
        """Return the event that answers a question."""
        if isinstance(ask, ev.AskPlan):
            return super().answer(ask)  # planners run in processes of their own
        with self._lock:
            return super().answer(ask)

    def locked(self, question: Callable[[], Any]) -> Any:
        """Return the answer to another question to the assistant."""
        with self._lock:
            return question()


class Banks:
    """The banks of one server, by domain and goals."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._by_source: dict[tuple[str, str | None], SharedBank] = {}
        self._building: dict[tuple[str, str | None], threading.Lock] = {}

    def get(self, domain: str, goals: str | None) -> SharedBank:
        """Return the bank of goals; a second request waits for the first one.

        Raises:
            HrcplanError: as for ``goals_named`` and ``bank_for``.
        """
        key = (domain, goals)
        with self._lock:
            building = self._building.setdefault(key, threading.Lock())
        with building:
            if key not in self._by_source:
                self._by_source[key] = SharedBank(bank_for(goals_named(domain, goals)))
            return self._by_source[key]
