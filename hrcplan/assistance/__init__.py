"""Robots that help a human whose goal they have to infer: history and belief in, step out.

The short way: ``ASSISTANTS.find("hrcplan")(bank)`` makes one; see `Assistant` for what it does.
"""

from hrcplan.assistance.assistant import Assistant, Options, Watched, Watcher, Why, why
from hrcplan.assistance.methods import ASSISTANTS

__all__ = ["ASSISTANTS", "Assistant", "Options", "Watched", "Watcher", "Why", "why"]
