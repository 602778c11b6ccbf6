"""Whether the channels of a campaign file refer to something, and can be what they say."""

from __future__ import annotations

from collections.abc import Sequence

from thermodata.errors import SpecError, UsageError
from thermodata.schema.files.campaign import Campaign, Channel, Sensor
from thermodata.schema.strict.declared import Value
from thermodata.schema.strict.lines import Document, Place
from thermodata.schema.strict.refer import must_be
from thermodata.schema.units.conversion import converts
from thermodata.schema.units.quantity import canonical
from thermodata.schema.units.value import split_value, value_in


def check_channels(campaign: Campaign, document: Document) -> None:
    """SpecError at the first that does not."""
    for name, channel in campaign.channels.items():
        place = ("channels", name)
        if channel.source is not None:
            must_be("source", channel.source, campaign.sources, document, (*place, "source"))
        used = [channel.calibration] if isinstance(channel.calibration, str) else channel.calibration or []
        for calibration in used:
            must_be("calibration", calibration, campaign.calibrations, document, (*place, "calibration"))
        _can_be(channel, channel.sensor, channel.schedule, document, place)
    for i, test in enumerate(campaign.tests):
        for name, override in test.channels.items():
            if name in campaign.channels:
                own = ("tests", i, "channels", name)
                _can_be(campaign.channels[name], override.sensor, override.schedule, document, own)


def _can_be(
    channel: Channel,
    sensor: Sensor | None,
    schedule: Sequence[tuple[Value, Value]] | None,
    document: Document,
    place: Place,
) -> None:
    if sensor is not None:
        _readings(channel, sensor, document, (*place, "sensor"))
    if schedule is not None:
        _in_order(schedule, document, (*place, "schedule"))


def _readings(channel: Channel, sensor: Sensor, document: Document, place: Place) -> None:
    """Its range and resolution are readings: of what the file has, or of what they become."""
    units = [u for u in (channel.unit, None if channel.quantity == "label" else canonical(channel.quantity)) if u]
    for key, values in (("range", sensor.range or ()), ("resolution", (sensor.resolution,))):
        for value in values:
            unit = "" if value is None else split_value(value)[1]
            # what the file says of its unit is not known here
            if unit and channel.unit and not any(converts(unit, u) for u in units):
                raise SpecError(
                    f"a reading of this channel is not in {unit}",
                    where=document.where((*place, key)),
                    expected=f"a value in {' or '.join(dict.fromkeys(units))}",
                    got=str(value),
                    hint="write the value in the unit of the sensor's own output, before its scaling, or of the "
                    "channel",
                )
    if sensor.range is not None:
        (low, unit), (high, other) = map(split_value, sensor.range)
        if unit == other and low >= high:
            raise SpecError(
                "a sensor range without width",
                where=document.where((*place, "range")),
                expected="[low, high] with low < high",
                got=f"[{sensor.range[0]}, {sensor.range[1]}]",
                hint="the ends between which the sensor's data sheet lets it measure; without 'range' they "
                "are looked for in the values",
            )


def _in_order(schedule: Sequence[tuple[Value, Value]], document: Document, place: Place) -> None:
    if not schedule:
        raise SpecError(
            "a schedule without a value",
            where=document.where(place),
            expected="[[0 h, 3000 rpm], ...]",
            got="[]",
            hint="give the value from the start on, [[0 h, ...]], or leave the channel out",
        )
    before: float | None = None
    for i, (at, _) in enumerate(schedule):
        try:
            now = value_in(at, "s")
        except UsageError as error:
            raise SpecError(
                error.what, where=document.where((*place, i)), expected=error.expected, got=str(at), hint=error.hint
            ) from None
        if before is not None and now <= before:
            raise SpecError(
                "a schedule that goes back in time",
                where=document.where((*place, i)),
                expected=f"times that increase: one after {schedule[i - 1][0]}",
                got=str(at),
                hint="put its rows in the order of their times",
            )
        before = now
