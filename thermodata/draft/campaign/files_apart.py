"""The files of a folder by what each is for: logs, lists and tables of tests, what describes signals."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from thermodata.draft.folder.beside.legend import with_legends
from thermodata.draft.folder.beside.lists_of_tests import lists_apart, times_listed
from thermodata.draft.folder.beside.sensors_described import with_sensors_described
from thermodata.draft.folder.beside.table import find_table, is_called_table, most_rows
from thermodata.draft.folder.into_sources.sources import sources_of
from thermodata.draft.folder.into_tests.by_listed_times import parted_by_lists
from thermodata.draft.folder.into_tests.group import tests_of
from thermodata.draft.folder.into_tests.sensor_files import with_their_sensors
from thermodata.draft.folder.saved_twice import saved_once
from thermodata.draft.folder.scan import Scan
from thermodata.draft.probes.jumps import jump_of
from thermodata.draft.times.date_order import with_orders_told
from thermodata.draft.times.year_order import with_years_told


@dataclass(frozen=True, slots=True)
class FilesApart:
    """scan: what was found, its logs with all that files beside them say of their signals; texts: files that may say
    what tests are; unread: (path, what of it is not read) of a table of tests; through_tests: notes on logs that go on
    through several tests; legends: notes on files that describe signals."""

    scan: Scan
    texts: Sequence[str]
    unread: Sequence[tuple[str, str]]
    through_tests: Sequence[str]
    legends: Sequence[str]


def files_apart(folder: Path, found: Scan) -> FilesApart:
    """The files of a folder, each where it belongs."""
    found, unread = _table_apart(folder, found)
    found = saved_once(lists_apart(folder, found))
    logs, through = parted_by_lists(found.logs, [times_listed(folder, p) for p in found.others])
    found = replace(found, logs=with_their_sensors(with_orders_told(folder, with_years_told(folder, logs))))
    texts = [p for p, _ in found.ignored]  # one that says what signals are may say what tests are, too
    found, described = with_sensors_described(folder, found)
    found, legends = with_legends(folder, found)
    legends = [*described, *legends]
    unread = [x for x in unread if not any(told.startswith(f"{x[0]} says") for told in legends)]
    return FilesApart(found, texts, unread, through, legends)


def _table_apart(folder: Path, found: Scan) -> tuple[Scan, list[tuple[str, str]]]:
    """(what was found, a table of tests that a reader takes for a log among the others; its sheets that are not read,
    with why)."""
    early = _claimed_table(folder, found)
    if early is None:
        return found, []
    own = next(f for f in found.logs if str(f.path) == early)
    unread = [(early, f"its {note}") for note in own.recording.notes if re.match(r"sheet '.*' is not read", note)]
    logs = tuple(f for f in found.logs if str(f.path) != early)
    return replace(found, logs=logs, others=(*found.others, early)), unread


def _claimed_table(folder: Path, found: Scan) -> str | None:
    """A table of tests that a reader takes for a log, because it has a column of dates; what holds long logs is none,
    though a sheet beside them lists the tests."""
    most = most_rows(len(found.logs))
    small = [str(f.path) for f in found.logs if f.size < 200_000 and f.part is None and f.sample.rows <= most]
    called = [p for p in small if is_called_table(p)]
    jumps = [j.file for f in found.logs if (j := jump_of(f)) is not None and j.named]
    logs = [f for f in found.logs if str(f.path) not in called]
    holding = [(t, fs) for g in tests_of(sources_of(logs, jumps), ()) for t, fs in g.tests.items()]
    for candidates, by_number in ((called, True), ([p for p in small if p not in called], False)):
        for candidate in candidates[:20]:
            ids = list(dict.fromkeys(t for t, fs in holding if any(str(f.path) != candidate for f in fs)))
            stems = [f.path.stem for f in logs if str(f.path) != candidate]
            if any(find_table(folder, [candidate], names, by_number) for names in (ids, stems)):
                return candidate
    return None
