"""Pages of the site that are made from the code: the reference of all commands.

MkDocs calls ``on_files`` when it has collected the pages and before it reads them.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import click
from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files

from hrcplan.cli.main import main as hrcplan

HEAD = """# Commands

Made from the commands themselves: `hrcplan COMMAND --help` prints the same. What every command has
in common (exit codes, `--json`, names and paths) is in [JSON and files](json.md).
"""


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add ``reference/cli.md`` to the pages."""
    page = Path("reference/cli.md").as_posix()
    files.append(File.generated(config, page, content=commands_page()))
    return files


def commands_page() -> str:
    """Return the reference of all commands as Markdown."""
    context = click.Context(hrcplan, info_name="hrcplan")
    return HEAD + "".join(_section(hrcplan, context))


def _section(command: click.Command, context: click.Context) -> Iterator[str]:
    """Yield the text of a command and of those below it."""
    if context.parent is not None:
        usage = " ".join(command.collect_usage_pieces(context))
        summary = (command.help or "").replace("\b", "").strip()
        yield f"\n## `{context.command_path}`\n\n```text\n{context.command_path} {usage}\n```\n\n"
        yield f"{_escape(summary)}\n"
        yield from _options(command)
    if isinstance(command, click.Group):
        for name in command.list_commands(context):
            below = command.get_command(context, name)
            assert below is not None
            yield from _section(below, click.Context(below, info_name=name, parent=context))


def _options(command: click.Command) -> Iterator[str]:
    options = [p for p in command.params if isinstance(p, click.Option) and not p.hidden]
    if not options:
        return
    yield "\n| option | meaning | default |\n|---|---|---|\n"
    for option in options:
        names = ", ".join([*option.opts, *option.secondary_opts])
        metavar = "" if option.is_flag else f" {option.metavar or option.type.name.upper()}"
        if isinstance(option.type, click.Choice):
            metavar = " " + "\\|".join(map(str, option.type.choices))
        shown = option.default if isinstance(option.default, (str, int, float)) else ""
        default = "" if option.is_flag or shown in ("", None) else f"`{shown}`"
        yield f"| `{names}{metavar}` | {_escape(option.help or '')} | {default} |\n"


def _escape(text: str) -> str:
    """Return text that Markdown and tables leave as it is."""
    return text.replace("<", "&lt;").replace("|", "\\|").replace("*", "\\*")
