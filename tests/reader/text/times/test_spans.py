"""Spans of time as programs write them: times of their own, and other texts that look like them."""

from __future__ import annotations

from collections.abc import Callable
from datetime import timedelta
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from thermodata_reader_table import Reader

from thermodata.errors import ThermodataError
from thermodata.plugin import Block, Source
from thermodata.reader.text import delimited
from thermodata.reader.text.times.one_cell.spans import SPAN, are_spans, is_span
from thermodata.reader.times.zone import NAT
from thermodata.testing.reader import load

ROWS, START_S = 300, 86_400 - 1_000
S = 10**9


def dotnet(s: int) -> str:
    days, clock = divmod(START_S + s, 86_400)
    return (f"{days}." if days else "") + f"{clock // 3600:02d}:{clock // 60 % 60:02d}:{clock % 60:02d}"


def pandas(s: int) -> str:
    return f"{s // 86_400} days {s // 3600 % 24:02d}:{s // 60 % 60:02d}:{s % 60:02d}"


def python(s: int) -> str:
    days, clock = divmod(START_S + s, 86_400)
    return (f"{days} day, " if days else "") + f"{clock // 3600}:{clock // 60 % 60:02d}:{clock % 60:02d}"


def iec(s: int) -> str:
    return f"T#{s // 3600}h{s // 60 % 60}m{s % 60}s" if s >= 3600 else f"T#{s // 60}m{s % 60}s"


def read(folder: Path, head: str, written: Callable[[int], str], table: dict[str, object] | None = None) -> list[int]:
    """Times of rows [ns], 20 s apart, since the first."""
    rows = [f'"{written(20 * k)}",{20 + k % 9}.5,{k % 4}.25' for k in range(ROWS)]
    (folder / "log.csv").write_text("\n".join([f"{head},T1 [degC],Z [um]", *rows, ""]), "utf-8")
    source = Source(table=table)
    found = delimited.open_table(folder / "log.csv", source)
    assert delimited.describe(found, source).of_day_ns is None
    blocks = [b for b in delimited.blocks(folder / "log.csv", found, source) if isinstance(b, Block)]
    t_ns = np.concatenate([b.t_ns for b in blocks])
    return (t_ns - t_ns[0]).tolist()


@pytest.mark.parametrize(
    ("head", "written"),
    [
        ("Elapsed", dotnet),
        ("", pandas),
        ("Time", python),
        ("Time", lambda s: f"{s} sec"),
        ("Time", lambda s: f"{s / 60:.6f} min"),
        ("Zeit", iec),
        ("Time", lambda s: f"PT{s // 60}M{s % 60}S"),
        ("Elapsed Time", lambda s: f"{s // 60}m{s % 60}.000s"),
    ],
    ids=["dotnet", "pandas", "python", "matlab", "matlab minutes", "iec", "iso", "go"],
)
def test_spans_are_times(tmp_path: Path, head: str, written: Callable[[int], str]) -> None:
    found = read(tmp_path, head, written)
    assert np.abs(np.array(found) - 20 * S * np.arange(ROWS)).max() <= 60_000  # digits of a minute


def counted_down(written: Callable[[timedelta], str]) -> Callable[[int], str]:
    return lambda s: written(timedelta(seconds=s - 100))


@pytest.mark.parametrize("written", [str, lambda d: f"{d.days} days +{str(d).rpartition(' ')[2]:0>8}"])
def test_times_before_a_start_are_negative(tmp_path: Path, written: Callable[[timedelta], str]) -> None:
    """As Python and pandas write them: only the days are."""
    assert read(tmp_path, "Time", counted_down(written)) == [20 * S * k for k in range(ROWS)]


@pytest.mark.parametrize("digits", range(10))
def test_parts_of_a_nanosecond_are_rounded(digits: int) -> None:
    assert SPAN.reads is not None
    for whole in (0, 1, 12, 1_234_567):
        text = f"{whole}.{'5' * digits or '0'}"
        assert [SPAN.reads(f"{text} {unit}") for unit in ("ns", "us", "min")] == [
            round(Fraction(text) * ns) for ns in (1, 1000, 60 * S)
        ]


@pytest.mark.parametrize(
    ("cell", "seconds"),
    [
        ("1.02:03:04.5", 93_784.5),
        ("-00:00:10", -10),
        ("-1.02:03:04", -93_784),
        ("-1 days +23:59:50", -10),
        ("-1 days +23:59:50.250000", -9.75),
        ("-1 day, 23:59:50", -10),
        ("-2 days, 0:00:00", -172_800),
        ("-1 days -02:03:04", -93_784),
        ("1 day -00:00:10", 86_390),
        ("1 day 00:00:10", 86_410),
        ("2 days", 172_800),
        ("0 days", 0),
        ("P1DT1S", 86_401),
        ("0,5 s", 0.5),
        ("T#100ms", 0.1),
        ("LTIME#5us", 5e-6),
        ("T#1d2h", 93_600),
        ("1h 2m 3s", 3723),
        ("10µs", 1e-5),
    ],
)
def test_what_a_span_says(cell: str, seconds: float) -> None:
    assert SPAN.reads is not None
    assert SPAN.reads(cell) == round(seconds * S)


@pytest.mark.parametrize(
    "cell",
    [
        "",
        "10 m",
        "10",
        "10.25",
        "10.25.",
        "10 µS",
        "5 K",
        "1.25:00:00",
        "10 s 1 h",
        "1.2.3",
        "P",
        "PT",
        "P5M",
        "T#",
        "10 V",
        "spindle",
        "08:00",
        "x 1 s",
    ],
)
def test_other_texts_are_no_spans(cell: str) -> None:
    assert SPAN.reads is not None
    assert SPAN.reads(cell) == NAT
    assert not is_span(cell)


def test_a_clock_is_no_span_and_a_damaged_one_makes_none() -> None:
    clocks = [f"08:{k:02d}:00" for k in range(60)]
    assert not are_spans(clocks)
    assert not are_spans([*clocks[:30], "1.08:30:00", *clocks[31:]])
    assert are_spans([*clocks, "1.08:30:00"])


def test_a_dwell_beside_the_time_is_none(tmp_path: Path) -> None:
    rows = [f"{20 * k},{k} sec,{20 + k % 9}.5" for k in range(60)]
    (tmp_path / "log.csv").write_text("\n".join(["Time [s],Dwell,T1 [degC]", *rows, ""]))
    table = delimited.open_table(tmp_path / "log.csv", Source())
    assert table.layout.time == (0,)


def test_spans_under_another_name_are_asked_about(tmp_path: Path) -> None:
    rows = [f"{k} sec,{20 + k % 9}.5,1.5" for k in range(60)]
    (tmp_path / "log.csv").write_text("\n".join(["Dwell,T1 [degC],T2 [degC]", *rows, ""]))
    with pytest.raises(ThermodataError, match="no time column found"):
        delimited.open_table(tmp_path / "log.csv", Source())
    table = delimited.open_table(tmp_path / "log.csv", Source(table={"time": {"column": "Dwell"}}))
    assert table.groups[0].formats == (SPAN,)


def test_the_row_times_of_a_timetable_are_its_time(tmp_path: Path) -> None:
    """MATLAB's writetimetable calls them so."""
    rows = [f"{10 * k} sec,{20 + k / 100}" for k in range(60)]
    (tmp_path / "m.csv").write_text("\n".join(["RowTimes,T_bed", *rows, ""]), encoding="utf-8")
    data = load(Reader(), tmp_path / "m.csv", Source())
    assert set(np.diff(data.t_ns["table"]).tolist()) == {10_000_000_000}
