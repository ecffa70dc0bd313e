"""A text of the language as a picture, coloured as an editor shows it."""

from __future__ import annotations

from pathlib import Path

from pygments import highlight
from pygments.formatters.img import ImageFormatter

from qsrlang.editor.highlighting import DarkStyle, QSRLexer

LETTER_HEIGHT = 20
PADDING = 18
"""Of letters, and of the ground around the text [pixels]."""


def code_picture(text: str, font: Path) -> bytes:
    """Return a text with its line numbers as PNG, in a TrueType font of fixed width; needs Pillow."""
    formatter = ImageFormatter(
        style=DarkStyle,
        font_name=str(font),
        font_size=LETTER_HEIGHT,
        image_pad=PADDING,
        line_pad=4,
        line_number_bg=DarkStyle.background_color,
        line_number_fg=DarkStyle.line_number_color,
        line_number_separator=False,
        line_number_pad=12,
    )
    drawn: bytes = highlight(text, QSRLexer(), formatter)
    return drawn
