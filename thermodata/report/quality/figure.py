"""The picture of a test: what each channel measured, what of it does not count, and every flag over time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from thermodata.chart import Axis, Chart, Marks, Panel, Row, Series, Span, Strip, effect_styles
from thermodata.plugin import Array, Float1D
from thermodata.report.charts.figures import TIME
from thermodata.report.quality.data import TestQuality, Trace, flag_names
from thermodata.report.words.numbers import duration
from thermodata.schema.flag import INVALID, Flag
from thermodata.schema.units.quantity import PROBED, STATES

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
_PANEL, _A_LABEL = 120, 13  # [px]
_MOST_PANELS = 6
_GAP_STEPS = 3.5  # of a channel's own, as at ingest
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


def draw_test(test: TestQuality) -> Chart:
    """Panels by quantity, every curve with its name at its end, those with something wrong in colour among the others
    in grey; and a lane for each channel that has a flag. Displacements are drawn from their first valid value: where a
    probe stands is nothing but its mounting, and beside hundreds of micrometres a drift of some is a flat line."""
    hours = (test.start_s + (np.arange(_bins(test)) + 0.5) * test.bin_s) / 3600
    whole = (test.start_s / 3600, (test.start_s + _bins(test) * test.bin_s) / 3600)
    panels: list[Panel | Strip] = [_panel(quantity, members, hours) for quantity, members in _panels(test.traces)]
    return Chart(
        f"Test {test.test}: what each channel measured, and what of it does not count",
        Axis(TIME, "h", range=whole),
        hours,
        panels,
        spans=[
            Span(e["from_s"] / 3600, e["to_s"] / 3600, "gap", "no samples")
            for e in test.events
            if e["flag"] == "gap" and e["channel"] is None and e["to_s"] - e["from_s"] > test.bin_s / 4
        ],
        rows=[_row(t, test) for t in test.traces if t.flags.any()],
        rows_title="flags",
    )


def _bins(test: TestQuality) -> int:
    return len(test.traces[0].good) if test.traces else 1


def _panels(traces: Sequence[Trace]) -> list[tuple[str, list[Trace]]]:
    """Quantities with their channels: those with something wrong first where there are too many."""
    found: dict[str, list[Trace]] = {}
    for trace in traces:
        if trace.quantity not in STATES:
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


def _panel(quantity: str, members: Sequence[Trace], hours: Float1D) -> Panel:
    """Sound channels first, so that the others lie above them; in colour too where none is bad."""
    styles = effect_styles(t.name for t in members if _bad(t) or not any(map(_bad, members)))
    name = quantity.replace("_", " ")
    if quantity in PROBED:
        members, name = [_from_first(t) for t in members], f"{name}, from the first valid value"
    ordered = sorted(members, key=_bad)
    curves = [_curve(t, hours, *styles.get(t.name, ("quiet", "solid")), t.name in styles) for t in ordered]
    return Panel(
        name,
        members[0].unit,
        curves,
        height=max(_PANEL, _A_LABEL * len(curves) + 16),
        range=_limits(members),
        marks=[_marks(t, hours) for t in members if _bad(t)],
    )


def _curve(trace: Trace, hours: Float1D, colour: str, dash: str, coloured: bool) -> Series:
    """A channel of fewer samples than bins is a line through its samples: a bin between two of them is no gap."""
    x, y, width = None, trace.good, 1.6 if coloured else 1.2
    at = np.flatnonzero(np.isfinite(trace.good) | (trace.flags != 0))
    if len(at) > 1 and trace.samples < len(trace.good):
        steps = np.diff(at)
        ends = np.flatnonzero(steps > _GAP_STEPS * np.median(steps)) + 1
        x, y = np.insert(hours[at], ends, hours[at[ends]]), np.insert(trace.good[at], ends, np.nan)
    return Series(trace.name, trace.unit, y, colour, x=x, dash=dash, width=width)


def _from_first(trace: Trace) -> Trace:
    """The same, from its first valid value; as it is where there is none."""
    valid = trace.good[np.isfinite(trace.good)]
    if not len(valid):
        return trace
    return replace(trace, good=trace.good - valid[0], low=trace.low - valid[0], high=trace.high - valid[0])


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


def _marks(trace: Trace, hours: Float1D) -> Marks:
    """A mark at the extremes of a bin's samples that don't count."""
    worst = worst_flag(trace.flags & np.uint16(_DEFECT))
    x: list[float] = []
    y: list[float] = []
    colours: list[str] = []
    reasons: list[str] = []
    for i in np.flatnonzero(worst >= 0):
        for value in dict.fromkeys((float(trace.low[i]), float(trace.high[i]))):
            if np.isfinite(value):
                x.append(float(hours[i]))
                y.append(value)
                colours.append(flag_colour(int(worst[i])))
                reasons.append(", ".join(flag_names(int(trace.flags[i]) & _DEFECT)).replace("_", " "))
    return Marks(trace.name, trace.unit, np.array(x), np.array(y), colours, reasons)


def flag_colour(severity: int) -> str:
    """The colour's name of the flag at this place of SEVERITY."""
    return f"flag-{SEVERITY[severity].word.replace('_', '-')}"


def worst_flag(flags: Array) -> Array:
    """Index into SEVERITY of the worst flag of each bin, -1 where there is none; shape (bins,)."""
    worst = np.full(flags.shape, -1)
    for i, flag in enumerate(SEVERITY):
        worst[(flags & np.uint16(flag)) != 0] = i
    return worst


def _row(trace: Trace, test: TestQuality) -> Row:
    """The worst flag over time, one stretch for bins that are alike."""
    flags = trace.flags
    edges = [0, *(np.flatnonzero(np.diff(flags)) + 1).tolist(), len(flags)]
    worst = worst_flag(flags)
    runs = []
    for a, b in pairwise(edges):
        if worst[a] >= 0:
            at = [(test.start_s + i * test.bin_s) / 3600 for i in (a, b)]
            reason = ", ".join(flag_names(int(flags[a]))).replace("_", " ")
            runs.append((at[0], at[1], flag_colour(int(worst[a])), reason))
    return Row(trace.name, runs)


def span_text(from_s: float | None, to_s: float | None) -> str:
    """'2.5 h – 3.0 h', or one time where both are the same to the eye."""
    a, b = duration(from_s), duration(to_s)
    return a if a == b else f"{a} – {b}"
