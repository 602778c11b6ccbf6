"""Blocks that stand beside each other in a text, each with its own time, and a date in the title above it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from thermodata_reader_table import Reader

from thermodata.plugin import Source
from thermodata.testing.reader import Data, load

NAMES = ["Ora", "dZ [um]", "T naso [C]"]


def read(folder: Path, titles: tuple[str, str], mark: str = ";", blank: bool = True, **table: object) -> Data:
    """Two blocks of 60 and 40 rows, a minute apart, from 08:00 and from 09:30."""
    between = [""] if blank else []
    one, other = ([t, "", ""] if isinstance(t, str) else t for t in titles)
    lines = [[*one, *between, *other], [*NAMES, *between, *NAMES]]
    for k in range(60):
        left = [f"{8 + k // 60:02d}:{k % 60:02d}:00", f"{k / 10:.1f}", "22.5"]
        right = [f"{9 + (30 + k) // 60:02d}:{(30 + k) % 60:02d}:00", f"{k / 5:.1f}", "23.5"] if k < 40 else [""] * 3
        lines.append([*left, *between, *right])
    path = folder / "prove.csv"
    path.write_text("\n".join(mark.join(line) for line in [*lines, []]), encoding="utf-8")
    return load(Reader(), path, Source(timezone="UTC", table=table or None))


def firsts(data: Data) -> list[str]:
    return [str(np.datetime64(int(t_ns[0]), "ns").astype("datetime64[m]")) for t_ns in data.t_ns.values()]


@pytest.mark.parametrize("mark", [";", "\t", ","])
@pytest.mark.parametrize("blank", [True, False])
@pytest.mark.parametrize(
    "titles",
    [
        ("Prova 1  15/06/2026", "Prova 2  16/06/2026"),
        ("Prova S4000  2026-06-15", "Prova S8000  2026-06-16"),
        ("Messung 15.06.2026", "Messung 16.06.2026"),
        ("S4000 (15.06.2026)", "S8000 (16.06.2026)"),
        (["Prova 1", "15/06/2026", ""], ["Prova 2", "16/06/2026", ""]),
    ],
)
def test_each_block_has_the_date_of_its_title(tmp_path: Path, titles: tuple[str, str], mark: str, blank: bool) -> None:
    data = read(tmp_path, titles, mark, blank)
    assert firsts(data) == ["2026-06-15T08:00", "2026-06-16T09:30"]
    assert [t_ns.size for t_ns in data.t_ns.values()] == [60, 40]
    assert sum("the date that stands above the rows" in n for n in data.recording.notes) == 2


@pytest.mark.parametrize(
    "titles",
    [
        ("Prova 1  15/06/2026", "Prova 2"),
        ("Kalibriert 15.06.2026", "Kalibriert 16.06.2026"),
        ("Report 15.06.2026", "Report 16.06.2026"),
        ("S4000 15.06.2026 16.06.2026", "S8000 17.06.2026"),
        ("S4000", "S8000"),
        ("v1.2.26.3", "v1.2.27.3"),
    ],
)
def test_titles_that_do_not_date_every_block_date_none(tmp_path: Path, titles: tuple[str, str]) -> None:
    data = read(tmp_path, titles)
    assert data.recording.clock == "relative"
    assert [int(t_ns[0]) // 60_000_000_000 for t_ns in data.t_ns.values()] == [0, 90]


def test_the_order_of_day_and_month_is_told_by_another_title_or_asked_and_answered(tmp_path: Path) -> None:
    assert firsts(read(tmp_path, ("S1 11/05/2026", "S2 13/05/2026"))) == ["2026-05-11T08:00", "2026-05-13T09:30"]
    either = ("S1 11/05/2026", "S2 12/05/2026")
    asked = read(tmp_path, either)
    assert asked.recording.clock == "relative"
    assert any("either way round" in n for n in asked.recording.notes)
    assert firsts(read(tmp_path, either, time={"start": "dmy"})) == ["2026-05-11T08:00", "2026-05-12T09:30"]
    assert firsts(read(tmp_path, either, time={"start": "mdy"})) == ["2026-11-05T08:00", "2026-12-05T09:30"]
    assert read(tmp_path, either, time={"start": "none"}).recording.clock == "relative"


def test_starts_of_blocks_that_count_are_their_own(tmp_path: Path) -> None:
    lines = ["Start 2026-06-15 08:00:00;;;Start 2026-06-16 09:30:00;", "t [min];dZ [um];;t [min];dZ [um]"]
    lines += [f"{k};{k / 10};;{k / 2};{k / 5}" for k in range(60)]
    (tmp_path / "a.csv").write_text("\n".join([*lines, ""]))
    data = load(Reader(), tmp_path / "a.csv", Source(timezone="UTC"))
    assert firsts(data) == ["2026-06-15T08:00", "2026-06-16T09:30"]
    assert [int(t[-1] - t[0]) // 30_000_000_000 for t in data.t_ns.values()] == [118, 59]
