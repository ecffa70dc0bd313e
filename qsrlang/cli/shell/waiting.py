"""Keys that are pressed while an answer is worked out wait for the next prompt, all of them."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress

if sys.platform != "win32":
    import termios

    @contextmanager
    def keys_wait() -> Iterator[None]:
        """Within it, the terminal neither shows nor ends nor drops what is typed; Ctrl-C still interrupts."""
        with _flags(termios.ISIG | termios.NOFLSH, without=termios.ICANON | termios.ECHO):
            yield

    def step_aside() -> None:
        """Stop, with the terminal as it usually is, until the person comes back."""
        with _flags(termios.ICANON | termios.ECHO, without=termios.NOFLSH):
            os.kill(0, signal.SIGTSTP)

    @contextmanager
    def _flags(flags: int, *, without: int) -> Iterator[None]:
        keyboard = sys.stdin.fileno()
        before, settings = termios.tcgetattr(keyboard), termios.tcgetattr(keyboard)
        settings[3] = (settings[3] | flags) & ~without
        termios.tcsetattr(keyboard, termios.TCSANOW, settings)
        try:
            yield
        finally:
            with suppress(termios.error):
                termios.tcsetattr(keyboard, termios.TCSADRAIN, before)

else:

    @contextmanager
    def keys_wait() -> Iterator[None]:
        """Within it, as outside of it."""
        yield

    def step_aside() -> None:
        """Stay, where nothing can be stopped."""
