"""ROS 2 messages by the package mcap-ros2-support, for definitions that our own parser does not read."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from thermodata_reader_mcap.container.definitions import Schema
from thermodata_reader_mcap.encodings.field_paths import MOST_ELEMENTS


@dataclass(slots=True)
class PackageDecoder:
    """made: the package's function from payload to message."""

    made: Any
    json: bool = False

    def decode(self, payload: bytes) -> Any:
        """A payload as Python values; the package's own errors where it is no such message."""
        return _as_python(self.made(payload))


def package_decoder(schema: Schema) -> PackageDecoder | None:
    """The package's decoder of a ros2msg schema; None where it does not read it either."""
    from mcap.records import Schema as Theirs
    from mcap_ros2.decoder import DecoderFactory

    theirs = Theirs(id=1, name=schema.name, encoding=schema.encoding, data=schema.data)
    try:
        made = DecoderFactory().decoder_for("cdr", theirs)
    except Exception:  # its parser of definitions raises what it likes
        return None
    return None if made is None else PackageDecoder(made)


def _as_python(value: Any) -> Any:
    """A message as Python values: objects with slots become dicts."""
    if isinstance(value, bool | int | float | str) or value is None:
        return value
    if isinstance(value, bytes | bytearray | memoryview):
        return list(value) if len(value) <= MOST_ELEMENTS else bytes(value)
    if isinstance(value, list | tuple):
        return [_as_python(v) for v in value]
    if hasattr(value, "tolist"):
        return value.tolist()
    return {name: _as_python(getattr(value, name)) for name in value.__slots__}
