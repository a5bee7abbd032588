"""Plans carried out: a pure monitor, a journal, worlds, and the loop that joins them.

Public names: ``simulate(spec: Spec) -> Outcome`` runs one simulated collaboration;
``Outcome.measures()`` and ``means(rows)`` give the figures of Table I.
"""

from hrcplan.execution.outcome import MEASURES, Outcome, means
from hrcplan.execution.simulate import Engine, Spec, engine_for, simulate

__all__ = ["MEASURES", "Engine", "Outcome", "Spec", "engine_for", "means", "simulate"]
