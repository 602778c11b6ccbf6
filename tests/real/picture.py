"""A picture of one response as an SVG: measured, two versions of a model, what each leaves, and what ran meanwhile."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pyarrow import parquet

from thermodata.chart.colour import FONT, light

Array = NDArray[np.float64]
INK, MUTED, GRID, PAPER, MEASURED, WAS, IS = (
    light()[name] for name in ("ink", "muted", "grid", "paper", "measured", "residual", "model")
)
WIDTH, LEFT, RIGHT = 760, 54, 12  # [px]
EVERY = 5  # [steps of the model] a point
ZERO = 10  # [steps] whose mean sets the level of a locked test
BEGINS_H = {"first": 0.0, "second": 16.1, "last30": 32.4}  # of fl_thermal/campaign.yaml
END_H = 46.4


@dataclass(frozen=True)
class Curve:
    """x [h] and y, shape (n,); NaN breaks the line."""

    x: Array
    y: Array
    colour: str
    wide: float = 1.2


@dataclass(frozen=True)
class Panel:
    """low, high: ends of its axis; told: names with their colours, above it."""

    height: int
    curves: Sequence[Curve]
    low: float
    high: float
    ticks: Sequence[float]
    told: Sequence[tuple[str, str]]


def of(bench: Any, response: str, before: str, after: str, beside: str, title: str) -> str:
    """bench: a story.Bench whose model `after` is `before` with one effect more, which reads the channel `beside`."""
    measured = _minutes(bench, response)
    x, y = _joined(measured)
    lines, left, told = [Curve(x, y, MEASURED, 1.6)], [], []
    for model, colour, name in ((before, WAS, "speed alone"), (after, IS, f"with {beside}")):
        wholes = {t: measured[t] - p for t, p in _predicted(bench, model).items()}
        rests = {t: r - (r[:ZERO].mean() if t == "last30" else np.nanmean(r)) for t, r in wholes.items()}
        _, rest = _joined(rests)
        lines.append(Curve(x, y - rest, colour))
        left.append(Curve(x, rest, colour))
        told.append((name, colour))
    _, speed = _joined(_minutes(bench, "spindle_speed"))
    _, warm = _joined(_minutes(bench, beside))
    panels = [
        Panel(170, lines, *_room(lines), told=[(f"{response} [um]: measured", MEASURED), *told]),
        Panel(90, left, *_room(left), told=[("left [um]: by speed alone", WAS), told[1]]),
        Panel(46, [Curve(x, speed / 1000, MUTED)], 0, 5.5, [0, 5], told=[("spindle speed [1000 rpm]", MUTED)]),
        Panel(60, [Curve(x, warm, INK)], *_room([Curve(x, warm, INK)]), told=[(f"{beside} [degC]", INK)]),
    ]
    return _drawn(panels, title, BEGINS_H["last30"], END_H)


def _minutes(bench: Any, channel: str) -> dict[str, Array]:
    """Means of a minute by test, flagged samples left out."""
    rows = bench.ask(
        "sql",
        "select test, cast(floor(t_s / 60) as int) as k, avg(value) as v from sample "
        f"where channel = '{channel}' and valid(flag) and t_s >= 0 group by 1, 2 order by 1, 2",
    )
    found = {}
    for test in sorted({r["test"] for r in rows}):
        ks, vs = zip(*((r["k"], r["v"]) for r in rows if r["test"] == test), strict=True)
        found[test] = np.full(max(ks) + 1, np.nan)
        found[test][list(ks)] = vs
    return found


def _predicted(bench: Any, model: str) -> dict[str, Array]:
    file = bench.folder / f"{model}.parquet"
    bench.ask("predict", model, "fl_thermal", "--out", file)
    table = parquet.read_table(file).to_pydict()
    tests = np.array(table["test"])
    return {str(t): np.array(table["predicted"])[tests == t] for t in np.unique(tests)}


def _joined(tests: dict[str, Array]) -> tuple[Array, Array]:
    """All tests on the hours of the recording, means of EVERY steps, a gap after each."""
    xs: list[Array] = []
    ys: list[Array] = []
    for test, begin in BEGINS_H.items():
        n = len(tests[test]) // EVERY
        means = np.nanmean(tests[test][: n * EVERY].reshape(n, EVERY), axis=1)
        xs += [begin + (np.arange(n) + 0.5) * EVERY / 60, np.array([np.nan])]
        ys += [means, np.array([np.nan])]
    return np.concatenate(xs), np.concatenate(ys)


def _room(curves: Sequence[Curve]) -> tuple[float, float, list[float]]:
    """low, high and ticks that hold all curves."""
    low, high = (float(f(np.concatenate([c.y for c in curves]))) for f in (np.nanmin, np.nanmax))
    step = next(s for s in (1, 2, 5, 10, 20, 50, 100) if (high - low) / s <= 5)
    low, high = step * np.floor(low / step), step * np.ceil(high / step)
    return low, high, list(np.arange(low, high + step / 2, step))


def _drawn(panels: Sequence[Panel], title: str, locked: float, end: float) -> str:
    height = 30 + sum(p.height + 24 for p in panels) + 34
    per_hour = (WIDTH - LEFT - RIGHT) / end
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" width="{WIDTH}" height="{height}" '
        f'font-family="{escape(FONT, quote=True)}" font-size="11">',
        f'<rect width="{WIDTH}" height="{height}" fill="{PAPER}"/>',
        _text(LEFT, 18, title, INK, size=13),
    ]
    top = 30
    for panel in panels:
        parts += _panel(panel, top + 18, per_hour, locked, end)
        top += panel.height + 24
    for h in range(0, 47, 4):
        parts.append(_text(LEFT + h * per_hour, top + 12, str(h), MUTED, "middle"))
    parts.append(_text(LEFT + end / 2 * per_hour, top + 27, "hours of the recording; shaded: locked", MUTED, "middle"))
    return "\n".join([*parts, "</svg>", ""])


def _panel(panel: Panel, top: float, per_hour: float, locked: float, end: float) -> list[str]:
    def x(h: float) -> float:
        return LEFT + h * per_hour

    def y(value: float) -> float:
        return top + panel.height * (panel.high - value) / (panel.high - panel.low)

    parts = [
        f'<rect x="{x(locked):.1f}" y="{top}" width="{(end - locked) * per_hour:.1f}" height="{panel.height}" '
        f'fill="{GRID}" fill-opacity="0.45"/>'
    ]
    for tick in panel.ticks:
        parts += [
            f'<path d="M{LEFT} {y(tick):.1f}H{WIDTH - RIGHT}" stroke="{GRID}"/>',
            _text(LEFT - 6, y(tick) + 4, f"{tick:g}", MUTED, "end"),
        ]
    at = float(LEFT)
    for name, colour in panel.told:
        parts.append(_text(at, top - 5, name, colour))
        at += 7 * len(name) + 12
    for curve in panel.curves:
        d, pen = [], "M"
        for h, value in zip(curve.x, curve.y, strict=True):
            if np.isnan(value):
                pen = "M"
                continue
            d.append(f"{pen}{x(h):.1f} {y(value):.1f}")
            pen = "L"
        parts.append(f'<path d="{"".join(d)}" fill="none" stroke="{curve.colour}" stroke-width="{curve.wide:g}"/>')
    return parts


def _text(x: float, y: float, text: str, colour: str, anchor: str = "start", size: float = 11) -> str:
    return (
        f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" fill="{colour}" font-size="{size:g}">'
        f"{escape(text)}</text>"
    )


def write(folder: Path, bench: Any, response: str, before: str, after: str, beside: str) -> Path:
    path = folder / f"real_{response}.svg"
    path.write_text(
        of(bench, response, before, after, beside, f"{response} of the spindle, by speed alone and with {beside}"),
        "utf-8",
    )
    return path
