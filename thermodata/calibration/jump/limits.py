"""Which way the limit of a calibration's check goes: most are limits from above, a few hold a value between two."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from thermodata.calibration.jump.plausible import COARSEST_UM_PER_V, FINEST_UM_PER_V

MOVES = "move_uncertainty_um"  # key of a row: what the campaign file says of one move, None where nothing was moved
DWELL = (0.4, 2.5)  # of the declared dwell
_ODD = {
    "answers_most": "value < threshold",
    "dwell_s": f"{DWELL[0]:g} * threshold <= value <= {DWELL[1]:g} * threshold",
    "length_kept": "1 / threshold <= value <= threshold",
    "probe_um_per_v": f"{FINEST_UM_PER_V:g} <= value <= {COARSEST_UM_PER_V:g}, or a noise of a probe's size",
}


def with_limits(checks: Iterable[Mapping[str, Any]] | None) -> list[dict[str, Any]]:
    """Rows of checks with `limit`: when they pass, of value and threshold; None where there is no threshold."""
    return [
        {**row, "limit": None if row["threshold"] is None else _ODD.get(row["name"], "value <= threshold")}
        for row in checks or ()
    ]
