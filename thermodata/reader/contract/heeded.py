"""What a reader never looks at of what its source declares: it would be ignored without a word, and is refused."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

from thermodata.errors import FAILED, UsageError
from thermodata.plugin import Reader, Recording, Source

_SHEET = "sheet"
_NO_SHEET = "thermodata: a sheet that no file has"  # longer than a workbook's can be


class _Heeded(dict[str, Any]):
    """A table's layout that knows which of its keys were looked at, and whether all were together, as by who copies
    it. What follows that may be the copying itself, and says nothing of a key."""

    def __init__(self, *said: Any) -> None:
        super().__init__(*said)
        self.seen: set[object] = set()
        self.together = False

    def _look(self, key: object) -> None:
        if not self.together:
            self.seen.add(key)

    def __getitem__(self, key: str) -> Any:
        self._look(key)
        return super().__getitem__(key)

    def __contains__(self, key: object) -> bool:
        self._look(key)
        return super().__contains__(key)

    def get(self, key: str, default: Any = None) -> Any:
        self._look(key)
        return super().get(key, default)

    def pop(self, key: str, *default: Any) -> Any:
        self._look(key)
        return super().pop(key, *default)

    def setdefault(self, key: str, default: Any = None) -> Any:
        self._look(key)
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
    heed: a sheet of a file that has none, by which each test would get the whole file."""

    def __init__(self, source: Source) -> None:
        self._said = source
        self._wanted = (source.table or {}).get(_SHEET)
        self._table = _Heeded(source.table) if source.table and self._wanted is not None else None
        self.source = source if self._table is None else replace(source, table=self._table)

    def refuse_ignored(self, reader: Reader, path: Path, said: Recording) -> None:
        """UsageError where a sheet is declared and the reader asked for none, or copied the whole layout and describes
        a sheet that no file has as it did this one. said: how it described the file."""
        if self._table is None or _SHEET in self._table.seen:
            return
        if self._table.together and not self._describes_any(reader, path, said):
            return
        raise UsageError(
            f"reader '{reader.name}' knows no sheets in such a file",
            where=path.name,
            expected="a source without table: {sheet: ...}, whose files are one test each",
            got=f"sheet: {self._wanted}",
            hint="take 'sheet' out of this source's table; a file that holds several tests is cut by 'window' in each",
        )

    def _describes_any(self, reader: Reader, path: Path, said: Recording) -> bool:
        """Whether a reader describes a file in the same way, whatever sheet is declared."""
        other = {**(self._said.table or {}), _SHEET: _NO_SHEET}
        try:
            return reader.describe(path, replace(self._said, table=other)) == said
        except FAILED:  # whatever it is that such a sheet is answered with: it was looked at
            return False
