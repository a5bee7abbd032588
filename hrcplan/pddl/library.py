"""Shipped domains and problems: find a file by path or by name.

``os.path`` answers False for a name that no file can have, where ``Path.is_file`` raises.

In a checkout the folders ``domains/`` and ``problems/`` next to the package come first, so a
file that was added a second ago is seen; an installed wheel carries a copy inside the package.
"""

from __future__ import annotations

import os
import re
import warnings
from collections.abc import Iterator, Sequence
from pathlib import Path

from hrcplan.core.text import nearest
from hrcplan.errors import InputError

_PACKAGE = Path(__file__).resolve().parent.parent
_HEADING = 100_000  # characters: comments may come first
_MOST_UP = 3  # folders above a problem's in which its domain may be
_SPACE = r"(?:\s|;[^\r\n]*(?:[\r\n]|$))*+"
_DOMAIN = rf"{_SPACE}\({_SPACE}define{_SPACE}\({_SPACE}domain{_SPACE}([^\s();]+)"
_OF_DOMAIN = (
    rf"{_SPACE}\({_SPACE}define{_SPACE}\({_SPACE}problem{_SPACE}[^\s();]++{_SPACE}\)"
    rf"{_SPACE}\({_SPACE}:domain{_SPACE}"
)
_PROBLEM = rf"{_OF_DOMAIN}([^\s();]+)"


class OwnFileWarning(UserWarning):
    """A file of the user's is taken instead of a shipped one of the same name."""


def root() -> Path:
    """Return the folder that holds ``domains`` and ``problems``."""
    checkout = _PACKAGE.parent
    if (checkout / "domains").is_dir() and (checkout / "pyproject.toml").is_file():
        return checkout
    return _PACKAGE / "_pddl"


def domain_names() -> tuple[str, ...]:
    """Return the names of the shipped domains, sorted."""
    return tuple(sorted(path.stem for path in (root() / "domains").glob("*.pddl")))


def problem_names(domain: str) -> tuple[str, ...]:
    """Return the names of the shipped problems of a domain, sorted."""
    return tuple(sorted(path.stem for path in (root() / "problems" / domain).glob("*.pddl")))


def find_domain(name: str) -> Path:
    """Return the file of a domain given by path or name; a path that exists wins.

    A name is looked up in the current folder (``NAME.pddl``, ``domains/NAME.pddl``) and then among
    the shipped domains; a folder of problems of that name stands for the domain of its problems.

    Raises:
        InputError: if there is neither; the message lists what there is.
    """
    if os.path.isfile(name) or _is_path(name):
        return Path(name)
    path = root() / "domains" / f"{name}.pddl"
    own = _own([Path(f"{name}.pddl"), Path("domains", f"{name}.pddl")], path, _DOMAIN)
    if own is not None:
        return own
    if os.path.isfile(path):
        return path
    if (path_of_goals := _domain_of_goals(name)) is not None:
        return path_of_goals
    hint = nearest(name, domain_names()) or f"shipped: {', '.join(domain_names())}"
    raise InputError(f"there is no domain '{name}'", code="no-file", path=name, hint=hint)


def find_problem(domain: str, name: str) -> Path:
    """Return the file of a problem of ``domain`` given by path or name; a path that exists wins.

    A name is looked up in the current folder (``problems/DOMAIN/NAME.pddl``,
    ``problems/NAME.pddl``, ``NAME.pddl``) and then among the shipped problems.

    Raises:
        InputError: if there is neither; the message lists what there is.
    """
    if os.path.isfile(name) or _is_path(name):
        return Path(name)
    domain_name = Path(domain).stem
    path = root() / "problems" / domain_name / f"{name}.pddl"
    file = f"{name}.pddl"
    places = [Path("problems", domain_name, file), Path("problems", file), Path(file)]
    own = _own(places, path, _problem_of(domain))
    if own is not None:
        return own
    if os.path.isfile(path):
        return path
    names = problem_names(domain_name)
    hint = nearest(name, names) or (f"shipped: {', '.join(names)}" if names else None)
    message = f"there is no problem '{name}' of domain '{domain_name}'"
    raise InputError(message, code="no-file", path=name, hint=hint)


