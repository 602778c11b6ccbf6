"""What the campaign file before a draft declared of clocks and tables, each for the source that it was of: zones, which
are kept, and what is not."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import yaml

from thermodata.draft.folder.into_sources.sources import Group
from thermodata.draft.folder.into_sources.sources_before import files_of_sources
from thermodata.errors import ThermodataError
from thermodata.reader.times.open_questions import UNKNOWN
from thermodata.reader.times.zone import zone as zone_called
from thermodata.schema.files.tests_from import pattern_of
from thermodata.schema.strict.lines import read_document
from thermodata.schema.words.sentences import with_count

_LINE = re.compile(r"""^[^#\n]*?(?:\b(\w+):\s*\{[^#\n]*)?\btimezone:\s*["']?([\w/+-]+)""", re.MULTILINE)
_SHOWN = 4
_NOT_KEPT = ("clock", "table", "options")  # of a source, which a draft makes by itself, and may make otherwise


@dataclass(frozen=True, slots=True)
class ZonesBefore:
    """zones: source -> its zone, '' where it can't be told; files: source -> its patterns, and those of its tests;
    declared: source -> its keys of `_NOT_KEPT`."""

    zones: Mapping[str, str] = field(default_factory=dict)
    files: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    declared: Mapping[str, Mapping[str, Mapping[str, Any]]] = field(default_factory=dict)

    def of(self, group: Group) -> str | None:
        """The zone that was declared for the files of a source: by the source that they were of, whatever it is called
        now, else by its name; of a file that names no files, with one zone in all, that one. None where none was."""
        every = set(self.zones.values())
        if len(every) < 2 and not self.files:
            return next(iter(every), None)
        return self.zones.get(self._source_of(group))

    def answered(self, group: Group) -> Mapping[str, Any]:
        """The table of a source, with the answers to what it leaves open."""
        return _filled(group.table, self.declared.get(self._source_of(group), {}).get("table", {}))

    def dropped(self, group: Group, clock: bool) -> str | None:
        """What to ask of what was declared for a source and is not in its draft; None where nothing was. clock: whether
        the draft declares its clock."""
        had = dict(self.declared.get(self._source_of(group), {}))
        if clock:
            had.pop("clock", None)
        table = self.answered(group)
        own = {**had, "table": {k: v for k, v in had.get("table", {}).items() if table.get(k) != v}}
        said = [f"{key}: {_flow(value)}" for key, value in own.items() if value]
        return f"{', '.join(said)}, as in the campaign file before? a draft does not keep it" if said else None

    def _source_of(self, group: Group) -> str:
        """The source that had the files of a group; its own name where none had them."""
        paths = [str(f.path) for f in (*group.files, *group.calibrations)]
        had = {s: sum(any(_fits(p, path) for p in own) for path in paths) for s, own in self.files.items()}
        most = max(had, key=lambda s: (had[s], s == group.source), default="")
        return most if had.get(most) else group.source

    def said(self) -> str:
        """What a question adds where it asks for a zone though some were declared; '' where none was."""
        if not self.zones:
            return ""
        each = [f"{zone} of {source}" if source.strip() else zone for source, zone in self.zones.items()]
        return f"; the campaign file before declares {with_count(each, _SHOWN)}"


def zones_before(path: Path) -> ZonesBefore:
    """Those of a campaign file, which need not be finished; none where there is no file."""
    try:
        text = path.read_text(encoding="utf-8", errors="replace")
    except OSError:
        return ZonesBefore()
    try:
        data = read_document(path).data or {}
    except ThermodataError:  # somebody is writing it
        found = {name or " " * k: zone for k, (name, zone) in enumerate(_LINE.findall(text), 1) if is_zone(zone)}
        return ZonesBefore(found)
    sources = data.get("sources")
    zones: dict[str, str] = {}
    declared: dict[str, dict[str, dict[str, Any]]] = {}
    for name, spec in (sources if isinstance(sources, dict) else {}).items():
        if not isinstance(spec, dict):
            continue
        declared[str(name)] = {key: _answered(spec[key]) for key in _NOT_KEPT if _is_dict(spec.get(key))}
        zone = spec.get("timezone")
        if isinstance(zone, str) and is_zone(zone):
            zones[str(name)] = zone
    return ZonesBefore(zones, files_of_sources(data), declared)


def is_zone(name: str) -> bool:
    """Whether a zone is called so."""
    try:
        zone_called(name)
    except ThermodataError:
        return False
    return True


def _answered(spec: Mapping[str, Any]) -> dict[str, Any]:
    return {str(k): v for k, v in spec.items() if UNKNOWN not in _flow(v)}


def _filled(table: Mapping[str, Any], answers: Any) -> dict[str, Any]:
    """A table with the answers in the place of what is unknown."""
    given = answers if _is_dict(answers) else {}
    made = {k: _filled(v, given.get(k)) if _is_dict(v) else v for k, v in table.items()}
    return {k: given.get(k, v) if v == UNKNOWN else v for k, v in made.items()}


def _flow(value: Any) -> str:
    """A value as one line of YAML."""
    return yaml.safe_dump(value, default_flow_style=True, width=10_000, sort_keys=False, allow_unicode=True).partition(
        "\n"
    )[0]


def _fits(pattern: str, path: str) -> bool:
    return pattern == path or pattern_of(pattern).fullmatch(path) is not None


def _is_dict(value: Any) -> bool:
    return isinstance(value, dict)
