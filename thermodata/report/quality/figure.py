"""The picture of a test: what each channel measured, what of it does not count, and every flag over time."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from thermodata.plugin import Array, Float1D
from thermodata.report import colour
from thermodata.report.figures import Figure, base_layout
from thermodata.report.quality.data import TestQuality, Trace, flag_names
from thermodata.report.words import duration
from thermodata.schema.flag import INVALID, Flag

# the worst of a bin's flags gives its colour: from what is only worth knowing to what must not be believed
SEVERITY = (
    Flag.INTERPOLATED,
    Flag.RATE_CHANGE,
    Flag.GAP,
    Flag.NOT_MEASURING,
    Flag.DUPLICATE_TIME,
    Flag.CLOCK_SUSPECT,
    Flag.SPIKE,
    Flag.SATURATED,
    Flag.OUT_OF_RANGE,
    Flag.HELD,
    Flag.STUCK,
    Flag.OFFSET,
    Flag.FOREIGN,
)
_DEFECT = int(INVALID & ~Flag.NOT_MEASURING)
TINTS = {
    "interpolated": "#cbd5e1",
    "rate_change": "#a3b18a",
    "gap": "#94a3b8",
    "not_measuring": "#e5e7eb",
    "duplicate_time": "#c4b5fd",
    "clock_suspect": "#8b5cf6",
    "spike": "#eab308",
    "saturated": "#f97316",
    "out_of_range": "#a16207",
    "held": "#0ea5e9",
    "stuck": "#db2777",
    "offset": "#dc2626",
    "foreign": "#7f1d1d",
}
_PANEL, _LANE, _GAP, _TOP, _BOTTOM = 120, 17, 26, 26, 44  # [px]
_MOST_PANELS = 6
_ORDER = (
    "displacement",
    "tilt",
    "temperature",
    "temperature_difference",
    "rotational_speed",
    "feed",
    "power",
    "load",
    "current",
    "torque",
    "position",
    "flow",
    "pressure",
    "humidity",
    "voltage",
)


def draw_test(test: TestQuality) -> Figure:
    """Panels by quantity, the channels with something wrong in colour among the others in grey, and a lane for each
    channel that has a flag."""
    panels = _panels(test.traces)
    lanes = [t for t in test.traces if t.flags.any()]
    hours = (test.start_s + (np.arange(_bins(test)) + 0.5) * test.bin_s) / 3600
    lane_height = _LANE * len(lanes) + (12 if lanes else 0)
    inner = _PANEL * len(panels) + _GAP * max(len(panels) - 1, 0) + ((_GAP + lane_height) if lanes else 0)
    layout = base_layout(max(inner, 60) + _TOP + _BOTTOM)
    layout.update(
        margin={"l": 150, "r": 14, "t": _TOP, "b": _BOTTOM},
        showlegend=False,
        annotations=[],
        shapes=[],
        hovermode="closest",
    )
    traces: list[dict[str, Any]] = []
    top = float(inner)
    for i, (quantity, members) in enumerate(panels, 1):
        axis = "" if i == 1 else str(i)
        limits = _limits(members)
        layout[f"yaxis{axis}"] = {
            "domain": [max(0.0, (top - _PANEL) / inner), min(1.0, top / inner)],
            "anchor": "x",
            "range": list(limits),
            "gridcolor": colour.GRID,
            "zeroline": False,
            "nticks": 5,
            "tickfont": {"size": 11, "color": colour.MUTED},
        }
        unit = f" [{members[0].unit}]" if members[0].unit not in ("", "1") else ""
        layout["annotations"].append(_title(f"<b>{quantity.replace('_', ' ')}</b>{unit}", top / inner))
        traces += _drawn(members, hours, f"y{axis}", limits)
        top -= _PANEL + _GAP
    if lanes:
        name = f"yaxis{len(panels) + 1}" if panels else "yaxis"
        layout[name] = {
            "domain": [0, max(0.02, (top) / inner)],
            "anchor": "x",
            "autorange": "reversed",
            "tickfont": {"size": 11},
            "ticks": "",
            "fixedrange": True,
            "showgrid": False,
        }
        layout["annotations"].append(_title("<b>flags</b>", max(0.02, top / inner)))
        traces.append(_heat(lanes, hours, "y" + name.removeprefix("yaxis")))
    for event in test.events:
        if event["flag"] == "gap" and event["channel"] is None and event["to_s"] - event["from_s"] > test.bin_s / 4:
            layout["shapes"].append(
                {
                    "type": "rect",
                    "xref": "x",
                    "x0": event["from_s"] / 3600,
                    "x1": event["to_s"] / 3600,
                    "yref": "paper",
                    "y0": 0,
                    "y1": 1,
                    "fillcolor": colour.faint("#64748b", 0.18),
                    "line": {"width": 0},
                    "layer": "below",
                }
            )
    layout["xaxis"] = {
        "range": [test.start_s / 3600, (test.start_s + _bins(test) * test.bin_s) / 3600],
        "anchor": "free" if not panels and not lanes else f"y{len(panels) + 1 if lanes else len(panels)}",
        "gridcolor": colour.GRID,
        "zeroline": False,
        "tickfont": {"size": 11, "color": colour.MUTED},
        "title": {"text": "time from the start of the test [h]", "font": {"size": 11.5, "color": colour.MUTED}},
    }
    if layout["xaxis"]["anchor"] == "y1":
        layout["xaxis"]["anchor"] = "y"
    return {"data": traces, "layout": layout}


def _bins(test: TestQuality) -> int:
    return len(test.traces[0].good) if test.traces else 1


def _panels(traces: Sequence[Trace]) -> list[tuple[str, list[Trace]]]:
    """Quantities with their channels: those with something wrong first where there are too many."""
    found: dict[str, list[Trace]] = {}
    for trace in traces:
        if trace.quantity not in ("state", "label"):
            found.setdefault(trace.quantity, []).append(trace)
    rank = {q: i for i, q in enumerate(_ORDER)}
    lively = [q for q in found if any(_bad(t) or _varies(t) for t in found[q])]
    bad_first = sorted(lively or found, key=lambda q: (not any(_bad(t) for t in found[q]), rank.get(q, 99)))
    return [(q, found[q]) for q in sorted(bad_first[:_MOST_PANELS], key=lambda q: rank.get(q, 99))]


def _varies(trace: Trace) -> bool:
    good = trace.good[np.isfinite(trace.good)]
    return len(good) > 1 and float(np.ptp(good)) > 1e-9 * float(np.abs(good).max())


def _bad(trace: Trace) -> bool:
    return bool((trace.flags & np.uint16(_DEFECT)).any())


def _limits(members: Sequence[Trace]) -> tuple[float, float]:
    """What the good samples span with a margin, and the flagged ones where they don't dwarf it."""
    good = np.concatenate([t.good for t in members])
    good = good[np.isfinite(good)]
    bad = np.concatenate([x for t in members for x in (t.low, t.high)])
    bad = bad[np.isfinite(bad)]
    both = good if len(good) else bad
    if not len(both):
        return 0.0, 1.0
    low, high = float(both.min()), float(both.max())
    reach = max(high - low, 1e-9 * max(abs(low), abs(high)), 1e-12)
    near = bad[(bad > low - 3 * reach) & (bad < high + 3 * reach)]
    if len(near):
        low, high = min(low, float(near.min())), max(high, float(near.max()))
    reach = max(high - low, reach)
    return low - 0.06 * reach, high + 0.06 * reach


