"""Journals: what happened and what was decided, one JSON object per line.

The first line holds everything that a run depends on (problem, profile, nature): ``setup.py``.
Then events and decisions alternate, numbered without gaps; the last line is the outcome. A line is
on disk before a decision is acted on (``writer.py``). A process that is killed loses at most an
incomplete last line, which is removed when the run is resumed (``reader.py``).
"""

from hrcplan.execution.journal.file import JournalFile, open_journal
from hrcplan.execution.journal.reader import FORMAT, Journal, read_journal
from hrcplan.execution.journal.setup import RunSetup, setup_from_json
from hrcplan.execution.journal.writer import JournalWriter

__all__ = [
    "FORMAT",
    "Journal",
    "JournalFile",
    "JournalWriter",
    "RunSetup",
    "open_journal",
    "read_journal",
    "setup_from_json",
]
