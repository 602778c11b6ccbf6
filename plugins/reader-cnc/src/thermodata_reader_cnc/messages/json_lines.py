"""Lines of JSON, an object each, as brokers' dumps, Telegraf and scripts write them: `{"ts": ..., "topic": ...,
"value": ...}`, `{"time": ..., "T1": 20.5, "T2": 20.6}`, Telegraf's `fields` and `tags`, the `vals` and `records` of
Industrial Edge [IE Common Databus Payload Format], the `id`, `v`, `q`, `t` of Kepware's IoT gateway; also those of an
array that holds an object a line, and an array a line, as a pack of SenML.

Messages of several sensors are parted by what they say of these: labels, also of an object beside the values, or a key
that parts them as a column does the rows of a table. A value holds until the next one of its name, but for objects that
all have the same keys: where one lacks a key there is no value.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from thermodata.errors import FormatError
from thermodata.plugin import Block, Loss, Recording, Source
from thermodata.reader.text import split_unit
from thermodata.reader.text.cells.values.number import to_float
from thermodata.reader.text.cells.values.status import BAD, declared_zero, zero_is_good
from thermodata.reader.text.file.lines import ODD, chunks, sample
from thermodata.reader.text.file.locate import line_of, lines_of
from thermodata.reader.text.file.losses import NAMED
from thermodata_reader_cnc import events
from thermodata_reader_cnc.events import GONE, Event, HeldTable
from thermodata_reader_cnc.messages import senml
from thermodata_reader_cnc.messages.json_text import loads
from thermodata_reader_cnc.messages.reports import Report, is_bad, reports
from thermodata_reader_cnc.messages.senders import Senders, senders
from thermodata_reader_cnc.messages.shape import shape_of
from thermodata_reader_cnc.opcua.long_times import Times, time_form
from thermodata_reader_cnc.opcua.row_units import in_unit_of

EXAMPLE = (
    b'{"ts":"2026-03-02T08:00:00Z","topic":"shop/T1","value":20.5}\n'
    b'{"ts":"2026-03-02T08:00:01Z","topic":"shop/T2","value":20.75}\n'
    b'{"ts":"2026-03-02T08:00:02Z","topic":"shop/T1","value":20.5}\n'
)
_FEWEST, _NEARLY_ALL, _LOOKED_AT = 3, 0.9, 200  # lines by which such a text is known
_LOOK = 4 << 20
_PART = 1 << 20
_ZERO_OF = "quality"


def claims(lines: Sequence[str]) -> str | None:
    """The reason for claiming lines of text, or None."""
    full = [text for line in lines if (text := _object_of(line))][:_LOOKED_AT]
    if not full or full[0][0] not in "{[":
        return None
    found = [_reports_of(text) for text in full]
    timed = sum(1 for each in found if each and each[0].time)
    several = len(full) >= _FEWEST or len({r.time for each in found if each for r in each}) >= _FEWEST
    return "lines of JSON, each an object with a time" if several and timed >= _NEARLY_ALL * len(full) else None


def _object_of(line: str) -> str:
    """The object in a line, '' where it only begins or ends an array."""
    text = line.strip().strip("\ufeff").removesuffix(",").rstrip()
    if text.startswith("[{") and not text.endswith("]"):
        return text[1:]
    if text.startswith("{") and text.endswith("}]"):
        return text[:-1]
    return "" if text in ("[", "]") else text


def _reports_of(text: str) -> list[Report] | None:
    """What an object reports, or an array of such; None where it is none."""
    try:
        message = loads(text)
    except (ValueError, RecursionError):
        return None
    if isinstance(message, dict):
        return list(reports(message))
    if not isinstance(message, list) or not message or not all(isinstance(each, dict) for each in message):
        return None
    each_one = senml.resolved(message) if senml.is_pack(message) else message
    return [report for one in each_one for report in reports(one)]


@dataclass(frozen=True, slots=True)
class _Look:
    """senders: whose a message is; labels: the places of those that tell reports apart; common: place -> the label that
    all have; keys: of an object, where all have the same; zero_good: whether the quality 0 is."""

    plan: events.Plan
    encoding: str
    senders: Senders
    labels: tuple[int, ...]
    common: Mapping[int, str]
    keys: tuple[str, ...]
    units: Mapping[str, str]
    zero_good: bool
    times: Times | None
    notes: tuple[str, ...]

    def key(self, report: Report) -> str:
        return _key(report, self.labels)

    def other(self, report: Report) -> str | None:
        """A label of a report that is none of those that the first look met: its values are of something else."""
        told = ((k, label) for k, label in enumerate(report.labels) if k not in self.labels)
        return next((label for k, label in told if self.common.get(k) != label), None)


def _key(report: Report, labels: Sequence[int]) -> str:
    told = [report.labels[k] for k in labels if k < len(report.labels) and report.labels[k] != GONE]
    return "/".join((*told, report.name) if report.name else told) or "value"


def _look_at(path: Path, source: Source) -> _Look:
    first = sample(path, source.encoding, _LOOK)
    lines = [text for line in (*first.head, *first.rest) if (text := _object_of(line))]
    head, rest = (
        [found for line in part if (found := _reports_of(_object_of(line)))] for part in (first.head, first.rest)
    )
    messages = [*head, *rest]
    every = [report for found in messages for report in found if report.time]
    said = (source.table or {}).get("time")
    form = time_form([r.time for r in every], path.name, said.get("format") if isinstance(said, Mapping) else None)
    if not every or form is None:
        raise FormatError(
            "no lines of JSON with a time",
            where=path.name,
            expected='objects with a date and time, as {"ts": "2026-03-02T08:00:00Z", "topic": "T1", "value": 20.5}',
            got=lines[0][:80] if lines else "nothing",
            hint="write the time of each message into it, as a date or in s, ms, us or ns since 1970",
        )
    of = senders(messages, source, form)
    head, messages = [of.named(found) for found in head], [of.named(found) for found in messages]
    every = [report for found in messages for report in found if report.time]
    labels = _differing_labels(every)
    units = dict[str, str]()
    for report in every:
        if report.unit:
            units.setdefault(_key(report, labels), report.unit)
    zero = declared_zero(source.table, zero_is_good([r.quality for r in every], _ZERO_OF), _ZERO_OF, path.name)
    sets = {tuple(sorted(_key(r, labels) for r in found)) for found in messages}
    keys = next(iter(sets)) if len(sets) == 1 and len(next(iter(sets))) > 1 else ()
    plan = events.plan(_heard(messages, labels), form=form)
    plan = replace(plan, beats=events.beats_of(_heard(head, labels), form))
    return _Look(
        plan,
        first.encoding,
        of,
        labels,
        {k: label for r in every for k, label in enumerate(r.labels) if k not in labels},
        keys,
        units,
        zero,
        _times_of(lines),
        (*([first.note] if first.note else []), *of.notes),
    )


def _heard(messages: Iterable[Sequence[Report]], labels: Sequence[int]) -> Iterator[Event]:
    """What messages of the first look report."""
    return (Event(r.time, _key(r, labels), _value(r), 0, "") for found in messages for r in found if r.time)


def _differing_labels(every: Iterable[Report]) -> tuple[int, ...]:
    """The places of labels that differ between reports: what all have in common names nothing."""
    seen: dict[int, set[str]] = {}
    for report in every:
        for k, label in enumerate(report.labels):
            seen.setdefault(k, set()).add(label)
    return tuple(k for k, words in sorted(seen.items()) if len(words) > 1)


def _times_of(lines: Sequence[str]) -> Times | None:
    """What the key of the time of the first object says of its zone."""
    message: Any = loads(lines[0]) if _reports_of(lines[0]) else None
    return shape_of(tuple(message)).times if isinstance(message, dict) else None


def _value(report: Report) -> str:
    value = report.value
    if value.count(",") == 1 and "." not in value and to_float(value, ",") is not None:
        return value.replace(",", ".")  # a text with a decimal comma
    return value


def _zoned(look: _Look, source: Source) -> tuple[Source, list[str]]:
    return (source, []) if look.times is None else look.times.source(source, look.plan.first, look.plan.form)


def describe(path: Path, source: Source) -> Recording:
    """Names and the first time of a log, by samples of it."""
    look = _look_at(path, source)
    zoned, said = _zoned(look, source)
    found = events.recording(look.plan, zoned, notes=(*look.notes, *said))
    signals = (
        replace(s, unit=look.units.get(s.name) or split_unit(s.name)[1], held=s.held and not look.keys)
        for s in found.signals
    )
    return replace(found, signals=tuple(signals))


class _Complaints:
    """The first losses of each name, the rest as a number."""

    def __init__(self) -> None:
        self._counts: dict[str, int] = {}

    def some(self, key: str, loss: Loss) -> Iterator[Loss]:
        key = key if key in self._counts or len(self._counts) < 1000 else ""
        self._counts[key] = self._counts.get(key, 0) + 1
        if self._counts[key] <= (1 if key else NAMED):
            yield loss

    def rest(self, name: str) -> Iterator[Loss]:
        for key, count in self._counts.items():
            if count > (1 if key else NAMED):
                more = count - (1 if key else NAMED)
                yield Loss(name, reason=f"{more} more {f'of {key!r}' if key else 'lines'} that do not read")


def blocks(path: Path, source: Source) -> Iterator[Block | Loss]:
    """Rows of values, and lines that do not read."""
    look, losses = _look_at(path, source), _Complaints()
    zoned, _ = _zoned(look, source)

    def complain(event: Event, reason: str) -> Iterator[Loss]:
        return losses.some(event.key, Loss(event.where, reason=f"'{event.key}': {reason}"))

    table = HeldTable(look.plan, zoned, complain, ordered=False, keep_all=True)
    for found in _events_of_file(path, look):
        if isinstance(found, Loss):
            yield from losses.some("", found)
        else:
            yield from table.add(found)
    yield from table.flush()
    yield from losses.rest(path.name)


def _events_of_file(path: Path, look: _Look) -> Iterator[Event | Loss]:
    part = f"{path.name} line"
    for chunk in chunks(path, look.encoding, _PART):
        for number in chunk.odd:
            yield Loss(f"{part} {number + 1}", reason=ODD)
        lines = chunk.data.decode("utf-8", "replace").split("\n")
        for number, line in enumerate(lines, chunk.line + 1):
            if text := _object_of(line.strip("\0")):
                yield from _events(text, number, part, look)


def _events(text: str, number: int, part: str, look: _Look) -> Iterator[Event | Loss]:
    """What a line reports. One that ends with its bracket is whole, also without a line end."""
    found = _reports_of(text)
    if found is None or not any(report.time for report in found):
        wanted = "an object of JSON" if found is None else "a time and a value"
        yield Loss(f"{part} {number}", reason=f"expected {wanted}, got '{text[:80]}'")
        return
    seen = set[str]()
    for report in look.senders.named(found):
        key = look.key(report)
        if (other := look.other(report)) is not None:
            yield Loss(f"{part} {number}", reason=f"'{key}' of '{other[:40]}', which the first look did not meet")
            continue
        seen.add(key)
        value, wrong = in_unit_of(key, _value(report), report.unit, look.units)
        if wrong is not None:
            yield Loss(f"{part} {number}", reason=f"'{key}': a value {wrong}: '{value[:40]}'")
            continue
        yield Event(report.time, key, value, number, part, BAD if is_bad(report, look.zero_good) else 0)
    for key in look.keys:
        if key not in seen:
            yield Event(found[0].time, key, GONE, number, part)


def locate(path: Path, source: Source, stream: str, row: int) -> str | None:
    """The lines of a row."""
    told = line_of if _look_at(path, source).plan.apart else lines_of
    return told(blocks(path, source), stream, row)
