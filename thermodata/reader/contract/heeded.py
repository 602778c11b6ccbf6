"""What a reader never looks at of what its source declares: it would be ignored without a word, and is refused."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

from thermodata.errors import FAILED, UsageError
from thermodata.plugin import Reader, Recording, Source
from thermodata.reader.signals.series import NEVER

_NO_SUCH = "thermodata: a name that no file has"  # longer than a workbook's sheet can be


class _RefusedKey(NamedTuple):
    """A key that is refused where it is not looked at. other: what no file answers alike."""

    key: str
    other: Any
    what: str
    expected: str
    hint: str


_WATCHED = (
    _RefusedKey(
        "sheet",
        _NO_SUCH,
        "knows no sheets in such a file",
        "a source without table: {sheet: ...}, whose files are one test each",
        "take 'sheet' out of this source's table; a file that holds several tests is cut by 'window' in each",
    ),
    _RefusedKey(
        "series",
        [_NO_SUCH],
        "parts no rows by what they are of in such a file",
        "a source without table: {series: [...]}, whose signals are one sensor's each",
        "take 'series' out of this source's table, or write a row a value with time, name and value in its columns",
    ),
)


class _Heeded(dict[str, Any]):
    """A table's layout that knows which of its keys were looked at, and whether all were together, as by who copies
    it. What follows that may be the copying itself, and says nothing of a key."""

    def __init__(self, *said: Any) -> None:
        super().__init__(*said)
        self.seen: set[object] = set()
        self.together = False

    def _note_key(self, key: object) -> None:
        if not self.together:
            self.seen.add(key)

    def __getitem__(self, key: str) -> Any:
        self._note_key(key)
        return super().__getitem__(key)

    def __contains__(self, key: object) -> bool:
        self._note_key(key)
        return super().__contains__(key)

    def get(self, key: str, default: Any = None) -> Any:
        self._note_key(key)
        return super().get(key, default)

    def pop(self, key: str, *default: Any) -> Any:
        self._note_key(key)
        return super().pop(key, *default)

    def setdefault(self, key: str, default: Any = None) -> Any:
        self._note_key(key)
        return super().setdefault(key, default)

    def __iter__(self) -> Iterator[str]:
        self.together = True
        return super().__iter__()

    def keys(self) -> Any:
        self.together = True
        return super().keys()

    def values(self) -> Any:
        self.together = True
        return super().values()

    def items(self) -> Any:
        self.together = True
        return super().items()

    def copy(self) -> dict[str, Any]:
        self.together = True
        return super().copy()

    def __or__(self, other: Any) -> Any:
        self.together = True
        return super().__or__(other)

    def __ror__(self, other: Any) -> Any:
        self.together = True
        return super().__ror__(other)


class Watched:
    """A source as its reader is given it for a description. `refuse_ignored` says afterwards what the reader did not
    heed: a sheet of a file that has none, by which each test would get the whole file, or columns that name series,
    whose rows would stay one."""

    def __init__(self, source: Source) -> None:
        said = source.table or {}
        self._said = source
        # none says what is so where nothing is parted
        self._wanted = [w for w in _WATCHED if w.key in said and said[w.key] not in (None, NEVER)]
        self._table = _Heeded(said) if self._wanted else None
        self.source = source if self._table is None else replace(source, table=self._table)

    def refuse_ignored(self, reader: Reader, path: Path, said: Recording) -> None:
        """UsageError where such a key is declared and the reader did not ask for it, or copied the whole layout and
        describes one that no file has as it did this one. said: how it described the file."""
        for wanted in self._wanted:
            if self._table is None or wanted.key in self._table.seen:
                continue
            if self._table.together and not self._describes_any(reader, path, said, wanted):
                continue
            raise UsageError(
                f"reader '{reader.name}' {wanted.what}",
                where=path.name,
                expected=wanted.expected,
                got=f"{wanted.key}: {(self._said.table or {})[wanted.key]}",
                hint=wanted.hint,
            )

    def _describes_any(self, reader: Reader, path: Path, said: Recording, wanted: _RefusedKey) -> bool:
        """Whether a reader describes a file in the same way, whatever is declared."""
        other = {**(self._said.table or {}), wanted.key: wanted.other}
        try:
            return reader.describe(path, replace(self._said, table=other)) == said
        except FAILED:  # whatever it is that such a name is answered with: it was looked at
            return False
