"""Files in, domains and problems and every fault out.

The one way in: ``load_domain``, ``load_problem`` and ``hrcplan check`` use the same pass, so
what ``check`` accepts can be loaded and what it rejects cannot.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING

from hrcplan.core.garbage import no_garbage_search
from hrcplan.core.records import record
from hrcplan.core.text import nearest, quote
from hrcplan.errors import Diagnostic, InputError, PddlError
from hrcplan.pddl.annotations import check_calls
from hrcplan.pddl.domain import read_domain
from hrcplan.pddl.model import Domain, Note, Problem
from hrcplan.pddl.problem import named_domain, read_problem
from hrcplan.pddl.reader import GroupNode, read
from hrcplan.pddl.source import SourceText, in_order, read_source

if TYPE_CHECKING:
    from pathlib import Path

ADVICE = "unset-function"  # the one warning about what PDDL allows
_PROBLEM_SECTIONS = frozenset([":domain", ":objects", ":init", ":goal", ":metric"])


class _File:
    """One file on its way through the check."""

    def __init__(self, source: SourceText, root: GroupNode | None, kind: str) -> None:
        self.source = source
        self.root = root
        self.kind = kind
        self.domain: Domain | None = None
        self.problem: Problem | None = None


@record
class CheckReport:
    """The faults of some files, in order, and the notes in them."""

    n_files: int
    diagnostics: tuple[Diagnostic, ...]
    notes: tuple[tuple[str, Note], ...]

    @property
    def has_errors(self) -> bool:
        """Whether any of the faults is an error, not only a warning."""
        return any(d.severity == "error" for d in self.diagnostics)

    @property
    def is_sloppy(self) -> bool:
        """Whether any of the faults is more than a hint at values that may be forgotten."""
        return any(d.code != ADVICE for d in self.diagnostics)

    def to_json(self) -> dict[str, object]:
        """Return the document that ``hrcplan check --json`` prints."""
        from dataclasses import asdict

        return {"files": self.n_files, "diagnostics": [asdict(d) for d in self.diagnostics]}

    def lines(self) -> Iterator[str]:
        """Yield the lines that ``hrcplan check`` prints: faults, then notes."""
        yield from map(str, self.diagnostics)
        for path, note in self.notes:
            yield f"{path}: note: {note}"


@no_garbage_search()
def check(paths: Sequence[str | Path], texts: Mapping[str, str] | None = None) -> CheckReport:
    """Return every fault of the files; problems are checked against their domains.

    A problem's domain is the one of its name among the files given, else near the problem (in its
    folder, the one above, or ``domains/``), else among the shipped ones. A file that cannot be read
    is a fault like any other.

    Args:
        paths: The files, or names: ``DOMAIN`` or ``DOMAIN/PROBLEM``.
        texts: By path, what to read instead of the file, as an editor has it.
    """
    texts = texts or {}
    files = [file for path in paths for file in _open_named(str(path), texts)]
    domains = _Domains(files, texts)
    for file in files:
        if file.kind == "problem":
            _check_problem(file, domains)
    _check_calls(files, domains)
    return CheckReport(
        n_files=len(files),
        diagnostics=in_order([d for file in files for d in file.source.diagnostics]),
        notes=tuple(
            (file.source.path, note)
            for file in files
            for owner in (file.domain, file.problem)
            if owner is not None
            for note in owner.notes
        ),
    )


def check_files(paths: Sequence[str | Path]) -> tuple[Diagnostic, ...]:
    """Return the diagnostics of ``check``."""
    return check(paths).diagnostics


def load_domain(path: str | Path) -> Domain:
    """Return the domain in a file.

    Raises:
        PddlError: with every fault of the file.
        InputError: if the file cannot be read.
    """
    return domain_in(read_source(path))


@no_garbage_search()
def domain_in(source: SourceText) -> Domain:
    """Return the domain in a text.

    Raises:
        PddlError: with every fault of the text.
    """
    file = _read(source)
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
    return problem_in(domain, read_source(path))


@no_garbage_search()
def problem_in(domain: Domain, source: SourceText) -> Problem:
    """Return the problem in a text, read against its domain.

    Raises:
        PddlError: with every fault of the text.
    """
    file = _read(source)
    if file.kind == "domain":
        file.source.error(0, "not-a-problem", "this is a domain file, not a problem")
    elif file.kind == "problem" and file.root is not None:
        file.problem = read_problem(file.root, file.source, domain)
    _raise_errors(file.source)
    assert file.problem is not None
    return file.problem


def _raise_errors(source: SourceText) -> None:
    if source.has_errors:
        raise PddlError(in_order(source.diagnostics))


def kind_of(path: str | Path) -> str:
    """Return ``domain``, ``problem`` or ``unknown``: what a file is meant to be."""
    return _open(path).kind


def _open_named(name: str, texts: Mapping[str, str]) -> Sequence[_File]:
    if name in texts:
        return [_open(name, texts)]
    try:
        from hrcplan.pddl import library

        return [_open(path, texts) for path in library.named_files(name)]
    except InputError as error:
        return [_without_text(name, error)]


def _open(path: str | Path, texts: Mapping[str, str] = MappingProxyType({})) -> _File:
    if str(path) in texts:
        return _read(SourceText(str(path), texts[str(path)]))
    try:
        return _read(read_source(path))
    except InputError as error:
        return _without_text(str(path), error)


def _without_text(path: str, error: InputError) -> _File:
    source = SourceText(path, "")
    source.error(0, error.code, error.message, error.hint)
    return _File(source, None, "unknown")


def _read(source: SourceText) -> _File:
    """Return a file with its tree; a domain is read at once, a problem waits for its domain."""
    root = read(source)
    kind = "unknown" if root is None else _kind(root)
    file = _File(source, root, kind)
    if root is not None and kind == "domain":
        file.domain = read_domain(root, source)
    return file


def _kind(root: GroupNode) -> str:
    """Return ``domain`` or ``problem``: what the file says, else what its sections suggest."""
    heading = root[1] if len(root) > 1 else None
    head = heading.head if isinstance(heading, GroupNode) else ""
    if head in ("domain", "problem"):
        return str(head)
    sections = {node.head for node in root if isinstance(node, GroupNode)}
    return "domain" if sections.isdisjoint(_PROBLEM_SECTIONS) else "problem"


class _Domains:
    """Domains by name: those among the files given, then those found elsewhere."""

    def __init__(self, files: Sequence[_File], texts: Mapping[str, str]) -> None:
        self._texts = texts
        self.by_name: dict[str, _File] = {}
        for file in files:
            if file.domain is not None:
                self.by_name.setdefault(file.domain.name, file)
        self._by_path: dict[Path, _File] = {}
        self._places: dict[tuple[str, Path], Path | None] = {}

    def find(self, name: str, problem: Path) -> _File | None:
        """Return the domain file of this name for a problem file, or None."""
        if name in self.by_name:
            return self.by_name[name]
        place = (name, problem.parent)
        if place not in self._places:
            from hrcplan.pddl import library

            self._places[place] = library.domain_file_for(name, problem)
        path = self._places[place]
        if path is None:
            return None
        if path not in self._by_path:
            self._by_path[path] = _open(path, self._texts)
        return self._by_path[path]

    @property
    def only(self) -> _File | None:
        """The one domain among the files given, if there is just one."""
        return next(iter(self.by_name.values())) if len(self.by_name) == 1 else None


def _check_problem(file: _File, domains: _Domains) -> None:
    assert file.root is not None
    name = named_domain(file.root)
    from pathlib import Path

    domain = None if name is None else domains.find(str(name), Path(file.source.path))
    domain = domain or domains.only  # a wrong name is reported, and the rest is still checked
    if domain is not None and domain.domain is not None:
        file.source.reported_types = domain.source.unknown_types
        file.problem = read_problem(file.root, file.source, domain.domain)
        if domain.source.has_errors and domain not in domains.by_name.values():
            _report_faulty(file, file.root.at if name is None else name.at, domain)
    elif name is None:
        file.source.error(file.root.at, "no-domain", "the problem does not say its (:domain NAME)")
    else:
        message = f"no domain {quote(name)} given, near the problem, or shipped"
        from hrcplan.pddl import library

        hint = nearest(name, [*domains.by_name, *library.domain_names()])
        file.source.error(name.at, "domain-mismatch", message, hint)


def _check_calls(files: Sequence[_File], domains: _Domains) -> None:
    """Check which objects the domains ``call``, where problems that declare objects are given."""
    for file in domains.by_name.values():
        problems = [f.problem for f in files if f.problem and f.problem.domain is file.domain]
        if file.domain is not None and problems:
            objects = {name: t for problem in problems for name, t in problem.objects.items()}
            check_calls(file.source, file.domain, objects)


def _report_faulty(file: _File, at: int, domain_file: _File) -> None:
    message = f"the domain of this problem has faults of its own ({domain_file.source.path})"
    file.source.error(at, "faulty-domain", message, "check that file too")
