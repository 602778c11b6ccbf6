"""Whether printed coefficients say what a function does: their sums against what the printed digits leave open.

A slow function at a fast sample time is a small difference of large numbers. Its gain at rest is sum(a) / sum(b),
and where rounding moves a sum by more than a fifth of itself, nobody knows the function that was meant.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from thermodata.errors import SpecError
from thermodata.schema.strict.printed import rounding

CLEAR = 5.0  # a sum is known where it exceeds its rounding so many times
SLOWEST_H = 100.0  # no record shows a slower function, and a pole so near 1 is rounding
_TRY = "print more digits (zeros at the end count: 0.98650), or identify the function from data"


def refuse_lost_digits(num: Sequence[float], den: Sequence[float], sample_s: float, where: str | None) -> None:
    """SpecError where the gain at rest of a discrete function is lost in rounding, or it is slower than any record."""
    for letter, numbers, what in (("a", num, "numerator"), ("b", den, "denominator")):
        total, lost = abs(float(np.sum(numbers))), sum(rounding(v) for v in numbers)
        if len(numbers) > 1 and total <= CLEAR * lost * (1 + 1e-9):
            raise SpecError(
                "the printed digits leave the function's gain at rest open",
                where=where,
                expected=f"a sum of the {what} over {CLEAR * lost:.3g}, {CLEAR:g} times the rounding of its digits",
                got=f"{' + '.join(f'{letter}{i}' for i in range(len(numbers)))} = {total:.3g}",
                hint=_TRY,
            )
    size = float(np.max(np.abs(np.roots(den)), initial=0.0))
    slowest = -sample_s / np.log(size) / 3600.0 if 0.0 < size < 1.0 else 0.0
    if slowest > SLOWEST_H:
        raise SpecError(
            "the printed digits make the function slower than any record",
            where=where,
            expected=f"a time constant under {SLOWEST_H:g} h",
            got=f"{slowest:.3g} h",
            hint=_TRY,
        )
