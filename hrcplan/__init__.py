"""PDDL-first human-robot collaborative planning."""

__version__ = "0.1.0"
