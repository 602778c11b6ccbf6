"""What a reader never looks at of what its source declares: it would be ignored without a word, and is refused."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

from thermodata.errors import UsageError
from thermodata.plugin import Source

_SHEET = "sheet"


class _Heeded(dict[str, Any]):
    """A table's layout that knows which of its keys were looked at; whoever copies it looks at all."""

    def __init__(self, *said: Any) -> None:
        super().__init__(*said)
        self.seen: set[object] = set()

    def __getitem__(self, key: str) -> Any:
        self.seen.add(key)
        return super().__getitem__(key)

    def get(self, key: str, default: Any = None) -> Any:
        self.seen.add(key)
        return super().get(key, default)

    def __iter__(self) -> Iterator[str]:
        self.seen.update(super().keys())
        return super().__iter__()


class Watched:
    """A source as its reader is given it for a description. `refuse_ignored` says afterwards what the reader did not
    heed: a sheet of a file that has none, by which each test would get the whole file."""

    def __init__(self, source: Source) -> None:
        wanted = (source.table or {}).get(_SHEET)
        self._table = _Heeded(source.table) if source.table and wanted is not None else None
        self.source = source if self._table is None else replace(source, table=self._table)

    def refuse_ignored(self, reader: str, path: Path) -> None:
        """UsageError where a sheet is declared and the reader asked for none."""
        if self._table is None or _SHEET in self._table.seen:
            return
        raise UsageError(
            f"reader '{reader}' knows no sheets in such a file",
            where=path.name,
            expected="a source without table: {sheet: ...}, whose files are one test each",
            got=f"sheet: {dict.get(self._table, _SHEET)}",
            hint="take 'sheet' out of this source's table; a file that holds several tests is cut by 'window' in each",
        )
