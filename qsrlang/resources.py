"""Finds what travels with the package: grammars/, knowledge/, the pages of the codes; and the folder of real data."""

from __future__ import annotations

import os
from functools import cache
from pathlib import Path

from qsrlang.errors import FileError

_PACKAGE = Path(__file__).resolve().parent
_IN_A_CHECKOUT = {"codes": Path("docs", "language", "codes")}


@cache
def resource_root(name: str) -> Path:
    """Return the folder `grammars`, `knowledge` or `codes`: inside an installed wheel, or in the checkout around it."""
    installed = _PACKAGE / name
    if installed.is_dir():
        return installed
    checkout = _PACKAGE.parent / _IN_A_CHECKOUT.get(name, name)
    if (_PACKAGE.parent / "pyproject.toml").is_file() and checkout.is_dir():
        return checkout
    raise FileError(installed, "this part of the package is missing", "install qsrlang again")


def resource_path(name: str, *parts: str) -> Path:
    """Return the path of one shipped file, such as `resource_path("knowledge", "core.qsr")`."""
    path = resource_root(name).joinpath(*parts)
    if not path.is_file():
        raise FileError(
            path, "no such file is shipped", f"the folder holds {', '.join(_listing(path.parent))}"
        )
    return path


def data_root() -> Path:
    """Return the folder of real maps and desks: $QSR_DATA, or ../shared/data beside a checkout."""
    return Path(os.environ.get("QSR_DATA", _PACKAGE.parent.parent / "shared" / "data"))


def _listing(folder: Path) -> list[str]:
    return sorted(entry.name for entry in folder.iterdir()) if folder.is_dir() else ["nothing"]
