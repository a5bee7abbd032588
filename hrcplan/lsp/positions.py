"""Offsets in a text as positions of the protocol, which count in the units of the editor."""

from __future__ import annotations

import re
from collections.abc import Sequence
from urllib.parse import quote, unquote, urlparse

from lsprotocol import types as lsp
from pygls.lsp.server import LanguageServer

from hrcplan.errors import Diagnostic
from hrcplan.pddl.source import SourceText

_WORD = re.compile(r"[^\s();]*")
_SEVERITIES = {
    "error": lsp.DiagnosticSeverity.Error,
    "warning": lsp.DiagnosticSeverity.Warning,
}


class Positions:
    """The positions of one text."""

    def __init__(self, server: LanguageServer, text: str) -> None:
        self._source = SourceText("", text)
        self._lines = text.splitlines(keepends=True)
        self._n_units = server.workspace.position_codec.client_num_units

    def range(self, at: int, length: int) -> lsp.Range:
        """Return the range of ``length`` characters from an offset."""
        return lsp.Range(self._position(at), self._position(at + length))

    def diagnostics(self, faults: Sequence[Diagnostic]) -> list[lsp.Diagnostic]:
        """Return faults for the editor; each covers the word at its place."""
        return [self._diagnostic(fault) for fault in faults]

    def _diagnostic(self, fault: Diagnostic) -> lsp.Diagnostic:
        line = self._lines[fault.line - 1] if fault.line <= len(self._lines) else ""
        start = fault.column - 1
        match = _WORD.match(line, start)
        end = max(match.end() if match else start, start + 1)
        where = lsp.Range(*(lsp.Position(fault.line - 1, self._n_units(line[:column]))
                            for column in (start, end)))  # fmt: skip
        hint = "" if fault.hint is None else f" ({fault.hint})"
        return lsp.Diagnostic(where, fault.message + hint, severity=_SEVERITIES[fault.severity],
                              code=fault.code, source="hrcplan")  # fmt: skip

    def _position(self, at: int) -> lsp.Position:
        line, column = self._source.position(at)
        return lsp.Position(line - 1, self._n_units(self._source.text[at - column + 1 : at]))


def path_of(uri: str) -> str:
    """Return the path of a file's address; of what is no address, the text itself."""
    try:
        return unquote(urlparse(uri).path)
    except ValueError:
        return uri


def uri_of(path: str) -> str:
    """Return the address of a file.

    >>> uri_of("/a b.pddl")
    'file:///a%20b.pddl'
    """
    return f"file://{quote(path)}"
