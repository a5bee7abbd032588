"""Every registry of parts has a law, and the documents say so."""

from __future__ import annotations

import re
from importlib import import_module
from pathlib import Path

import pytest

from hrcplan import testing
from hrcplan.core.registry import PartNames

ROOT = Path(__file__).resolve().parent.parent.parent
PAGES = [ROOT / "CONTRIBUTING.md", ROOT / "docs" / "reference" / "python" / "protocols.md"]


def registries() -> dict[str, PartNames]:
    """Return the registries of the package by their entry-point group."""
    found = {}
    for path in sorted((ROOT / "hrcplan").rglob("*.py")):
        if re.search(r"^[A-Z_]+: (Object)?Registry\[", path.read_text("utf-8"), re.MULTILINE):
            module = ".".join(path.relative_to(ROOT).with_suffix("").parts)
            for value in vars(import_module(module)).values():
                if isinstance(value, PartNames):
                    found[value.group] = value
    return found


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_every_registry_has_a_law_that_the_documents_name(page: Path) -> None:
    rows = re.findall(r"\| `(check_\w+)` \| `([\w.]+)` \|$", page.read_text("utf-8"), re.MULTILINE)
    laws = {group: law for law, group in rows}
    assert set(laws) == set(registries())
    assert len(set(laws.values())) == len(laws)
    assert set(laws.values()) <= set(testing.__all__)
