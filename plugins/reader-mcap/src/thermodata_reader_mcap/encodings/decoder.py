"""What every encoding gives: a decoder of payloads, or the reason why there is none."""

from __future__ import annotations

from typing import Any, Protocol

from thermodata_reader_mcap.encodings.topic import Declared


class UnsupportedError(Exception):
    """An encoding or a schema that nothing here reads; the message says what."""


class Decoder(Protocol):
    """json: payloads are JSON text. hint: what the schema says of a path."""

    @property
    def json(self) -> bool: ...

    def decode(self, payload: bytes) -> Any:
        """A payload as Python values: dict, list, numbers, bool, text, bytes; any exception where it is none."""


def hints(made: Decoder) -> Declared:
    """What a decoder's schema says of a path."""
    found: Declared = getattr(made, "hint", lambda path: None)
    return found
