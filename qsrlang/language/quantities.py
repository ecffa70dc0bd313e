"""Units: what each one measures, and its factor to SI."""

from __future__ import annotations

import math

from qsrlang.language.syntax import Dimension

UNITS: dict[str, tuple[Dimension, float]] = {
    "m": (Dimension.LENGTH, 1.0),
    "cm": (Dimension.LENGTH, 1e-2),
    "mm": (Dimension.LENGTH, 1e-3),
    "rad": (Dimension.ANGLE, 1.0),
    "deg": (Dimension.ANGLE, math.pi / 180.0),
    "s": (Dimension.DURATION, 1.0),
    "h": (Dimension.DURATION, 3600.0),
    "%": (Dimension.FRACTION, 1e-2),
}

EXAMPLES = {
    Dimension.LENGTH: "a length such as 25 cm or 0.25 m",
    Dimension.ANGLE: "an angle such as 90 deg or 1.57 rad",
    Dimension.DURATION: "a duration such as 3 s",
    Dimension.FRACTION: "a percentage such as 50 %",
    Dimension.NUMBER: "a bare number",
}
_LEAST_CENTIMETRES = 5.0


def to_si(number: float, unit: str | None) -> tuple[float, Dimension]:
    """Return the value of a quantity in SI units, and what it measures; infinite where it is too large."""
    dimension, factor = UNITS[unit] if unit else (Dimension.NUMBER, 1.0)
    # Dividing by 100 or 1000 rounds once, where multiplying by 0.01 rounds twice: 30 cm is 0.3 m exactly.
    value = number / round(1.0 / factor) if factor in (1e-2, 1e-3) else number * factor
    return value, dimension


def likely_unit(number: float, dimension: Dimension) -> str | None:
    """Return the unit that a bare number probably lacks: centimetres from 5 up, else metres; degrees; seconds."""
    if dimension is Dimension.LENGTH:
        return "cm" if abs(number) >= _LEAST_CENTIMETRES else "m"
    return {Dimension.ANGLE: "deg", Dimension.DURATION: "s", Dimension.FRACTION: "%"}.get(dimension)
