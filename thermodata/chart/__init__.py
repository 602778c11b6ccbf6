"""Charts: what is drawn as plain values (`spec`), fewer points (`decimate`), and the one script that draws them all.

Both pages of this program use it, the saved report and the local workbench; see docs/charts.md.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from thermodata.chart.assets import SCRIPTS, STYLES, asset, script, style
    from thermodata.chart.colour import effect_styles
    from thermodata.chart.decimate import columns_in, min_max, shortened
    from thermodata.chart.pack import packed, script_json
    from thermodata.chart.spec import Axis, Band, Chart, HeatMap, Limit, Marks, Panel, Row, Series, Span, Strip

__all__ = [
    "SCRIPTS",
    "STYLES",
    "Axis",
    "Band",
    "Chart",
    "HeatMap",
    "Limit",
    "Marks",
    "Panel",
    "Row",
    "Series",
    "Span",
    "Strip",
    "asset",
    "columns_in",
    "effect_styles",
    "min_max",
    "packed",
    "script",
    "script_json",
    "shortened",
    "style",
]
# scripts and styles are asked for where nothing is drawn yet: numpy waits for the first curve
_HOME = {
    "SCRIPTS": "assets",
    "STYLES": "assets",
    "asset": "assets",
    "script": "assets",
    "style": "assets",
    "effect_styles": "colour",
    "columns_in": "decimate",
    "min_max": "decimate",
    "shortened": "decimate",
    "packed": "pack",
    "script_json": "pack",
    "Axis": "spec",
    "Band": "spec",
    "Chart": "spec",
    "HeatMap": "spec",
    "Limit": "spec",
    "Marks": "spec",
    "Panel": "spec",
    "Row": "spec",
    "Series": "spec",
    "Span": "spec",
    "Strip": "spec",
}


def __getattr__(name: str) -> Any:
    if name in _HOME:
        return getattr(import_module(f"{__name__}.{_HOME[name]}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
