"""A model as a system, drawn into a PNG, SVG or PDF by the name of the file: step responses, Bode, autocorrelation,
residual against each state."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from thermodata.chart.colour import DASHES, effect_styles, light
from thermodata.errors import UsageError
from thermodata.modelling.seen.as_system import SeenResponse
from thermodata.report.words.numbers import correlation_text, probability_text, time_unit
from thermodata.schema.agreed.certainty import Z95
from thermodata.store.base.files import whole_file

DPI = 110
LEGEND_BESIDE = 1.6  # of the curves' length: where the axis ends
ROW_IN, WIDE_IN = 3.1, 13.0  # [inch]
PERIODS_MIN = {"1 min": 1.0, "10 min": 10.0, "1 h": 60.0, "6 h": 360.0, "1 d": 1440.0, "1 week": 10080.0}
MOST_DECADES = 2.5
SHORTEST_STEPS = 8.0  # a period that is drawn: below, what samples make of it (0 or 180 deg at two) is not the model
TITLE_WIDE, LABEL_WIDE = 58, 50  # [letters] that have room over half of the picture, and under a third of it
# nothing of when and by what it was drawn: the same model gives the same file
ANONYMOUS = {"png": {}, "svg": {"Date": None}, "pdf": {"CreationDate": None}}


def draw(seen: Sequence[SeenResponse], out: Path, title: str) -> None:
    """Write the picture; a cut write leaves no half file. UsageError where matplotlib is not installed."""
    try:
        import matplotlib

        matplotlib.use("Agg")
        from matplotlib import pyplot
    except ImportError:
        raise UsageError(
            "a picture needs matplotlib, which is not installed",
            hint="pip install 'thermodata[picture]'; thermodata report MODEL draws the same into a page without it",
        ) from None
    state_rows = [math.ceil(len(s.states) / 3) for s in seen]
    rows = sum(2 + n for n in state_rows)
    figure = pyplot.figure(figsize=(WIDE_IN, ROW_IN * rows + 0.6), dpi=DPI, layout="constrained")
    grid, at = figure.add_gridspec(rows, 6), 0
    figure.suptitle(title)
    for one, more in zip(seen, state_rows, strict=True):
        looks = {n: _look(*style) for n, style in effect_styles(p.name for p in one.paths).items()}
        _step(figure.add_subplot(grid[at, :3]), one, looks)
        _bode(figure.add_subplot(grid[at, 3:]), one, looks, phase=False)
        _correlation(figure.add_subplot(grid[at + 1, :3]), one)
        _bode(figure.add_subplot(grid[at + 1, 3:]), one, looks, phase=True)
        for i, state in enumerate(one.states):
            axes = figure.add_subplot(grid[at + 2 + i // 3, 2 * (i % 3) : 2 * (i % 3) + 2])
            _against(axes, state, one.unit)
        at += 2 + more
    try:
        kind = out.suffix.lower().removeprefix(".")
        with whole_file(out) as part, matplotlib.rc_context({"svg.hashsalt": "thermodata", "svg.fonttype": "none"}):
            figure.savefig(part, format=kind, metadata=ANONYMOUS[kind])
    finally:
        pyplot.close(figure)


def _look(colour: str, dash: str) -> dict[str, Any]:
    """Of a line, as matplotlib takes it."""
    return {"color": light()[colour], "linestyle": (0, DASHES[dash]) if DASHES[dash] else "solid"}


def _step(axes: Any, seen: SeenResponse, looks: dict[str, dict[str, Any]]) -> None:
    longest = max((p.step[0][-1] for p in seen.paths), default=3600.0)
    size, unit = time_unit(longest)
    for p in seen.paths:
        t, y = p.step
        axes.plot([*t / size, longest / size], [*y, y[-1]], **looks[p.name], label=f"{p.name} [{p.unit}]")
    axes.axhline(0.0, color="0.6", linewidth=0.6)
    axes.set(
        title=folded(f"Step response of {seen.response}, a unit of each drive", TITLE_WIDE),
        xlabel=f"time [{unit}]",
        ylabel=f"[{seen.unit} a unit]",
    )
    if seen.paths:
        # beside the ends of the curves, which it would cover anywhere else
        axes.set_xlim(right=LEGEND_BESIDE * longest / size)
        axes.set_xticks([at for at in axes.get_xticks() if 0.0 <= at <= longest / size])  # no curve goes on there
        axes.legend(fontsize="small", loc="center right")


def _bode(axes: Any, seen: SeenResponse, looks: dict[str, dict[str, Any]], phase: bool) -> None:
    for p in seen.paths:
        hertz, size, angle = p.bode
        told = hertz * seen.step_s <= 1.0 / SHORTEST_STEPS
        minutes = 1.0 / hertz[told] / 60.0
        (axes.semilogx if phase else axes.loglog)(minutes, (angle if phase else size)[told], **looks[p.name])
    low, high = axes.get_xlim()
    axes.invert_xaxis()
    shown = {name: at for name, at in PERIODS_MIN.items() if low <= at <= high}
    axes.set_xticks(list(shown.values()), list(shown))
    if not phase:
        _plain_decades(axes)
    axes.grid(True, which="major", color="0.9")
    what = "phase [deg]" if phase else f"magnitude [{seen.unit} a unit]"
    axes.set(title=f"Bode: {what}", xlabel="period", ylabel=what)


def _plain_decades(axes: Any) -> None:
    """0.1, 0.2, 0.5, 1 in place of powers of ten, of which a picture may hold one or none; tens where it holds many."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    low, high = axes.get_ylim()
    many = math.log10(high / low) > MOST_DECADES
    axes.yaxis.set_major_locator(LogLocator(subs=(1.0,) if many else (1.0, 2.0, 5.0), numticks=20))
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.yaxis.set_minor_formatter(NullFormatter())


