"""The parse table of the grammar as JSON, made once and shipped: loading it takes a tenth of the time of making it.

It is data, not a pickle; a table of another grammar or of another version of lark is passed over, and made anew in
memory. `python -m qsrlang.language.table > grammars/qsr.json` writes it.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping
from hashlib import sha256
from typing import Any

import lark
from lark import Lark
from lark.grammar import Rule
from lark.lexer import TerminalDef

from qsrlang.errors import FileError
from qsrlang.resources import resource_path

FILE = "qsr.json"
STARTS = ("statement", "context_head", "query", "landmark_body", "document")


def make_parser(grammar: str, **options: Any) -> Lark:
    """Return a parser made from the grammar."""
    return Lark(
        grammar,
        parser="lalr",
        lexer="contextual",
        start=list(STARTS),
        keep_all_tokens=True,
        maybe_placeholders=False,
        **options,
    )


def load_parser(grammar: str, **options: Any) -> Lark | None:
    """Return the parser of the shipped table, or None where that is not this grammar's or this lark's."""
    try:
        table = json.loads(resource_path("grammars", FILE).read_text("utf-8"), object_pairs_hook=_numbered)
    except (FileError, OSError, ValueError):
        return None
    if not isinstance(table, dict) or table.get("made of") != _origin(grammar):
        return None
    parser: Lark = Lark._load_from_dict(table["data"], table["memo"], **options)  # type: ignore[no-untyped-call]
    return parser


def table_text(grammar: str) -> str:
    """Return the table of a grammar as JSON, with what it was made of."""
    data, memo = make_parser(grammar).memo_serialize([TerminalDef, Rule])
    return json.dumps({"made of": _origin(grammar), "data": data, "memo": memo}, separators=(",", ":")) + "\n"


def _origin(grammar: str) -> dict[str, str]:
    return {"lark": lark.__version__, "sha256": sha256(grammar.encode()).hexdigest()}


def _numbered(pairs: list[tuple[str, Any]]) -> Mapping[str | int, Any]:
    """JSON writes the numbers of states and rules as strings."""
    return {int(key) if key.isdigit() else key: value for key, value in pairs}


if __name__ == "__main__":
    sys.stdout.write(table_text(resource_path("grammars", "qsr.lark").read_text(encoding="utf-8")))
