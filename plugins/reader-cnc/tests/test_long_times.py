"""Long tables whose time is called in ways that no list of names holds, and says its zone."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from thermodata_reader_cnc import Reader
from thermodata_reader_cnc.opcua import long_table

from thermodata.plugin import Source
from thermodata.testing.reader import load

from .logs import written

EIGHT = np.datetime64("2026-03-02T08:00:00", "ns").astype(np.int64)
HOUR = 3600 * 10**9
ROWS = "".join(f"2026-03-02 08:{k:02d}:00,T{1 + k % 2},{20 + k},degC,Good\n" for k in range(40))


def read(tmp_path: Path, header: str, zone: str | None = None, rows: str = ROWS) -> tuple[int, tuple[str, ...]]:
    """(start, notes) of a long table below such a header."""
    path = written(tmp_path, f"{header}\n{rows}", "pi.csv")
    assert long_table.claims(path.read_text("utf-8").split("\n")) is not None
    data = load(Reader(), path, Source(timezone=zone))
    assert not data.losses
    assert sorted(n for _, n in data.values) == ["T1", "T2"]
    start = data.recording.start_ns
    assert start is not None
    assert start == min(int(t[0]) for t in data.t_ns.values())
    return start, data.recording.notes


@pytest.mark.parametrize(
    ("name", "zone", "start"),
    [
        ("Timestamp (UTC)", "UTC", EIGHT),
        ("timestamp_utc", "UTC", EIGHT),
        ("TimestampUTC", None, EIGHT),
        ("Zeitstempel (UTC)", "UTC", EIGHT),
        ("DateTime (UTC+2)", "Etc/GMT-2", EIGHT - 2 * HOUR),
        ("Timestamp [Europe/Berlin]", "Europe/Berlin", EIGHT - HOUR),
        ("Time [GMT-05:00]", "Etc/GMT+5", EIGHT + 5 * HOUR),
    ],
)
def test_a_zone_in_the_name_of_the_time_counts(tmp_path: Path, name: str, zone: str | None, start: int) -> None:
    found, notes = read(tmp_path, f"{name},Tag,Value,EngUnits,Status")
    assert found == start
    assert zone is None or any(f"times in {zone} by their header '{name}'" in n for n in notes)
    assert zone is None or not any("no time zone" in n for n in notes)
    declared, notes = read(tmp_path, f"{name},Tag,Value,EngUnits,Status", "Asia/Tokyo")
    assert zone is None or (declared == start and any("Asia/Tokyo is not used" in n for n in notes))


@pytest.mark.parametrize(
    "header",
    [
        "Timestamp (local),Tag,Value,EngUnits,Status",
        "Event Time,Tag,Value,UnitOfMeasure,Quality",
        "Sample Time (yyyy-mm-dd hh:mm:ss),Tag,Value,unit_of_measure,Quality",
        "时间,标签,值,单位,质量",
        "日時,タグ,値,単位,品質",
        "Horodatage,Tag,Valeur,Unité,Qualité",
        "Erfasst,Messstelle,Wert,Einheit,Status",
        "Fecha/Hora,Etiqueta,Valor,Unidad de medida,Estado",
    ],
)
def test_a_time_of_any_name_is_local_and_units_beside_it_count(tmp_path: Path, header: str) -> None:
    start, notes = read(tmp_path, header, "Europe/Prague")
    assert start == EIGHT - HOUR
    assert not any("is not used" in n for n in notes)
    signals = load(Reader(), tmp_path / "pi.csv", Source()).recording.signals
    assert [s.unit for s in signals] == ["degC", "degC"]


def test_of_two_times_in_two_zones_the_one_in_utc_counts(tmp_path: Path) -> None:
    rows = "".join(f"2026-03-02 09:{k:02d}:00,2026-03-02 08:{k:02d}:00,T{1 + k % 2},{20 + k}\n" for k in range(40))
    assert read(tmp_path, "Timestamp (local),Timestamp (UTC),Tag,Value", "Asia/Tokyo", rows)[0] == EIGHT


def test_a_table_without_dates_beside_tag_and_value_is_no_long_one_of_it(tmp_path: Path) -> None:
    rows = [f"{k},T{1 + k % 2},{20 + k}" for k in range(40)]
    assert long_table.claims(["Row,Tag,Value", *rows]) is None
    assert long_table.claims(["Timestamp (UTC),Tag,Value", *rows]) is None


def rows_of(*cells: str, name: str = "") -> str:
    """40 rows of two tags, or of one name. cells: of a row, where WHEN, TAG and VALUE stand for its own."""
    text = ",".join(cells)
    each = (("WHEN", "2026-03-02 08:{0:02d}:00"), ("TAG", name or "T{1}"), ("VALUE", "{0}.5"), ("OTHER", "2{0}.25"))
    for word, own in each:
        text = text.replace(word, own)
    return "".join(text.format(k, 1 + k % 2) + "\n" for k in range(40))


@pytest.mark.parametrize(
    ("header", "cells"),
    [
        ("Calibrated,Tag,Value,When", ("2019-01-01 00:00:00", "TAG", "VALUE", "WHEN")),
        ("Due,Tag,Value,When", ("2027-01-0{1} 00:00:00", "TAG", "VALUE", "WHEN")),
        ("Tag,Due,Value,Erfasst", ("TAG", "2027-01-01 00:00:00", "VALUE", "WHEN")),
    ],
)
def test_the_time_is_the_date_that_goes_on(tmp_path: Path, header: str, cells: tuple[str, ...]) -> None:
    assert read(tmp_path, header, "UTC", rows_of(*cells))[0] == EIGHT


@pytest.mark.parametrize(
    ("header", "wide"),
    [
        ("Datum,Name,Wert,T_Lager [°C]", True),
        ("Erfasst,Name,Wert,T2", True),
        ("Time,Name,Value,T_Lager [°C]", True),
        ("Time,Name,Value,Raw", False),  # as exports are that name a tag in each row
    ],
)
def test_a_wide_log_that_names_its_operator_is_no_long_one(header: str, wide: bool) -> None:
    rows = rows_of("WHEN", "TAG", "VALUE", "OTHER", name="Meier").split("\n")
    assert (long_table.claims([header, *rows]) is None) == wide
    assert long_table.claims([header, *rows_of("WHEN", "TAG", "VALUE", "OTHER").split("\n")]) is not None
