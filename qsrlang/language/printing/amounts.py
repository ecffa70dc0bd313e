"""Numbers and quantities as the shortest text that reads back as the same value."""

from __future__ import annotations

import math
from collections.abc import Iterator

from qsrlang.language.quantities import UNITS, to_si
from qsrlang.language.syntax import Dimension, Quantity

# The units to write, in order of preference where two texts are equally short; any length, angle and duration can be
# written in the last one exactly.
_PREFERRED = {
    Dimension.LENGTH: ("cm", "m"),
    Dimension.ANGLE: ("deg", "rad"),
    Dimension.DURATION: ("s", "h"),
    Dimension.FRACTION: ("%",),
}
_DIGITS = range(1, 18)


def number_text(value: float) -> str:
    """Return a finite number without a sign."""
    digits, exponent, power = repr(float(abs(value))).partition("e")
    return digits.removesuffix(".0") + (f"{exponent}{int(power)}" if exponent else "")


def quantity_text(quantity: Quantity) -> str:
    """Return a quantity in the unit that makes it shortest: `8 cm`, `3 m`, `-90 deg`; centimetres and degrees first.

    A percentage that no number of percent makes exactly is written as the nearest one.
    """
    if quantity.dimension is Dimension.NUMBER:
        return signed_text(quantity.value)
    return amount_text(quantity.value, quantity.dimension)


def amount_text(value: float, dimension: Dimension) -> str:
    """Return a value in SI units with a unit of a dimension."""
    size = abs(value)
    written = [(f"{text} {unit}", text) for unit in _PREFERRED[dimension] for text in _exact(size, unit)]
    nearest = f"{number_text(size / UNITS['%'][1])} %"
    return _sign(value) + min(written, key=lambda one: len(one[1]), default=(nearest, nearest))[0]


def signed_text(value: float) -> str:
    """Return a bare number with its sign."""
    return _sign(value) + number_text(value)


def _sign(value: float) -> str:
    return "-" if math.copysign(1.0, value) < 0.0 else ""


def _exact(size: float, unit: str) -> Iterator[str]:
    """Yield the shortest number that in this unit is exactly this size, if any is."""
    about = size / UNITS[unit][1]
    if not math.isfinite(about):
        return
    near = [float(f"{about:.{digits}g}") for digits in _DIGITS]
    near += [math.nextafter(about, 0.0), math.nextafter(about, math.inf)]
    exact = [number for number in near if to_si(number, unit)[0] == size]
    if exact:
        yield min((number_text(number) for number in exact), key=len)
