"""Array types, and the one way arrays enter a frozen value: copied, checked for shape, read-only."""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from qsrlang.errors import ValueRangeError

FloatArray: TypeAlias = npt.NDArray[np.float64]
IntArray: TypeAlias = npt.NDArray[np.int64]
BoolArray: TypeAlias = npt.NDArray[np.bool_]


def frozen_array(
    what: str, value: npt.ArrayLike, shape: tuple[int | None, ...], dtype: Any = np.float64
) -> npt.NDArray[Any]:
    """Return a read-only copy of `value`; None in `shape` stands for any length.

    Raises ValueRangeError where the shape differs or a float is not finite.
    """
    array = np.array(value, dtype=dtype)
    fits = array.ndim == len(shape) and all(
        want is None or have == want for have, want in zip(array.shape, shape, strict=True)
    )
    if not fits:
        raise ValueRangeError(f"the shape of {what}", array.shape, f"{shape}")
    if array.dtype.kind == "f" and not np.isfinite(array).all():
        raise ValueRangeError(what, "not finite", "finite numbers")
    array.setflags(write=False)
    return array
