"""A first model of a folder: the plain effects whose sensors are there, for `fit`, `compare` and `diagnose`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from thermodata.draft.campaign.parts import Draft
from thermodata.draft.writing.not_driving import why_not_driving
from thermodata.draft.writing.seal import sealed
from thermodata.draft.writing.write import flow, one_line, scalar
from thermodata.effect.binding import unnamed
from thermodata.effect.registry import effects
from thermodata.schema.files.campaign import Campaign
from thermodata.schema.words.places import is_around
from thermodata.schema.words.sentences import with_count

# what a lab's first model has, the strongest first; what else moves the tool is for `diagnose` to find
_PLAIN = ("spindle_bearing", "feed_screw", "column_bending", "table_bearing", "ambient_frame")
# what many machines have besides: offered where a sensor is there, and left to the lab and to `diagnose`
_OFFERED = ("spindle_motor", "coolant_temperature", "hydraulics")
_WITHOUT_SENSOR = {"spindle_bearing": "spindle_friction"}  # where only the speed is logged
_AXES = ("Z", "Y", "X")
_ASKED = ("temperature", "rotational_speed")
_SHOWN = 12


@dataclass(frozen=True, slots=True)
class _KnownChannel:
    """What is known of a channel."""

    quantity: str
    at: str | None
    axis: str | None


def responses_of_draft(draft: Draft) -> list[str]:
    """The displacements of the tool that the first model of a draft is of, or could be: the one that it takes first."""
    said = {c.name: c.said for c in draft.channels}
    channels = {n: _KnownChannel(s.quantity, s.at, s.axis) for n, s in said.items() if s.quantity}
    axes = _axes(channels)
    found = [n for n, c in channels.items() if _is_tools(c) and c.axis in axes]
    return sorted(found, key=lambda n: axes.index(str(channels[n].axis)))


def model_text_of(campaign: Campaign, response: str | None = None) -> str | None:
    """The text of model.yaml of a campaign file as it stands, with the places that were answered since its draft; None
    where no displacement with an axis is there, or no sensor drives a plain effect. response: one of `responses_of`,
    the first where None."""
    return _text(campaign.id, _known(campaign), response)


def left_out_of(campaign: Campaign, response: str) -> list[str]:
    """The logged channels that drive nothing in the first model of a response, which says why."""
    channels = _known(campaign)
    chosen = _chosen(channels, channels[response].axis)
    return list(chosen.why_not) if chosen is not None else []


def responses_of(campaign: Campaign) -> list[str]:
    """The displacements that a first model may be of: the tool's before others, Z before Y before X before the rest."""
    channels = _known(campaign)

    def late(name: str) -> tuple[bool, int]:
        axis = channels[name].axis
        return channels[name].at != "tcp", _AXES.index(axis) if axis in _AXES else len(_AXES)

    return sorted((n for n, c in channels.items() if c.quantity == "displacement"), key=late)


def _known(campaign: Campaign) -> dict[str, _KnownChannel]:
    return {n: _KnownChannel(c.quantity, c.at, c.axis) for n, c in campaign.channels.items()}


@dataclass(frozen=True, slots=True)
class _Sensors:
    """The channels that may drive effects, for a response on `axis`."""

    drivers: Mapping[str, _KnownChannel]
    axis: str | None

    def fitting(self, name: str) -> list[dict[str, str]]:
        """How the channels drive an effect, the nearest sensor first; [] where none does, or it is not installed."""
        there = self.anywhere(name)
        return _nearest_first(name, _on_axis(there, self.drivers, self.axis or "none"), self.drivers)

    def anywhere(self, name: str) -> list[dict[str, str]]:
        """The same with those on other axes than the response's."""
        effect = effects().get(name)
        return [] if effect is None else unnamed(effect, self.drivers)

    def plain(self, name: str) -> tuple[str, list[dict[str, str]]] | None:
        """A plain effect, or what stands for it where only its speed is logged, and how the channels drive it; None
        without either."""
        for tried in filter(None, (name, _WITHOUT_SENSOR.get(name))):
            if fits := self.fitting(tried):
                return tried, fits
        return None


def _text(campaign: str, channels: Mapping[str, _KnownChannel], chosen: str | None = None) -> str | None:
    """chosen: the response, the first of the tool's where None. None where there is none, or nothing drives it."""
    axes = _axes(channels)
    first = next((n for n, c in channels.items() if axes and _is_tools(c) and c.axis == axes[0]), None)
    chosen = chosen or first
    if chosen is None:
        return None
    axis = channels[chosen].axis
    effects_chosen = _chosen(channels, axis)
    if effects_chosen is None:
        return None
    alone = _is_tools(channels[chosen]) and sum(_is_tools(c) and c.axis == axis for c in channels.values()) == 1
    wanted = f"{{axis: {axis}, at: tcp}}" if alone else f"{{{flow({'channel': chosen})}}}"
    others = _measured_too(channels, chosen, axes)
    unplaced = [name for name, c in channels.items() if c.quantity in _ASKED and c.at is None]
    name = "baseline" if chosen == first else str(scalar(f"baseline_{chosen}"))
    text = [
        "# Drafted by thermodata init: a first model, one plain effect for each sensor that stands where it acts.",
        f"# Next: thermodata fit model.yaml, then thermodata diagnose {name} says which effect is missing.",
        "schema: thermodata/model/1",
        f"name: {name}",
        f"campaign: {scalar(campaign)}",
        f"response: {wanted}" + (f"   # measured too: {', '.join(others)}" if others else ""),
        "step: 60 s",
        "effects:",
        *effects_chosen.lines,
    ]
    if effects_chosen.why_not:
        text.append("# logged, and driving nothing here:")
        text += [f"#   {scalar(name)}: {one_line(why)}" for name, why in effects_chosen.why_not.items()]
    if unplaced:
        text.append(f"# ? drive nothing until their place ('at') is answered: {with_count(unplaced, _SHOWN)}")
    return sealed("\n".join([*text, ""]))


