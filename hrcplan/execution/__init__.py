"""Plans carried out: a pure monitor, a journal, worlds, and the loop that joins them.

Public names: ``simulate(spec: Spec) -> Row`` runs one simulated collaboration;
``Row.measures()`` and ``means(rows)`` give the figures of Table I.
"""

from hrcplan.execution.row import MEASURES, Row, means
from hrcplan.execution.simulate import Engine, Spec, engine_for, simulate

__all__ = ["MEASURES", "Engine", "Row", "Spec", "engine_for", "means", "simulate"]
