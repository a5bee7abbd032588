"""The command line: parse, call, print. The only place that exits or prints."""

from hrcplan.cli.main import main

__all__ = ["main"]
