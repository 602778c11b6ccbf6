"""The scale that a file declares for its values, which every ingest applies: said, so that nobody applies it twice."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable

import numpy as np

from thermodata.calibration.scaling import apply_scaling
from thermodata.errors import ThermodataError
from thermodata.plugin import Signal

_NONE = "none"


def scale_note(signals: Iterable[Signal]) -> str | None:
    """What to say of a channel whose files scale it; signals: of each file its own. None where they leave it as it is,
    and of counts of a converter, which nobody takes for values."""
    found = Counter(_scale(s) for s in signals)
    if set(found) == {_NONE}:
        return None
    if len(found) == 1:
        return f"the file's own scale ({next(iter(found))}) is applied"
    return f"each file's own scale is applied: {', '.join(f'{s} ({n})' for s, n in found.most_common())}"


def _scale(signal: Signal) -> str:
    """'x10', 'x10 +0.5', or how it is called where it is no straight line."""
    if signal.scaling is None or not signal.dtype.startswith("float"):
        return _NONE
    try:
        low, middle, high = apply_scaling(signal.scaling, np.array([0.0, 1.0, 2.0])).tolist()
    except ThermodataError:
        return "another"
    gain = middle - low
    if not np.isclose(high - middle, gain):
        kinds = [str(v).lower() for k, v in signal.scaling.properties.items() if k.endswith("_Scale_Type")]
        return ", ".join(kinds) or "a curve"
    if (gain, low) == (1.0, 0.0):
        return _NONE
    return f"x{gain:g}" + (f" {low:+g}" if low else "")
