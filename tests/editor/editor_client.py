"""An editor for tests: a real client of `qsr lsp`, in a process of its own, over stdio."""

import asyncio
import sys
import threading
from pathlib import Path

from lsprotocol import types
from pygls.lsp.client import LanguageClient

PATIENCE = 60.0
COMMAND = "import sys; from qsrlang.cli.main import main; sys.argv[1:] = ['lsp', '--stdio']; main()"


class Editor:
    """Opens files, types, and asks; every method waits for the answer."""

    def __init__(self, folder, encodings=None):
        self.folder = Path(folder)
        self.findings = {}
        self.messages = []
        self._texts = {}
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_forever, daemon=True)
        self._thread.start()
        self._told = threading.Condition()
        self.client = LanguageClient("an editor for tests", "1")
        self.client.feature(types.TEXT_DOCUMENT_PUBLISH_DIAGNOSTICS)(lambda params: self._receive(params))
        self.client.feature(types.WINDOW_SHOW_MESSAGE)(lambda params: self.messages.append(params))
        self.capabilities = self.run(self._start(encodings)).capabilities

    def _receive(self, params):
        with self._told:
            self.findings.setdefault(params.uri, []).append(params)
            self._told.notify_all()

    async def _start(self, encodings):
        await self.client.start_io(sys.executable, "-c", COMMAND)
        able = types.ClientCapabilities(
            general=types.GeneralClientCapabilities(position_encodings=encodings),
            text_document=types.TextDocumentClientCapabilities(
                rename=types.RenameClientCapabilities(prepare_support=True)
            ),
        )
        answer = await self.client.initialize_async(
            types.InitializeParams(capabilities=able, root_uri=self.folder.as_uri())
        )
        self.client.initialized(types.InitializedParams())
        return answer

    def run(self, coroutine):
        return asyncio.run_coroutine_threadsafe(coroutine, self._loop).result(PATIENCE)

    def call(self, function, *arguments):
        """Call something of the client in its own thread."""

        async def called():
            function(*arguments)

        self.run(called())

    def stop(self):
        self.run(self.client.shutdown_async(None))
        self.call(self.client.exit, None)
        self.run(self.client.stop())
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join(PATIENCE)
        self._loop.close()

    def uri(self, name):
        return name if name.startswith("untitled:") else (self.folder / name).as_uri()

    def open(self, name, text=None):
        """Open a file, or a text that is saved nowhere yet, and return the findings of it."""
        if text is None:
            text = (self.folder / name).read_text(encoding="utf-8")
        self._texts[name] = (text, 1)
        item = types.TextDocumentItem(self.uri(name), "qsr", 1, text)
        return self._awaiting(name, self.client.text_document_did_open, types.DidOpenTextDocumentParams(item))

    def change(self, name, text):
        """Give an open file another content, and return the findings of it."""
        version = self._texts[name][1] + 1
        self._texts[name] = (text, version)
        changed = types.DidChangeTextDocumentParams(
            types.VersionedTextDocumentIdentifier(version, self.uri(name)),
            [types.TextDocumentContentChangeWholeDocument(text)],
        )
        return self._awaiting(name, self.client.text_document_did_change, changed)

    def save(self, name):
        saved = types.DidSaveTextDocumentParams(self.document(name))
        return self._awaiting(name, self.client.text_document_did_save, saved)

    def close(self, name):
        self._texts.pop(name)
        self.call(self.client.text_document_did_close, types.DidCloseTextDocumentParams(self.document(name)))

    def _awaiting(self, name, function, params):
        """Send a change of an open text, and return the findings of that version of it."""
        uri, version = self.uri(name), self._texts[name][1]
        before = len(self.findings.get(uri, []))
        self.call(function, params)
        return self._wait(lambda: self._news(uri, before, version))[-1]

    def comes_to_show(self, name, codes):
        """Wait until the last findings of a file have these codes."""
        uri = self.uri(name)
        self._wait(
            lambda: [one.code for one in self._news(uri, 0)[-1]] == codes if uri in self.findings else False
        )

    def _news(self, uri, before, version=None):
        come = self.findings.get(uri, [])[before:]
        return [list(one.diagnostics) for one in come if version in (None, one.version)]

    def _wait(self, condition):
        with self._told:
            assert self._told.wait_for(condition, PATIENCE), "the server does not say what was expected"
            return condition()

    def document(self, name):
        return types.TextDocumentIdentifier(self.uri(name))

    def place(self, name, mark, within=0):
        """The position of a mark in an open text, some characters into it, in UTF-16 units."""
        text = self._texts[name][0]
        before = text[: text.index(mark) + within]
        line = before[before.rfind("\n") + 1 :]
        return types.Position(before.count("\n"), len(line.encode("utf-16-le")) // 2)

    def hover(self, name, mark, within=0):
        answer = self.run(
            self.client.text_document_hover_async(
                types.HoverParams(self.document(name), self.place(name, mark, within))
            )
        )
        return answer and answer.contents.value

    def complete(self, name, mark):
        """What may stand right after a mark."""
        place = self.place(name, mark, len(mark))
        answer = self.run(
            self.client.text_document_completion_async(types.CompletionParams(self.document(name), place))
        )
        return {item.label: item for item in answer}

    def define(self, name, mark, within=0):
        params = types.DefinitionParams(self.document(name), self.place(name, mark, within))
        return list(self.run(self.client.text_document_definition_async(params)))

    def refer(self, name, mark, declaration=True, within=0):
        params = types.ReferenceParams(
            types.ReferenceContext(declaration), self.document(name), self.place(name, mark, within)
        )
        return list(self.run(self.client.text_document_references_async(params)))

    def prepare_rename(self, name, mark, within=0):
        params = types.PrepareRenameParams(self.document(name), self.place(name, mark, within))
        return self.run(self.client.text_document_prepare_rename_async(params))

    def rename(self, name, mark, new, within=0):
        """The new content of every file that the renaming changes, by file name."""
        params = types.RenameParams(self.document(name), self.place(name, mark, within), new)
        answer = self.run(self.client.text_document_rename_async(params))
        return {Path(uri).name: self.edited(Path(uri).name, edits) for uri, edits in answer.changes.items()}

    def format(self, name):
        params = types.DocumentFormattingParams(self.document(name), types.FormattingOptions(4, True))
        return self.edited(name, self.run(self.client.text_document_formatting_async(params)))

    def actions(self, name, found):
        """What is offered at the place of a finding, by title."""
        params = types.CodeActionParams(self.document(name), found.range, types.CodeActionContext([found]))
        return {one.title: one for one in self.run(self.client.text_document_code_action_async(params))}

    def edited(self, name, edits):
        """The content of a file with edits made, places counted in UTF-16 units."""
        text = (
            self._texts[name][0] if name in self._texts else (self.folder / name).read_text(encoding="utf-8")
        )
        lines = text.split("\n")
        for edit in sorted(
            edits, key=lambda one: (one.range.start.line, one.range.start.character), reverse=True
        ):
            start, end = (self._offset(lines, one) for one in (edit.range.start, edit.range.end))
            text = text[:start] + edit.new_text + text[end:]
        return text

    @staticmethod
    def _offset(lines, position):
        line = lines[position.line].encode("utf-16-le")[: 2 * position.character].decode("utf-16-le")
        return sum(len(one) + 1 for one in lines[: position.line]) + len(line)
