"""What a query may do: read the store, and write files of its own elsewhere. Nothing writes into the store's folder but
this program."""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import Any

from thermodata.errors import UsageError

_READING = frozenset({"SELECT", "EXPLAIN", "PRAGMA", "CALL", "COPY", "MULTI"})  # MULTI is what PIVOT becomes
# that only look: others change settings, of which some make DuckDB write files
_LOOKING = re.compile(
    r"(?i)\s*(?:pragma|call)\s+(?:pragma_)?(?:table_info|show_tables|show_tables_expanded|show|database_list|"
    r"database_size|version|functions|storage_info|platform|user_agent|duckdb_\w+)\b"
)
# comments, quoted names and texts, brackets, words: enough to see what is outside of them
_TOKEN = re.compile(
    r"--[^\n]*|/\*.*?\*/|(?P<text>[eE]?'(?:[^']|'')*')|\"(?:[^\"]|\"\")*\"|(?P<mark>[()])|(?P<word>\w+)|\$\$.*?\$\$",
    re.DOTALL,
)


def check_statement(statement: Any, folder: Path) -> None:
    """UsageError where a statement of DuckDB's does more than read, or writes a file into the store's folder."""
    kind, text = statement.type.name, statement.query
    copies = any((m["word"] or "").casefold() == "copy" for m in _TOKEN.finditer(text))
    if kind not in _READING or (kind in ("PRAGMA", "CALL") and not _LOOKING.match(text)):
        raise _refusal(text, kind)
    if kind == "COPY":
        _check_target(text, folder)
    elif copies and kind in ("EXPLAIN", "MULTI"):
        raise _refusal(text, f"COPY inside of {kind}")


def _check_target(text: str, folder: Path) -> None:
    """COPY ... TO 'file': one file or folder that is named, and neither in the store nor around it."""
    depth, targets, before = 0, [], ""
    for match in _TOKEN.finditer(text):
        if match["mark"]:
            depth += 1 if match["mark"] == "(" else -1
        elif depth == 0 and match["text"] and before == "to":
            targets.append(match["text"])
        if match["word"] or match["text"] or match["mark"]:
            before = (match["word"] or "").casefold()
    if len(targets) != 1 or targets[0][0] != "'":
        raise _refusal(text, "COPY without one file that it names")
    name = targets[0][1:-1].replace("''", "'")
    target = _real_path(name[7:] if name.startswith("file://") else name)
    store = _real_path(folder)
    if target == store or store in target.parents or target in store.parents:
        raise UsageError(
            "a query writes nothing into the store's folder",
            where=text.strip()[:200],
            expected="a file outside of it",
            got=name,
            hint="name a file elsewhere; thermodata snapshot OUT.duckdb copies the store into one file",
        )


def _real_path(path: Path | str) -> Path:
    return Path(os.path.normcase(os.path.realpath(os.path.expanduser(path))))


def _refusal(text: str, got: str) -> UsageError:
    return UsageError(
        "a query only reads the store",
        where=text.strip()[:200],
        expected="SELECT, FROM, DESCRIBE, SHOW or COPY ... TO 'file'",
        got=got,
        hint="thermodata snapshot OUT.duckdb gives a file of your own to write in; thermodata forget removes a test",
    )
