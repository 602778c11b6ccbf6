"""The parts of a recording of SINUMERIK Edge (Analyze MyWorkpiece /Capture4Analysis): its header, and the messages of
its payload one by one, for a document of any length is one line."""

from __future__ import annotations

import codecs
import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from thermodata.errors import FormatError
from thermodata.plugin import Loss

PIECE = 1 << 20  # bytes that are read at once
_LONGEST = 32 << 20  # letters of a header, and of a message
_PAYLOAD = re.compile(r'"Payload"\s*:\s*\[')
_HEADER = re.compile(r'"Header"\s*:\s*(?=\{)')
_BETWEEN = re.compile(r"[\s,]*")
_MESSAGE = re.compile(r'\{\s*"(?:HF|LF|External)[A-Za-z]*"\s*:')  # how one begins, in which a reading goes on
_DEEPEST = 60  # a message that opens more brackets than that before it closes any is none
_OPENS = re.compile(r"[\[{]\s*" * _DEEPEST)
_DECODER = json.JSONDecoder()


class Document:
    """A file that is read from its begin to its end. header: as it stands."""

    def __init__(self, path: Path) -> None:
        self.name, self._size = path.name, max(1, path.stat().st_size)
        self._file = path.open("rb")
        self._decode = codecs.getincrementaldecoder("utf-8-sig")("replace").decode
        self._text, self._at, self._read, self._ended = "", 0, 0, False  # text[at:] is still to be told
        self.header = self._read_header()

    def close(self) -> None:
        self._file.close()

    @property
    def read(self) -> int:
        """Bytes of the file so far."""
        return self._read

    def _read_more(self) -> bool:
        """Whether there was more to read: as much as is held already, so that a long message is not tried too often."""
        self._text, self._at = self._text[self._at :], 0
        if self._ended or len(self._text) > _LONGEST:
            return False
        data = self._file.read(max(PIECE, len(self._text)))
        self._read += len(data)
        self._ended = not data
        self._text += self._decode(data, final=not data)
        return not self._ended

    def _read_header(self) -> dict[str, Any]:
        while (payload := _PAYLOAD.search(self._text)) is None:
            if not self._read_more():
                raise self._refusal("a payload")
        found = _HEADER.search(self._text, 0, payload.start())
        header = None if found is None else _object_at(self._text, found.end())
        if header is None or not isinstance(header[0], dict):
            raise self._refusal("a header before its payload")
        self._at = payload.end()
        return header[0]

    def _refusal(self, lacking: str) -> FormatError:
        return FormatError(
            "no recording of SINUMERIK Edge",
            where=self.name,
            expected=f"JSON with {lacking}",
            got=f"{self._text[:60]!r}",
        )

    def messages(self) -> Iterator[dict[str, Any] | Loss]:
        """The messages of the payload, in order, and what of it does not read."""
        while True:
            between = _BETWEEN.match(self._text, self._at)
            self._at = self._at if between is None else between.end()
            if self._at == len(self._text):
                if self._read_more():
                    continue
                yield Loss(f"{self.name} at its end", reason="the payload has no end: the file is cut")
                return
            if self._text[self._at] == "]":
                return
            found = _object_at(self._text, self._at)
            if found is not None:
                self._at = found[1]
                if isinstance(found[0], dict):
                    yield found[0]
                continue
            if self._is_short() and self._read_more():
                continue
            behind = _MESSAGE.search(self._text, self._at + 1)
            yield self._loss_up_to(len(self._text) if behind is None else behind.start())
            if behind is None:
                return

    def _is_short(self) -> bool:
        """Whether more text may make a message of what is held: one that another follows in a few pieces is damaged."""
        return len(self._text) - self._at < 8 * PIECE or _MESSAGE.search(self._text, self._at + 1) is None

    def _loss_up_to(self, end: int) -> Loss:
        start, letters = self._text[self._at : self._at + 60], end - self._at
        self._at = end
        return Loss(
            f"{self.name} before byte {self._read}",
            fraction=min(1.0, letters / self._size),
            reason=f"{letters} letters that are no message: {start!r}",
        )


def _object_at(text: str, at: int) -> tuple[Any, int] | None:
    """(what stands there in JSON, where it ends); None where it is none, or not whole."""
    if _OPENS.match(text, at):
        return None
    try:
        return _DECODER.raw_decode(text, at)
    except (ValueError, RecursionError):
        return None
