"""Statistics below a table, and marks of its end: no rows, no losses, and told."""

from __future__ import annotations

from pathlib import Path

import pytest
from thermodata_reader_table import Reader

from thermodata.plugin import Source
from thermodata.testing.reader import Data, load

from .test_sheets import sheet, workbook

ROWS = "".join(f"{i / 2:.1f};{20 + i / 8:.3f};3000\n" for i in range(40))
SAID = "lines of statistics or of the end of the table are not read: "


def read(tmp_path: Path, text: str) -> Data:
    path = tmp_path / "log.csv"
    path.write_text("Zeit [s];T [°C];n [rpm]\n" + text, encoding="utf-8")
    return load(Reader(), path, Source(timezone="UTC"))


@pytest.mark.parametrize(
    ("footer", "said"),
    [
        ("Min;20.0;3000\nMax;25.1;3000\nMittelwert;22.5;3000\n", "'Min', 'Max', 'Mittelwert'"),
        ("\nMinimum:;20.0;3000\nStd.Abw.;0.1;-\n", "'Minimum:', 'Std.Abw.'"),
        (
            "最大値;25.1;3000\n最小値;20.0;3000\n平均値;22.5;3000\n標準偏差;1.1;0\n",
            "'最大値', '最小値', '平均値', '標準偏差'",
        ),
        ("Average;22.5\n", "'Average'"),
        ("END\n", "'END'"),
        ('"$RT_COUNT$";5965;;;;\n', "'$RT_COUNT$'"),
    ],
)
def test_a_footer_is_no_loss(tmp_path: Path, footer: str, said: str) -> None:
    data = read(tmp_path, ROWS + footer)
    assert data.t_ns["table"].size == 40
    assert data.losses == ()
    assert SAID + said in data.recording.notes


@pytest.mark.parametrize("line", ["garbage;20.0;3000", "Max;broken;3000", "Max", "min;2026-03-02;3000", ";20.0;3000"])
def test_what_is_no_footer_is_lost(tmp_path: Path, line: str) -> None:
    data = read(tmp_path, ROWS + line + "\n")
    assert len(data.losses) == 1
    assert not any(note.startswith(SAID) for note in data.recording.notes)


def test_rows_behind_statistics_are_rows(tmp_path: Path) -> None:
    data = read(tmp_path, ROWS + "Max;25.1;3000\n30.0;25.0;3000\n")
    assert data.t_ns["table"].size == 41
    assert data.losses == ()


@pytest.mark.parametrize("styles", [(), (1,)])
def test_a_footer_below_a_sheet_and_the_empty_row_above_it_are_no_losses(
    tmp_path: Path, styles: tuple[int, ...]
) -> None:
    rows: list[list[object]] = [["Zeit", "T [°C]"], *([46082 + i / 1440, 20.5] for i in range(40))]
    rows += [[None, None], ["Mittelwert", 20.5], ["lost", 20.5]]
    path = workbook(tmp_path / "x.xlsx", {"a": sheet(rows, styles)})
    data = load(Reader(), path, Source(timezone="UTC", table={"time": {"unit": "excel"}}))
    assert data.t_ns["table"].size == 40
    assert [loss.reason for loss in data.losses] == ["1 row without a time"]


def test_a_line_that_says_what_happened_is_no_loss_and_told(tmp_path: Path) -> None:
    data = read(tmp_path, f"{ROWS}20.0;EVENT: spindle on M3\n20.0;25.0;3000\n")
    assert not data.losses
    assert any("(1 line, the first is line 42): 'EVENT: spindle on M3'" in note for note in data.recording.notes)
    assert read(tmp_path, f"{ROWS}20.0;Overflow\n20.0;25.0;3000\n").losses


def test_lines_that_say_what_happened_are_told_with_their_count_and_the_first(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    rows = [f"{k};20.{k % 10};3000;1.5" for k in range(60)]
    rows[30] = rows[45] = "30;sensor lost"
    path.write_text("\n".join(["# logger: A", "Zeit [s];T [°C];n [rpm];P [kW]", *rows, ""]), encoding="utf-8")
    data = load(Reader(), path, Source(timezone="UTC"))
    assert not data.losses
    assert any("not read (2 lines, the first is line 33): 'sensor lost'" in note for note in data.recording.notes)


def test_a_line_of_words_behind_what_the_note_looked_at_is_a_loss(tmp_path: Path) -> None:
    """A large file is looked at in part, and nothing is passed over without a word."""
    rows = [f"{i};{20 + i % 7}.5;21.{i % 10}" for i in range(60_000)]
    rows[50_000] = "50000;sensor lost"
    path = tmp_path / "a.csv"
    path.write_text("t [s];T1 [degC];T2 [degC]\n" + "\n".join(rows) + "\n")
    data = load(Reader(), path, Source())
    assert [loss.where for loss in data.losses] == ["a.csv line 50002"]
    assert "sensor lost" in data.losses[0].reason
