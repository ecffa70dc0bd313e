"""What signals do to a REPL: Ctrl-C stops an answer, and only that; a signal to end lets it leave in order."""

from __future__ import annotations

import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType, TracebackType

from prompt_toolkit.application import Application

ENDS = tuple(getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name))
_Handler = Callable[[int, FrameType | None], None] | int | None


class Signals:
    """Takes the signals of a process, within it, for the prompt that waits and for the answers in between.

    `ended` is the signal to end that came, or 0.
    """

    def __init__(self, prompt: Application[str]) -> None:
        self.ended = 0
        self._prompt = prompt
        self._is_answering = False
        self._before: dict[int, _Handler] = {}

    def __enter__(self) -> Signals:
        self._before = {number: signal.signal(number, self._end) for number in ENDS}
        self._before[signal.SIGINT] = signal.signal(signal.SIGINT, self._interrupt)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for number, handler in self._before.items():
            signal.signal(number, handler)

    @contextmanager
    def answering(self) -> Iterator[None]:
        """Within it, Ctrl-C raises KeyboardInterrupt."""
        if self.ended:
            raise SystemExit(128 + self.ended)
        try:
            self._is_answering = True
            yield
        finally:
            self._is_answering = False

    def ignore(self) -> None:
        """From now on, let nothing come in between."""
        for number in self._before:
            signal.signal(number, signal.SIG_IGN)

    def _interrupt(self, number: int, frame: FrameType | None) -> None:
        if self._is_answering:
            raise KeyboardInterrupt

    def _end(self, number: int, frame: FrameType | None) -> None:
        """Leave the prompt by its own loop: an exception raised just anywhere in it could be lost."""
        self.ended = number
        if not self._prompt.is_running or self._prompt.loop is None:
            raise SystemExit(128 + number)
        self._prompt.loop.call_soon_threadsafe(self._leave_prompt)

    def _leave_prompt(self) -> None:
        if self._prompt.is_running and not self._prompt.is_done:
            self._prompt.exit(exception=EOFError())