def _drawn(members: Sequence[Trace], hours: Float1D, axis: str, limits: tuple[float, float]) -> list[dict[str, Any]]:
    """Grey lines for sound channels, coloured ones for the others, and marks where samples don't count."""
    made: list[dict[str, Any]] = []
    tints = colour.effect_colours([t.name for t in members if _bad(t)])
    for trace in sorted(members, key=_bad):
        tint = tints.get(trace.name, "#b6c0cc")
        made.append(_line(trace, hours, axis, tint, 1.6 if trace.name in tints else 1.0))
    for trace in members:
        if trace.name in tints:
            made += _marks(trace, hours, axis, limits)
    return made


def _line(trace: Trace, hours: Float1D, axis: str, tint: str, width: float) -> dict[str, Any]:
    unit = "" if trace.unit == "1" else f" {trace.unit}"
    return {
        "type": "scatter",
        "mode": "lines",
        "x": _short(hours, 4),
        "y": _short(trace.good),
        "yaxis": axis,
        "name": trace.name,
        "connectgaps": False,
        "line": {"color": tint, "width": width},
        "hovertemplate": f"{trace.name} %{{y:.5~g}}{unit}<extra></extra>",
    }


def _marks(trace: Trace, hours: Float1D, axis: str, limits: tuple[float, float]) -> list[dict[str, Any]]:
    """A mark at the extremes of a bin's samples that don't count; off the panel, at its edge with the true value."""
    made = []
    edge = 0.03 * (limits[1] - limits[0])
    inside = limits[0] + edge, limits[1] - edge
    worst = worst_flag(trace.flags & np.uint16(_DEFECT))
    for i, values in enumerate((trace.low, trace.high)):
        at = np.isfinite(values) & (worst >= 0)
        if not at.any() or (i and np.array_equal(values[at], trace.low[at])):
            continue
        names = [", ".join(flag_names(int(f) & _DEFECT)) for f in trace.flags[at]]
        made.append(
            {
                "type": "scatter",
                "mode": "markers",
                "x": _short(hours[at], 4),
                "y": _short(np.clip(values[at], *inside)),
                "yaxis": axis,
                "cliponaxis": False,
                "marker": {
                    "size": 4.5,
                    "color": [TINTS[str(SEVERITY[w].name).lower()] for w in worst[at]],
                    "symbol": [
                        "circle" if limits[0] <= v <= limits[1] else "triangle-up" if v > limits[1] else "triangle-down"
                        for v in values[at]
                    ],
                },
                "customdata": [[float(f"{v:.5g}"), n] for v, n in zip(values[at], names, strict=True)],
                "hovertemplate": f"{trace.name} %{{customdata[0]}} {trace.unit}: %{{customdata[1]}}<extra></extra>",
            }
        )
    return made


