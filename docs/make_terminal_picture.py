"""The picture of the REPL, made anew: types into it in a real terminal and draws what the screen then shows."""

from __future__ import annotations

import os
import sys
import tempfile
from pathlib import Path

import matplotlib
import pexpect
import pyte
from PIL import Image, ImageDraw, ImageFont

IMAGES = Path(__file__).parent / "images"
COMMAND = "from qsrlang.cli.main import main; main()"
PROMPT, CONTINUATION = "qsr>", "...>"
TYPED = (
    "landmark monitor-1 : Monitor at (1.2 m, 3.0 m) facing -90 deg ± (2 cm, 2 cm, 3 deg).",
    "landmark desk-1 : Desk at (1.2 m, 2.8 m) facing -90 deg.",
    "dynamic Mug { size: 9 cm × 9 cm × 10 cm, on: Desk }.",
    "observe 6 × right_of(Mug, Keyboard).",
    "observe 6 × right-of(Mug, Keyboard).",
    "observe 2 × behind-of(Mug, Keyboard)",
    "  ∧ close-to(Mug, Keyboard).",
    "where Mug?",
)
COLUMNS, ROWS = 96, 60
QUIET = 0.5
FONTS = Path(matplotlib.get_data_path(), "fonts", "ttf")
SIZE = 15
GROUND, INK = "#16161e", "#d8d8e0"
COLOURS = {
    "black": GROUND,
    "red": "#f7768e",
    "green": "#8fce6b",
    "brown": "#e0af68",
    "blue": "#6ba5f7",
    "magenta": "#c79bf0",
    "cyan": "#7fd4e8",
    "white": INK,
    "brightblack": "#8b8b98",
    "brightblue": "#8fbcff",
}
BLOCKS = {"▀": (0.0, 0.5), "▄": (0.5, 1.0), "█": (0.0, 1.0)}


class Terminal:
    """A terminal in which `qsr repl` runs."""

    def __init__(self, folder: str) -> None:
        settings = {"TERM": "xterm-256color", "COLORTERM": "truecolor", "XDG_STATE_HOME": folder}
        self._child = pexpect.spawn(
            sys.executable,
            ["-c", COMMAND, "repl", "office/desk"],
            env={**os.environ, **settings},
            dimensions=(ROWS, COLUMNS),
            encoding="utf-8",
        )
        self.screen = pyte.Screen(COLUMNS, ROWS)
        self.screen.write_process_input = self._child.send
        self._stream = pyte.Stream(self.screen)

    def type(self, line: str) -> None:
        """Send a line once the prompt stands."""
        self.wait()
        self._child.sendline(line)

    def wait(self) -> None:
        """Read until the prompt stands and nothing else comes."""
        while True:
            try:
                self._stream.feed(self._child.read_nonblocking(65536, timeout=QUIET))
            except pexpect.TIMEOUT:
                if self.screen.display[self.screen.cursor.y].strip() in (PROMPT, CONTINUATION):
                    return

    def close(self) -> None:
        """End what runs in it."""
        self._child.close(force=True)


def draw(screen: pyte.Screen, path: Path) -> None:
    """Write the screen, down to the prompt, as a picture."""
    fonts = [ImageFont.truetype(FONTS / f"DejaVuSansMono{kind}.ttf", SIZE) for kind in ("", "-Bold")]
    wide, high = round(fonts[0].getlength("M")), SIZE + 5
    rows = screen.cursor.y + 1
    image = Image.new("RGB", (wide * (COLUMNS + 2), high * (rows + 1)), GROUND)
    pen = ImageDraw.Draw(image)
    for row in range(rows):
        for column in range(COLUMNS):
            cell = screen.buffer[row][column]
            x, y = wide * (column + 1), high * row + high // 2
            pen.rectangle((x, y, x + wide - 1, y + high - 1), fill=colour_of(cell.bg, GROUND))
            if cell.data in BLOCKS:
                top, bottom = (round(high * share) for share in BLOCKS[cell.data])
                pen.rectangle((x, y + top, x + wide - 1, y + bottom - 1), fill=colour_of(cell.fg, INK))
            else:
                pen.text((x, y + 1), cell.data, font=fonts[cell.bold], fill=colour_of(cell.fg, INK))
    image.save(path, optimize=True)


def colour_of(name: str, default: str) -> str:
    """Return the colour of a name as the terminal gives it, or of six digits."""
    known = COLOURS.get(name) or COLOURS.get(name.removeprefix("bright"))
    return known or (f"#{name}" if len(name) == 6 else default)


def main() -> None:
    """Make docs/images/repl.png."""
    with tempfile.TemporaryDirectory() as folder:
        terminal = Terminal(folder)
        for line in TYPED:
            terminal.type(line)
        terminal.wait()
        terminal.close()
    draw(terminal.screen, IMAGES / "repl.png")


if __name__ == "__main__":
    main()
