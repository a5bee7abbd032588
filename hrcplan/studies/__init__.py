"""Studies: a specification gives rows, rows give a report; nothing here plans or infers.

Public names: ``run_study(name, folder, ...)`` fills ``rows.sqlite``, ``report_study(folder)``
writes ``report.json`` and ``report.html`` from it.
"""

from hrcplan.studies.report import report_study
from hrcplan.studies.run import run_study

__all__ = ["report_study", "run_study"]
