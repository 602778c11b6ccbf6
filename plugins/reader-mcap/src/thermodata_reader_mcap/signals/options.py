"""What a campaign file may declare under `options` of an mcap source."""

from __future__ import annotations

from dataclasses import dataclass, field
from difflib import get_close_matches

from thermodata.errors import FormatError
from thermodata.plugin import Source
from thermodata.reader.signals.series import Declaration
from thermodata_reader_mcap.encodings.field_paths import Path

LOG, PUBLISH = "log_time", "publish_time"
SCALES = {"s": 10**9, "ms": 10**6, "us": 10**3, "ns": 1}
STAMPS = (("sec", "nanosec"), ("secs", "nsecs"), ("seconds", "nanos"), ("sec", "nsec"))


@dataclass(frozen=True, slots=True)
class Options:
    """time: "log_time", "publish_time", or a field of the messages, such as "header.stamp". scale: nanoseconds of
    one unit of that field, where it is one number. enums: protobuf's enumerations as "number" or "label".
    publish: whether publish times are always a signal, not only where a sample of them differs from the log times.
    series: fields that name whose a message is, or none."""

    time: str = LOG
    scale: int | None = None
    enums: str = "number"
    publish: bool = False
    series: Declaration = field(default_factory=Declaration)

    @property
    def stamp(self) -> Path | None:
        """The path of the field that is the time; None where the time is the record's."""
        return None if self.time in (LOG, PUBLISH) else tuple(self.time.strip(".").split("."))

    def stamps(self) -> list[tuple[Path, ...]]:
        """Paths that may hold the time: seconds and nanoseconds, or one number in `scale`."""
        if self.stamp is None:
            return []
        pairs = [((*self.stamp, a), (*self.stamp, b)) for a, b in STAMPS]
        return [*pairs, (self.stamp,)] if self.scale else list(pairs)


def options(source: Source) -> Options:
    """The declared options. FormatError: an unknown key or value."""
    known = ("time", "time_unit", "enums", "publish_time", "series")
    for key in source.options:
        if key not in known:
            near = get_close_matches(str(key), known, 1)
            raise FormatError(
                f"no option '{key}' of the mcap reader",
                where=f"source '{source.name}'",
                expected=", ".join(known),
                got=str(key),
                hint=f"did you mean '{near[0]}'?" if near else "remove it",
            )
    unit, enums = source.options.get("time_unit"), source.options.get("enums", "number")
    if unit is not None and unit not in SCALES:
        raise FormatError(
            "time_unit is none",
            where=f"source '{source.name}'",
            expected=", ".join(SCALES),
            got=str(unit),
            hint="leave time_unit out where the size of the numbers tells it",
        )
    if enums not in ("number", "label"):
        raise FormatError(
            "enums is none",
            where=f"source '{source.name}'",
            expected="number, label",
            got=str(enums),
            hint="number keeps what was sent, label gives the words of the schema",
        )
    time = source.options.get("time", LOG)
    if not isinstance(time, str) or not time.strip("."):
        raise FormatError(
            "time is none",
            where=f"source '{source.name}'",
            expected="log_time, publish_time, or a field such as header.stamp",
            got=str(time),
            hint="leave 'time' out, which means log_time",
        )
    series = Declaration.of(source.options.get("series"), "options: {{series: {}}}")
    publish = bool(source.options.get("publish_time", False))
    return Options(time, None if unit is None else SCALES[unit], enums, publish, series)
