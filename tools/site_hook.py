"""What the site makes from the code: the reference of all commands, and examples of docstrings.

MkDocs calls ``on_config`` and ``on_files`` before it reads the pages, ``on_page_content`` after.
"""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterator
from pathlib import Path

import click
from markdown import Extension, Markdown
from markdown.preprocessors import Preprocessor
from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files
from mkdocs.structure.pages import Page

from hrcplan.cli.main import main as hrcplan

HEAD = """# Commands

Made from the commands themselves: `hrcplan COMMAND --help` prints the same. What every command has
in common (exit codes, `--json`, names and paths) is in [JSON](json.md).
"""


class _Examples(Preprocessor):
    """Paragraphs that begin with ``>>> `` are Python sessions, not quotations."""

    def run(self, lines: list[str]) -> list[str]:
        """Return the lines with a fence around each such paragraph outside of fences."""
        result: list[str] = []
        is_fenced = is_example = False
        for line in [*lines, ""]:
            is_fenced ^= bool(re.match(r"\s*```", line))
            if is_example and not line.strip():
                result.append("```")
                is_example = False
            elif line.startswith(">>> ") and not is_example and not is_fenced:
                result += ["", "```pycon"]
                is_example = True
            result.append(line)
        return result[:-1]


class Examples(Extension):
    """The Markdown extension of ``_Examples``."""

    def extendMarkdown(self, md: Markdown) -> None:  # noqa: N802 - the name is Markdown's
        """Run before fenced code is read."""
        md.preprocessors.register(_Examples(md), "hrcplan-examples", 200)


def on_config(config: MkDocsConfig) -> MkDocsConfig:
    """Add the extension for examples in docstrings."""
    config.markdown_extensions.append(Examples())
    return config


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add ``reference/cli.md`` to the pages."""
    page = Path("reference/cli.md").as_posix()
    files.append(File.generated(config, page, content=commands_page()))
    return files


def on_page_content(html: str, page: Page, config: MkDocsConfig, files: Files) -> str:
    """Mark code of one short word: it is not broken at a hyphen, as in ``--json``."""
    return re.sub(r"<code>([^<\s]{1,28})</code>", r'<code class="word">\1</code>', html)


def commands_page() -> str:
    """Return the reference of all commands as Markdown."""
    context = click.Context(hrcplan, info_name="hrcplan")
    return HEAD + "".join(_section(hrcplan, context))


def _section(command: click.Command, context: click.Context) -> Iterator[str]:
    """Yield the text of a command and of those below it."""
    if context.parent is not None:
        usage = " ".join(command.collect_usage_pieces(context))
        summary = inspect.cleandoc((command.help or "").replace("\b", ""))
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
