"""Files in, domains and problems and every fault out.

The one way in: ``load`` and ``hrcplan check`` use the same pass, so what ``check`` accepts
can be loaded and what it rejects cannot.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from hrcplan.errors import Diagnostic, InputError, PddlError
from hrcplan.pddl import conventions, library
from hrcplan.pddl.domain import read_domain
from hrcplan.pddl.model import Domain, Problem
from hrcplan.pddl.problem import named_domain, read_problem
from hrcplan.pddl.reader import Group, read
from hrcplan.pddl.source import Source, in_order, nearest, quote, read_source


@dataclass(slots=True)
class _File:
    """One file on its way through the check."""

    source: Source
    root: Group | None
    kind: str
    domain: Domain | None = None
    problem: Problem | None = None


def check_files(paths: Sequence[str | Path]) -> tuple[Diagnostic, ...]:
    """Return every fault of the files, in order; problems are checked against their domains.

    A problem's domain is the one of its name among the files given, else beside the problem,
    else among the shipped ones.

    Raises:
        InputError: if none of the files can be opened is not raised: a missing file is a fault.
    """
    files = [_open(path) for path in paths]
    domains = {f.domain.name: f for f in files if f.domain is not None}
    for file in files:
        if file.kind == "problem":
            _check_problem(file, domains)
    return in_order([d for file in files for d in file.source.diagnostics])


def load_domain(path: str | Path) -> Domain:
    """Return the domain in a file.

    Raises:
        PddlError: with every fault of the file.
        InputError: if the file cannot be read.
    """
    file = _open(path, missing_ok=False)
    if file.kind == "problem":
        file.source.error(0, "not-a-domain", "this is a problem file, not a domain")
    _raise_errors(file.source)
    assert file.domain is not None
    return file.domain


def load_problem(domain: Domain, path: str | Path) -> Problem:
    """Return the problem in a file, read against its domain.

    Raises:
        PddlError: with every fault of the file.
        InputError: if the file cannot be read.
    """
    file = _open(path, missing_ok=False)
    if file.kind == "domain":
        file.source.error(0, "not-a-problem", "this is a domain file, not a problem")
    if file.root is not None and not file.source.has_errors:
        _read_problem(file, domain)
    _raise_errors(file.source)
    assert file.problem is not None
    return file.problem


def _raise_errors(source: Source) -> None:
    if source.has_errors:
        raise PddlError(in_order(source.diagnostics))


def _open(path: str | Path, missing_ok: bool = True) -> _File:
    try:
        source = read_source(path)
    except InputError as error:
        if not missing_ok:
            raise
        source = Source(str(path), "")
        source.error(0, error.code, error.message, error.hint)
    root = None if source.has_errors else read(source)
    file = _File(source, root, _kind(root, source))
    if file.kind == "domain" and root is not None:
        file.domain = read_domain(root, source)
        conventions.check_domain(file.domain, root, source)
    return file


def _kind(root: Group | None, source: Source) -> str:
    if root is None:
        return "unknown"
    heading = root[1] if len(root) > 1 else None
    head = heading.head if isinstance(heading, Group) else ""
    if root.head == "define" and head in ("domain", "problem"):
        return head
    message = "the file is neither (define (domain …)) nor (define (problem …))"
    source.error(root.at, "not-pddl", message)
    return "unknown"


def _check_problem(file: _File, given: Mapping[str, _File]) -> None:
    assert file.root is not None
    name = named_domain(file.root)
    if name is None:
        file.source.error(file.root.at, "no-domain", "the problem does not say its (:domain NAME)")
        return
    if name in given:
        domain = given[name].domain
    else:
        found = library.domain_file_for(str(name), Path(file.source.path))
        domain = None if found is None else _open(found).domain
    if domain is None:
        message = f"no domain {quote(name)} among the files given, beside the problem, or shipped"
        hint = nearest(name, [*given, *library.domain_names()])
        file.source.error(name.at, "domain-mismatch", message, hint)
        return
    _read_problem(file, domain)


def _read_problem(file: _File, domain: Domain) -> None:
    assert file.root is not None
    file.problem = read_problem(file.root, file.source, domain)
    if not file.source.has_errors:
        conventions.check_problem(file.problem, file.root, file.source)
