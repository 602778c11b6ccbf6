"""Names of colours, one for one meaning on every page. What they look like, light and dark, stands in palette.css."""

from __future__ import annotations

import re
from collections.abc import Iterable
from functools import cache

from thermodata.chart.assets import asset

EFFECTS = tuple(f"effect-{i}" for i in range(1, 13))
"""Twelve colours: people who miss one kind of cone tell six of them apart, and the other six."""
SOLID = 6
"""So many lines have one dash: two that somebody might take for each other differ in it."""
MEASURED, MODEL, RESIDUAL = "measured", "model", "residual"
FONT = "system-ui, -apple-system, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, sans-serif"
DASHES: dict[str, tuple[int, ...]] = {
    "solid": (),
    "dashed": (7, 4),
    "dotted": (2, 3),
    "dash-dot": (8, 3, 2, 3),
    "long": (15, 4),
    "dash-dot-dot": (8, 3, 2, 3, 2, 3),
    "sparse": (3, 7),
    "long-dot": (15, 3, 2, 3),
}
"""Name -> drawn and left out by turns [px], as in paint.js; beside the name of a line they stand in chart.css."""


def effect_styles(names: Iterable[str]) -> dict[str, tuple[str, str]]:
    """Name -> (colour, dash), in the order of the names: no two of the first 48 are alike."""
    each, dashes = enumerate(dict.fromkeys(names)), list(DASHES)
    return {name: (EFFECTS[i % len(EFFECTS)], dashes[i // SOLID % len(dashes)]) for i, name in each}


@cache
def light() -> dict[str, str]:
    """Name -> '#rrggbb' of the light look, for a picture that stands in no page."""
    block = asset("palette.css").partition("{")[2].partition("}")[0]
    return dict(re.findall(r"--c-([\w-]+):\s*(#[0-9a-f]{6})", block))
