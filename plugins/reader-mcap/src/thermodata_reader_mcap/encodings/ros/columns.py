"""Many ROS messages at once. Where the lengths of texts and arrays agree, every field of two messages stands at the
same place: the first message is walked, and the fields of all that agree with it are cut out as columns."""

from __future__ import annotations

import struct
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from thermodata.plugin import Array, Int1D
from thermodata_reader_mcap.encodings import decoded_messages
from thermodata_reader_mcap.encodings.columns import MISSING, Columns, Wrong, merged
from thermodata_reader_mcap.encodings.field_paths import MOST_ELEMENTS, Path, path_name
from thermodata_reader_mcap.encodings.ros.cdr import FORMATS, PADDING, Cursor, PayloadError, begin
from thermodata_reader_mcap.encodings.ros.decoder import RosDecoder
from thermodata_reader_mcap.encodings.ros.message_types import Field, is_struct
from thermodata_reader_mcap.encodings.topic import Topic

_FEW = 8  # messages of one layout that go one by one
_LAYOUTS = 50  # of one length; the rest goes one by one
_NATURAL = {"?": "bool", "string": "str", "u8": "uint64", "f4": "float64", "f8": "float64"}


@dataclass(slots=True)
class Layout:
    """slots: path -> kind, place, bytes. lengths: places of the lengths that make this layout. cut: paths of arrays
    of which not all elements are slots. order: of bytes."""

    order: str
    slots: dict[Path, tuple[str, int, int]] = field(default_factory=dict)
    lengths: list[int] = field(default_factory=list)
    cut: list[Path] = field(default_factory=list)


@dataclass(slots=True)
class RosColumns(RosDecoder):
    """A decoder that also reads many messages of one layout at once."""

    def columns(self, topic: Topic, payloads: Sequence[bytes]) -> Columns:
        """The payloads as columns; equal to decoding them one by one."""
        sizes = np.fromiter(map(len, payloads), np.int64, len(payloads))
        parts: dict[int, list[Columns]] = {}
        places: dict[int, Int1D] = {}
        single: list[Int1D] = []
        for size in np.unique(sizes).tolist():
            mine = np.flatnonzero(sizes == size)
            for where, part in self._of_one_size(topic, payloads, mine, size):
                if part is None:
                    single.append(where)
                else:
                    places[len(parts)] = where
                    parts[len(parts)] = [part]
        if single:
            where = np.sort(np.concatenate(single))
            places[len(parts)] = where
            parts[len(parts)] = [decoded_messages.columns(topic, self.decode, [payloads[k] for k in where], 0)]
        return merged(parts, places)

    def _of_one_size(
        self, topic: Topic, payloads: Sequence[bytes], mine: Int1D, size: int
    ) -> Iterator[tuple[Int1D, Columns | None]]:
        """(which messages, their columns); None for those that go one by one."""
        for _ in range(_LAYOUTS):
            if mine.size <= _FEW:
                break
            layout = self._layout(payloads[mine[0]])
            reader = None if layout is None else _Reader.of(topic, layout)
            if layout is None or reader is None:
                yield mine[:1], None
                mine = mine[1:]
                continue
            rows = np.frombuffer(b"".join([payloads[k] for k in mine.tolist()]), np.uint8).reshape(mine.size, size)
            fixed = ([0, 1] if not self.ros1 else []) + [at + k for at in layout.lengths for k in range(4)]
            same = (rows[:, fixed] == rows[0, fixed]).all(axis=1)
            yield mine[same], reader.columns(topic, rows if same.all() else rows[same])
            mine = mine[~same]
        if mine.size:
            yield mine, None

    def _layout(self, payload: bytes) -> Layout | None:
        try:
            cursor = begin(payload, self.ros1)
            layout = Layout(cursor.order)
            self._walk_kind(self.types.root, cursor, (), layout, True)
        except PayloadError:
            return None
        return layout if len(payload) - cursor.at <= PADDING else None

    def _walk_kind(self, kind: str, cursor: Cursor, path: Path, layout: Layout, kept: bool) -> None:
        if is_struct(kind):
            fields = self.types.structs[kind]
            if not fields and not self.ros1:
                cursor.take(1)
            for f in fields:
                self._walk_field(f, cursor, (*path, f.name), layout, kept)
        elif kind == "string":
            n = self._length(cursor, layout)
            at = cursor.take(n)
            if kept:
                layout.slots[path] = (kind, at, n)
        else:
            size = struct.calcsize("=" + FORMATS[kind])
            cursor.align(size)
            at = cursor.take(size)
            if kept:
                layout.slots[path] = (kind, at, size)

    def _walk_field(self, f: Field, cursor: Cursor, path: Path, layout: Layout, kept: bool) -> None:
        if f.fixed is None and not f.sequence:
            self._walk_kind(f.kind, cursor, path, layout, kept)
            return
        n = self._length(cursor, layout) if f.sequence else f.fixed or 0
        if kept and n > MOST_ELEMENTS:
            layout.cut.append(path)
        binary = f.kind == "u1" and n > MOST_ELEMENTS
        letter = FORMATS.get(f.kind)
        if letter is not None and n:
            size = struct.calcsize("=" + letter)
            cursor.align(size)
            at = cursor.take(n * size)
            for k in range(0 if binary or not kept else min(n, MOST_ELEMENTS)):
                layout.slots[(*path, k)] = (f.kind, at + k * size, size)
            return
        for k in range(n):
            self._walk_kind(f.kind, cursor, (*path, k), layout, kept and k < MOST_ELEMENTS)

    def _length(self, cursor: Cursor, layout: Layout) -> int:
        n = cursor.length()
        layout.lengths.append(cursor.at - 4)
        return n


