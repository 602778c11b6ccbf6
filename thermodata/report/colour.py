"""One colour for one meaning, on every figure of a page."""

from __future__ import annotations

from collections.abc import Iterable

INK, MUTED, GRID, PAPER = "#1f2933", "#64748b", "#e8ecf1", "#ffffff"
MEASURED, MODEL, RESIDUAL = "#1f2933", "#2563eb", "#c2410c"
WEAK, LANE, GOOD = "#f59e0b", "#94a3b8", "#15803d"
FONT = "system-ui, -apple-system, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, sans-serif"
# Okabe and Ito's palette (jfly.uni-koeln.de/color), darkened where thin lines would fade on white
_EFFECTS = (
    "#0072b2",
    "#d55e00",
    "#009e73",
    "#cc79a7",
    "#b8860b",
    "#56b4e9",
    "#7f3c8d",
    "#8c564b",
    "#3b7a57",
    "#b0413e",
)


def effect_colours(names: Iterable[str]) -> dict[str, str]:
    """Name -> colour, in the order of the names; the palette repeats after ten."""
    return {name: _EFFECTS[i % len(_EFFECTS)] for i, name in enumerate(dict.fromkeys(names))}


def faint(colour: str, alpha: float) -> str:
    """'#rrggbb' as 'rgba(r,g,b,alpha)'."""
    r, g, b = (int(colour[i : i + 2], 16) for i in (1, 3, 5))
    return f"rgba({r},{g},{b},{alpha:g})"
