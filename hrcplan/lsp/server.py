"""The Language Server Protocol over a ``PddlWorkspace``: positions in, positions out."""

from __future__ import annotations

import asyncio
import os
import re
from collections.abc import Sequence

from lsprotocol import types as lsp
from pygls.lsp.server import LanguageServer
from pygls.workspace import TextDocument

from hrcplan import __version__
from hrcplan.errors import HrcplanError
from hrcplan.lsp.positions import Positions, path_of, uri_of
from hrcplan.lsp.signatures import sections, signature
from hrcplan.lsp.workspace import PddlWorkspace, Place
from hrcplan.pddl.layout import format_text
from hrcplan.pddl.names import Name, NameKind, name_at, names

_SUGGESTION = re.compile(r"did you mean '([^']+)'\?")
_WORD = re.compile(r"[^\s();]*")
_COMPLETIONS = {
    NameKind.TYPE: lsp.CompletionItemKind.Class,
    NameKind.SYMBOL: lsp.CompletionItemKind.Function,
    NameKind.OBJECT: lsp.CompletionItemKind.Constant,
    NameKind.VARIABLE: lsp.CompletionItemKind.Variable,
}
_SECTION_KINDS = dict.fromkeys(
    (":action", ":durative-action", ":process", ":event"), lsp.SymbolKind.Method
)
LONG = 200_000
"""Characters of a text whose check takes so long that it waits for a pause of the typing."""
PAUSE_S = 0.4
KEYWORDS = (
    ":requirements", ":types", ":constants", ":predicates", ":functions", ":derived", ":action",
    ":durative-action", ":parameters", ":precondition", ":condition", ":duration", ":effect",
    ":domain", ":objects", ":init", ":goal", ":metric", ":constraints",
)  # fmt: skip


def make_server() -> LanguageServer:
    """Return a server that waits for an editor."""
    server = LanguageServer("hrcplan", __version__)
    files = PddlWorkspace()
    _add_documents(server, files)
    _add_questions(server, files)
    _add_edits(server, files)
    return server


def document_of(server: LanguageServer, files: PddlWorkspace, uri: str) -> TextDocument:
    """Return an open document, or the file of an address; empty if it cannot be read.

    All questions are then answered with the text of the open one.
    """
    open_document: TextDocument | None = server.workspace.text_documents.get(uri)
    if open_document is not None:
        files.texts[path_of(uri)] = open_document.source
        return open_document
    path, codec = path_of(uri), server.workspace.position_codec
    return TextDocument(uri_of(path), files.text(path), position_codec=codec)


def _add_documents(server: LanguageServer, files: PddlWorkspace) -> None:
    """Follow what is opened, changed, saved and closed, and publish faults."""

    def publish(uri: str, with_folder: bool) -> None:
        path = path_of(uri)
        document_of(server, files, uri)
        show(path, with_folder)

    def show(path: str, with_folder: bool) -> None:
        for name, faults in files.faults(path, with_folder=with_folder).items():
            shown = Positions(server, files.text(name)).diagnostics(faults)
            server.text_document_publish_diagnostics(
                lsp.PublishDiagnosticsParams(uri_of(name), shown)
            )

    @server.feature(lsp.TEXT_DOCUMENT_DID_OPEN)
    def opened(params: lsp.DidOpenTextDocumentParams) -> None:
        publish(params.text_document.uri, True)

    def publish_last(document: lsp.VersionedTextDocumentIdentifier) -> None:
        now = server.workspace.text_documents.get(document.uri)
        if now is not None and now.version == document.version:
            publish(document.uri, False)

    @server.feature(lsp.TEXT_DOCUMENT_DID_CHANGE)
    def changed(params: lsp.DidChangeTextDocumentParams) -> None:
        document = params.text_document
        if len(document_of(server, files, document.uri).source) < LONG:
            publish(document.uri, False)
        else:  # checked once for several changes
            asyncio.get_running_loop().call_later(PAUSE_S, publish_last, document)

    @server.feature(lsp.TEXT_DOCUMENT_DID_SAVE)
    def saved(params: lsp.DidSaveTextDocumentParams) -> None:
        publish(params.text_document.uri, True)

    @server.feature(lsp.TEXT_DOCUMENT_DID_CLOSE)
    def closed(params: lsp.DidCloseTextDocumentParams) -> None:
        path = path_of(params.text_document.uri)
        files.texts.pop(path, None)
        if os.path.isfile(path):
            show(path, False)
            return
        # A file that is gone has no faults, and problems of its domain have others now.
        server.text_document_publish_diagnostics(
            lsp.PublishDiagnosticsParams(params.text_document.uri, [])
        )
        for other in list(files.texts)[:1]:
            show(other, False)


