"""The page's figures as plain Plotly specifications (data and layout); nothing here draws."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import numpy as np

from thermodata.plugin import Float1D
from thermodata.report import colour
from thermodata.report.data import Curve, TestPart, Version
from thermodata.report.decimate import MOST_POINTS, block_mean, block_size, packed
from thermodata.report.words import duration, number
from thermodata.schema.result import WeakSpot

Figure = dict[str, Any]
_GAP, _TOP, _BOTTOM = 22, 50, 44  # [px]


@dataclass(slots=True)
class _Panels:
    """Panels stacked over one x axis; each has its own y axis, placed by pixels once all heights are known."""

    traces: list[dict[str, Any]] = field(default_factory=list)
    titles: list[tuple[str, int, dict[str, Any]]] = field(default_factory=list)

    def add(self, title: str, height: int, **axis: Any) -> str:
        """A new panel below the others; returns the name of its axis ('y', 'y2', ...)."""
        self.titles.append((title, height, axis))
        return "y" if len(self.titles) == 1 else f"y{len(self.titles)}"

    def layout(self, span: tuple[float, float]) -> Figure:
        """The layout with all axes; x in hours over `span`."""
        inner = sum(h for _, h, _ in self.titles) + _GAP * (len(self.titles) - 1)
        made: Figure = base_layout(inner + _TOP + _BOTTOM)
        made.update(hovermode="x", hoversubplots="axis", annotations=[], shapes=[])
        top = float(inner)
        for i, (title, height, axis) in enumerate(self.titles, 1):
            low, high = max(0.0, (top - height) / inner), min(1.0, top / inner)
            made["yaxis" if i == 1 else f"yaxis{i}"] = {
                "domain": [low, high],
                "anchor": "x",
                "gridcolor": colour.GRID,
                "zeroline": False,
                "nticks": max(3, height // 26),
                "tickfont": {"size": 11, "color": colour.MUTED},
                **axis,
            }
            made["annotations"].append(
                {
                    "text": title,
                    "xref": "paper",
                    "yref": "paper",
                    "x": 0,
                    "y": high,
                    "xanchor": "left",
                    "yanchor": "bottom",
                    "showarrow": False,
                    "font": {
                        "size": 11.5 if height > 60 else 10.5,
                        "color": colour.INK if height > 60 else colour.MUTED,
                    },
                }
            )
            top -= height + _GAP
        made["xaxis"] = {
            "range": list(span),
            "anchor": f"y{len(self.titles)}" if len(self.titles) > 1 else "y",
            "gridcolor": colour.GRID,
            "zeroline": False,
            "showline": True,
            "linecolor": "#cbd5e1",
            "title": {"text": "time from the start of the test [h]", "font": {"size": 11.5, "color": colour.MUTED}},
            "tickfont": {"size": 11, "color": colour.MUTED},
            "showspikes": True,
            "spikemode": "across",
            "spikethickness": 1,
            "spikedash": "dot",
            "spikecolor": colour.MUTED,
        }
        return made


def base_layout(height: int) -> Figure:
    """What all figures share."""
    return {
        "height": height,
        "margin": {"l": 56, "r": 14, "t": _TOP, "b": _BOTTOM, "pad": 0},
        "autosize": True,
        "paper_bgcolor": colour.PAPER,
        "plot_bgcolor": colour.PAPER,
        "font": {"family": colour.FONT, "color": colour.INK},
        "hoverlabel": {"font": {"family": colour.FONT, "size": 12}},
        "dragmode": "zoom",
        "legend": {
            "orientation": "h",
            "x": 1,
            "xanchor": "right",
            "y": 1,
            "yanchor": "bottom",
            "font": {"size": 11},
            "bgcolor": "rgba(0,0,0,0)",
        },
    }


def test_figure(
    part: TestPart, weak: Sequence[WeakSpot], colours: Mapping[str, str], noise_um: float | None, unit: str
) -> Figure:
    """Measured and model, residual with weak spots, contributions, drivers, and the operating state below."""
    size = block_size(len(part.measured))
    step_h = part.step_s * size / 3600
    x0 = (part.start_s + part.step_s * (size - 1) / 2) / 3600
    span = (part.start_s / 3600, (part.start_s + part.step_s * len(part.measured)) / 3600)
    panels = _Panels()

    def line(values: Float1D, axis: str, name: str, tint: str, unit_: str, mode: str = "lines", **more: Any) -> None:
        panels.traces.append(
            {
                "type": "scatter",
                "mode": mode,
                "x0": x0,
                "dx": step_h,
                "y": packed(block_mean(values, size)),
                "yaxis": axis,
                "name": name,
                "connectgaps": False,
                "hovertemplate": f"{name} %{{y:.4~g}} {unit_}<extra></extra>",
                **{"line": {"color": tint, "width": 1.6}, **more},
            }
        )

    top = panels.add(f"<b>{part.response}</b> [{unit}]", 230)
    # a machine that is measured now and then gives points; a line would hide where it was not measured
    sparse = bool(np.mean(np.isfinite(part.residual)) < 0.9)
    dots: dict[str, Any] = {"mode": "markers"} if sparse else {}
    line(
        part.measured,
        top,
        "measured",
        colour.MEASURED,
        unit,
        line={"color": colour.MEASURED, "width": 1.5},
        marker={"color": colour.MEASURED, "size": 3},
        **dots,
    )
    line(part.predicted, top, "model", colour.MODEL, unit, line={"color": colour.MODEL, "width": 2.2})
    below = panels.add(f"<b>residual</b>, measured - model [{unit}]", 130, zeroline=True, zerolinecolor="#cbd5e1")
    line(
        part.residual,
        below,
        "residual",
        colour.RESIDUAL,
        unit,
        showlegend=False,
        line={"color": colour.RESIDUAL, "width": 1.3},
        marker={"color": colour.RESIDUAL, "size": 3},
        **dots,
    )
    if part.contributions:
        axis = panels.add(f"<b>contributions</b> of the effects [{unit}]", 170)
        for curve in part.contributions:
            line(
                curve.values,
                axis,
                curve.name,
                colours.get(curve.name, colour.MUTED),
                unit,
                legend="legend2",
                line={"color": colours.get(curve.name, colour.MUTED), "width": 1.8},
            )
    if part.drivers:
        axis = panels.add(f"<b>drivers</b> [{part.drivers[0].unit}]", 120)
        for i, curve in enumerate(part.drivers):
            tint = _DRIVER_TINTS[i % len(_DRIVER_TINTS)]
            line(curve.values, axis, curve.name, tint, curve.unit, legend="legend3", line={"color": tint, "width": 1.3})
    for lane in part.lanes:
        _lane(panels, lane, line)
    layout = panels.layout(span)
    _place_legends(layout, panels)
    for w in weak:
        begin, end = w.from_s / 3600, w.to_s / 3600
        layout["shapes"] += [_shade(begin, end, "y domain"), _shade(begin, end, "y2 domain")]
        layout["annotations"].append(
            _note(
                f"{number(w.rmse_um, 2)} {unit}",
                (begin + end) / 2,
                1,
                "y2 domain",
                "#92400e",
                hovertext=f"{w.state}, {duration(w.to_s - w.from_s)}",
            )
        )
    if noise_um:
        layout["shapes"] += [
            {
                "type": "line",
                "xref": "paper",
                "x0": 0,
                "x1": 1,
                "yref": "y2",
                "y0": y,
                "y1": y,
                "line": {"color": colour.MUTED, "width": 1, "dash": "dot"},
            }
            for y in (noise_um, -noise_um)
        ]
    for name, (from_s, to_s) in part.phases.items():
        begin, end = from_s / 3600, to_s / 3600
        layout["shapes"].append(
            {
                "type": "line",
                "xref": "x",
                "x0": begin,
                "x1": begin,
                "yref": "y domain",
                "y0": 0,
                "y1": 1,
                "line": {"color": "#cbd5e1", "width": 1, "dash": "dash"},
            }
        )
        layout["annotations"].append(_note(name, (begin + end) / 2, 0, "y domain", colour.MUTED))
    return {"data": panels.traces, "layout": layout}


_DRIVER_TINTS = ("#be123c", "#0e7490", "#65a30d", "#7c3aed", "#a16207", "#475569", "#db2777", "#0369a1")


def _lane(panels: _Panels, lane: Curve, line: Any) -> None:
    """One operating state as a low filled strip, scaled to its own largest value."""
    finite = lane.values[np.isfinite(lane.values)]
    top = float(np.max(np.abs(finite))) if len(finite) else 1.0
    low = min(0.0, float(np.min(finite))) if len(finite) else 0.0
    unit = "" if lane.unit in ("1", "") else f" {lane.unit}"
    axis = panels.add(
        f"{lane.name} (max {number(top)}{unit})" if unit else lane.name,
        24,
        showticklabels=False,
        showgrid=False,
        fixedrange=True,
        range=[low * 1.1, max(top, 1e-12) * 1.1],
    )
    line(
        lane.values,
        axis,
        lane.name,
        colour.LANE,
        lane.unit if unit else "",
        showlegend=False,
        fill="tozeroy",
        fillcolor=colour.faint(colour.LANE, 0.45),
        line={"color": colour.LANE, "width": 1, "shape": "hv"},
    )


def _place_legends(layout: Figure, panels: _Panels) -> None:
    """Legends of contributions and drivers stand on their panel's title line."""
    for key in ("legend2", "legend3"):
        axis = next((t["yaxis"] for t in panels.traces if t.get("legend") == key), None)
        if axis is not None:
            domain = layout["yaxis" + axis[1:]]["domain"]
            layout[key] = {**layout["legend"], "y": domain[1]}


