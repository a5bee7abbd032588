"""Faults of files as a document of SARIF 2.1.0, the format in which code hosts show them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from urllib.parse import quote

from hrcplan import __version__
from hrcplan.errors import Diagnostic

SCHEMA = "https://json.schemastore.org/sarif-2.1.0.json"


def sarif_document(diagnostics: Sequence[Diagnostic]) -> Mapping[str, object]:
    """Return a document with one result per fault; columns count characters.

    Paths inside the current folder are relative to it, as code hosts need them.
    """
    driver = {
        "name": "hrcplan check",
        "version": __version__,
        "informationUri": "https://github.com/hrcplan/hrcplan",
        "rules": [{"id": code} for code in sorted({fault.code for fault in diagnostics})],
    }
    run = {
        "tool": {"driver": driver},
        "columnKind": "unicodeCodePoints",
        "results": [_result(fault) for fault in diagnostics],
    }
    return {"$schema": SCHEMA, "version": "2.1.0", "runs": [run]}


def _result(fault: Diagnostic) -> Mapping[str, object]:
    hint = "" if fault.hint is None else f" ({fault.hint})"
    region = {"startLine": fault.line, "startColumn": fault.column}
    place = {"artifactLocation": {"uri": _uri(fault.path)}, "region": region}
    return {
        "ruleId": fault.code,
        "level": fault.severity,
        "message": {"text": fault.message + hint},
        "locations": [{"physicalLocation": place}],
    }


def _uri(name: str) -> str:
    path = Path(name).absolute()
    here = Path.cwd()
    return quote(str(path.relative_to(here))) if path.is_relative_to(here) else path.as_uri()