def _add_questions(server: LanguageServer, files: PddlWorkspace) -> None:
    """Answer where a name is declared and used, and what it is."""

    def question(
        place: lsp.TextDocumentIdentifier, position: lsp.Position
    ) -> tuple[str, str, int, Name | None]:
        document = document_of(server, files, place.uri)
        offset = document.offset_at_position(position)
        path = path_of(place.uri)
        return path, document.source, offset, name_at(document.source, offset)

    def locations(places: Sequence[Place]) -> list[lsp.Location]:
        return [lsp.Location(uri_of(p.path), range_of(p)) for p in places]

    def range_of(place: Place) -> lsp.Range:
        name = place.name
        return Positions(server, files.text(place.path)).range(name.at, name.length)

    @server.feature(lsp.TEXT_DOCUMENT_DEFINITION)
    def definition(params: lsp.DefinitionParams) -> list[lsp.Location]:
        path, _, _, name = question(params.text_document, params.position)
        return [] if name is None else locations(files.declarations(path, name))

    @server.feature(lsp.TEXT_DOCUMENT_REFERENCES)
    def references(params: lsp.ReferenceParams) -> list[lsp.Location]:
        path, _, _, name = question(params.text_document, params.position)
        places = [] if name is None else files.places(path, name)
        if not params.context.include_declaration:
            places = [place for place in places if not place.name.declares]
        return locations(places)

    @server.feature(lsp.TEXT_DOCUMENT_HOVER)
    def hover(params: lsp.HoverParams) -> lsp.Hover | None:
        path, _, _, name = question(params.text_document, params.position)
        declared = [] if name is None else files.declarations(path, name)
        if not declared:
            return None
        place = declared[0]
        text = f"```pddl\n{signature(files.text(place.path), place.name)}\n```"
        return lsp.Hover(lsp.MarkupContent(lsp.MarkupKind.Markdown, text))

    @server.feature(
        lsp.TEXT_DOCUMENT_COMPLETION, lsp.CompletionOptions(trigger_characters=["(", ":", "?", "-"])
    )
    def completion(params: lsp.CompletionParams) -> list[lsp.CompletionItem]:
        path, text, offset, _ = question(params.text_document, params.position)
        before = text[:offset]
        word = re.search(r"[^\s();]*$", before)
        start = word.start() if word else offset
        return _completions(files, path, text, start)

    @server.feature(lsp.TEXT_DOCUMENT_DOCUMENT_SYMBOL)
    def symbols(params: lsp.DocumentSymbolParams) -> list[lsp.DocumentSymbol]:
        text = document_of(server, files, params.text_document.uri).source
        positions = Positions(server, text)
        return [
            lsp.DocumentSymbol(
                title, _SECTION_KINDS.get(title.partition(" ")[0], lsp.SymbolKind.Namespace),
                positions.range(start, end - start), positions.range(start, 1),
            )
            for start, end, title in sections(text)
        ]  # fmt: skip


def _add_edits(server: LanguageServer, files: PddlWorkspace) -> None:
    """Offer fixes, new names and the layout of hrcplan."""

    @server.feature(lsp.TEXT_DOCUMENT_RENAME)
    def rename(params: lsp.RenameParams) -> lsp.WorkspaceEdit | None:
        document = document_of(server, files, params.text_document.uri)
        path = path_of(params.text_document.uri)
        name = name_at(document.source, document.offset_at_position(params.position))
        if name is None or not _WORD.fullmatch(params.new_name) or not params.new_name:
            return None
        changes: dict[str, list[lsp.TextEdit]] = {}
        for place in files.places(path, name):
            positions = Positions(server, files.text(place.path))
            where = positions.range(place.name.at, place.name.length)
            new = params.new_name
            if name.kind == NameKind.VARIABLE and not new.startswith("?"):
                new = f"?{new}"
            changes.setdefault(uri_of(place.path), []).append(lsp.TextEdit(where, new))
        return lsp.WorkspaceEdit(changes)

    @server.feature(lsp.TEXT_DOCUMENT_FORMATTING)
    def layout(params: lsp.DocumentFormattingParams) -> list[lsp.TextEdit]:
        document = document_of(server, files, params.text_document.uri)
        try:
            text = format_text(document.source, path_of(params.text_document.uri))
        except HrcplanError as error:
            server.window_show_message(
                lsp.ShowMessageParams(lsp.MessageType.Warning, f"not formatted: {error}")
            )
            return []
        end = lsp.Position(len(document.lines), 0)
        return [lsp.TextEdit(lsp.Range(lsp.Position(0, 0), end), text)]

    @server.feature(
        lsp.TEXT_DOCUMENT_CODE_ACTION,
        lsp.CodeActionOptions(code_action_kinds=[lsp.CodeActionKind.QuickFix]),
    )
    def fixes(params: lsp.CodeActionParams) -> list[lsp.CodeAction]:
        uri = params.text_document.uri
        document = document_of(server, files, uri)
        return [action for fault in params.context.diagnostics
                for action in _fixes(uri, document, fault)]  # fmt: skip


def _fixes(uri: str, document: TextDocument, fault: lsp.Diagnostic) -> list[lsp.CodeAction]:
    match = _SUGGESTION.search(fault.message)
    if match is None:
        return []
    edit = lsp.WorkspaceEdit({uri: [lsp.TextEdit(fault.range, match[1])]})
    return [lsp.CodeAction(f"change to '{match[1]}'", lsp.CodeActionKind.QuickFix, [fault],
                           edit=edit, is_preferred=True)]  # fmt: skip


def _completions(
    files: PddlWorkspace, path: str, text: str, start: int
) -> list[lsp.CompletionItem]:
    """Return what may stand at an offset, by the character before it."""
    before = text[:start].rstrip(" \t\r\n")
    variables = {name.word for name in names(text) if name.kind == NameKind.VARIABLE}
    if before.endswith("-") and before[-2:-1].isspace():
        kinds = [NameKind.TYPE]
    elif before.endswith("("):
        kinds = [NameKind.SYMBOL]
    else:
        kinds = [NameKind.OBJECT]
    items = [lsp.CompletionItem(word, kind=_COMPLETIONS[kind])
             for kind in kinds for word in files.words(path, kind)]  # fmt: skip
    if kinds == [NameKind.OBJECT]:
        items += [lsp.CompletionItem(word, kind=_COMPLETIONS[NameKind.VARIABLE])
                  for word in sorted(variables)]  # fmt: skip
    if kinds != [NameKind.TYPE]:
        items += [lsp.CompletionItem(word, kind=lsp.CompletionItemKind.Keyword)
                  for word in KEYWORDS]  # fmt: skip
    return items
