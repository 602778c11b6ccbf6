"""Rows of several names, each before its value."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from thermodata_reader_table import Reader

from thermodata.errors import FormatError
from thermodata.plugin import Block, Loss, Source
from thermodata.reader.contract.guard import described, guarded
from thermodata.reader.finding.match import match_signal

from .test_sheets import sheet, workbook


def names_of(path: Path) -> list[str]:
    return [s.name for s in Reader().describe(path, Source()).signals]


@pytest.mark.parametrize("header", [[], ["when;Sensor A;x;Sensor B;y"]])
def test_names_that_change_their_places_from_row_to_row_are_refused(tmp_path: Path, header: list[str]) -> None:
    pairs = [("T_front", 21.5), ("T_rear", 20.5)]
    rows = [
        f"2026-03-12 08:{k:02d}:00;" + ";".join(f"{n};{v}" for n, v in (pairs if k < 20 else pairs[::-1]))
        for k in range(40)
    ]
    path = tmp_path / "pairs.csv"
    path.write_text("\n".join([*header, *rows, ""]))
    if header:  # what nobody calls a name of something may be anything
        assert names_of(path)
        return
    with pytest.raises(FormatError, match="rows of several names, each before its value") as said:
        names_of(path)
    assert "time,channel,value,channel,value" in str(said.value)


@pytest.mark.parametrize("words", [("ON", "OFF"), ("um", "mm"), ("T_front", "T_front"), ("12a", "12b")])
def test_words_before_numbers_that_stay_or_are_states_are_no_names_that_move(
    tmp_path: Path, words: tuple[str, str]
) -> None:
    turned = words[0] == "ON"
    rows = [
        f"2026-03-12 08:{k:02d}:00;{words[turned and k > 20]};21.5;{words[not (turned and k > 20)]};20.5"
        for k in range(40)
    ]
    path = tmp_path / "words.csv"
    path.write_text("\n".join([*rows, ""]))
    assert names_of(path) == ["column 2", "column 3", "column 4", "column 5"]


def pairs(missing: str) -> list[list[str]]:
    """Rows of a time and three names, each before its value; holes: a name and a value, or a value alone."""
    rows = []
    for k in range(60):
        cells = [f"2026-03-12T08:{k:02d}:00Z"]
        for n, name in enumerate(("T_front [degC]", "T_air", "disp_z")):
            hole = k % (7 + n) == 3 and n < 2
            cells += [name if missing == "value" or not hole else "", "" if hole else f"{20 + n + k / 100:.2f}"]
        rows.append(cells)
    return rows


@pytest.mark.parametrize("missing", ["both", "value"])
def test_names_that_stay_before_their_values_are_those_of_the_columns_also_beside_holes(
    tmp_path: Path, missing: str
) -> None:
    path = tmp_path / "pairs.csv"
    path.write_text("\n".join([*(",".join(r) for r in pairs(missing)), ""]))
    recording = Reader().describe(path, Source())
    values = [s for s in recording.signals if s.dtype == "float64"]
    assert [(s.name, s.unit) for s in values] == [("T_front [degC]", "degC"), ("T_air", None), ("disp_z", None)]
    assert any("called by the words before their values" in n for n in recording.notes)


@pytest.mark.parametrize("other", ["header", "number", "once", "no name"])
def test_other_tables_keep_their_names(tmp_path: Path, other: str) -> None:
    rows = pairs("both")
    if other == "header":
        rows = [["time", *(f"c{k}" for k in range(6))], *rows]
    elif other == "number":  # which no word names
        rows = [[*r, str(k)] for k, r in enumerate(rows)]
    elif other == "once":
        rows = [r[:3] for r in rows]
    else:
        rows[3][1], rows[3][2] = "", "20.5"
    path = tmp_path / "pairs.csv"
    path.write_text("\n".join([*(",".join(r) for r in rows), ""]))
    assert not {"T_front [degC]", "T_air"} & set(names_of(path))


def later(rows: int, to: int) -> list[list[str]]:
    """Rows of two names, the first another one from a row on."""
    return [
        [
            f"2026-03-12 {8 + k // 3600:02d}:{k // 60 % 60:02d}:{k % 60:02d}",
            "T_front" if k < to else "T_rear",
            f"{20 + k / 1000:.3f}",
            "T_air",
            f"{21 + k / 1000:.3f}",
        ]
        for k in range(rows)
    ]


@pytest.mark.parametrize("quote", ["", '"'])
def test_values_behind_another_name_are_lost_to_the_column_and_told(tmp_path: Path, quote: str) -> None:
    path = tmp_path / "pairs.csv"
    rows = [[r[0], f"{quote}{r[1]}{quote}", *r[2:]] for r in later(3000, 2000)]
    path.write_text("\n".join([*(",".join(r) for r in rows), ""]))
    reader, source = Reader(), Source(timezone="UTC")
    read = list(guarded(reader, path, source, described(reader, path, source)))
    front, air = (
        np.concatenate([b.values[name] for b in read if isinstance(b, Block)]) for name in ("T_front", "T_air")
    )
    assert np.isfinite(front[:2000]).all()
    assert np.isnan(front[2000:]).all()
    assert np.isfinite(air).all()
    losses = [x for x in read if isinstance(x, Loss)]
    assert losses
    assert {x.signal for x in losses} == {"T_front"}
    assert "line 2001" in losses[0].where
    assert "got one behind 'T_rear'" in losses[0].reason


def test_so_are_those_of_a_workbook(tmp_path: Path) -> None:
    path = tmp_path / "pairs.xlsx"
    rows: list[list[object]] = [[r[0], r[1], float(r[2]), r[3], float(r[4])] for r in later(600, 400)]
    workbook(path, {"log": sheet(rows)})
    reader, source = Reader(), Source(timezone="UTC")
    recording = described(reader, path, source)
    assert match_signal("column 3", recording.signals).name == "T_front"
    read = list(guarded(reader, path, source, recording))
    (front,) = (b.values["T_front"] for b in read if isinstance(b, Block))
    assert np.isfinite(front[:400]).all()
    assert np.isnan(front[400:]).all()
    (loss,) = (x for x in read if isinstance(x, Loss))
    assert loss.signal == "T_front"
    assert "T_rear" in loss.reason
    assert "row 401" in loss.where


def test_a_column_that_is_called_by_words_goes_by_its_place_too(tmp_path: Path) -> None:
    path = tmp_path / "pairs.csv"
    path.write_text("\n".join([*(",".join(r) for r in pairs("both")), ""]))
    signals = Reader().describe(path, Source()).signals
    found = [match_signal(name, signals).name for name in ("column 3", "column 5", "T_front", "column 2")]
    assert found == ["T_front [degC]", "T_air", "T_front [degC]", "column 2"]