def _measured_too(channels: Mapping[str, _KnownChannel], chosen: str, axes: Sequence[str]) -> list[str]:
    """The tool's other displacements as a response names them: by the axis alone, where one probe is along it."""
    found = []
    for axis in axes:
        probes = [n for n, c in channels.items() if _is_tools(c) and c.axis == axis]
        beside = [f"{{{flow({'channel': n})}}}" for n in probes if n != chosen]
        if beside:
            found.append(axis if len(probes) == 1 else f"{axis} by {' or '.join(beside)}")
    return found


@dataclass(frozen=True, slots=True)
class _Chosen:
    """lines: of the effects that have a sensor, then, behind '#', what else could be there; why_not: channel -> why it
    drives none."""

    lines: list[str]
    why_not: dict[str, str]


def _chosen(channels: Mapping[str, _KnownChannel], axis: str | None) -> _Chosen | None:
    """The effects of a response on an axis; None where none has a sensor."""
    drivers = {n: c for n, c in channels.items() if c.quantity not in ("displacement", "label")}
    sensors = _Sensors(drivers, axis)
    lines, missing, elsewhere, used = list[str](), [], [], []
    for name in _PLAIN:
        if (plain := sensors.plain(name)) is not None:
            taken, fits = plain
            used.append((taken, fits[0]))
            rest = f"; or by {one_line(', '.join(fits[1].values()))}" if len(fits) > 1 else ""
            lines.append(f"{_line(taken, fits[0])}   # {one_line(effects()[taken].meaning.split(':')[0])}{rest}")
        elif there := sensors.anywhere(name):
            elsewhere.append(f"{name} ({one_line(', '.join(there[0].values()))})")
        else:
            missing.append(name)
    if not lines:
        return None
    offered = [(name, fits[0]) for name in _OFFERED if (fits := sensors.fitting(name))]
    if offered:
        lines.append("# logged too, and left to thermodata diagnose; to have one now, delete its '#':")
        lines += [f"#{_line(name, by)}" for name, by in offered]
    if elsewhere:
        lines.append(f"# {_elsewhere(sensors.axis)}: {', '.join(elsewhere)}")
    if missing:
        lines.append(f"# no sensor for: {', '.join(missing)}")
    return _Chosen(lines, why_not_driving(drivers, used, offered, axis))


def _elsewhere(axis: str | None) -> str:
    if axis is None:
        return "on an axis, and the response has none yet"
    return f"on another axis than the response's, {axis}"


def _line(effect: str, drivers: Mapping[str, str]) -> str:
    return f"  - {{{flow({'effect': effect, 'drivers': dict(drivers)})}}}"


def _axes(channels: Mapping[str, _KnownChannel]) -> list[str]:
    """The axes of the tool's displacements, the one that is modelled first before the others: Z before Y before X."""
    there = {c.axis for c in channels.values() if _is_tools(c)}
    return [a for a in _AXES if a in there]


def _is_tools(channel: _KnownChannel) -> bool:
    return channel.quantity == "displacement" and channel.at == "tcp" and channel.axis is not None


def _on_axis(found: list[dict[str, str]], drivers: Mapping[str, _KnownChannel], axis: str) -> list[dict[str, str]]:
    """The bindings, without those whose sensor sits on another axis than the modelled one."""

    def own(name: str) -> bool:
        at = drivers[name].at or ""
        return not at.startswith("axis.") or at.split(".")[1] == axis.lower()

    return [b for b in found if all(own(c) for c in b.values())]


def _nearest_first(
    effect: str, found: list[dict[str, str]], drivers: Mapping[str, _KnownChannel]
) -> list[dict[str, str]]:
    """The bindings in their order, but a sensor at the part that the effect is called after before others: of
    table_bearing table.bearing before table.motor; and the air of the hall before that at its top or bottom, which is
    warmer or colder for most of the day."""

    def rank(binding: Mapping[str, str]) -> tuple[bool, int]:
        places = [drivers[c].at or "" for c in binding.values()]
        aside = any(is_around(at) and "." in at for at in places)
        return aside, -len(set(effect.split("_")) & {part for at in places for part in at.split(".")})

    return sorted(found, key=rank)
