"""Compiled kernels over rows, spread over threads where the work is worth it."""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

ALONE = 400_000
"""Work of fewer steps than this is done in one thread."""
_PARTS_PER_THREAD = 4


def processors() -> int:
    """Return how many processors this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


class _Threads:
    """How many threads there are, and the pool, made when it is first needed."""

    count = processors()
    pool: ThreadPoolExecutor | None = None


def use_threads(count: int) -> None:
    """Set how many threads the kernels of this process use; results do not depend on it."""
    _Threads.count = max(1, count)


def over_rows(kernel: Callable[[int, int], None], rows: int, work: int) -> None:
    """Call `kernel(first, last)` for parts of `rows` that make up the whole; `work` is about how many steps all take.

    Kernels write each row once, whatever the parts, and let go of the interpreter's lock.
    """
    if rows == 0:
        return
    if work < ALONE or _Threads.count == 1 or rows == 1:
        kernel(0, rows)
        return
    if _Threads.pool is None:
        _Threads.pool = ThreadPoolExecutor(processors(), thread_name_prefix="qsrlang")
    parts = min(rows, _Threads.count * _PARTS_PER_THREAD)
    edges = [rows * part // parts for part in range(parts + 1)]
    list(_Threads.pool.map(kernel, edges[:-1], edges[1:]))
