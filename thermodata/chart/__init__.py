"""Charts: what is drawn as plain values (`spec`, of `parts`), fewer points (`decimate`), and the script that draws it.

Both pages of this program use it, the saved report and the local workbench; see docs/charts.md.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from thermodata.lazy import on_demand

if TYPE_CHECKING:
    from thermodata.chart.assets import SCRIPTS, STYLES, asset, script, style
    from thermodata.chart.colour import effect_styles
    from thermodata.chart.decimate import columns_in, min_max, shortened
    from thermodata.chart.pack import packed, script_json
    from thermodata.chart.parts import Axis, Band, Limit, Marks, Panel, Row, Series, Span, Strip
    from thermodata.chart.spec import Chart, HeatMap

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
__getattr__ = on_demand(
    __name__,
    {
        "assets": "SCRIPTS STYLES asset script style",
        "colour": "effect_styles",
        "decimate": "columns_in min_max shortened",
        "pack": "packed script_json",
        "parts": "Axis Band Limit Marks Panel Row Series Span Strip",
        "spec": "Chart HeatMap",
    },
)
