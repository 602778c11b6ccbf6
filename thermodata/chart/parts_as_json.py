"""The parts of a chart as the script in a page takes them."""

from __future__ import annotations

from typing import Any

from thermodata.chart.pack import exactly, packed
from thermodata.chart.parts import Axis, Marks, Panel, Row, Series, Span, Strip


def axis_as_json(axis: Axis) -> dict[str, Any]:
    """What runs along x."""
    return {
        "label": axis.label,
        "unit": axis.unit,
        "range": list(axis.range) if axis.range else None,
        "scale": axis.scale,
        "time": axis.time,
    }


def panel_as_json(panel: Panel | Strip, coarse: bool) -> dict[str, Any]:
    """A panel, or a strip as one. coarse: two bytes a value."""
    if isinstance(panel, Strip):
        return {
            "strip": True,
            "title": panel.title,
            "unit": panel.series.unit,
            "height": panel.height,
            "scale": "linear",
            "range": None,
            "zero": False,
            "series": [_series(panel.series, coarse)],
            "marks": [],
            "limits": [],
        }
    # sixteen bits of a span are too few for small values on a logarithmic axis
    fine = coarse and panel.scale == "linear"
    return {
        "strip": False,
        "title": panel.title,
        "unit": panel.unit,
        "height": panel.height,
        "scale": panel.scale,
        "range": list(panel.range) if panel.range else None,
        "zero": panel.zero,
        "series": [_series(s, fine) for s in panel.series],
        "marks": [_marks(m) for m in panel.marks],
        "limits": [{"y": line.y, "label": line.label, "colour": line.colour} for line in panel.limits],
    }


def _series(series: Series, coarse: bool) -> dict[str, Any]:
    band = series.band
    return {
        "name": series.name,
        "unit": series.unit,
        "colour": series.colour,
        "style": series.style,
        "dash": series.dash,
        "width": series.width,
        "label": series.name if series.label is None else series.label,
        "note": series.note,
        "x": None if series.x is None else exactly(series.x),
        "y": packed(series.y, coarse),
        "band": None
        if band is None
        else {"low": packed(band.low, coarse), "high": packed(band.high, coarse), "label": band.label},
    }


def _marks(marks: Marks) -> dict[str, Any]:
    """Reasons and colours repeat: each is written once."""
    colours, reasons = list(dict.fromkeys(marks.colours)), list(dict.fromkeys(marks.reasons))
    return {
        "name": marks.name,
        "unit": marks.unit,
        "x": [_round(v) for v in marks.x],
        "y": [_round(v) for v in marks.y],
        "colours": colours,
        "colour": [colours.index(c) for c in marks.colours],
        "reasons": reasons,
        "reason": [reasons.index(r) for r in marks.reasons],
    }


def row_as_json(row: Row) -> dict[str, Any]:
    """A row's name and its stretches."""
    return {"name": row.name, "runs": [[_round(a), _round(b), colour, why] for a, b, colour, why in row.runs]}


def span_as_json(span: Span) -> dict[str, Any]:
    """A shaded stretch; panels: their numbers, null where it shades all."""
    return {
        "from": span.start,
        "to": span.stop,
        "kind": span.kind,
        "label": span.label,
        "reason": span.reason,
        "rank": span.rank,
        "panels": None if span.panels is None else list(span.panels),
    }


def _round(value: float) -> float:
    return float(f"{value:.6g}")
