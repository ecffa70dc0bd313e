"""Reads grey images of the PGM format, plain (P2) and raw (P5)."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from qsrlang.arrays import FloatArray
from qsrlang.errors import FileError
from qsrlang.maps.reading import read_bounded

MAX_PIXELS = 25_000_000
MAX_PGM_BYTES = 150_000_000
_BLANK = rb"(?:\s|#[^\n]*\n)"
_HEADER = re.compile(
    rb"P([25])" + _BLANK + rb"+(\d{1,9})" + _BLANK + rb"+(\d{1,9})" + _BLANK + rb"+(\d{1,9})(?:#[^\n]*\n|\s)"
)
_KINDS = {b"\x89PNG": "a PNG", b"\xff\xd8": "a JPEG", b"BM": "a BMP", b"GIF8": "a GIF"}
_AGAIN = "copy or save the image again"
_REMEDY = "convert the image to PGM (P5), as map_saver writes it"


def read_pgm(path: Path) -> FloatArray:
    """Return the pixels (H, W) of a PGM image, top row first, scaled to 0 (black) to 255 (white).

    Largest values up to 255 (one byte a pixel) and up to 65,535 (two bytes, high byte first) are read.
    Raises FileError where the file is missing, no PGM, cut short or larger than MAX_PIXELS.
    """
    data = read_bounded(path, MAX_PGM_BYTES, "a PGM image")
    header = _HEADER.match(data)
    if header is None:
        raise FileError(path, f"this is not a PGM image but {_kind(data)}", _REMEDY)
    width, height, largest = (int(header[group]) for group in (2, 3, 4))
    if width * height == 0 or width * height > MAX_PIXELS:
        raise FileError(path, f"{width} x {height} pixels", f"use an image of 1 to {MAX_PIXELS:,} pixels")
    if not 1 <= largest <= 65_535:
        raise FileError(path, f"its largest value is {largest}", "use a largest value of 1 to 65535")
    read = _raw if header[1] == b"5" else _plain
    pixels = read(path, data[header.end() :], width * height, largest)
    if pixels.max() > largest:
        raise FileError(
            path, f"a pixel is {pixels.max():.0f}, above its largest value {largest}", "save it again"
        )
    return np.asarray(pixels.reshape(height, width) * (255.0 / largest))


def _raw(path: Path, body: bytes, count: int, largest: int) -> FloatArray:
    kind = np.dtype(np.uint8 if largest < 256 else ">u2")
    if len(body) < count * kind.itemsize:
        have = len(body) // kind.itemsize
        raise FileError(
            path, f"the image is cut short: {have:,} of {count:,} pixels", "copy or save the file again"
        )
    return np.frombuffer(body, dtype=kind, count=count).astype(np.float64)


def _plain(path: Path, body: bytes, count: int, largest: int) -> FloatArray:
    words = re.sub(rb"#[^\n]*", b" ", body).split()
    if len(words) < count:
        raise FileError(
            path, f"the image is cut short: {len(words):,} of {count:,} pixels", "save the file again"
        )
    if not all(word.isdigit() and len(word) <= 5 for word in words[:count]):
        raise FileError(path, f"a pixel is not a number up to {largest}", _AGAIN)
    return np.array(words[:count], dtype=np.float64)


def _kind(data: bytes) -> str:
    for magic, kind in _KINDS.items():
        if data.startswith(magic):
            return kind
    if re.match(rb"P[1-7]\s", data):
        return f"an image of type {data[:2].decode()} or one with a damaged header"
    return "something else" if data else "empty"
