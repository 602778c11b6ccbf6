"""MTConnect stream documents: one, or a log of many one after another, as an agent answered them.

Observations are ordered by the agent's instance and sequence, not by time; what an agent sends again is dropped, and
sequences that it no longer held when it was asked, or that are missing from the log, are a loss.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from pathlib import Path

from thermodata.errors import FormatError
from thermodata.plugin import Block, Loss, Recording, Source
from thermodata.reader.text.file.locate import row_at
from thermodata_reader_cnc import events
from thermodata_reader_cnc.events import Event, HeldTable
from thermodata_reader_cnc.mtconnect import time_series
from thermodata_reader_cnc.mtconnect.document import Document, Names, Observation
from thermodata_reader_cnc.mtconnect.documents import documents

EXAMPLE = b'<?xml version="1.0"?>\n<MTConnectStreams xmlns="urn:mtconnect.org:MTConnectStreams:1.5">\n'
_END = re.compile(rb"</(?:[\w.-]+:)?MTConnectStreams\s*>")
_LOOK = 8 << 20
_PIECES = 24  # places of a long log that the first look sees beside its beginning
_PIECE = 1 << 18
_DENSE = 0.9  # sequences of a document that are there, from where on the others are missing


def claims(lines: Sequence[str]) -> str | None:
    """The reason for claiming lines of XML, or None."""
    if re.search(r"<(?:[\w.-]+:)?MTConnectStreams[\s>/]", "\n".join(lines)[:4096]):
        return "MTConnect: the root is MTConnectStreams"
    return None


class Order:
    """Puts the observations of documents in the agent's order, each once."""

    def __init__(self) -> None:
        self.instance: int | None = None
        self.next: int | None = None
        self.latest: dict[str, int] = {}  # sequence by item
        self.times: dict[str, str] = {}
        self.dense = False

    def of(self, document: Document) -> Iterator[Event | Observation | Loss]:
        """The new observations of a document as events; of time series as they are."""
        if document.instance is not None and document.instance != self.instance:
            self.instance, self.next, self.latest, self.dense = document.instance, None, {}, False
        observed = sorted(document.observations, key=lambda o: o.sequence)
        yield from self._lost_sequences(document, observed)
        if document.undated:
            yield Loss(document.place, reason=f"{document.undated} observations without sequence or time")
        part = f"{document.place} sequence"
        for each in observed:
            if each.sequence <= self.latest.get(each.key, -1):
                continue
            again = each.key not in self.latest and self.times.get(each.key, "") >= each.time
            self.latest[each.key] = each.sequence
            if again:
                continue  # a restarted agent sends what it had
            self.times[each.key] = max(each.time, self.times.get(each.key, ""))
            if each.series:
                yield each
            else:
                yield Event(each.time, each.key, each.value, each.sequence, part)
        if document.next is not None:
            self.next = max(self.next or 0, document.next)

    def _lost_sequences(self, document: Document, observed: list[Observation]) -> Iterator[Loss]:
        """Sequences that the agent no longer held, and holes in documents that hold all of a range."""
        held = sorted({o.sequence for o in observed})
        if self.next is not None and document.first is not None and document.first > self.next:
            yield Loss(
                document.place,
                reason=f"sequences {self.next} to {document.first - 1} are lost: the agent's "
                "buffer no longer held them when it was asked",
            )
        elif self.dense and self.next is not None and held and held[0] > self.next:
            yield Loss(document.place, reason=f"sequences {self.next} to {held[0] - 1} are not in the log")
        if not held:
            return
        first, stop = held[0], held[-1] + 1
        if document.whole and document.next is not None and self._is_nearly_all(document.next, stop, len(held)):
            stop = max(stop, document.next)  # the answer runs up to here
        if (
            self.next is not None
            and self.dense
            and self.next < first
            and self._is_nearly_all(first, self.next, len(held))
        ):
            first = self.next
        whole = len(held) + document.undated >= _DENSE * (stop - first)
        if whole and len(held) + document.undated < stop - first and len(held) > 1:
            yield Loss(
                document.place,
                fraction=None,
                reason=(f"{stop - first - len(held)} of the sequences {first} to {stop - 1} are missing"),
            )
        self.dense = whole

    @staticmethod
    def _is_nearly_all(far: int, near: int, count: int) -> bool:
        return 0 <= far - near <= max(1, (1 - _DENSE) * count)


