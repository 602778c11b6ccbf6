"""What one message reports: an object with a time, of a value with its name, of values by their keys, or of a list of
such objects, as brokers of MQTT, Telegraf and Industrial Edge write them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from thermodata.reader.signals.header_words import LABEL_WORDS, SENSOR_WORDS
from thermodata.reader.text.cells.values.status import is_good
from thermodata_reader_cnc.events import GONE
from thermodata_reader_cnc.messages.json_text import Number, loads
from thermodata_reader_cnc.messages.shape import QC, Shape, shape_of
from thermodata_reader_cnc.opcua.long_words import bare

_DEEPEST = 8  # objects within objects
_LONGEST_WORD = 64  # letters of a time, a unit, a quality
_MOST_ELEMENTS = 16  # numbers of an array that are signals of their own
_MOST_OF_ORIGIN = 8  # keys of an object that says where others come from
_TELEGRAF = {"fields", "tags", "name", "timestamp"}


class Report(NamedTuple):
    """A value at a time, as texts. labels: of where it comes from, outermost first; quality: the code or word that is
    told of it, '' where none is."""

    time: str
    labels: tuple[str, ...]
    name: str
    value: str
    unit: str = ""
    quality: str = ""


class _Place(NamedTuple):
    """Where an object stands: what those around it say."""

    time: str = ""
    labels: tuple[str, ...] = ()
    name: str = ""
    depth: int = 0


def reports(message: Any) -> Iterator[Report]:
    """The values of a message. One without a time has none ('')."""
    return _reports_in(message, _Place())


def _reports_in(value: Any, at: _Place) -> Iterator[Report]:
    if at.depth > _DEEPEST:
        return
    if isinstance(value, dict):
        yield from _of_object(value, at)
    elif isinstance(value, list):
        yield from _of_list(value, at)
    elif at.name or at.labels:
        yield Report(at.time, at.labels, at.name, _text(value))


def _of_object(message: Mapping[str, Any], at: _Place) -> Iterator[Report]:
    shape = shape_of(tuple(message))
    if message.keys() >= _TELEGRAF and isinstance(message["fields"], dict):
        tags = message["tags"] if isinstance(message["tags"], dict) else {}
        labels = (*at.labels, _text(message["name"]), *map(_text, tags.values()))
        yield from _of_values(
            message["fields"], _Place(_word(message["timestamp"]), labels, "", at.depth + 1), frozenset()
        )
        return
    time = _time(message, shape) or at.time
    labels = (*at.labels, *(_text(message[k]) for k in shape.labels if _is_scalar(message[k])))
    name = _text(message[shape.name]) if shape.name is not None and _is_scalar(message[shape.name]) else ""
    if shape.null is not None and message[shape.null] is True and (name or at.name):
        yield Report(time, labels, "/".join(filter(None, (at.name, name))), GONE)
    elif shape.value is not None and (name or at.name):
        yield from _of_value(message, shape, _Place(time, labels, "/".join(filter(None, (at.name, name))), at.depth))
    else:
        labels = (*labels, name) if name else labels
        told = shape.told - {shape.value} if shape.value is not None else shape.told
        origins = {k: own for k, each in message.items() if isinstance(each, dict) and (own := _origin(k, each))}
        labels = (*labels, *(_text(message[k][j]) for k, own in origins.items() for j in own))
        rest = {k: v if k not in origins else _without_keys(v, origins[k]) for k, v in message.items()}
        yield from _of_values(rest, _Place(time, labels, at.name, at.depth), told)


def _origin(key: str, value: Mapping[str, Any]) -> tuple[str, ...]:
    """The keys of labels in an object that says where what stands beside it comes from, and holds no number and no time
    of its own: {"end_device_ids": {"device_id": "hall-n"}, "uplink_message": {...}}, {"source": {"id": "1001"}}."""
    shape = shape_of(tuple(value))
    if len(value) > _MOST_OF_ORIGIN or shape.time is not None or shape.value is not None:
        return ()
    own = [*shape.labels, *(k for k in value if bare(k) in SENSOR_WORDS and k not in shape.labels)]
    if bare(key) in LABEL_WORDS or bare(key) in SENSOR_WORDS:
        own += [k for k in value if bare(k) in ("id", "name")]
    if any(isinstance(v, Number | list | bool) for k, v in value.items() if k not in own):
        return ()
    return tuple(k for k in own if _is_scalar(value[k]))


def _without_keys(value: Mapping[str, Any], keys: Sequence[str]) -> dict[str, Any]:
    return {k: v for k, v in value.items() if k not in keys}


def _of_value(message: Mapping[str, Any], shape: Shape, at: _Place) -> Iterator[Report]:
    """Of an object that says what its value is of: a number, a word, or a message in it."""
    value = _unpacked(message[str(shape.value)])
    if not _is_scalar(value):
        yield from _reports_in(value, _Place(at.time, (*at.labels, at.name), "", at.depth + 1))
        return
    unit, quality = (_word(message[k]) if k is not None else "" for k in (shape.unit, shape.quality))
    if shape.quality is not None and bare(shape.quality) == QC:
        quality = "bad" if quality == "0" else "good"
    yield Report(at.time, at.labels, at.name, _text(value), unit, quality)


def _of_values(message: Mapping[str, Any], at: _Place, told: frozenset[str]) -> Iterator[Report]:
    """Of an object whose keys name its values."""
    for key, value in message.items():
        if key in told:
            continue
        held = next((each for each in value if isinstance(each, dict)), None) if isinstance(value, list) else None
        if held is None:
            place = _Place(at.time, at.labels, ".".join(filter(None, (at.name, key))), at.depth + 1)
        else:
            place = _Place(at.time, (*at.labels, *_told_by(key, held)), at.name, at.depth + 1)
        yield from _reports_in(value, place)


def _told_by(key: str, held: Mapping[str, Any]) -> tuple[str, ...]:
    """What the key of a list of objects says of them that they don't say themselves: the device or signal they are of,
    as ThingsBoard writes them."""
    return () if shape_of(tuple(held)).name is not None or held.keys() >= _TELEGRAF else (key,)


def _of_list(values: Sequence[Any], at: _Place) -> Iterator[Report]:
    """Of a list: objects that say what they are, or numbers, each by its place."""
    if not any(isinstance(each, (dict, list)) for each in values) and len(values) > _MOST_ELEMENTS:
        return
    for k, value in enumerate(values):
        said = isinstance(value, dict) and (own := shape_of(tuple(value))) is not None and _says_what_or_when(own)
        yield from _reports_in(value, _Place(at.time, at.labels, at.name if said else f"{at.name}[{k}]", at.depth + 1))


def _says_what_or_when(shape: Shape) -> bool:
    """Whether an object of a list says what it is, or when it was."""
    return shape.name is not None or shape.time is not None


def _time(message: Mapping[str, Any], shape: Shape) -> str:
    value = None if shape.time is None else message[shape.time]
    return _word(value) if isinstance(value, str) else ""


def _unpacked(value: Any) -> Any:
    """A value that is a text in JSON, as a broker hands a payload on, by what it holds."""
    if isinstance(value, str) and not isinstance(value, Number) and value.lstrip()[:1] == "{":
        try:
            return loads(value)
        except (ValueError, RecursionError):
            return value
    return value


def _is_scalar(value: Any) -> bool:
    return not isinstance(value, (dict, list))


def _word(value: Any) -> str:
    """A time, a unit or a quality; '' of what is none."""
    text = _text(value)
    return "" if text == GONE or len(text) > _LONGEST_WORD else text


def _text(value: Any) -> str:
    if value is None or not _is_scalar(value):
        return GONE
    return str(value).lower() if isinstance(value, bool) else str(value).strip() or GONE


def is_bad(report: Report, zero_good: bool) -> bool:
    """Whether the message itself calls a value bad. zero_good: whether the code 0 is good."""
    return bool(report.quality) and not is_good(report.quality, zero_good)
