"""What a caller may give as a problem: names, paths, PDDL text, or the object itself."""

from __future__ import annotations

import os
import re
from typing import TYPE_CHECKING

from hrcplan.core.records import replace
from hrcplan.core.text import type_text
from hrcplan.errors import InputError, UsageError
from hrcplan.pddl.check import domain_in, load_domain, load_problem, problem_in
from hrcplan.pddl.model import Domain, Problem
from hrcplan.pddl.problem import named_domain
from hrcplan.pddl.reader import read as read_tree
from hrcplan.pddl.source import SourceText, decode, read_source

_PDDL = re.compile(r"(?:\s|;[^\r\n]*(?:[\r\n]|$))*+\(")
_SHORT_NAME = r"[^/]+(?<!\.pddl)(/[^/]+(?<!\.pddl))?"

if TYPE_CHECKING:
    from pathlib import Path

Readable = str | os.PathLike[str]
"""A name, a path, or PDDL text; text is what begins with a parenthesis after its comments."""


def read(domain: Readable | Domain, problem: Readable | None = None) -> Problem:
    """Return the problem that names, paths or PDDL texts describe.

    Args:
        domain: The domain: a shipped name, a path, PDDL text, or a `Domain`. Without ``problem``:
            both in one word (``"transport/two-boxes"``), or a problem (path or text) whose domain
            is looked up near it (its folder, the one above, ``domains/``) and among the shipped.
        problem: The problem: a shipped name of that domain, a path, or PDDL text.

    Raises:
        PddlError: with every fault of the first file that has any.
        InputError: if a file is missing or unreadable, or the domain of a problem is not found.
        UsageError: if only a domain is named.
        TypeError: if an argument is none of these.

    >>> read("transport/two-boxes").name
    'two-boxes'
    >>> read("transport", "two-boxes") == read("transport/two-boxes")
    True
    """
    if isinstance(domain, Domain):
        if problem is None:
            raise UsageError(f"a problem of domain '{domain.name}' is needed too")
        return _problem_of(domain, domain.name, _readable(problem, "problem"))
    first = _readable(domain, "domain")
    if problem is None:
        return _read_one(first)
    second = _readable(problem, "problem")
    if isinstance(first, SourceText):
        domain_copy = replace(domain_in(first), path="")
        return _problem_of(domain_copy, domain_copy.name, second)
    return _problem_of(load_domain(_domain_file(first)), first, second)


def as_problem(domain: Readable | Domain | Problem, problem: Readable | None = None) -> Problem:
    """Return a `Problem` as it is, and anything else as `read` reads it.

    Every function of the package that takes a problem calls this, so all of them take the same.

    Raises:
        UsageError: if a `Problem` is given and a second problem with it.
        HrcplanError: as `read` does.
        TypeError: as `read` does.
    """
    if not isinstance(domain, Problem):
        return read(domain, problem)
    if problem is not None:
        hint = "options such as planner= are named"
        message = f"problem '{domain.name}' is given already, so {problem!r:.60} is too much"
        raise UsageError(message, hint=hint)
    return domain


def _readable(value: Readable, noun: str) -> str | SourceText:
    """Return a name or path as it is, and PDDL text as a source.

    Raises:
        TypeError: if it is neither.
    """
    if isinstance(value, str) and _PDDL.match(value):
        return decode(f"<{noun}>", value.encode("utf-8", "surrogatepass"))
    if isinstance(value, (str, os.PathLike)):
        place = os.fspath(value)
        if isinstance(place, str):
            return place
    raise TypeError(
        f"a {noun} is a name, a path, PDDL text, or an object that hrcplan has read, "
        f"not {type_text(value)}"
    )


def _problem_of(domain: Domain, folder: str, problem: str | SourceText) -> Problem:
    if isinstance(problem, SourceText):
        return replace(problem_in(domain, problem), path="")
    if _is_file(problem):
        return load_problem(domain, problem)
    from hrcplan.pddl import library

    return load_problem(domain, library.find_problem(folder, problem))


def _domain_file(name: str) -> str | Path:
    if _is_file(name):
        return name
    from hrcplan.pddl import library

    return library.find_domain(name)


def _is_file(name: str) -> bool:
    """Return whether a name is a path as it stands, so that nothing has to be looked up."""
    return "./" not in name and "//" not in name and os.path.isfile(name)


def _read_one(source: str | SourceText) -> Problem:
    """Return the problem of one word, one file or one text."""
    if isinstance(source, SourceText):
        return _problem_of(_domain_for(source, None), "", source)
    from hrcplan.pddl import library

    if os.path.isfile(source) or not re.fullmatch(_SHORT_NAME, source):
        from pathlib import Path

        file = read_source(source)
        return problem_in(_domain_for(file, Path(source)), file)
    domain, slash, problem = source.partition("/")
    path = library.find_domain(domain)
    if not slash:
        names = ", ".join(library.problem_names(domain))
        message = f"'{source}' is a domain; a problem is needed too"
        raise UsageError(message, hint=f"shipped: {names}" if names else None)
    return load_problem(load_domain(path), library.find_problem(domain, problem))


def _domain_for(source: SourceText, path: Path | None) -> Domain:
    """Return the domain that a problem names: near it, or among the shipped ones.

    Raises:
        InputError: if there is none of that name.
    """
    root = read_tree(SourceText(source.path, source.text))
    name = None if root is None else named_domain(root)
    if name is None:
        return Domain("")  # the problem's own faults are reported when it is read
    from hrcplan.pddl import library

    file = library.domain_file_for(str(name), path)
    if file is None:
        where = "among the shipped ones" if path is None else "near it or shipped"
        message = f"the problem is of domain '{name}', and there is none {where}"
        raise InputError(message, code="domain-mismatch", path=source.path)
    return load_domain(file)
