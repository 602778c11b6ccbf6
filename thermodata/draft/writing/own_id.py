"""The id of a folder's campaign: one that no other campaign of the store at hand has."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from contextlib import suppress
from itertools import count
from pathlib import Path

from thermodata.draft.words.naming import plain
from thermodata.errors import ThermodataError
from thermodata.schema.files.load import load_campaign

# of a folder in which every campaign keeps its logs
_SAYS_NOTHING = re.compile(
    r"(?i)(raw|roh|log|mess|test)?[ _-]?(data|daten|logs?|files)|raw|messung(en)?|measurements?|mereni|měření|"
    r"donnees|données|brutes|mesures|datos|mediciones|dati|misure|dados|dane|pomiary|csv|export|数据|原始数据|データ|测量数据"
)
NOTHING_HELD: Mapping[str, str] = {}


def id_of(folder: Path, held: Mapping[str, str] = NOTHING_HELD) -> str:
    """The folder's name, or that of the nearest one above it that says more than 'raw'; with that of the next one
    above, or else a number, where another campaign has it. held: id -> path of its campaign file."""
    out = folder / "campaign.yaml"
    return next(name for name in _ids(folder) if name not in held or _is_its(name, held[name], out))


def taken_by_another(folder: Path, name: str, held: Mapping[str, str]) -> tuple[str, str] | None:
    """(the id that a folder's campaign would have, the file of the other one that has it) where its own is `name`
    instead, as `id_of` drafts it; None else."""
    first = next(_ids(folder))
    return (first, held[first]) if first != name == id_of(folder, held) else None


def _ids(folder: Path) -> Iterator[str]:
    path = folder.resolve()
    telling = [p.name for p in (path, *path.parents) if p.name and not _SAYS_NOTHING.fullmatch(p.name)] or [path.name]
    first = _as_id(telling[0]) or "campaign"
    yield first
    if len(telling) > 1 and (above := _as_id(telling[1])):
        yield f"{above}-{first}"[:100]
    yield from (f"{first}-{n}" for n in count(2))


def _as_id(name: str) -> str:
    return re.sub(r"[^A-Za-z0-9._-]+", "-", name if name.isascii() else plain(name)).strip("-._")[:100]


def _is_its(name: str, path: str, out: Path) -> bool:
    """Whether the campaign of that id is this one: from here, or drafted before, wherever it stood when it was
    ingested."""
    with suppress(ThermodataError, OSError):
        if load_campaign(out).id == name:
            return True
    return bool(path) and Path(path).parent.resolve() == out.parent.resolve()
