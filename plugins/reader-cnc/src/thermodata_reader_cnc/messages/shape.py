"""What the keys of an object in a message are: its time, the name, value, unit and quality of what it reports, and
labels of where that comes from."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

from thermodata.reader.signals.header_words import LABEL_WORDS, NAME_WORDS, UNIT_WORDS, VALUE_WORDS
from thermodata.reader.text.cells.values.status import tells_quality
from thermodata_reader_cnc.opcua.long_times import Times, time_columns
from thermodata_reader_cnc.opcua.long_words import bare

_OF_BROKER = "tst"  # what mosquitto_sub calls the time at which a message came
_NAMES = ("topic", *NAME_WORDS)
_VALUES = (*(w for w in VALUE_WORDS if w != "measurement"), "val", "payload")
_ID = "id"  # names what is beside a value, and elsewhere the message
# what a broker or a bus says of a message itself
_OF_MESSAGE = frozenset(
    {"qos", "retain", "dup", "mid", "payloadlen", "properties", "seq", "rseq", "qx", "datatype", "alias"}
)
# of Kepware's IoT gateway: an object that has these keys and no other
_SHORT = {"id": "id", "v": "value", "q": "quality", "t": "time"}
_NULL = "isnull"  # of Sparkplug, in place of a value
QC = "qc"  # of Industrial Edge: 0 is bad, 1 uncertain, 2 and 3 good


@dataclass(frozen=True, slots=True)
class Shape:
    """Keys of an object, None where it has none of the kind. times: the keys of its time, and its zone; null: says that
    there is no value; of_message: those that say something of the message."""

    times: Times | None
    time: str | None
    name: str | None
    value: str | None
    unit: str | None
    quality: str | None
    null: str | None
    labels: tuple[str, ...]
    of_message: frozenset[str]

    @property
    def told(self) -> frozenset[str]:
        """The keys that are no values of their own."""
        kinds = (self.time, self.name, self.value, self.unit, self.quality, self.null, *self.labels)
        return frozenset(k for k in kinds if k is not None) | self.of_message


@lru_cache(maxsize=4096)
def shape_of(keys: tuple[str, ...]) -> Shape:
    """The shape of an object with these keys."""
    names = [bare(k) for k in keys]
    if {"id", "v"} <= set(names) <= _SHORT.keys():
        names = [_SHORT[n] for n in names]

    def first(words: tuple[str, ...]) -> str | None:
        return next((keys[names.index(w)] for w in words if w in names), None)

    times = time_columns(keys, names, (), ())
    time = first((_OF_BROKER,)) if times is None else keys[times.places[0]]
    value, name = first(_VALUES), first(_NAMES)
    if value is not None and name is None:
        name = first((_ID,))
    quality = min(
        ((sure, k) for k, n in zip(keys, names, strict=True) if (sure := tells_quality(n)) is not None), default=None
    )
    return Shape(
        times,
        time,
        name,
        value,
        first(UNIT_WORDS),
        first((QC,)) or (None if quality is None or value is None else quality[1]),
        first((_NULL,)),
        tuple(k for k, n in zip(keys, names, strict=True) if n in LABEL_WORDS and k not in (name, value)),
        frozenset(k for k, n in zip(keys, names, strict=True) if n in _OF_MESSAGE),
    )
