"""A row of units with other cells than the names above it: refused where nobody can tell which unit is whose."""

from __future__ import annotations

from pathlib import Path

import pytest

from thermodata.errors import FormatError
from thermodata.plugin import Source
from thermodata.reader.text.tables.find_table import open_table

ROWS = [f"2026-03-02 08:{k:02d}:00;21.{k % 10};68.{k % 7};-0.0{k % 9}" for k in range(60)]


def _units(folder: Path, head: list[str], table: dict[str, object] | None = None) -> tuple[str | None, ...]:
    (folder / "a.csv").write_text("\n".join([*head, *ROWS]))
    return open_table(folder / "a.csv", Source(table=table)).layout.units


@pytest.mark.parametrize(
    "row", ["degC;degF;mm", "degC;degF;mm;", "degC;degF", "[degC];[degF];[mm]", "s;degC;degF;mm;um"]
)
@pytest.mark.parametrize("declared", [{}, {"header_rows": 2}, {"units_row": 2}])
def test_a_row_of_units_that_lost_a_cell_or_has_one_too_many_is_refused(
    tmp_path: Path, row: str, declared: dict[str, object]
) -> None:
    with pytest.raises(FormatError, match="row of units has") as told:
        _units(tmp_path, ["time;T_bearing;T_bed;dZ", row], declared or None)
    assert told.value.where == "a.csv line 2, names in line 1"


@pytest.mark.parametrize(
    ("row", "units"),
    [
        (";degC;degF;mm", [None, "degC", "degF", "mm"]),
        ("s;degC;degF;mm", ["s", "degC", "degF", "mm"]),
        ("s;degC;degF", ["s", "degC", "degF", None]),
        ("[];degC;degF;", [None, "degC", "degF", None]),
        ("TS;degC;degF;", [None, "degC", "degF", None]),
    ],
)
def test_cells_that_stand_below_their_names_are_units(tmp_path: Path, row: str, units: list[str | None]) -> None:
    found = _units(tmp_path, ["time;T_bearing;T_bed;dZ", row])
    assert list(found)[1:] == units[1:]


def test_declared_names_end_the_doubt(tmp_path: Path) -> None:
    names = ["time", "T1 [degC]", "T2 [degF]", "dZ [mm]"]
    found = _units(
        tmp_path, ["time;T_bearing;T_bed;dZ", "degC;degF;mm"], {"skip_rows": 2, "header_rows": 0, "names": names}
    )
    assert found == (None, "degC", "degF", "mm")


def test_a_time_in_the_last_column_leaves_the_units_before_it(tmp_path: Path) -> None:
    rows = [";".join([*r.split(";")[1:], r.split(";")[0]]) for r in ROWS]
    (tmp_path / "a.csv").write_text("\n".join(["T1;T2;dZ;time", "degC;degF;mm", *rows]))
    assert open_table(tmp_path / "a.csv", Source()).layout.units[:3] == ("degC", "degF", "mm")


def _of_a_recorder(folder: Path, channels: list[str], tags: list[str]) -> list[tuple[str | None, ...]]:
    """[names, units] of an export with rows of what each channel is, as recorders write them."""
    n = len(channels)
    rows = [f"2026/06/01 09:00:{k:02d}\t" + "\t".join(f"{21 + k % 7 / 10 + j}" for j in range(n)) for k in range(60)]
    head = [
        "YREC",
        "Measure Data\tVersion 1.00.00",
        "\t".join(["Ch", *channels, "Message"]),
        "\t".join(["Tag", *tags, ""]),
        "\t".join(["Unit", *("C" for _ in channels[:-1]), "mV", ""]),
        "\t".join(["Type", *("Meas" for _ in channels), "Message"]),
        "\t".join(["Kind", *("Inst" for _ in channels), "Count"]),
        "Sampling Data",
    ]
    (folder / "a.txt").write_text("\n".join([*head, *(r + "\t" for r in rows), ""]))
    layout = open_table(folder / "a.txt", Source(timezone="UTC")).layout
    return [layout.names, layout.units]


@pytest.mark.parametrize("left_out", [None, 1])
def test_names_of_a_recorder_are_those_of_its_tags_whichever_channels_it_has(
    tmp_path: Path, left_out: int | None
) -> None:
    channels, tags = ["001", "002", "003", "004"], ["T_front", "T_rear", "T_bed", "dZ"]
    kept = [k for k in range(4) if k != left_out]
    names, units = _of_a_recorder(tmp_path, [channels[k] for k in kept], [tags[k] for k in kept])
    assert list(names[1 : 1 + len(kept)]) == [tags[k] for k in kept]
    assert list(units[1 : 1 + len(kept)]) == [*("C" for _ in kept[:-1]), "mV"]
