"""What a dataTaker delivers: its schedules below each other, each a stream with its own time."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from thermodata_reader_table import Reader

from thermodata.errors import FormatError
from thermodata.plugin import Head, Source
from thermodata.testing.reader import Data, load

HEAD = '"Timestamp","TZ","Z (mV)","n (rpm)","A.ALnum","A.ALstate","A.ALtext","bed (degC)","hall (degC)"'


def at(seconds: int) -> str:
    return f"2026/03/17 09:{seconds // 60:02d}:{seconds % 60:02d}.000"


def fast(k: int, zone: str = "n") -> str:
    return f"{at(10 * k)},{zone},{k / 10},{4000 * (k > 3)}"


def slow(k: int, zone: str = "n") -> str:
    return f"{at(30 * k + 3)},{zone},,,,,,{21 + k / 10:.1f},{20 + k / 20:.2f}"


def read(folder: Path, lines: list[str]) -> Data:
    (folder / "a.csv").write_text("\r\n".join([*lines, ""]), encoding="utf-8")
    return load(Reader(), folder / "a.csv", Source(timezone="UTC"))


FAST, SLOW = [fast(k) for k in range(240)], [slow(k) for k in range(80)]


@pytest.mark.parametrize("head", [HEAD, f"DT80> {HEAD}"])
@pytest.mark.parametrize("mixed", [False, True])
def test_each_schedule_has_its_own_time(tmp_path: Path, head: str, mixed: bool) -> None:
    rows = sorted([*FAST, *SLOW]) if mixed else [*FAST, *SLOW]
    data = read(tmp_path, [head, *rows])
    assert not data.losses
    first, second = data.t_ns
    assert np.array_equal(np.diff(data.t_ns[first]), np.full(239, 10 * 10**9))
    assert np.array_equal(np.diff(data.t_ns[second]), np.full(79, 30 * 10**9))
    assert data.t_ns[second][0] - data.t_ns[first][0] == 3 * 10**9
    assert np.allclose(data.values[first, "Z (mV)"], np.arange(240) / 10)
    assert np.allclose(data.values[second, "bed (degC)"], np.round(21 + np.arange(80) / 10, 1))
    assert Reader().locate(tmp_path / "a.csv", Source(timezone="UTC"), second, 5) == (f"line {2 + rows.index(SLOW[5])}")


def test_a_file_whose_beginning_has_one_schedule_alone_is_claimed() -> None:
    start = "\r\n".join([HEAD, *FAST]).encode()
    assert Reader().sniff(Head("a.csv", 2 * len(start), start)) is not None


def test_a_text_of_an_alarm_is_kept_in_its_row(tmp_path: Path) -> None:
    alarm = f'{at(25)},n,,,1,1,"hot, so what"'
    data = read(tmp_path, [HEAD, *FAST[:3], alarm, *FAST[3:], *SLOW])
    first = next(iter(data.t_ns))
    texts = data.values[first, "A.ALtext"]
    assert [t for t in texts if t] == ["hot, so what"]
    assert not data.losses


def test_a_row_with_more_cells_than_the_header_is_lost_alone(tmp_path: Path) -> None:
    data = read(tmp_path, [HEAD, *FAST[:5], f"{FAST[5]},,,,,,,,9,9", *FAST[6:], *SLOW])
    assert len(data.losses) == 1
    assert next(iter(data.t_ns.values())).size == 239


def test_one_schedule_is_a_table_and_a_zone_that_it_says_is_kept(tmp_path: Path) -> None:
    one = read(tmp_path, ['"Timestamp","TZ","Z (mV)"', *(f"{at(k)},n,{k / 10}" for k in range(100))])
    assert [s.name for s in one.recording.signals] == ["Z (mV)"]
    assert next(iter(one.t_ns.values())).size == 100


def test_a_table_that_is_none_of_a_data_taker_still_loses_rows_that_are_too_short(tmp_path: Path) -> None:
    head = HEAD.replace("TZ", "Zone").replace(",n,", ",")
    with pytest.raises(FormatError, match="more cells than the rows"):
        read(tmp_path, [head, *FAST, *SLOW])


@pytest.mark.parametrize("many", [600, 20_000])
def test_schedules_follow_each_other_however_long_they_are(tmp_path: Path, many: int) -> None:
    """The rows of the second begin behind all lines by which a layout is known, or behind the first part of a file that
    is too long to look at whole."""
    begin = np.datetime64("2026-03-17T09:00:00")
    times = [str(begin + 10 * k).replace("-", "/").replace("T", " ") for k in range(many)]
    first = [f'{t},n,{k / 10},0,0,0,""' for k, t in enumerate(times)]
    second = [f"{t},n,,,,,,{21 + k / 1000:.3f},20.5" for k, t in enumerate(times[: many // 2])]
    data = read(tmp_path, [HEAD, *first, *second])
    assert not data.losses
    assert sorted(t.size for t in data.t_ns.values()) == [many // 2, many]
    bed = next(v for (_, name), v in data.values.items() if name == "bed (degC)")
    assert bed[-1] == pytest.approx(21 + (many // 2 - 1) / 1000, abs=1e-3)


def test_a_schedule_without_a_row_has_no_time_of_its_own(tmp_path: Path) -> None:
    data = read(tmp_path, [HEAD, *FAST])
    assert next(iter(data.t_ns.values())).size == 240
    assert not [s.name for s in data.recording.signals if "Timestamp" in s.name]


def test_one_that_nothing_sampled_shows_keeps_its_values_at_their_times(tmp_path: Path) -> None:
    """A few rows amid a long file."""
    begin = np.datetime64("2026-03-17T09:00:00")
    times = [str(begin + 10 * k).replace("-", "/").replace("T", " ") for k in range(40_000)]
    rows = [f'{t},n,{k / 10},0,0,0,""' for k, t in enumerate(times)]
    rows.insert(9_000, f"{times[8_999][:-1]}5,n,,,,,,21.5,20.5")
    data = read(tmp_path, [HEAD, *rows])
    (bed,) = [v for (_, name), v in data.values.items() if name == "bed (degC)"]
    assert list(bed[np.isfinite(bed)]) == [21.5]