def _events(path: Path, names: Names, limit: int | None = None) -> Iterator[Event | Observation | Loss]:
    order, count = Order(), 0
    for document in documents(path, names):
        if isinstance(document, Loss):
            yield document
            continue
        yield from order.of(document)
        count += len(document.observations)
        if limit is not None and count > limit:
            return


class _Look:
    """The items of a log, by all of a short one, else by its first documents and pieces from all over it."""

    def __init__(self, path: Path) -> None:
        self.names = Names()
        self.series: set[str] = set()
        size = path.stat().st_size
        self.sampled = size > _LOOK
        self.plan = events.plan(
            self._sampled_events(path, size), lambda key: self.names.properties.get(key, {}).get("category") == "SAMPLE"
        )

    def _sampled_events(self, path: Path, size: int) -> Iterator[Event]:
        for event in _events(path, self.names, 20_000 if self.sampled else None):
            yield from self._note_series(event)
        for k in range(1, _PIECES + 1 if self.sampled else 0):
            at = (size - _PIECE) * k // _PIECES
            for document in documents(path, self.names, at, at + _PIECE):
                if isinstance(document, Document):
                    for each in document.observations[:20_000]:
                        yield from self._note_series(
                            each if each.series else Event(each.time, each.key, each.value, 0, "")
                        )

    def _note_series(self, event: Event | Observation | Loss) -> Iterator[Event]:
        if isinstance(event, Observation):
            self.series.add(event.key)
        elif isinstance(event, Event):
            yield event


def describe(path: Path, source: Source) -> Recording:
    """Items and the first time of a log, by its first documents."""
    look = _Look(path)
    if not look.plan.items and not look.series:
        raise FormatError(
            "no observations",
            where=path.name,
            expected="MTConnectStreams with observations",
            got="none",
            hint="ask the agent for /sample or /current: a /probe says what there is, and no values",
        )
    with path.open("rb") as file:
        file.seek(max(0, path.stat().st_size - 4096))
        behind = _END.split(file.read())
        # a log may end behind any document, so a whole last one proves nothing
        complete = len(behind) > 1 and b"<" not in behind[-1]
    held = events.recording(
        look.plan,
        source,
        look.names.properties,
        None if complete else False,
        (time_series.NOTE,) if look.series else (),
    )
    signals = tuple(time_series.signal(key, look.names.properties.get(key)) for key in sorted(look.series))
    return Recording((*held.signals, *signals), held.clock, held.start_ns, held.complete, held.notes)


def blocks(path: Path, source: Source) -> Iterator[Block | Loss]:
    """Rows of held values in the agent's order, and what is missing."""
    look = _Look(path)
    told: set[str] = set()

    def complain(event: Event, reason: str) -> Iterator[Loss]:
        if event.key not in told and len(told) < 1000:
            told.add(event.key)
            yield Loss(event.where, reason=f"'{event.key}': {reason}")

    table = HeldTable(look.plan, source, complain)
    for event in _events(path, Names()):
        if isinstance(event, Loss):
            yield event
        elif isinstance(event, Event):
            yield from table.add(event)
        elif event.key in look.series:
            yield time_series.rows(event.report(path.name), table.clock)
        elif event.key not in told:
            told.add(event.key)
            yield Loss(
                f"{path.name} sequence {event.sequence}",
                reason=f"'{event.key}': a time series that the first look did not meet; it is not read",
            )
    yield from table.flush()


def locate(path: Path, source: Source, stream: str, row: int) -> str | None:
    """The sequence number of a row's first observation; of a time series, and the number of the sample."""
    plan = _Look(path).plan
    if stream.startswith(time_series.STREAM) and stream not in map(plan.stream, plan.items):
        report = time_series.sample_of(blocks(path, source), stream, row)
        return None if report is None else f"sequence {report[0]}, {report[1]}"
    here = row_at(blocks(path, source), stream, row)
    return None if here is None else f"sequence {here[0]}"
