"""The chart of the workbench's benchmark in Panel, in an environment of its own; workbench.py starts it.

    python tests/benchmarks/workbench_panel.py JSON

JSON: {"file", "port", "channels": [...], "invalid": bits of the flags of samples that do not count, "binned"}. binned:
the lowest and the highest of each of 1,200 bins, as thermodata/view/curves/window.py gives them, anew after each zoom;
else every sample is sent.
"""

from __future__ import annotations

import json
import sys
from typing import Any

import duckdb
import panel as pn
from bokeh.models import ColumnDataSource, Range1d
from bokeh.palettes import Category20
from bokeh.plotting import figure

BINS = 1200
GIVEN = json.loads(sys.argv[1])
NAMES: list[str] = GIVEN["channels"]
TABLE = f"read_parquet('{GIVEN['file']}')"
COUNTED = {n: f'case when "{n}__flag" & {GIVEN["invalid"]} = 0 then "{n}" end' for n in NAMES}


def samples(low: float, high: float) -> dict[str, Any]:
    """Column -> shape (n,), every sample; t_h: hours."""
    columns = ", ".join(f'{value} as "{name}"' for name, value in COUNTED.items())
    return (
        duckdb.connect()
        .execute(
            f"select t_s / 3600 as t_h, {columns} from {TABLE} where t_s between {low!r} and {high!r} order by t_s"
        )
        .fetchnumpy()
    )


def extremes(low: float, high: float) -> dict[str, Any]:
    """As `samples`, two for each bin."""
    width = f"{(high - low) / BINS!r}::double"  # as they stand, numbers are decimals of 18 digits
    both = ", ".join(f'min({value}) as "{name}_0", max({value}) as "{name}_1"' for name, value in COUNTED.items())
    one = ", ".join(f'case each.k when 0 then "{name}_0" else "{name}_1" end as "{name}"' for name in NAMES)
    return (
        duckdb.connect()
        .execute(
            f"select ({low!r} + (bin + 0.25 + 0.5 * each.k) * {width}) / 3600 as t_h, {one} from "
            f"(select least(cast(floor((t_s - {low!r}) / {width}) as integer), {BINS - 1}) as bin, {both} "
            f"from {TABLE} where t_s between {low!r} and {high!r} group by 1), (values (0), (1)) as each(k) order by 1"
        )
        .fetchnumpy()
    )


def chart() -> pn.pane.Bokeh:
    """A session's own."""
    row = duckdb.connect().execute(f"select min(t_s), max(t_s) from {TABLE}").fetchone()
    assert row is not None
    first, last = row
    read = extremes if GIVEN["binned"] else samples
    source = ColumnDataSource(read(first, last))
    span = Range1d(first / 3600, last / 3600)
    plot = figure(width=1200, height=480, x_range=span, tools="xwheel_zoom,xbox_zoom,reset", output_backend="canvas")
    for name, colour in zip(NAMES, Category20[20], strict=False):
        plot.line("t_h", name, source=source, color=colour)

    def refine(_attribute: str, _old: float, _new: float) -> None:
        source.data = extremes(max(first, span.start * 3600), min(last, span.end * 3600))

    if GIVEN["binned"]:
        span.on_change("end", refine)  # the beginning came before it
    return pn.pane.Bokeh(plot)


pn.serve({"chart": chart}, port=GIVEN["port"], address="127.0.0.1", show=False)