def folded(text: str, wide: int) -> str:
    """In lines of at most `wide` letters, broken at blanks, and within a longer name behind '_', '.', ':' or '/'."""
    lines, line = list[str](), ""
    for piece in re.findall(r"[^\s_.:/]*(?:[_.:/]+|\s+|$)", text):
        if line and len((line + piece).rstrip()) > wide:
            lines.append(line.rstrip())
            line = ""
        line += piece
    return "\n".join([*lines, line.rstrip()])


def _correlation(axes: Any, seen: SeenResponse) -> None:
    lags_s = np.arange(len(seen.correlation)) * seen.step_s
    size, unit = time_unit(float(lags_s[-1]) if len(lags_s) else 0.0)
    axes.fill_between(lags_s / size, 0.0, seen.correlation, step="mid", color="#7b8794", alpha=0.5)
    band = Z95 / math.sqrt(max(seen.count, 1))
    axes.axhspan(-band, band, color="#f0b429", alpha=0.35, linewidth=0)
    axes.axhline(0.0, color="0.3", linewidth=0.6)
    told = "\n".join(f"{one.lags} lags {probability_text(one.p_value)}" for one in seen.ljung_box)
    axes.set(
        title="Autocorrelation of the residual (band: 95 % of white noise)",
        xlabel=f"lag [{unit}]",
        ylim=(-1.05, 1.05),
    )
    # three probabilities are wider than the axes as a part of the title
    axes.text(
        0.99, 0.97, f"Ljung-Box: {told or 'too short'}", transform=axes.transAxes, ha="right", va="top", size="small"
    )


def _against(axes: Any, state: Any, unit: str) -> None:
    axes.errorbar(state.centres, state.means, yerr=state.sds, fmt="o-", color="#2f6f9f", ecolor="#b8cfe0", markersize=3)
    axes.axhline(0.0, color="0.6", linewidth=0.6)
    over = "" if state.unit in ("1", "") else f" [{state.unit}]"
    axes.set(xlabel=folded(f"{state.state}{over}", LABEL_WIDE), ylabel=f"residual [{unit}]")
    axes.set_title(f"Residual, mean ± standard deviation, r = {correlation_text(state.correlation)}", fontsize="medium")
    axes.xaxis.label.set_size("small")