@dataclass(frozen=True, slots=True)
class _Reader:
    """What of a layout goes into which signal."""

    layout: Layout
    new: tuple[Path, ...]

    @classmethod
    def of(cls, topic: Topic, layout: Layout) -> _Reader | None:
        """None where a signal's dtype is not that of the field."""
        for leaf in topic.leaves:
            slot = layout.slots.get(leaf.path)
            if slot is not None and _NATURAL.get(slot[0], "int64") != leaf.dtype:
                return None
        known = {leaf.path for leaf in topic.leaves} | topic.skipped
        new = [path for path in layout.slots if path not in known]
        new += [(*path, MOST_ELEMENTS) for path in layout.cut if path not in topic.long and path not in topic.skipped]
        return cls(layout, tuple(new))

    def columns(self, topic: Topic, rows: npt.NDArray[np.uint8]) -> Columns:
        n = rows.shape[0]
        result = Columns(
            np.arange(n),
            {},
            {},
            [Wrong(k, path_name(topic.name, path), None, "") for path in self.new for k in range(n)],
        )
        for leaf in topic.leaves:
            slot = self.layout.slots.get(leaf.path)
            if slot is not None:
                result.values[leaf.name] = self._values(rows, *slot)
            elif leaf.dtype == "str":
                result.values[leaf.name] = np.full(n, None, object)
            elif leaf.dtype == "float64":
                result.values[leaf.name] = np.full(n, np.nan)
            else:
                result.values[leaf.name] = np.zeros(n, leaf.dtype)
                result.flags[leaf.name] = np.full(n, MISSING)
        return result

    def _values(self, rows: npt.NDArray[np.uint8], kind: str, at: int, size: int) -> Array:
        part = np.ascontiguousarray(rows[:, at : at + size])
        if kind == "string":
            return _texts(part)
        if kind == "?":
            truth: Array = part[:, 0] != 0
            return truth
        values = part.view(self.layout.order + kind)[:, 0]
        natural: Array = values.astype(_NATURAL.get(kind, "int64"))
        return natural


def _texts(part: npt.NDArray[np.uint8]) -> Array:
    """Rows of bytes as texts."""
    result = np.empty(part.shape[0], object)
    if not part.shape[1] or (part == part[0]).all():
        result[:] = part[0].tobytes().removesuffix(b"\0").decode("utf-8", "backslashreplace")
        return result
    whole, size = part.tobytes(), part.shape[1]
    result[:] = [
        whole[k : k + size].removesuffix(b"\0").decode("utf-8", "backslashreplace") for k in range(0, len(whole), size)
    ]
    return result
