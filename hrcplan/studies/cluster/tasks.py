"""What a worker does for a study: compare itself with the parent, take files, run episodes."""

from __future__ import annotations

import hashlib
import os
import platform
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from importlib import metadata
from pathlib import Path

import hrcplan
from hrcplan.core.files import cache_folder, write_atomically
from hrcplan.errors import HrcplanError
from hrcplan.studies.runner import StudyWork, results_of
from hrcplan.studies.study import Episode, find
from hrcplan.studies.trace_files import EpisodeResult

PACKAGES = ("distributed", "numpy", "scikit-learn", "kairos-planner", "unified-planning",
            "up-fast-downward", "up-enhsp")  # fmt: skip
"""What rows depend on besides hrcplan and Python, or how batches travel."""

Software = tuple[tuple[str, str], ...]


class WorkerError(Exception):
    """Something has failed on a worker; the text says why."""


class DifferenceError(Exception):
    """A worker may not run episodes; the text says why."""


@dataclass(frozen=True, slots=True)
class ClusterJob:
    """What a worker has to know, and has to be like.

    Attributes:
        work: What results depend on.
        folder: The parent's current folder; files and modules may be named from there.
        software: The result of ``software_versions`` in the parent.
        inputs_sha256: The digest of the study's inputs in the parent.
    """

    work: StudyWork
    folder: str
    software: Software
    inputs_sha256: str


def software_versions() -> Software:
    """Return the versions of everything that rows depend on, by name."""
    versions = {"hrcplan": hrcplan.__version__, "code of hrcplan": source_digest()[:12],
                "Python": platform.python_version()}  # fmt: skip
    return (*versions.items(), *((name, _version(name)) for name in PACKAGES))


def _version(package: str) -> str:
    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:
        return "missing"


@lru_cache(maxsize=1)
def source_digest() -> str:
    """Return a hash, in hex, of the code and the settings of hrcplan."""
    folder, sha = Path(hrcplan.__file__).parent, hashlib.sha256()
    paths = {path.relative_to(folder).as_posix(): path
             for suffix in ("py", "toml") for path in folder.rglob(f"*.{suffix}")}  # fmt: skip
    for name in sorted(paths):
        sha.update(f"{name}\0".encode() + hashlib.sha256(paths[name].read_bytes()).digest())
    return sha.hexdigest()


def check_software(job: ClusterJob) -> None:
    """Return if this process has the software of the parent.

    Raises:
        DifferenceError: if a version differs.
    """
    here = dict(software_versions())
    differences = [
        f"{name} {here.get(name, 'missing')}, not {version}"
        for name, version in job.software
        if here.get(name) != version
    ]
    if differences:
        raise DifferenceError(f"has {'; '.join(differences)}")


def list_absent_files(job: ClusterJob, names: Sequence[str]) -> list[str]:
    """Return which files the cache folder here lacks, by their names from there."""
    folder = cache_folder()
    return [name for name in names if folder and not os.path.isfile(folder / name)]


def store_file(job: ClusterJob, name: str, data: bytes) -> None:
    """Write a file to the cache folder here, by its name from there.

    Raises:
        UsageError: if the folder cannot be written to.
    """
    path = (cache_folder() or Path()) / name
    path.parent.mkdir(parents=True, exist_ok=True)
    write_atomically(path, data)


def check_inputs(job: ClusterJob) -> None:
    """Return if the same inputs are read here as in the parent.

    Raises:
        DifferenceError: if not, or if a file, a method or the study itself is missing here.
    """
    check_software(job)
    _check_inputs(job)


def run_batch(job: ClusterJob, episodes: Sequence[Episode]) -> list[EpisodeResult]:
    """Return the results of episodes.

    Raises:
        DifferenceError: if this process differs from the parent.
    """
    check_inputs(job)
    return results_of(job.work, episodes)


@lru_cache(maxsize=1)
def _check_inputs(job: ClusterJob) -> None:
    try:
        inputs = find(job.work.study).inputs(dict(job.work.options))
    except HrcplanError as error:
        raise DifferenceError(f"lacks something: {error.message}") from None
    if hashlib.sha256(inputs.encode()).hexdigest() != job.inputs_sha256:
        raise DifferenceError("reads other inputs: the PDDL files or the goals differ")
