"""The tools of the server, and what a language model reads about each of them."""

from __future__ import annotations

import re
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any

from mcp.server.mcpserver import MCPServer
from pydantic import Field

from hrcplan import __version__
from hrcplan.errors import UsageError
from hrcplan.mcp.commands import MAX_SECONDS, FolderCommands
from hrcplan.planners.registry import names

_ELEMENT = re.compile(r"\w[\w-]*( \w[\w-]*)*")  # never an option
DomainInput = Annotated[
    str, Field(description="A PDDL domain: its text, a file, or a shipped name such as transport")
]
ProblemInput = Annotated[
    str, Field(description="A PDDL problem: its text, a file, or a shipped name such as two-boxes")
]
Seconds = Annotated[float, Field(gt=0, le=MAX_SECONDS, description="Seconds for the answer")]
Settings = Annotated[list[str], Field(description="Values that replace those of the initial state, "
                                      "as in 'motivation human=10'")]  # fmt: skip


def make_server(folders: Sequence[str | Path], inputs: str | None = None) -> MCPServer:
    """Return a server whose tools read files of the folders only, and write none.

    Texts of requests are written to ``inputs`` for a while; by default a temporary folder.
    """
    server = MCPServer("hrcplan", version=__version__, instructions=(
        "Plan, check and explain human-robot collaboration from PDDL. Texts of PDDL can be given "
        "instead of files. Every answer is a JSON document with an exit_code: 0 done, 1 the answer "
        "is no, 2 wrong use, 3 bad input with line and column, 4 limit, 5 planner missing."
    ))  # fmt: skip
    commands = FolderCommands(folders, inputs)
    _add_pddl_tools(server, commands)
    _add_people_tools(server, commands)
    return server


def _add_pddl_tools(server: MCPServer, commands: FolderCommands) -> None:
    @server.tool()
    def check(
        files: Annotated[list[str], Field(min_length=1, description="PDDL texts or files")],
    ) -> dict[str, Any]:
        """Report every fault of PDDL domains and problems, with line, column and cure."""
        with commands.files(*files) as paths:
            return commands.run("check", *paths)

    @server.tool()
    def plan(
        domain: DomainInput, problem: ProblemInput, planner: str = "auto", timeout_s: Seconds = 60,
        any_plan: bool = False, settings: Settings = [],  # noqa: B006 - a default of a schema
    ) -> dict[str, Any]:  # fmt: skip
        """Find a plan, replayed in PDDL's own semantics, with its cost, bound and proof."""
        if planner not in ("auto", *names()):
            raise UsageError(f"planners: auto, {', '.join(names())}")
        more = ["--any"] if any_plan else []
        with commands.files(domain, problem) as paths:
            return commands.run("plan", *paths, "--planner", planner, "--timeout", str(timeout_s),
                                *more, *_set(settings), timeout_s=timeout_s)  # fmt: skip

    @server.tool()
    def validate(
        domain: DomainInput, problem: ProblemInput,
        plan: Annotated[str, Field(description="The plan: its text or a file")],
    ) -> dict[str, Any]:  # fmt: skip
        """Replay a plan step by step: is it valid, what does it cost, or where does it fail?"""
        with commands.files(domain, problem, plan) as paths:
            return commands.run("validate", *paths)


def _add_people_tools(server: MCPServer, commands: FolderCommands) -> None:
    @server.tool()
    def allocation(
        domain: DomainInput, problem: ProblemInput,
        element: Annotated[str, Field(description="An element of an agent's state, as in "
                                      "'motivation human'")],
        timeout_s: Seconds = 60, settings: Settings = [],  # noqa: B006 - a default of a schema
    ) -> dict[str, Any]:  # fmt: skip
        """Show who does how much in the best plan, for every value of an agent's state."""
        if not _ELEMENT.fullmatch(element):
            raise UsageError(f"no element of an agent's state: '{element}'")
        with commands.files(domain, problem) as paths:
            return commands.run("allocation", *paths, element, "--timeout", str(timeout_s),
                                *_set(settings))  # fmt: skip

    @server.tool()
    def infer(
        domain: DomainInput,
        actions: Annotated[list[str], Field(description="Observed ground actions in their order, "
                                            "as in '(get human yogurt)'")],
        goals: Annotated[str | None, Field(description="A folder with a problem per goal, or a "
                                           "shipped name; by default the domain's goals")] = None,
    ) -> dict[str, Any]:  # fmt: skip
        """Infer which goal a human pursues from observed actions, and where it changed."""
        inputs = [domain] if goals is None else [domain, goals]
        with tempfile.TemporaryDirectory(prefix="hrcplan-mcp-") as folder:
            bank, seen = Path(folder) / "goals.bank", Path(folder) / "seen.txt"
            seen.write_text("\n".join(actions) + "\n", encoding="utf-8", errors="replace")
            with commands.files(*inputs) as paths:
                built = commands.run("bank", "build", *paths, "-o", str(bank))
            return commands.run("infer", str(bank), str(seen)) if bank.exists() else built


def _set(settings: Sequence[str]) -> list[str]:
    return [word for setting in settings for word in ("--set", setting)]
