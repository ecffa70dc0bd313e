"""The language server: what editors ask, over stdio."""

from __future__ import annotations

from typing import Any

from lsprotocol import types
from pygls.exceptions import JsonRpcException

from qsrlang.editor.completion import Completion, complete
from qsrlang.editor.describing import hover_text
from qsrlang.editor.diagnosing import actions
from qsrlang.editor.navigation import Thing, imported_at, occurrence_at, thing_at
from qsrlang.editor.renaming import RenamingError, check_renamable, rename
from qsrlang.editor.session import EditorSession
from qsrlang.language.printing.formatter import format_source
from qsrlang.language.source import Span

_COMPLETION_KINDS = {
    "keyword": types.CompletionItemKind.Keyword,
    "sign": types.CompletionItemKind.Operator,
    "unit": types.CompletionItemKind.Unit,
    "class": types.CompletionItemKind.Class,
    "landmark": types.CompletionItemKind.Variable,
    "relation": types.CompletionItemKind.Function,
    "scene": types.CompletionItemKind.Event,
    "role": types.CompletionItemKind.Field,
    "default": types.CompletionItemKind.Constant,
    "room": types.CompletionItemKind.Module,
    "file": types.CompletionItemKind.File,
    "code": types.CompletionItemKind.Value,
}


def serve() -> None:
    """Serve one editor over stdin and stdout until it says goodbye."""
    build_server().start_io()


def build_server() -> EditorSession:
    """Return a server that is ready to be started."""
    server = EditorSession()
    for name, (answer, options) in _FEATURES.items():
        register: Any = server.feature(name, options)
        register(answer)
    return server


def _opened(ls: EditorSession, params: types.DidOpenTextDocumentParams) -> None:
    ls.bench.put(params.text_document.uri, params.text_document.text)
    ls.check_soon(0.0)


def _changed(ls: EditorSession, params: types.DidChangeTextDocumentParams) -> None:
    address = params.text_document.uri
    ls.bench.put(address, ls.workspace.get_text_document(address).source)
    ls.check_soon()


def _saved(ls: EditorSession, params: types.DidSaveTextDocumentParams) -> None:
    ls.bench.reread()
    ls.check_soon(0.0)


def _closed(ls: EditorSession, params: types.DidCloseTextDocumentParams) -> None:
    ls.bench.drop(params.text_document.uri)
    ls.check_soon(0.0)


def _files_changed(ls: EditorSession, params: types.DidChangeWatchedFilesParams) -> None:
    ls.bench.reread()
    ls.check_soon()


def _hover(ls: EditorSession, params: types.HoverParams) -> types.Hover | None:
    address = params.text_document.uri
    here = occurrence_at(ls.bench, address, ls.offset(address, params.position))
    if here is None:
        return None
    text = hover_text(here.kind, here.name, ls.bench.built(address))
    return types.Hover(types.MarkupContent(types.MarkupKind.Markdown, text), ls.translator.range(here.span))


def _complete(ls: EditorSession, params: types.CompletionParams) -> list[types.CompletionItem]:
    """Punctuation that is on every keyboard is left out: it would only be in the way."""
    address = params.text_document.uri
    source, position = ls.bench.source(address), ls.offset(address, params.position)
    if source is None:
        return []
    found = complete(source.text, position, ls.bench.built(address))
    wanted = [one for one in found if not (one.kind == "sign" and one.text.isascii())]
    return [
        _item(one, ls.translator.range(Span(source, one.start, position)), number)
        for number, one in enumerate(wanted)
    ]


def _item(one: Completion, place: types.Range, number: int) -> types.CompletionItem:
    return types.CompletionItem(
        one.text,
        kind=_COMPLETION_KINDS[one.kind],
        detail=one.detail or None,
        sort_text=f"{number:05}",
        filter_text=one.text,
        text_edit=types.TextEdit(place, one.text),
    )


def _thing(ls: EditorSession, address: str, position: types.Position) -> Thing | None:
    return thing_at(ls.bench, address, ls.offset(address, position))


def _define(ls: EditorSession, params: types.DefinitionParams) -> list[types.Location]:
    thing = _thing(ls, params.text_document.uri, params.position)
    if thing is not None:
        return [ls.translator.location(span) for span in thing.definitions]
    address = params.text_document.uri
    file = imported_at(ls.bench, address, ls.offset(address, params.position))
    return [] if file is None else [ls.translator.location(Span(file, 0, 0))]


def _refer(ls: EditorSession, params: types.ReferenceParams) -> list[types.Location]:
    thing = _thing(ls, params.text_document.uri, params.position)
    if thing is None:
        return []
    wanted = [one for one in thing.places if params.context.include_declaration or not one.defines]
    return [ls.translator.location(one.span) for one in wanted]


def _prepare_rename(
    ls: EditorSession, params: types.PrepareRenameParams
) -> types.PrepareRenamePlaceholder | None:
    address = params.text_document.uri
    here = occurrence_at(ls.bench, address, ls.offset(address, params.position))
    thing = _thing(ls, params.text_document.uri, params.position)
    if here is None or thing is None:
        return None
    try:
        check_renamable(thing)
    except RenamingError as error:
        raise _refused(error) from None
    return types.PrepareRenamePlaceholder(ls.translator.range(here.span), here.span.text)


def _refused(error: RenamingError) -> JsonRpcException:
    return JsonRpcException(str(error), types.LSPErrorCodes.RequestFailed)


def _rename(ls: EditorSession, params: types.RenameParams) -> types.WorkspaceEdit | None:
    thing = _thing(ls, params.text_document.uri, params.position)
    if thing is None:
        return None
    try:
        return ls.translator.edits(rename(thing, params.new_name, ls.bench.readings()))
    except RenamingError as error:
        raise _refused(error) from None


def _format(ls: EditorSession, params: types.DocumentFormattingParams) -> list[types.TextEdit]:
    source = ls.bench.source(params.text_document.uri)
    if source is None:
        return []
    text, whole = format_source(source), Span(source, 0, len(source.text))
    return [] if text == source.text else [types.TextEdit(ls.translator.range(whole), text)]


def _act(ls: EditorSession, params: types.CodeActionParams) -> list[types.CodeAction]:
    only = params.context.only
    found = actions(ls.bench, params.text_document.uri, params.range, ls.translator.encoding)
    return [one for one in found if only is None or one.kind in only]


_FEATURES = {
    types.TEXT_DOCUMENT_DID_OPEN: (_opened, None),
    types.TEXT_DOCUMENT_DID_CHANGE: (_changed, None),
    types.TEXT_DOCUMENT_DID_SAVE: (_saved, None),
    types.TEXT_DOCUMENT_DID_CLOSE: (_closed, None),
    types.WORKSPACE_DID_CHANGE_WATCHED_FILES: (_files_changed, None),
    types.TEXT_DOCUMENT_HOVER: (_hover, None),
    types.TEXT_DOCUMENT_COMPLETION: (_complete, types.CompletionOptions(trigger_characters=['"', "/", "("])),
    types.TEXT_DOCUMENT_DEFINITION: (_define, None),
    types.TEXT_DOCUMENT_REFERENCES: (_refer, None),
    types.TEXT_DOCUMENT_PREPARE_RENAME: (_prepare_rename, None),
    types.TEXT_DOCUMENT_RENAME: (_rename, types.RenameOptions(prepare_provider=True)),
    types.TEXT_DOCUMENT_FORMATTING: (_format, None),
    types.TEXT_DOCUMENT_CODE_ACTION: (
        _act,
        types.CodeActionOptions([types.CodeActionKind.QuickFix, types.CodeActionKind.SourceFixAll]),
    ),
}
