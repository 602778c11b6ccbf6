"""What is logged and drives nothing in a first model, each with why: a source of heat that is left out is said."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence

from thermodata.effect.binding import Described, bindings
from thermodata.effect.registry import effects
from thermodata.schema.words.sentences import with_count

_GENERIC = "generic"  # the family of effects that take anything
_SHOWN = 3


def why_not_driving(
    drivers: Mapping[str, Described],
    used: Collection[tuple[str, Mapping[str, str]]],
    offered: Sequence[tuple[str, Mapping[str, str]]],
    axis: str | None,
) -> dict[str, str]:
    """Channel -> why it drives nothing, of all channels that could. used: (effect, its channels) of the model; offered:
    of those whose line stands in it behind '#'; axis: of the response."""
    driving = {c for _, channels in used for c in channels.values()}
    takes = _takers(drivers)
    by_line = {c: effect for effect, channels in reversed(offered) for c in channels.values()}
    return {
        name: _why(name, info, [e for e, _ in used], takes.get(name, []), by_line.get(name), axis)
        for name, info in drivers.items()
        if name not in driving
    }


def _why(
    name: str, info: Described, used: Collection[str], takes: Sequence[str], offered: str | None, axis: str | None
) -> str:
    if offered is not None:
        return f"left to thermodata diagnose: the line of {offered} above has it once its '#' is deleted"
    if info.at is None and not takes:
        return "has no place: answer its 'at' in the campaign file"
    if not takes:
        return (
            f"no effect takes {info.quantity} at {info.at} by its place: write {{effect: lag, drivers: {{u: {name}}}}} "
            "to have it"
        )
    parts = (info.at or "").split(".")
    if parts[0] == "axis" and parts[1:2] != [(axis or "").lower()]:
        which = f"another axis than the response's, {axis}" if axis else "an axis, and the response has none yet"
        return f"on {which}: thermodata diagnose tries {with_count(takes, _SHOWN)}"
    if of_another := [e for e in takes if e in used]:
        return f"another sensor drives {with_count(of_another, _SHOWN)}: write it there in its place"
    return f"left to thermodata diagnose, which tries {with_count(takes, _SHOWN)}"


def _takers(drivers: Mapping[str, Described]) -> dict[str, list[str]]:
    """Channel -> the installed effects that it can drive, with others where they need more; those that need the fewest
    first."""
    found: dict[str, list[tuple[int, str]]] = {}
    for name, effect in effects().items():
        if effect.family == _GENERIC:
            continue
        for binding in bindings(effect, drivers):
            for channel in binding.values():
                if (len(binding), name) not in found.setdefault(channel, []):
                    found[channel].append((len(binding), name))
    return {channel: list(dict.fromkeys(name for _, name in sorted(takers))) for channel, takers in found.items()}
