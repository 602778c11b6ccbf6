"""The band around a curve that was fitted, and its words."""

from __future__ import annotations

from typing import TYPE_CHECKING

from thermodata.chart.parts import Band
from thermodata.schema.agreed.certainty import Z95

if TYPE_CHECKING:
    from thermodata.plugin import Float1D

SHADED = "shaded: 95 % by the parameters"
"""What a band is, where there is room to say it."""
_LABEL = "95 %"


def band_95(y: Float1D, sd: Float1D) -> Band:
    """Where a curve lies with 95 % by the uncertainty of the fitted parameters. y, sd: shape (n,), the curve and its
    standard deviation, in one unit."""
    return Band(y - Z95 * sd, y + Z95 * sd, _LABEL)
