"""Imports pybullet without the line it prints."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def _without_banner() -> Iterator[None]:
    """Send file descriptor 2 to the null device for a while.

    The C code of pybullet prints its build time to it on import. An error of the import is still raised.
    """
    try:
        saved = os.dup(2)
    except OSError:
        saved = -1
    null = os.open(os.devnull, os.O_WRONLY)
    os.dup2(null, 2)
    os.close(null)
    try:
        yield
    finally:
        if saved >= 0:
            os.dup2(saved, 2)
            os.close(saved)


with _without_banner():
    import pybullet

__all__ = ["pybullet"]
