"""The PDDL files of an editor: open texts, files of their folders, faults and names."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

from hrcplan.core.files import read_bytes
from hrcplan.errors import Diagnostic, InputError
from hrcplan.pddl.check import check
from hrcplan.pddl.names import Name, NameKind, names
from hrcplan.pddl.source import MAX_BYTES

MAX_FILES = 200  # files of a folder that are read besides the open ones
_COMMENT = re.compile(r";[^\r\n]*")
_DOMAIN = re.compile(r"\(\s*:?domain\s+([^\s();]+)", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class Place:
    """A name in a file."""

    path: str
    name: Name


@dataclass
class PddlWorkspace:
    """Texts of open files by path; every question is answered with them instead of the files."""

    texts: dict[str, str] = field(default_factory=dict)

    def faults(self, path: str, *, with_folder: bool) -> Mapping[str, Sequence[Diagnostic]]:
        """Return the faults of a file and of all open files, by path, also where there are none.

        Args:
            path: The file that was opened, changed or saved.
            with_folder: Whether the other files of its folder are checked, too.
        """
        paths = list(dict.fromkeys([path, *self.texts]))
        if with_folder:
            paths = list(dict.fromkeys([*paths, *self._in_folder(path)]))
        faults: dict[str, list[Diagnostic]] = {name: [] for name in paths}
        for fault in check(paths, self.texts).diagnostics:
            faults[fault.path].append(fault)
        return faults

    def text(self, path: str) -> str:
        """Return the text of a file, as the editor has it; empty if it cannot be read."""
        if path in self.texts:
            return self.texts[path]
        if not os.path.isfile(path):  # the reading of a pipe would not end
            return ""
        try:
            return read_bytes(path, MAX_BYTES).decode(errors="replace")
        except InputError:
            return ""

    def places(self, path: str, name: Name) -> list[Place]:
        """Return where a name of a file stands.

        A variable reaches as far as its action; another name as far as its domain: the domain's
        file and its problems, open, in the same folder, or in the folders ``domains`` and
        ``problems/NAME`` of a project.
        """
        if name.kind == NameKind.VARIABLE:
            return [Place(path, other) for other in names(self.text(path))
                    if other.word == name.word and other.scope == name.scope]  # fmt: skip
        return [place for place in self._all_places(path) if _is_same(name, place.name)]

    def declarations(self, path: str, name: Name) -> list[Place]:
        """Return the places that declare a name."""
        return [place for place in self.places(path, name) if place.name.declares]

    def words(self, path: str, kind: NameKind) -> list[str]:
        """Return the names of one kind that the files of its domain declare, sorted."""
        return sorted({place.name.word for place in self._all_places(path)
                       if place.name.kind == kind and place.name.declares})  # fmt: skip

    def _all_places(self, path: str) -> Iterator[Place]:
        domain = _domain_of(self.text(path))
        for file in dict.fromkeys([path, *self.texts, *self._in_folder(path), *_in_project(path)]):
            text = self.text(file)
            if file == path or _domain_of(text) == domain is not None:
                for name in names(text):
                    yield Place(file, name)

    def _in_folder(self, path: str) -> list[str]:
        """Return the PDDL files of the folder of a file, the open ones first."""
        folder = Path(path).parent
        files = [name for name in self.texts if Path(name).parent == folder]
        files += _files_in(folder)
        return list(dict.fromkeys(files))


def _domain_of(text: str) -> str | None:
    """Return the name of the domain that a text defines, or that its problem names."""
    match = _DOMAIN.search(_COMMENT.sub("", text))
    return match[1].lower() if match else None


def _in_project(path: str) -> list[str]:
    """Return the files of ``domains`` and ``problems/NAME``, if that is where a file stands."""
    file = Path(path)
    if file.parent.name == "domains":
        return _files_in(file.parents[1] / "problems" / file.stem)
    if len(file.parents) > 2 and file.parents[1].name == "problems":
        return _files_in(file.parents[2] / "domains")
    return []


def _files_in(folder: Path) -> list[str]:
    """Return the PDDL files of a folder; none if it may not be read. No pipe is among them."""
    with suppress(OSError):
        return sorted(str(file) for file in folder.glob("*.pddl") if file.is_file())[:MAX_FILES]
    return []


def _is_same(name: Name, other: Name) -> bool:
    if name.word != other.word:
        return False
    callable_kinds = {NameKind.OBJECT, NameKind.TYPE, NameKind.CALLED}
    if NameKind.CALLED in (name.kind, other.kind):
        return {name.kind, other.kind} <= callable_kinds
    return name.kind == other.kind
