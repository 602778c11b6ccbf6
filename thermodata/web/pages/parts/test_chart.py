"""A test as one chart: model and residual, the displacements, temperatures by where they are, what the machine did."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from thermodata.chart.band import SHADED, band_95
from thermodata.chart.colour import EFFECTS, effect_styles
from thermodata.chart.parts import Axis, Band, Panel, Row, Series, Span, Strip, Style
from thermodata.chart.spec import Chart
from thermodata.plugin import Float1D
from thermodata.schema.units.quantity import MEASURED
from thermodata.schema.units.unit import difference_unit
from thermodata.schema.words.sentences import counted
from thermodata.view.curves.predictions import Prediction
from thermodata.view.curves.window import Channel, Window
from thermodata.view.lists.events import About, Flagged

_HOUR = 3600.0
_MOST_ROWS = 16
_BODIES = {"spindle": "spindle and headstock", "headstock": "spindle and headstock", "ram": "spindle and headstock"}


@dataclass(frozen=True, slots=True)
class OfModel:
    """What a model says of a test. order: of its effects, for their colours; units: response -> its unit; driven: an
    effect -> its name with what drives it."""

    predicted: Sequence[Prediction] = ()
    order: Sequence[str] = ()
    units: Mapping[str, str] = field(default_factory=dict)
    driven: Mapping[str, str] = field(default_factory=dict)


NO_MODEL = OfModel()


def test_chart(
    about: About, channels: Sequence[Channel], windows: Sequence[Window], model: OfModel, *, named: bool
) -> Chart:
    """named: the channels were asked for by name, and are drawn though one never moves in these windows: a zoom must
    not lose a strip. x: hours from the test's start, over the whole test; windows may hold a part of it in finer
    steps."""
    length = (about.row["duration_s"] or 0.0) / _HOUR
    if not length:
        length = max((float(w.t_s[-1]) / _HOUR for w in windows if len(w.t_s)), default=1.0)
    values = {name: (w.t_s / _HOUR, y) for w in windows for name, y in w.values.items()}
    known = [c for c in channels if c.name in values]
    drawn = [f for f in about.flagged if not f.idle]
    panels: list[Panel | Strip] = [*_of_model(model), *_of_channels(known, values, named)]
    return Chart(
        f"Test {about.row['test']} over {length:.3g} hours: {counted(len(known), 'channel')}"
        + (", with the model's prediction and what it leaves over" if model.predicted else ""),
        Axis("time", "h", range=(0.0, length)),
        np.empty(0),
        panels,
        spans=_spans(about),
        rows=_rows(drawn),
        rows_title=_flags_title(drawn),
    )


def drawn_as_curve(channel: Channel) -> bool:
    """Whether it has a panel with an axis; what the machine did is a strip."""
    return channel.quantity in MEASURED or channel.quantity.startswith("temperature")


def _of_model(model: OfModel) -> list[Panel]:
    panels = []
    for p in model.predicted:
        unit = model.units.get(p.response, "um")
        of_errors = difference_unit(unit)
        x = p.t_s / _HOUR
        measured = np.where(p.valid, p.measured, np.nan)
        panels += [
            Panel(
                f"{p.response}, model",
                unit,
                [
                    Series("measured", unit, measured, "measured", x=x),
                    Series("model", unit, p.predicted, "model", x=x, band=_band(p, "predicted", p.predicted)),
                ],
            ),
            Panel(
                f"{p.response}, residual",
                of_errors,
                [Series("residual", of_errors, np.where(p.valid, p.residual, np.nan), "residual", x=x)],
                height=110,
                zero=True,
            ),
        ]
        if p.contributions:
            styles = effect_styles([*model.order, *p.contributions])
            panels.append(
                Panel(
                    f"{p.response}, contributions{f', {SHADED}' if p.deviations else ''}",
                    of_errors,
                    [
                        Series(
                            model.driven.get(name, name),
                            of_errors,
                            y,
                            styles[name][0],
                            x=x,
                            dash=styles[name][1],
                            label=name,
                            band=_band(p, name, y),
                        )
                        for name, y in p.contributions.items()
                    ],
                    zero=True,
                )
            )
    return panels


def _band(p: Prediction, name: str, y: Float1D) -> Band | None:
    sd = p.deviations.get(name)
    return None if sd is None else band_95(y, sd)


def _of_channels(
    channels: Sequence[Channel], values: dict[str, tuple[Float1D, Float1D]], named: bool
) -> list[Panel | Strip]:
    groups: dict[tuple[str, str], list[Channel]] = {}
    strips: list[Panel | Strip] = []
    for channel in channels:
        if drawn_as_curve(channel):
            body = f", {_body(channel)}" if channel.quantity.startswith("temperature") else ""
            groups.setdefault((channel.quantity + body, channel.unit), []).append(channel)
        else:
            x, y = values[channel.name]
            if named or (np.isfinite(y).any() and np.nanmax(y) > np.nanmin(y)):  # what never moved says nothing
                style: Style = "steps" if channel.held else "line"
                strips.append(Strip(Series(channel.name, channel.unit, y, "lane", x=x, style=style), channel.name))
    # a place with one sensor needs no panel of its own
    alone = [key for key, members in groups.items() if len(members) == 1 and key[0].startswith("temperature")]
    if len(alone) > 1:
        members = [groups.pop(key)[0] for key in alone]
        groups["temperature, elsewhere", members[0].unit] = members
    panels: list[Panel | Strip] = []
    for (title, unit), members in groups.items():
        styles = effect_styles([c.name for c in members])
        own = len(members) == 1
        panels.append(
            Panel(
                members[0].name if own else title,
                unit,
                [
                    Series(
                        c.name,
                        unit,
                        values[c.name][1],
                        EFFECTS[0] if own else styles[c.name][0],
                        x=values[c.name][0],
                        dash="solid" if own else styles[c.name][1],
                        note=c.at or "",
                    )
                    for c in members
                ],
                height=130 if own else 160,
            )
        )
    return [*panels, *strips]


def _body(channel: Channel) -> str:
    """The part of the machine that a temperature belongs to."""
    parts = (channel.at or "").split(".")
    if not parts[0]:
        return "no place"
    if parts[0] == "axis":
        return "axes"
    return _BODIES.get(parts[0], parts[0])


def _spans(about: About) -> list[Span]:
    spans = [
        Span(a / _HOUR, b / _HOUR, "phase", label=name, reason="phase of the campaign file")
        for name, (a, b) in about.phases.items()
    ]
    gaps = {(f.source, f.from_s, f.to_s): f for f in about.flagged if f.flag == "gap"}
    return [
        *spans,
        *(
            Span(a / _HOUR, b / _HOUR, "gap", label=f"gap of {source}", reason=f.detail)
            for (source, a, b), f in gaps.items()
        ),
    ]


def _flags_title(drawn: Sequence[Flagged]) -> str:
    """Which flags the rows are of: a colour alone says nothing on paper, nor to everybody."""
    kinds = dict.fromkeys(f.flag.replace("_", " ") for f in drawn)
    return f"flags: {', '.join(kinds)}" if kinds else "flags"


def _rows(drawn: Sequence[Flagged]) -> list[Row]:
    runs: dict[str, list[tuple[float, float, str, str]]] = {}
    for f in drawn:
        reason = f.flag.replace("_", " ") + (f": {f.detail}" if f.detail else "")
        colour = f"flag-{f.flag.replace('_', '-')}"
        runs.setdefault(f.channel or f.source, []).append((f.from_s / _HOUR, f.to_s / _HOUR, colour, reason))
    return [Row(name, listed) for name, listed in list(runs.items())[:_MOST_ROWS]]