def worst_flag(flags: Array) -> Array:
    """Index into SEVERITY of the worst flag of each bin, -1 where there is none; shape (bins,)."""
    worst = np.full(flags.shape, -1)
    for i, flag in enumerate(SEVERITY):
        worst[(flags & np.uint16(flag)) != 0] = i
    return worst


def _heat(lanes: Sequence[Trace], hours: Float1D, axis: str) -> dict[str, Any]:
    z = np.stack([worst_flag(t.flags) for t in lanes])
    n = len(SEVERITY)
    scale: list[list[Any]] = []
    for i, flag in enumerate(SEVERITY):
        tint = TINTS[str(flag.name).lower()]
        scale += [[i / n, tint], [(i + 1) / n, tint]]
    text = [[", ".join(flag_names(int(f))) for f in t.flags] for t in lanes]
    return {
        "type": "heatmap",
        "z": [[int(v) if v >= 0 else None for v in row] for row in z],
        "x": _short(hours, 4),
        "y": [t.name for t in lanes],
        "yaxis": axis,
        "zmin": -0.5,
        "zmax": n - 0.5,
        "colorscale": scale,
        "showscale": False,
        "ygap": 3,
        "hoverongaps": False,
        "text": text,
        "hovertemplate": "%{y}, %{x:.2f} h: %{text}<extra></extra>",
    }


def _title(text: str, y: float) -> dict[str, Any]:
    return {
        "text": text,
        "xref": "paper",
        "yref": "paper",
        "x": 0,
        "y": min(1.0, y),
        "xanchor": "left",
        "yanchor": "bottom",
        "showarrow": False,
        "font": {"size": 11.5, "color": colour.INK},
    }


def _short(values: Float1D, digits: int = 6) -> list[float | None]:
    """Numbers for a page: a few digits, and null where there is none."""
    return [float(f"{v:.{digits}g}") if np.isfinite(v) else None for v in values]


def when(from_s: float | None, to_s: float | None) -> str:
    """'2.5 h – 3.0 h', or one time where both are the same to the eye."""
    a, b = duration(from_s), duration(to_s)
    return a if a == b else f"{a} – {b}"
