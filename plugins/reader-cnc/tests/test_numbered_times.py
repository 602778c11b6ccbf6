"""Times in numbers since 1970, and lines parted by '|' that no adapter of MTConnect wrote."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from thermodata_reader_cnc import Reader
from thermodata_reader_cnc.mtconnect import shdr
from thermodata_reader_cnc.opcua import long_table

from thermodata.errors import QuestionError, UsageError
from thermodata.plugin import Source
from thermodata.testing.reader.case import Data, load

from .logs import written

SIX = int(np.datetime64("2026-04-13T06:00:00", "ns").astype(np.int64))
EPOCH_S = 1776060000


def read(tmp_path: Path, text: str, **table: object) -> Data:
    source = Source(table={"time": table}) if table else Source()
    return load(Reader(), written(tmp_path, text, "log.txt"), source)


def rows(stamp: str, between: str, unit: bool, n: int = 40) -> str:
    """Lines of dX [um] and T_bed [degC], every 10 s. stamp: of second k, in Python's own."""
    lines = []
    for k in range(n):
        at = eval(f"f'{stamp}'", {"k": 10 * k})
        for name, value, word in (("dX", f"{k / 10:.3f}", "um"), ("T_bed", f"{21 + k / 100:.2f}", "degC")):
            lines.append(between.join([at, name, value, *([word] if unit else [])]))
    return "\n".join(lines) + "\n"


@pytest.mark.parametrize("between", [",", ";", "\t", "|"])
@pytest.mark.parametrize(
    ("stamp", "behind_ns"),
    [
        ("{1776060000 + k}", 0),
        ("{1776060000 + k}.5", 500_000_000),
        ("{1776060000 + k}000", 0),
        ("{2461143.75 + k / 86400:.9f}", 0),
    ],
)
def test_a_long_table_of_seconds_since_1970_is_read(tmp_path: Path, between: str, stamp: str, behind_ns: int) -> None:
    head = between.join(["ts", "kanal", "wert", "einheit"])
    data = read(tmp_path, f"{head}\n{rows(stamp, between, unit=True)}")
    assert data.recording.clock == "absolute"
    assert np.abs(data.t_ns["nc"] - (SIX + behind_ns + 10_000_000_000 * np.arange(40))).max() < 100_000
    assert data.values["nc", "dX"][-1] == 3.9
    assert {s.name: s.unit for s in data.recording.signals} == {"dX": "um", "T_bed": "degC"}
    assert not data.losses


def test_numbers_of_another_size_are_no_seconds_since_1970() -> None:
    lines = ["ts,tag,value", *(f"{100 * k},T1,20.5" for k in range(40))]
    assert long_table.claims(lines) is None


@pytest.mark.parametrize("unit", [False, True])
@pytest.mark.parametrize("stamp", ["{1776060000 + k}", "{1776060000 + k}000", "{2461143.75 + k / 86400:.9f}"])
def test_lines_of_pipes_without_names_are_dated_by_their_numbers(tmp_path: Path, stamp: str, unit: bool) -> None:
    data = read(tmp_path, rows(stamp, "|", unit))
    assert data.recording.clock == "absolute"
    assert np.abs(data.t_ns["nc"] - (SIX + 10_000_000_000 * np.arange(40))).max() < 100_000
    assert data.values["nc", "dX"][-1] == 3.9
    assert {s.name: s.unit for s in data.recording.signals} == (
        {"dX": "um", "T_bed": "degC"} if unit else {"dX": None, "T_bed": None}
    )


def test_a_unit_behind_each_value_is_no_message(tmp_path: Path) -> None:
    text = rows("2026-04-13T06:{k // 60:02d}:{k % 60:02d}", "|", unit=True) + "2026-04-13T06:30:00|dX|0.004|mm\n"
    data = read(tmp_path, text)
    assert {s.name: s.unit for s in data.recording.signals} == {"dX": "um", "T_bed": "degC"}
    assert data.values["nc", "dX"][-1] == 4.0  # um


def test_the_text_of_a_message_is_no_unit(tmp_path: Path) -> None:
    text = "".join(f"2026-04-13T06:00:{k:02d}Z|Xabs|{k}\n2026-04-13T06:00:{k:02d}Z|msg|{k}|V\n" for k in range(20))
    assert {s.name for s in read(tmp_path, text).recording.signals} == {"Xabs", "msg", "msg[code]"}


def test_numbers_from_a_start_at_a_rate_are_asked_and_declared(tmp_path: Path) -> None:
    text = rows("{k}", "|", unit=False)
    with pytest.raises(QuestionError, match="times without a unit") as asked:
        read(tmp_path, text)
    assert asked.value.declare == {"time": {"unit": "unknown"}}
    with pytest.raises(UsageError, match="times in 'h'"):
        read(tmp_path, text, unit="h")
    for unit, step_ns in (("s", 10**10), ("ms", 10**7)):
        assert read(tmp_path, text, unit=unit).t_ns["nc"][1] == step_ns


def test_names_of_columns_are_no_report() -> None:
    assert shdr.claims(["ts|kanal|wert", *(f"{k}|dX|1.5" for k in range(40))]) is None


@pytest.mark.parametrize(("step", "asks"), [(0.5, True), (3.7, True), (12.5, False), (250.0, False)])
def test_numbers_so_close_that_no_control_reports_so_often_are_asked(tmp_path: Path, step: float, asks: bool) -> None:
    """Seconds with decimals, as loggers of one's own write them; an adapter's milliseconds lie further apart."""
    stamps = np.cumsum(step * np.random.default_rng(1).uniform(0.8, 1.2, 40))
    text = "".join(f"{t:.3f}|dX|{k / 10}\n" for k, t in enumerate(stamps))
    if not asks:
        assert read(tmp_path, text).t_ns["nc"][-1] == pytest.approx(stamps[-1] * 1e6, rel=1e-4)
        return
    with pytest.raises(QuestionError, match="times without a unit"):
        read(tmp_path, text)
    assert read(tmp_path, text, unit="s").t_ns["nc"][-1] == pytest.approx(stamps[-1] * 1e9, rel=1e-4)
