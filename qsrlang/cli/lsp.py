"""`qsr lsp`: the language server, for editors to start."""

from __future__ import annotations

from typing import Annotated

import typer

from qsrlang.editor.server import serve


def lsp(
    stdio: Annotated[
        bool, typer.Option("--stdio", hidden=True, help="The only way; some editors say it.")
    ] = False,
) -> None:
    """Serve an editor: findings, hover, completion, navigation, rename, formatting, over stdin and stdout."""
    serve()
