"""Which way a probe looks, and what that says of its sign.

Geometry: the probe is fixed on the table and looks along `facing` at the target on the tool side. When the
tool centre point moves along +facing, the target moves away and the gap grows. So a probe whose reading
increases with the gap and that faces +X has a positive gain in X; facing -X, a negative one; a probe whose
reading increases with the approach, the reverse. (A probe carried by the tool that looks at an artefact on the
table: give the direction from the artefact to the probe.)
"""

from __future__ import annotations

from thermodata.errors import CalibrationError


def geometric_sign(facing: str, increases_with: str) -> int:
    """+1 or -1: the sign that the gain of such a probe must have."""
    along = 1 if facing.startswith("+") else -1
    return along if increases_with == "gap" else -along


def facing_axis(name: str, facing: str | None, axis: str | None) -> str | None:
    """The axis, from `axis` or from `facing`; CalibrationError where they contradict each other."""
    if facing is not None and axis is not None and facing[1:] != axis:
        raise CalibrationError(
            f"calibration '{name}' is for axis {axis}, but its probe faces {facing}",
            where=f"calibrations.{name}",
            expected=f"facing +{axis} or -{axis}",
            got=facing,
            hint="a probe measures along the direction in which it looks; correct axis or facing",
        )
    return axis if axis is not None else (facing[1:] if facing is not None else None)
