"""Names of colours, one for one meaning on every page. What they look like, light and dark, stands in palette.css."""

from __future__ import annotations

from collections.abc import Iterable

MEASURED, MODEL, RESIDUAL, SOURCE, LANE, MUTED = "measured", "model", "residual", "source", "lane", "muted"
EFFECTS = tuple(f"effect-{i}" for i in range(1, 7))
"""Told apart by people who miss one kind of cone as well; more than six lines repeat them with other dashes."""
_DASHES = ("solid", "dashed", "dotted")


def effect_styles(names: Iterable[str]) -> dict[str, tuple[str, str]]:
    """Name -> (colour, dash), in the order of the names: no two of the first eighteen are alike."""
    each = enumerate(dict.fromkeys(names))
    return {name: (EFFECTS[i % 6], _DASHES[i // 6 % 3]) for i, name in each}
