"""One editor's session: the texts that are open in it, and the findings that were sent of them."""

from __future__ import annotations

import asyncio

from lsprotocol import types
from pygls.lsp.server import LanguageServer

from qsrlang.editor.diagnosing import Translator, findings_by_address
from qsrlang.editor.positions import ruler
from qsrlang.editor.workbench import Workbench
from qsrlang.errors import QSRError
from qsrlang.language.parser import LANGUAGE_VERSION

PAUSE = 0.15
"""How long typing must rest before findings are sent [s]."""


class EditorSession(LanguageServer):
    """A server with the texts of one editor; whole texts are sent, for line ends differ between protocols."""

    def __init__(self) -> None:
        super().__init__("qsr", f"language {LANGUAGE_VERSION}", types.TextDocumentSyncKind.Full)
        self.bench = Workbench()
        self._timer: asyncio.TimerHandle | None = None
        self._shown: frozenset[str] = frozenset()

    @property
    def translator(self) -> Translator:
        """From places to the protocol's, in the encoding that was agreed on."""
        return Translator(self.bench, types.PositionEncodingKind(self.workspace.position_encoding))

    def offset(self, address: str, position: types.Position) -> int:
        """Return the offset of a position in an open text."""
        source = self.bench.source(address)
        return ruler(source.text if source else "", self.translator.encoding).offset(position)

    def check_soon(self, pause: float = PAUSE) -> None:
        """Send the findings of all open texts once nothing was typed for a while."""
        if self._timer is not None:
            self._timer.cancel()
        self._timer = asyncio.get_running_loop().call_later(pause, self.check)

    def check(self) -> None:
        """Send the findings of all open texts, and of others that they have errors in; clear those gone."""
        try:
            shown = findings_by_address(self.bench)
        except QSRError as error:
            self.window_show_message(types.ShowMessageParams(types.MessageType.Error, str(error)))
            return
        for address in sorted(self._shown | shown.keys()):
            found = [self.translator.finding(one) for one in shown.get(address, ())]
            number = self.workspace.get_text_document(address).version if address in self.bench.open else None
            self.text_document_publish_diagnostics(types.PublishDiagnosticsParams(address, found, number))
        self._shown = frozenset(address for address, found in shown.items() if found)
