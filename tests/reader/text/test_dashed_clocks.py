"""Times of day with dashes beside a date are asked for as what they are, and never read as dates."""

from __future__ import annotations

from datetime import datetime, timedelta
from pathlib import Path

import pytest

from thermodata.errors import QuestionError
from thermodata.plugin import Block, Source
from thermodata.reader.text import delimited
from thermodata.reader.text.clocks.odd_clocks import are_dashed_clocks

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
    assert not are_dashed_clocks([f"{FIRST + timedelta(days=k):%d-%m-%y}" for k in range(60)])
    assert not are_dashed_clocks([f"{FIRST + timedelta(days=k):%m-%d-%y}" for k in range(60)])
    assert not are_dashed_clocks(["", None, 5.0])
