"""Names of colours, one for one meaning on every page. What they look like, light and dark, stands in palette.css."""

from __future__ import annotations

import re
from collections.abc import Iterable
from functools import cache

from thermodata.chart.assets import asset

EFFECTS = tuple(f"effect-{i}" for i in range(1, 7))
"""Told apart by people who miss one kind of cone as well; more than six lines repeat them with other dashes."""
MEASURED, MODEL, RESIDUAL, LANE = "measured", "model", "residual", "lane"
FONT = "system-ui, -apple-system, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, sans-serif"
_DASHES = ("solid", "dashed", "dotted")


def effect_styles(names: Iterable[str]) -> dict[str, tuple[str, str]]:
    """Name -> (colour, dash), in the order of the names: no two of the first eighteen are alike."""
    each = enumerate(dict.fromkeys(names))
    return {name: (EFFECTS[i % 6], _DASHES[i // 6 % 3]) for i, name in each}


@cache
def light() -> dict[str, str]:
    """Name -> '#rrggbb' of the light look, for a picture that stands in no page."""
    block = asset("palette.css").partition("{")[2].partition("}")[0]
    return dict(re.findall(r"--c-([\w-]+):\s*(#[0-9a-f]{6})", block))
