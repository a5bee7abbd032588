"""Parts by name: built-in ones, those of installed packages, and a user's own as ``module:Class``.

One rule holds for planners, beliefs, assistants, humans, worlds and studies. A name is looked up
among (1) the built-in parts, (2) the entry points of installed packages, (3) the prefixes that the
part declares, such as ``up:NAME``; then (4) it is read as ``module:Class``. The module of (4) may
also lie in the current folder.

Only names that a user types, on the command line or in Python, may load any code: `Registry.find`.
Names that come out of a data file (a script, a journal, rows) go through `Registry.find_listed`,
which refuses (4), and the prefixes of (3) that run a program.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from functools import partial
from importlib import import_module, invalidate_caches
from importlib.util import find_spec
from inspect import isfunction
from types import ModuleType
from typing import TYPE_CHECKING, Generic, ParamSpec, Protocol, TypeVar, cast

from hrcplan.core.deprecation import current_name
from hrcplan.core.entry_points import entry_points
from hrcplan.core.text import nearest
from hrcplan.errors import HrcplanError, UsageError

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

P = ParamSpec("P")
T = TypeVar("T")


@dataclass(frozen=True)
class PartNames:
    """The names of the parts of one kind, and where each of them is defined.

    Attributes:
        kind: What a part is called in messages and error codes (``unknown-<kind>``).
        built_in: ``module:Name`` of each built-in part.
        group: The entry-point group of parts that installed packages add.
        protocol: The class that every part is an instance of: often a runtime-checkable protocol.
        aliases: Names of earlier versions; they still work, with a DeprecationWarning.
        prefixes: ``module:Class`` by prefix: ``up:tamer`` is that class, made from ``"tamer"``.
        program_prefixes: The prefixes that run a program of any name; data files cannot use them.
        load_error: What is raised if a built-in or installed part cannot be imported.
    """

    kind: str
    built_in: Mapping[str, str]
    group: str
    protocol: type
    aliases: Mapping[str, str] = field(default_factory=dict)
    prefixes: Mapping[str, str] = field(default_factory=dict)
    program_prefixes: frozenset[str] = frozenset()
    load_error: type[HrcplanError] = UsageError

    def names(self) -> list[str]:
        """Return the names of all parts, the built-in ones first."""
        extra = {entry.name for entry in self._entry_points()} - set(self.built_in)
        return [*self.built_in, *sorted(extra)]

    def canonical(self, name: str) -> str:
        """Return the present name of a part; a name of an earlier version gives a warning."""
        return current_name(self.kind, name, self.aliases)

    def _entry_points(self) -> Iterable[EntryPoint]:
        return entry_points(self.group)

    def _entry(self, name: str) -> Hashable | None:
        """Return a built-in or installed part; None if there is none of this name.

        Raises:
            HrcplanError: the ``load_error``, if the part cannot be imported.
        """
        place = self.built_in.get(name)
        if place is None:
            place = next((e.value for e in self._entry_points() if e.name == name), None)
        if place is None:
            return None
        try:
            return _member(place)
        except Exception as error:
            message = f"{self.kind} '{name}' cannot be loaded from {place}: {_in_words(error)}"
            raise self.load_error(message, hint="is its package installed?") from error

    def _own(self, name: str) -> Hashable | None:
        """Return a user's own part, named as ``module:Class``; None if it is no such name.

        Raises:
            UsageError: if the module is missing or raises, or has nothing of that name.
        """
        path, _, attribute = name.partition(":")
        if not (attribute.isidentifier() and all(map(str.isidentifier, path.split(".")))):
            return None
        module = _user_module(path, self.kind, name)
        if attribute not in vars(module):
            hint = nearest(attribute, [n for n in vars(module) if not n.startswith("_")])
            message = f"module '{path}' has no '{attribute}'"
            raise UsageError(message, code=self._code, path=module.__file__, hint=hint)
        part: Hashable = vars(module)[attribute]
        return part

    @property
    def _code(self) -> str:
        return f"unknown-{self.kind}"

    def _unknown(self, name: str, is_typed: bool) -> UsageError:
        places = [f"{prefix}:…" for prefix in self.prefixes] + ["module:Class"] if is_typed else []
        hint = nearest(name, self.names())
        hint = hint or f"{self.kind}s: {', '.join([*self.names(), *places])}"
        message = f"there is no {self.kind} '{name}'"
        if not is_typed and ":" in name:
            message = f"a file cannot name the {self.kind} '{name}'"
            hint = f"code is only loaded if it is named on the command line; {self.kind}s for files"
            hint += f": {', '.join(self.names())}"
        return UsageError(message, code=self._code, hint=hint)


class Registry(PartNames, Generic[P, T]):
    """Classes by name; ``P`` are the arguments they are made from, ``T`` is their protocol.

    >>> from hrcplan.planners.registry import PLANNERS
    >>> PLANNERS.make("kairos").card.name
    'kairos'
    """

    def find(self, name: str) -> Callable[P, T]:
        """Return the class of a part that a user has named.

        Raises:
            UsageError: if there is none, it cannot be imported, or it is no such part.
        """
        return self._find(self.canonical(name), is_typed=True)

    def find_listed(self, name: str) -> Callable[P, T]:
        """Return the class of a part that a data file names: a built-in or installed one.

        Raises:
            UsageError: if there is none, it cannot be imported, or it is no such part.
        """
        return self._find(self.canonical(name), is_typed=False)

    def make(self, name: str, *args: P.args, **options: P.kwargs) -> T:
        """Return a part that a user has named, made from ``args`` and ``options``.

        Raises:
            UsageError: as `find` does; also if the object made lacks something of its protocol.
        """
        part = self.find(name)(*args, **options)
        if not isinstance(part, self.protocol):
            raise self._no_part(name, [n for n in members(self.protocol) if n not in dir(part)])
        return part

    def _find(self, name: str, is_typed: bool) -> Callable[P, T]:
        prefix, _, rest = name.partition(":")
        part = self._entry(name)
        if part is None and rest and prefix in self.prefixes:
            if is_typed or prefix not in self.program_prefixes:
                made_from_text = self._check(name, _member(self.prefixes[prefix]))
                return partial(made_from_text, rest)  # type: ignore[arg-type]
        elif part is None and is_typed:
            part = self._own(name)
        if part is None:
            raise self._unknown(name, is_typed)
        return self._check(name, part)

    def _check(self, name: str, part: Hashable) -> Callable[P, T]:
        """Return a part if it is a class that has the methods of the protocol."""
        if not isinstance(part, type):
            raise UsageError(f"{name} is no class", code=f"not-a-{self.kind}")
        lacks = [n for n in methods(self.protocol) if n not in dir(part)]
        if lacks:
            raise self._no_part(name, lacks)
        return cast(Callable[P, T], part)

    def _no_part(self, name: str, lacks: Iterable[str]) -> UsageError:
        message = f"{name} is no {self.kind}: it has no {', '.join(lacks)}"
        hint = f"see {self.protocol.__name__} in {self.protocol.__module__}"
        return UsageError(message, code=f"not-a-{self.kind}", hint=hint)


class ObjectRegistry(PartNames, Generic[T]):
    """Objects by name, such as studies; each is an instance of ``protocol``."""

    def find(self, name: str) -> T:
        """Return a part that a user has named.

        Raises:
            UsageError: if there is none, it cannot be imported, or it is no such part.
        """
        name = self.canonical(name)
        part = self._entry(name)
        return self._check(name, self._own(name) if part is None else part, is_typed=True)

    def find_listed(self, name: str) -> T:
        """Return a part that a data file names: a built-in or installed one.

        Raises:
            UsageError: if there is none, it cannot be imported, or it is no such part.
        """
        name = self.canonical(name)
        return self._check(name, self._entry(name), is_typed=False)

    def _check(self, name: str, part: T | Hashable | None, is_typed: bool) -> T:
        if part is None:
            raise self._unknown(name, is_typed)
        if not isinstance(part, self.protocol):
            message = f"{name} is no {self.protocol.__name__}"
            raise UsageError(message, code=f"not-a-{self.kind}")
        return cast(T, part)


def members(protocol: type) -> list[str]:
    """Return the public names that a protocol requires, in order."""
    bases = [base for base in reversed(protocol.__mro__) if base not in (object, Generic, Protocol)]
    names = [n for base in bases for n in (*vars(base).get("__annotations__", ()), *vars(base))]
    return [name for name in dict.fromkeys(names) if not name.startswith("_")]


def methods(protocol: type) -> list[str]:
    """Return the methods that a protocol requires: a class has them before it is made."""
    return [name for name in members(protocol) if isfunction(getattr(protocol, name, None))]


def _member(place: str) -> Hashable:
    """Return what ``module:name`` is in an installed module."""
    module, _, attribute = place.partition(":")
    value: Hashable = getattr(import_module(module), attribute)
    return value


def _user_module(path: str, kind: str, name: str) -> ModuleType:
    """Import a module that a user has named, from the current folder if it is nowhere else.

    Raises:
        UsageError: if there is no such module, or it raises.
    """
    code = f"unknown-{kind}"
    try:
        with _current_folder(path.partition(".")[0]):
            return import_module(path)
    except (Exception, SystemExit) as error:
        is_missing = isinstance(error, ModuleNotFoundError) and f"{path}.".startswith(
            f"{error.name}."
        )
        if is_missing:
            message = f"there is no module '{path}' for the {kind} '{name}'"
            hint = f"looked among the installed packages and in '{_folder() or 'no folder'}'"
            if path.endswith(".py"):
                hint = f"name the module without its suffix: {name.replace('.py:', ':')}"
            raise UsageError(message, code=code, hint=hint) from None
        message = f"module '{path}' of the {kind} '{name}' cannot be imported: {_in_words(error)}"
        hint = f"`python -c 'import {path}'` shows where"
        raise UsageError(message, code=code, hint=hint) from error


@contextmanager
def _current_folder(module: str) -> Iterator[None]:
    """Let imports search the current folder, last, if a module is not installed.

    The folder is removed from the path afterwards, so that no other import can find a file there.
    """
    folder = _folder()
    if folder is None or folder in sys.path or module in sys.modules or find_spec(module):
        yield
        return
    invalidate_caches()
    sys.path.append(folder)
    try:
        yield
    finally:
        with suppress(ValueError):
            sys.path.remove(folder)


def _folder() -> str | None:
    try:
        return os.getcwd()
    except OSError:  # the folder was removed
        return None


def _in_words(error: BaseException) -> str:
    return f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
