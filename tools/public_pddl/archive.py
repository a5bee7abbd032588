"""Pairs of a domain and one of its problems in a folder, or in a bare git repository."""

from __future__ import annotations

import random
import re
import subprocess
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import islice
from pathlib import Path, PurePosixPath

MOST_BYTES = 300_000
_COMMENT = re.compile(r";[^\n]*")
_DOMAIN = re.compile(r"\(\s*define\s*\(\s*domain\s+([^\s()]+)", re.IGNORECASE)
_PROBLEM = re.compile(r"\(\s*define\s*\(\s*problem\b", re.IGNORECASE)
_DOMAIN_OF = re.compile(r"\(\s*:domain\s+([^\s()]+)", re.IGNORECASE)
_DIGITS = re.compile(r"\d+")
_PLAN = re.compile(r"(\.[\w-]+)?\.(plan|soln|solution)$")


@dataclass(frozen=True)
class Pair:
    """A domain file and a problem file, with the plan that the archive has for it."""

    domain: Path
    problem: Path
    plan: Path | None = None


@dataclass(frozen=True)
class _Problem:
    path: PurePosixPath
    domain: str
    size: int


def export(source: Path, target: Path) -> Path:
    """Return a folder with PDDL and plans of an archive: itself, or what ``HEAD`` holds."""
    if not (source / "HEAD").exists():
        return source
    files = list[Path]()
    listing = _git(source, "ls-tree", "-r", "-l", "-z", "HEAD").decode(errors="replace")
    for line in listing.split("\0"):
        entry, _, name = line.partition("\t")
        if not (name.endswith(".pddl") or _PLAN.search(name)) or not entry.split()[3].isdigit():
            continue  # no PDDL, or a file that this copy of the repository lacks
        if int(entry.split()[3]) <= MOST_BYTES:
            files.append(target / name)
            files[-1].parent.mkdir(parents=True, exist_ok=True)
            files[-1].write_text(entry.split()[2])
    _fill(source, files)
    return target


def _fill(source: Path, files: list[Path]) -> None:
    """Replace the hash that stands in every file by the content of that hash."""
    names = "\n".join(path.read_text() for path in files)
    data = _git(source, "cat-file", "--batch", text=names.encode())
    place = 0
    for path in files:
        end = data.index(b"\n", place)
        size = int(data[place:end].split()[2])
        path.write_bytes(data[end + 1 : end + 1 + size])
        place = end + size + 2


def _git(source: Path, *words: str, text: bytes = b"") -> bytes:
    command = ["git", "-c", "safe.directory=*", "-C", str(source), *words]
    return subprocess.run(command, input=text, capture_output=True, check=True).stdout


def pairs(folder: Path, n: int, seed: int, *, middle: bool = False) -> list[Pair]:
    """Return a sample of ``n`` domains, one of each name and folder, with a problem of each.

    That is the smallest problem in the folder closest to the domain, or the middle one by size.
    """
    domains: dict[tuple[PurePosixPath, str], list[PurePosixPath]] = {}
    problems = list[_Problem]()
    for path in sorted(folder.rglob("*.pddl")):
        if not path.is_file() or path.stat().st_size > MOST_BYTES:
            continue
        text = _COMMENT.sub("", path.read_text(errors="replace")).lower()
        place = PurePosixPath(path.relative_to(folder))
        if domain := _DOMAIN.search(text):
            domains.setdefault((place.parent, domain[1]), []).append(place)
        elif _PROBLEM.search(text):
            of = _DOMAIN_OF.search(text)
            problems.append(_Problem(place, of[1] if of else "", len(text)))
    rng = random.Random(seed)
    keys = sorted(domains, key=str)
    rng.shuffle(keys)
    all_of = (_pair(folder, rng.choice(domains[key]), key[1], problems, middle) for key in keys)
    chosen = islice((pair for pair in all_of if pair is not None), n)
    plans = _plans(folder)
    return [replace(pair, plan=_plan(folder, pair, plans)) for pair in chosen]


def _plans(folder: Path) -> dict[str, list[Path]]:
    """Return the plan files of an archive by the name that they share with their problem."""
    plans: dict[str, list[Path]] = {}
    for path in sorted(folder.rglob("*")):
        if path.is_file() and (end := _PLAN.search(path.name)):
            plans.setdefault(path.name[: end.start()], []).append(path)
    return plans


def _plan(folder: Path, pair: Pair, plans: dict[str, list[Path]]) -> Path | None:
    """Return the plan beside a problem, or at the same place of a folder with solutions."""
    place = pair.problem.relative_to(folder).parent.parts
    for path in plans.get(pair.problem.stem, []):
        parts = path.relative_to(folder).parent.parts
        if parts in (place, ("solutions", *place)):
            return path
    return None


def _pair(
    folder: Path, domain: PurePosixPath, name: str, problems: list[_Problem], middle: bool
) -> Pair | None:
    ranks = sorted(rank for p in problems if (rank := _rank(domain, name, p)) is not None)
    if not ranks:
        return None
    closest = [rank for rank in ranks if rank[:2] == ranks[0][:2]]
    return Pair(folder / domain, folder / closest[len(closest) // 2 if middle else 0][-1])


def _rank(domain: PurePosixPath, name: str, problem: _Problem) -> tuple[int, int, int, str] | None:
    """Return how far a problem is from a domain; None where it is another domain's."""
    if problem.domain != name:
        return None
    numbers = [_DIGITS.findall(path.stem) for path in (domain, problem.path)]
    other = int(bool(numbers[0]) and numbers[0][-1:] != numbers[1][-1:])
    common = len(_common(domain.parent.parts, problem.path.parent.parts))
    distance = len(domain.parent.parts) + len(problem.path.parent.parts) - 2 * common
    return (distance, other, problem.size, str(problem.path)) if distance <= 2 else None


def _common(first: tuple[str, ...], second: tuple[str, ...]) -> list[str]:
    def shared() -> Iterator[str]:
        for a, b in zip(first, second, strict=False):
            if a != b:
                return
            yield a

    return list(shared())