def _shade(x0: float, x1: float, yref: str) -> dict[str, Any]:
    return {
        "type": "rect",
        "xref": "x",
        "x0": x0,
        "x1": x1,
        "yref": yref,
        "y0": 0,
        "y1": 1,
        "fillcolor": colour.faint(colour.WEAK, 0.16),
        "line": {"width": 0},
        "layer": "below",
    }


def _note(text: str, x: float, y: int, yref: str, tint: str, **more: Any) -> dict[str, Any]:
    """A small text inside a panel, at its top (y 1) or bottom (y 0)."""
    return {
        "text": text,
        "x": x,
        "xref": "x",
        "y": y,
        "yref": yref,
        "yanchor": "top" if y else "bottom",
        "showarrow": False,
        "font": {"size": 10.5, "color": tint},
        **more,
    }


def overview_figure(parts: Sequence[TestPart], unit: str) -> Figure:
    """The residual of every test as one coloured strip each, over hours: where the model fails, at a glance."""
    size = block_size(max(len(p.residual) for p in parts), 400)
    strips = [block_mean(p.residual, size) for p in parts]
    columns, dx_h = max(len(s) for s in strips), parts[0].step_s * size / 3600  # a model has one step
    z = np.array([np.pad(s, (0, columns - len(s)), constant_values=np.nan) for s in strips])
    seen = np.abs(z[np.isfinite(z)])
    limit = float(np.quantile(seen, 0.99)) if len(seen) else 1.0
    names = [p.test if len({q.campaign for q in parts}) == 1 else f"{p.campaign}/{p.test}" for p in parts]
    several = len({p.response for p in parts}) > 1
    names = [f"{n} {p.response}" if several else n for n, p in zip(names, parts, strict=True)]
    layout = base_layout(26 * len(parts) + 74)
    layout.update(
        margin={"l": 10, "r": 10, "t": 8, "b": 44},
        yaxis={"autorange": "reversed", "automargin": True, "tickfont": {"size": 12}, "fixedrange": True, "ticks": ""},
        xaxis={
            "title": {"text": "time from the start of the test [h]", "font": {"size": 11.5, "color": colour.MUTED}},
            "tickfont": {"size": 11, "color": colour.MUTED},
            "showgrid": False,
            "zeroline": False,
        },
    )
    scale = [[0, "#2166ac"], [0.25, "#92c5de"], [0.5, "#f7f7f7"], [0.75, "#f4a582"], [1, "#b2182b"]]
    return {
        "data": [
            {
                "type": "heatmap",
                "z": packed(z),
                "y": names,
                "x0": dx_h / 2,
                "dx": dx_h,
                "zmid": 0,
                "zmin": -limit,
                "zmax": limit,
                "ygap": 5,
                "colorscale": scale,
                "hoverongaps": False,
                "hovertemplate": f"%{{y}}, %{{x:.1f}} h: %{{z:.2f}} {unit}<extra></extra>",
                "colorbar": {
                    "title": {"text": unit, "font": {"size": 11}},
                    "thickness": 10,
                    "outlinewidth": 0,
                    "tickfont": {"size": 10.5},
                },
            }
        ],
        "layout": layout,
    }


