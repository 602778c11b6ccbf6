"""Times of day with dashes beside a date are asked for as what they are, and never read as dates."""

from __future__ import annotations

from datetime import datetime, timedelta
from pathlib import Path

import pytest

from thermodata.errors import QuestionError
from thermodata.plugin import Block, Source
from thermodata.reader.text import delimited
from thermodata.reader.text.clocks.odd_clocks import looks_like_dates

FIRST = datetime(2026, 3, 13, 8)


def written(folder: Path, head: str, forms: list[str], step: timedelta) -> Path:
    path = folder / "log.csv"
    rows = [";".join(f"{FIRST + k * step:{form}}" for form in forms) + f";{k / 10}" for k in range(200)]
    path.write_text("\n".join([f"{head};T1 [degC]", *rows, ""]), "utf-8")
    return path


@pytest.mark.parametrize("day", ["%Y-%m-%d", "%d.%m.%Y", "%d-%m-%y"])
@pytest.mark.parametrize("step", [timedelta(seconds=10), timedelta(milliseconds=250), timedelta(minutes=20)])
@pytest.mark.parametrize("turned", [False, True])
def test_a_time_of_dashes_beside_a_date_is_asked_with_its_format(
    tmp_path: Path, day: str, step: timedelta, turned: bool
) -> None:
    if step < timedelta(seconds=1) and turned:
        return
    head, forms = ("Time;Date", ["%H-%M-%S", day]) if turned else ("Date;Time", [day, "%H-%M-%S"])
    path = written(tmp_path, head, forms, step)
    with pytest.raises(QuestionError) as caught:
        delimited.open_table(path, Source())
    time = {"column": [2, 1] if turned else [1, 2], "format": f"{day} %H-%M-%S"}
    assert caught.value.declare == {"time": time}
    source = Source(timezone="UTC", table={"time": time})
    table = delimited.open_table(path, source)
    times = [int(t) for b in delimited.blocks(path, table, source) if isinstance(b, Block) for t in b.t_ns]
    whole = [(FIRST + k * step).replace(microsecond=0) for k in range(200)]
    assert [t // 10**9 for t in times] == [int((w - datetime(1970, 1, 1)).total_seconds()) for w in whole]


def test_dates_of_two_digits_beside_dates_are_no_times(tmp_path: Path) -> None:
    path = written(tmp_path, "Date;Calibrated", ["%Y-%m-%d %H:%M:%S", "01-02-26"], timedelta(seconds=10))
    assert delimited.describe(delimited.open_table(path, Source()), Source()).start_ns == 1773388800 * 10**9
    assert not looks_like_dates([f"{FIRST + timedelta(days=k):%d-%m-%y}" for k in range(60)])
    assert not looks_like_dates([f"{FIRST + timedelta(days=k):%m-%d-%y}" for k in range(60)])
    assert not looks_like_dates(["", None, 5.0])


@pytest.mark.parametrize("form", ["%H.%M.%S", "%H-%M-%S"])
def test_a_time_that_may_be_a_date_in_all_rows_is_none(form: str) -> None:
    assert looks_like_dates([f"{datetime(2026, 3, 2, 10, 10) + k * timedelta(seconds=1):{form}}" for k in range(90)])
    assert not looks_like_dates([f"{datetime(2023, 3, 2) + timedelta(days=k):%y-%m-%d}" for k in range(60)])


@pytest.mark.parametrize("clock", ["%H.%M.%S", "%H.%M"])
@pytest.mark.parametrize("day", ["%d.%m.%Y", "%Y-%m-%d"])
def test_a_time_of_points_beside_a_date_is_asked_with_its_format(tmp_path: Path, day: str, clock: str) -> None:
    step = timedelta(minutes=1) if clock == "%H.%M" else timedelta(seconds=10)
    path = written(tmp_path, "Date;Time", [day, clock], step)
    with pytest.raises(QuestionError) as caught:
        delimited.open_table(path, Source())
    time = {"column": [1, 2], "format": f"{day} {clock}"}
    assert caught.value.declare == {"time": time}
    source = Source(timezone="UTC", table={"time": time})
    table = delimited.open_table(path, source)
    times = [int(t) for b in delimited.blocks(path, table, source) if isinstance(b, Block) for t in b.t_ns]
    assert [t // 10**9 for t in times] == [
        int((FIRST + k * step - datetime(1970, 1, 1)).total_seconds()) for k in range(200)
    ]


def test_a_time_of_points_whose_day_may_be_a_month_names_both_formats(tmp_path: Path) -> None:
    rows = [f"06/07/2026;{datetime(2026, 7, 6, 8) + k * timedelta(seconds=10):%H.%M.%S};{k / 10}" for k in range(200)]
    (tmp_path / "log.csv").write_text("\n".join(["Data;Ora;T1 [degC]", *rows, ""]))
    with pytest.raises(QuestionError) as caught:
        delimited.open_table(tmp_path / "log.csv", Source())
    assert caught.value.declare == {"time": {"column": [1, 2], "format": "unknown"}}
    assert "%m/%d/%Y %H.%M.%S or %d/%m/%Y %H.%M.%S?" in caught.value.ask


def test_numbers_with_a_unit_of_time_are_no_times_of_points(tmp_path: Path) -> None:
    path = written(tmp_path, "Date;Time [h]", ["%Y-%m-%d", "%H.%M"], timedelta(minutes=1))
    assert delimited.open_table(path, Source(timezone="UTC")).layout.time == (1,)


@pytest.mark.parametrize("clock", ["%H.%M.%S", "%H-%M-%S"])
def test_a_time_that_looks_like_dates_is_asked_without_a_date_beside_it(tmp_path: Path, clock: str) -> None:
    path = written(tmp_path, "Time", [clock], timedelta(seconds=10))
    with pytest.raises(QuestionError) as caught:
        delimited.open_table(path, Source())
    assert caught.value.declare == {"time": {"column": 1, "format": clock}}
    source = Source(table=caught.value.declare)
    table = delimited.open_table(path, source)
    times = [int(t) for b in delimited.blocks(path, table, source) if isinstance(b, Block) for t in b.t_ns]
    assert [(t - times[0]) // 10**9 for t in times] == [10 * k for k in range(200)]
