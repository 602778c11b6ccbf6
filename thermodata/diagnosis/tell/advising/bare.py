"""Places of other parts that a cause may be as well and that no channel reads: what to log there."""

from __future__ import annotations

from collections.abc import Mapping

from thermodata.diagnosis.candidates.unread import AXIS, GREATER, part_of, reads
from thermodata.diagnosis.claims.probability import elsewhere
from thermodata.diagnosis.weigh.scored import Scored
from thermodata.schema.words.places import heat_at
from thermodata.view.grid.dataset import ChannelInfo

FIXTURE = "fixture"
# a place of no machine's own: whoever has no sensor there may have one that nobody declared to be there
_ON_FIXTURE = (
    "put a sensor on what holds the probes or the part and declare it at: fixture, or declare so the logged "
    "temperature that sits there"
)


def to_log(one: Scored, channels: Mapping[str, ChannelInfo]) -> str | None:
    """The sensor that tells its heat from that of another part; None where each of them has one."""
    bare = bare_places(one, channels)
    if not bare:
        return None
    if bare == [FIXTURE]:
        return f"to tell {one.candidate.id} from {heat_at(bare, ' and ')}: {_ON_FIXTURE}"
    more = f", and {_ON_FIXTURE}" if FIXTURE in bare else ""
    more += _or_by_its_scale(bare)
    return f"to tell {one.candidate.id} from {heat_at(bare, ' and ')}: log a temperature there{more}"


def _or_by_its_scale(bare: list[str]) -> str:
    """Of a screw that nobody reads: who knows what closes the loop of its axis may need no sensor."""
    axes = [part.heat.removeprefix(AXIS).upper() for place in bare if (part := part_of(place)) and part.name == GREATER]
    if not axes:
        return ""
    return (
        f"; or, where a linear scale closes the loop of {axes[0]}, declare that (machine: {{axes: {{{axes[0]}: "
        "{feedback: scale}}}), for behind it no screw moves the tool"
    )


def with_fixture(said: str | None, head: Scored | None, channels: Mapping[str, ChannelInfo]) -> str | None:
    """The advice, and beside it the sensor that tells the likeliest cause from a fixture, where that may be it as well
    and the advice has no word of it. head: that cause."""
    if head is None or FIXTURE not in bare_places(head, channels) or _ON_FIXTURE in (said or ""):
        return said
    tells = f"to tell {head.candidate.id} from {heat_at([FIXTURE], ' and ')}, {_ON_FIXTURE}"
    return f"{said}; and {tells}" if said else tells


def bare_places(one: Scored, channels: Mapping[str, ChannelInfo]) -> list[str]:
    """Of the other parts that it may be those that no sound channel reads."""
    sound = {name: channel for name, channel in channels.items() if channel.faulty is None}
    return [place for place in elsewhere(one) if not reads(sound, place)]