def waterfall_figure(versions: Sequence[Version], noise_um: float | None, unit: str) -> Figure:
    """The error of the first version, what each added effect took from it, and what is left."""
    kept = [v for v in versions if v.all_um is not None]
    errors = [v.all_um for v in kept if v.all_um is not None]
    steps = [b - a for a, b in pairwise(errors)]
    names = [kept[0].name, *(f"+ {v.added or v.name}" for v in kept[1:]), "now"]
    layout = base_layout(250)
    layout.update(
        showlegend=False,
        margin={"l": 50, "r": 14, "t": 18, "b": 40},
        yaxis={
            "title": {"text": f"RMSE [{unit}]", "font": {"size": 11.5, "color": colour.MUTED}},
            "gridcolor": colour.GRID,
            "rangemode": "tozero",
            "tickfont": {"size": 11},
        },
        xaxis={"type": "category", "tickfont": {"size": 12}},
        shapes=[],
        annotations=[],
    )
    if noise_um:
        layout["shapes"].append(
            {
                "type": "line",
                "xref": "paper",
                "x0": 0,
                "x1": 1,
                "y0": noise_um,
                "y1": noise_um,
                "line": {"color": colour.MUTED, "width": 1, "dash": "dot"},
            }
        )
        layout["annotations"].append(
            {
                "text": "noise",
                "xref": "paper",
                "x": 1,
                "y": noise_um,
                "yanchor": "bottom",
                "xanchor": "right",
                "showarrow": False,
                "font": {"size": 10.5, "color": colour.MUTED},
            }
        )
    texts = [number(errors[0]), *(f"{'+' if s > 0 else '−'}{number(abs(s))}" for s in steps), number(errors[-1])]
    return {
        "data": [
            {
                "type": "waterfall",
                "x": names,
                "y": [errors[0], *steps, errors[-1]],
                "text": texts,
                "textposition": "auto",
                "insidetextfont": {"color": "#ffffff"},
                "textangle": 0,
                "width": [0.36] * len(texts),
                "measure": ["absolute", *("relative" for _ in steps), "total"],
                "cliponaxis": False,
                "connector": {"line": {"color": "#cbd5e1", "width": 1}},
                "hovertemplate": "%{x}: %{text}<extra></extra>",
                "decreasing": {"marker": {"color": colour.GOOD}},
                "increasing": {"marker": {"color": colour.RESIDUAL}},
                "totals": {"marker": {"color": colour.MODEL}},
            }
        ],
        "layout": layout,
    }


__all__ = ["MOST_POINTS", "Figure", "base_layout", "overview_figure", "test_figure", "waterfall_figure"]
