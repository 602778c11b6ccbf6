"""The signals of one topic, by a sample of its messages."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from thermodata_reader_mcap.container.definitions import Channel
from thermodata_reader_mcap.encodings.decoder import Decoder, UnsupportedError, hints
from thermodata_reader_mcap.encodings.decoders import decoder
from thermodata_reader_mcap.encodings.field_paths import Path
from thermodata_reader_mcap.encodings.json.arrow import joined
from thermodata_reader_mcap.encodings.json.decoder import JsonDecoder
from thermodata_reader_mcap.encodings.named_elements import NamedDecoder, find_naming
from thermodata_reader_mcap.encodings.topic import Declared, Hint, Topic
from thermodata_reader_mcap.signals.options import Options
from thermodata_reader_mcap.signals.survey.field_survey import Survey, UnsureError
from thermodata_reader_mcap.signals.survey.field_types import find_leaves

_NAMES_IN = 200  # messages of a channel that tell whether the elements of arrays have names
_ROWS, _BYTES = 512, 128 << 10  # inferred at a time: each message may bring fields of its own


def readers(
    channels: Sequence[Channel],
    samples: Mapping[Channel, Sequence[bytes]],
    options: Options,
    encoding: str | None,
) -> tuple[dict[Channel, Decoder], dict[Channel, str], list[str]]:
    """(the decoders of channels, why others have none, notes)."""
    notes: list[str] = []
    made: dict[Channel, Decoder] = {}
    problems: dict[Channel, str] = {}
    for channel in channels:
        try:
            one = decoder(channel, options.enums)
        except UnsupportedError as error:
            problems[channel] = str(error)
            continue
        if isinstance(one, JsonDecoder) and not _is_utf8(b"\n".join(samples.get(channel, ()))):
            one = replace(one, encoding=encoding or "cp1252")
            notes.append(
                f"topic '{channel.topic}': the text is not UTF-8; it is read as {one.encoding}"
                + ("" if encoding else " (set encoding: if that is wrong)")
            )
        made[channel] = one
    return made, problems, notes


def by_name(made: Mapping[Channel, Decoder], samples: Mapping[Channel, Sequence[bytes]]) -> dict[Channel, Decoder]:
    """The decoders of a topic's channels, by the names of the elements where its arrays have some."""
    messages: list[Any] = []
    for channel, one in made.items():
        payloads = samples.get(channel, ())
        for payload in payloads[:: max(1, len(payloads) // _NAMES_IN)]:
            try:
                messages.append(one.decode(payload))
            except Exception:  # whatever a decoder raises: counted and named when it is read
                continue
    naming = find_naming(messages)
    return {channel: NamedDecoder(one, naming) for channel, one in made.items()} if naming else dict(made)


def _is_utf8(payload: bytes) -> bool:
    try:
        payload.decode()
    except UnicodeDecodeError:
        return False
    return True


def discover(
    name: str,
    made: Mapping[Channel, Decoder],
    samples: Mapping[Channel, Sequence[bytes]],
    whole: bool,
    budget: int,
) -> tuple[Topic | None, list[str]]:
    """(the topic, None where no message decodes; notes). whole: the samples are all messages. budget: bytes to look
    at."""
    objects, others = Survey(), Survey()
    exact = whole
    for channel, one in made.items():
        exact &= _survey(one, samples.get(channel, ()), budget // len(made), objects, others)
    wrapped = objects.total < others.total
    survey = others if wrapped else objects
    leaves, notes = find_leaves(name, survey, _first_hint(list(made.values())), exact)
    if not leaves:
        return None, notes
    chosen = {leaf.path for leaf in leaves}
    inner = {path[:k] for path in survey.seen for k in range(len(path))}
    skipped = set(survey.binary) | {path for path in survey.seen if path not in chosen and path not in inner}
    return Topic(name, leaves, wrapped, frozenset(survey.long), frozenset(skipped)), notes


def _first_hint(decoders: list[Decoder]) -> Declared:
    every = [hints(d) for d in decoders]

    def first(path: Path) -> Hint | None:
        return next((found for each in every if (found := each(path)) is not None), None)

    return first


def _survey(one: Decoder, payloads: Sequence[bytes], budget: int, objects: Survey, others: Survey) -> bool:
    """Looks at messages until the budget is used up, evenly over all; whether these were all."""
    size = sum(map(len, payloads))
    quick = one.json and getattr(one, "encoding", None) is None
    if not quick:
        budget = max(budget // 8, 1 << 16)
    step = max(1, -(-size // budget))
    chosen = list(payloads[::step])
    if step > 1:
        chosen += [*payloads[:20], *payloads[-1:]]
    rows = max(1, min(_ROWS, _BYTES * len(payloads) // max(1, size)))
    for begin in range(0, len(chosen), rows):
        part = chosen[begin : begin + rows]
        if not (quick and len(part) > 16 and _by_arrow(part, objects)):
            for payload in part:
                _survey_message(one, payload, objects, others)
    return step == 1


def _by_arrow(payloads: Sequence[bytes], into: Survey) -> bool:
    import pyarrow as pa
    import pyarrow.json as pj

    text = joined(False, payloads)
    if text is None or len(text) > 8 * _BYTES:
        return False
    try:
        table = pj.read_json(pa.BufferReader(text), pj.ReadOptions(use_threads=False, block_size=len(text) + 16))
        if table.num_rows != len(payloads) or len(table.schema) > 2000:
            return False
        into.add_table(table)
    except (pa.ArrowException, UnsureError, UnicodeDecodeError):
        return False
    return True


def _survey_message(one: Decoder, payload: bytes, objects: Survey, others: Survey) -> None:
    try:
        message: Any = one.decode(payload)
    except Exception:  # counted and named when it is read
        return
    (objects if isinstance(message, dict) else others).add(message)
