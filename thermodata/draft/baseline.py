"""A first model of a folder: the plain effects whose sensors are there, for `fit`, `compare` and `diagnose`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from thermodata.draft.plan import Draft
from thermodata.draft.write import flow, one_line, scalar
from thermodata.effect.binding import bindings
from thermodata.effect.registry import effects
from thermodata.schema.campaign import Campaign

# what a lab's first model has, the strongest first; what else moves the tool is for `diagnose` to find
_PLAIN = ("spindle_bearing", "feed_screw", "column_bending", "table_bearing", "ambient_frame")
_WITHOUT_SENSOR = {"spindle_bearing": "spindle_friction"}  # where only the speed is logged
_AXES = ("Z", "Y", "X")
_ASKED = ("temperature", "rotational_speed")


@dataclass(frozen=True, slots=True)
class _Known:
    """What is known of a channel."""

    quantity: str
    at: str | None
    axis: str | None


def model_text(draft: Draft) -> str | None:
    """The text of model.yaml; None where no displacement with an axis is there, or no sensor drives a plain effect."""
    said = {c.name: c.said for c in draft.channels}
    return _text(draft.campaign, {n: _Known(s.quantity, s.at, s.axis) for n, s in said.items() if s.quantity})


def model_text_of(campaign: Campaign) -> str | None:
    """The same of a campaign file as it stands, with the places that were answered since its draft."""
    return _text(campaign.id, {n: _Known(c.quantity, c.at, c.axis) for n, c in campaign.channels.items()})


def _text(campaign: str, channels: Mapping[str, _Known]) -> str | None:
    axes = _axes(channels)
    axis, others = (axes[0], axes[1:]) if axes else (None, [])
    drivers = {n: c for n, c in channels.items() if c.quantity not in ("displacement", "label")}
    known = effects()
    lines, missing = [], []
    for name in _PLAIN if axis else ():
        for tried in filter(None, (name, _WITHOUT_SENSOR.get(name))):
            effect = known.get(tried)
            fits = _on_axis(bindings(effect, drivers), drivers, axis or "") if effect is not None else []
            if effect is not None and fits:
                rest = f"; or by {one_line(', '.join(fits[1].values()))}" if len(fits) > 1 else ""
                spec = flow({"effect": tried, "drivers": fits[0]})
                lines.append(f"  - {{{spec}}}   # {one_line(effect.meaning.split(':')[0])}{rest}")
                break
        else:
            missing.append(name)
    if axis is None or not lines:
        return None
    nowhere = [name for name, c in channels.items() if c.quantity in _ASKED and c.at is None]
    return "\n".join(
        [
            "# Drafted by thermodata init: a first model, one plain effect for each sensor that stands where it acts.",
            "# Next: thermodata fit model.yaml, then thermodata diagnose baseline says which effect is missing.",
            "schema: thermodata/model/1",
            "name: baseline",
            f"campaign: {scalar(campaign)}",
            f"response: {{axis: {axis}, at: tcp}}" + (f"   # measured too: {', '.join(others)}" if others else ""),
            "step: 60 s",
            "effects:",
            *lines,
            *([f"# no sensor for: {', '.join(missing)}"] if missing else []),
            *(
                [f"# ? drive nothing until their place ('at') is answered: {', '.join(nowhere[:12])}"]
                if nowhere
                else []
            ),
            "",
        ]
    )


def _axes(channels: Mapping[str, _Known]) -> list[str]:
    """The axes of the tool's displacements, the one that is modelled first before the others: Z before Y before X."""
    there = {c.axis for c in channels.values() if c.quantity == "displacement" and c.at == "tcp"}
    return [a for a in _AXES if a in there]


def _on_axis(found: list[dict[str, str]], drivers: Mapping[str, _Known], axis: str) -> list[dict[str, str]]:
    """The bindings, without those whose sensor sits on another axis than the modelled one."""

    def own(name: str) -> bool:
        at = drivers[name].at or ""
        return not at.startswith("axis.") or at.split(".")[1] == axis.lower()

    return [b for b in found if all(own(c) for c in b.values())]
