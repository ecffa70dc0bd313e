"""Units: every quantity is checked and converted to SI once, where it is read."""

from __future__ import annotations

import math

from qsrlang.language.diagnostics import Diagnostic
from qsrlang.language.source import Span
from qsrlang.language.syntax import Dimension, Quantity

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

_EXAMPLES = {
    Dimension.LENGTH: "a length such as 25 cm or 0.25 m",
    Dimension.ANGLE: "an angle such as 90 deg or 1.57 rad",
    Dimension.DURATION: "a duration such as 3 s",
    Dimension.FRACTION: "a percentage such as 50 %",
    Dimension.NUMBER: "a bare number",
}
_USUAL_UNIT = {
    Dimension.LENGTH: "cm",
    Dimension.ANGLE: "deg",
    Dimension.DURATION: "s",
    Dimension.FRACTION: "%",
}


class Refused(Exception):
    """Carries the diagnostic of a statement that cannot be taken over."""

    def __init__(self, diagnostic: Diagnostic) -> None:
        super().__init__(diagnostic.message)
        self.diagnostic = diagnostic


def convert(span: Span, number: float, unit: str | None) -> Quantity:
    """Return the quantity in SI units."""
    dimension, factor = UNITS[unit] if unit else (Dimension.NUMBER, 1.0)
    # Dividing by 100 or 1000 rounds once, where multiplying by 0.01 rounds twice: 30 cm is 0.3 m exactly.
    value = number / round(1.0 / factor) if factor in (1e-2, 1e-3) else number * factor
    if not math.isfinite(value):
        raise Refused(Diagnostic("Q303", f"{span.text} is too large a number", span))
    return Quantity(span, value, dimension)


def expect(quantity: Quantity, what: str, *allowed: Dimension) -> float:
    """Return the value of a quantity of one of the allowed dimensions, or refuse it with a remedy."""
    if quantity.dimension in allowed:
        return quantity.value
    wanted = " or ".join(_EXAMPLES[dimension] for dimension in allowed)
    unit = _USUAL_UNIT.get(allowed[0])
    if quantity.dimension is Dimension.NUMBER and unit:
        message = f"{what} needs a unit"
        remedy = f"write '{quantity.span.text} {unit}'"
        raise Refused(Diagnostic("Q301", message, quantity.span, f"expected {wanted}", remedy))
    message = f"{what} has the unit of {quantity.dimension.value}"
    raise Refused(Diagnostic("Q302", message, quantity.span, f"expected {wanted}"))


def expect_positive(quantity: Quantity, what: str, dimension: Dimension) -> float:
    """Return the value of a positive quantity, or refuse it."""
    value = expect(quantity, what, dimension)
    if value <= 0.0:
        raise Refused(Diagnostic("Q303", f"{what} must be positive", quantity.span))
    return value
