"""Rows of settings with a label before their cells, above rows that have none."""

from __future__ import annotations

from pathlib import Path

import pytest
from thermodata_reader_table import Reader

from thermodata.errors import QuestionError
from thermodata.plugin import Source
from thermodata.testing.reader.case import Data, load

ROWS = [(f"{k / 100:.3f}", f"{-k / 50:.3f}", f"{20 + k / 1000:.3f}") for k in range(60)]
GERMAN = """\
Channel;dX;dY;T_Bett
Unit;um;um;°C
Range;500;500;100
Offset;0;0;0
Rate [Hz];0,1;0,1;0,1
"""
YOKOGAWA = """\
"Header Size",14
"Model Name","DL850E"
"TraceName","X","Y","Tbed"
"BlockSize",60,60,60
"VUnit","um","um","C"
"SampleRate",1.0E-01,1.0E-01,1.0E-01
"HResolution",1.000000E+01,1.000000E+01,1.000000E+01
"HUnit","s","s","s"
"Date","2026/04/07","2026/04/07","2026/04/07"
"Time","12:59:50.00","12:59:50.00","12:59:50.00"

"""


def read(path: Path, text: str) -> Data:
    path.write_text(text, encoding="utf-8")
    with pytest.raises(QuestionError, match="no time column found") as asked:
        load(Reader(), path, Source())
    assert asked.value.declare == {"time": {"period": "10 s"}}
    assert "every 10 s, as '" in asked.value.ask
    return load(Reader(), path, Source(table=asked.value.declare))


def units(data: Data) -> dict[str, str | None]:
    return {s.name: s.unit for s in data.recording.signals}


def test_settings_above_rows_without_a_label_are_no_data(tmp_path: Path) -> None:
    rows = "\n".join(";" + ";".join(row).replace(".", ",") for row in ROWS)
    data = read(tmp_path / "a.csv", f"{GERMAN}{rows}\n")
    assert units(data) == {"Channel": None, "dX": "um", "dY": "um", "T_Bett": "°C"}
    assert [float(v) for v in next(v for (_, n), v in data.values.items() if n == "dX")] == [k / 100 for k in range(60)]
    assert any("'Range', 'Offset', 'Rate [Hz]'" in n for n in data.recording.notes)
    assert not data.losses


def test_a_recorder_says_its_names_units_and_resolution_by_labels(tmp_path: Path) -> None:
    rows = "\n".join("," + ",".join(row) for row in ROWS)
    data = read(tmp_path / "a.csv", f"{YOKOGAWA}{rows}\n")
    assert units(data) == {"TraceName": None, "X": "um", "Y": "um", "Tbed": "C"}
    assert len(next(v for (_, n), v in data.values.items() if n == "X")) == 60


def test_a_word_that_marks_the_first_row_is_no_label(tmp_path: Path) -> None:
    rows = "\n".join(";".join(["Start" if not k else "", *row]) for k, row in enumerate(ROWS))
    (tmp_path / "a.csv").write_text(f"Marker;dX;dY;T\n{rows}\n")
    data = load(Reader(), tmp_path / "a.csv", Source(table={"time": {"period": "10 s"}}))
    assert len(next(v for (_, n), v in data.values.items() if n == "dX")) == 60
