"""Files of one recording that overlap, and files into which a part was copied again."""

from __future__ import annotations

import io

import numpy as np
import pandas as pd
import pytest

from .conftest import Lab

T1 = {"T1": {"signal": "T", "quantity": "temperature", "unit": "degC", "at": "hall"}}
N, TWICE = 200, 11
ROWS = [(pd.Timestamp("2026-03-02T08:00:00") + pd.Timedelta(seconds=5 * k), 20 + k / 8) for k in range(N)]


def wide(rows: list[tuple[pd.Timestamp, float]]) -> bytes:
    return ("time;T\n" + "".join(f"{t:%Y-%m-%d %H:%M:%S};{v}\n" for t, v in rows)).encode()


def long(rows: list[tuple[pd.Timestamp, float]]) -> bytes:
    lines = (f"{t:%Y-%m-%d %H:%M:%S},T,{v}\n{t:%Y-%m-%d %H:%M:%S},n,{v * 4}\n" for t, v in rows)
    return ("time,tag,value\n" + "".join(lines)).encode()


def parquet(rows: list[tuple[pd.Timestamp, float]]) -> bytes:
    buffer = io.BytesIO()
    pd.DataFrame({"time": [t for t, _ in rows], "T": [v for _, v in rows]}).to_parquet(buffer)
    return buffer.getvalue()


KINDS = [(wide, "csv", "table"), (long, "csv", "cnc"), (parquet, "parquet", "table")]


@pytest.mark.parametrize(("kind", "suffix", "reader"), KINDS, ids=["wide", "long", "parquet"])
@pytest.mark.parametrize("files", [1, 2])
def test_what_stands_twice_moves_nothing_and_is_told(lab: Lab, kind, suffix: str, reader: str, files: int) -> None:  # type: ignore[no-untyped-def]
    parts = [ROWS[:100], ROWS[100 - TWICE :]]
    for k, part in enumerate(parts if files == 2 else [parts[0] + parts[1]]):
        lab.write(f"raw/{k}.{suffix}", kind(part))
    said = lab.ingest(T1, {"reader": reader})
    assert said.code == 0, said.err
    assert "set back" not in said.out
    t_s, values = lab.values("T1")
    fresh = np.concatenate([[True], np.diff(t_s) > 0])
    np.testing.assert_allclose(t_s[fresh], np.arange(N) * 5.0)
    np.testing.assert_array_equal(values[fresh], 20 + np.arange(N) / 8)
    if files == 2 or kind is not long:  # what stands near within one log of changes is sorted in where it is read
        assert f"{TWICE} rows repeat earlier ones" in said.out
        assert fresh.all()
    else:
        assert "duplicate_time" in said.out


def test_a_copy_in_the_middle_of_a_recording_loses_nothing(lab: Lab) -> None:
    lab.write("raw/a.csv", wide(ROWS))
    lab.write("raw/b.csv", wide(ROWS[100:150]))
    said = lab.ingest(T1)
    assert said.code == 0, said.err
    assert "50 rows repeat earlier ones" in said.out
    np.testing.assert_array_equal(lab.values("T1")[0], np.arange(N) * 5.0)


def test_a_clock_that_was_set_back_is_still_joined(lab: Lab) -> None:
    lab.write("raw/a.csv", wide([*ROWS[:100], *((t - pd.Timedelta(seconds=55), v) for t, v in ROWS[100:])]))
    said = lab.ingest(T1)
    assert said.code == 0, said.err
    assert "the clock was set back once" in said.out
    np.testing.assert_array_equal(lab.values("T1")[0], np.arange(N) * 5.0)


def test_a_row_behind_what_was_left_out_is_traced_to_its_line(lab: Lab) -> None:
    lab.write("raw/a.csv", wide(ROWS[:100]))
    lab.write("raw/b.csv", wide(ROWS[100 - TWICE :]))
    lab.ingest(T1)
    traced = lab("trace", "odd", "one", "T1", "--at", "500 s", "--verify")
    assert traced.code == 0, traced.err
    assert f"line {TWICE + 2}" in traced.out
    assert "b.csv" in traced.out