def find_goals(name: str) -> Path:
    """Return a folder of goals given by path, or by name: ``problems/NAME`` here, else shipped.

    A path that exists wins.
    """
    if os.path.exists(name):
        return Path(name)
    package_path = root() / "problems" / name
    return own_goals(name) or (package_path if os.path.isdir(package_path) else Path(name))


def _domain_of_goals(name: str) -> Path | None:
    """Return the file of the domain that the first problem of a folder of goals names."""
    folder = own_goals(name) or root() / "problems" / name
    first = min(folder.glob("*.pddl"), default=None) if os.path.isdir(folder) else None
    match = None if first is None else re.match(_PROBLEM, _heading(first))
    return None if match is None else domain_file_for(match[1], first)


def own_goals(name: str) -> Path | None:
    """Return the folder ``problems/NAME`` of the current folder; None if it holds no problems.

    A warning says that it is not the shipped one of the same name.
    """
    own, package_path = Path("problems", name), root() / "problems" / name
    if not os.path.isdir(own) or next(own.glob("*.pddl"), None) is None:
        return None
    if os.path.isdir(package_path):
        if os.path.samefile(own, package_path):
            return None
        message = f"'{name}' is the folder ./{own} here, not the shipped one of that name"
        warnings.warn(message, OwnFileWarning, stacklevel=4)
    return own


def domain_file_for(name: str, problem: Path | None) -> Path | None:
    """Return the file of domain ``name`` for a problem file, or None.

    It is any file of the problem's folder; else ``NAME.pddl`` or ``*domain*.pddl`` in the folder
    above, or ``domains/NAME.pddl`` next to the problem or further up; else a shipped one. A problem
    that is no file (None) has no folder.
    """
    return next(
        (p for p in _places_of_domain(name, problem) if os.path.isfile(p) and _defines(p, name)),
        None,
    )


def _places_of_domain(name: str, problem: Path | None) -> Iterator[Path]:
    file = f"{name}.pddl"
    if problem is not None:
        folder = problem.parent
        yield from (path for path in sorted(folder.glob("*.pddl")) if path != problem)
        up = [Path(os.path.normpath(folder.joinpath(*[".."] * n))) for n in range(_MOST_UP + 1)]
        yield up[1] / file
        yield from sorted(up[1].glob("*domain*.pddl"))
        yield from (path / "domains" / file for path in up)
    yield root() / "domains" / file


def named_files(name: str) -> Sequence[Path]:
    """Return the files of ``DOMAIN`` or ``DOMAIN/PROBLEM``; a path that exists is itself.

    Raises:
        InputError: if there is no domain or problem of that name.
    """
    domain, _, problem = name.partition("/")
    if os.path.exists(name) or name.endswith(".pddl") or "/" in problem:
        return [Path(name)]
    file = find_domain(domain)
    return [file, find_problem(domain, problem)] if problem else [file]


def _own(places: Sequence[Path], package_path: Path, heading: str) -> Path | None:
    """Return the first of the user's files that begins as it should.

    A warning says that it is not the shipped one of the same name.
    """
    path = next((p for p in places if os.path.isfile(p) and re.match(heading, _heading(p))), None)
    if path is not None and os.path.isfile(package_path):
        if os.path.samefile(path, package_path):
            return None
        message = f"'{path.stem}' is ./{path} here, not the shipped file of that name"
        warnings.warn(message, OwnFileWarning, stacklevel=4)
    return path


def _problem_of(domain: str) -> str:
    """Return what the beginning of a problem of a domain reads like."""
    match = re.match(
        _DOMAIN, _heading(Path(domain) if os.path.isfile(domain) else find_domain(domain))
    )
    name = re.escape(match[1] if match else Path(domain).stem.lower())
    return rf"{_OF_DOMAIN}{name}{_SPACE}\)"


def _heading(path: Path) -> str:
    try:
        with path.open(encoding="utf-8-sig", errors="replace") as file:
            return file.read(_HEADING).lower()
    except OSError:
        return ""


def _is_path(name: str) -> bool:
    return "/" in name or name.endswith(".pddl")


def _defines(path: Path, name: str) -> bool:
    """Whether the beginning of a file reads ``(define (domain NAME)``."""
    match = re.match(_DOMAIN, _heading(path))
    return match is not None and match[1] == name
