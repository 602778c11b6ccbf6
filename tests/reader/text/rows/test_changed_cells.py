"""Logs that write the changed cells alone: told by their cells, held over the empty ones, and no other table is."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest

from thermodata.errors import UsageError
from thermodata.plugin import Block, Source
from thermodata.reader.text import delimited
from thermodata.reader.text.rows.changed_cells import Standing, declared_standing, find_standing
from thermodata.schema.flag import Flag

N = 600
RNG = np.random.default_rng(5)
WARM = 20 + 8 * (1 - np.exp(-np.arange(N) / 200))
SPEED = np.where((np.arange(N) > 60) & (np.arange(N) < 480), 4000.0, 0.0)


def as_text(values: np.ndarray, step: float) -> list[str]:  # type: ignore[type-arg]
    return [f"{v:g}" for v in np.round(values / step) * step]


def changes(cells: Sequence[str], keyframe: int = 0) -> list[str]:
    """A cell where it differs from the one before, and in every n-th row."""
    return [c if not k or c != cells[k - 1] or (keyframe and k % keyframe == 0) else "" for k, c in enumerate(cells)]


T = as_text(WARM + RNG.normal(0, 0.1, N), 0.1)
POWER = as_text(180 + 0.1 * SPEED + RNG.normal(0, 4, N), 5)
FINE = as_text(WARM + RNG.normal(0, 0.02, N), 0.001)
S = as_text(SPEED, 1)


@pytest.mark.parametrize("keyframe", [0, 60])
def test_a_log_of_changed_cells_is_told_with_or_without_rows_of_all(keyframe: int) -> None:
    columns = {"T": changes(T, keyframe), "P": changes(POWER, keyframe), "S": changes(S, keyframe)}
    found, note = find_standing(columns)
    assert found == {"T", "P", "S"}
    assert "written where they change" in (note or "")


def test_a_set_speed_that_is_written_on_change_beside_sensors_that_are_not() -> None:
    found, note = find_standing({"T": T, "P": POWER, "S": changes(S)})
    assert found == {"S"}
    assert note is not None


def with_gaps(cells: Sequence[str], *, every: int = 0, share: float = 0.0) -> list[str]:
    lost = np.random.default_rng(3).random(len(cells)) < share
    return ["" if lost[k] or (every and k % every) else c for k, c in enumerate(cells)]


@pytest.mark.parametrize(
    "columns",
    [
        {"T": T, "P": POWER, "S": S},
        {"T": with_gaps(T, share=0.3), "P": POWER},  # a sensor that drops out repeats itself all the same
        {"T": with_gaps(FINE, share=0.3), "P": POWER},
        {"T": with_gaps(T, every=10), "P": POWER},  # read at another rate
        {"T": with_gaps(FINE, every=10), "P": FINE},
        {"T": [*FINE[:300], *[""] * 300], "P": FINE},  # a sensor that died
        {"n": [str(k // 10) if k % 10 == 0 else "" for k in range(N)], "P": FINE},  # what counts
        {"T": [*T[:100], *["NaN"] * 20, *changes(T)[120:]], "P": T},
    ],
)
def test_other_tables_with_empty_cells_are_read_as_they_stand(columns: dict[str, list[str]]) -> None:
    assert find_standing(columns) == (frozenset(), None)


def test_few_readings_that_nobody_sets_are_told_of_and_left_alone() -> None:
    hand = [""] * N
    for k, value in ((0, "20.31"), (170, "23.42"), (390, "27.07")):
        hand[k] = value
    found, note = find_standing({"T": FINE, "by hand": hand})
    assert not found
    assert "stands: [by hand]" in (note or "")


def test_what_stands_goes_on_over_blocks_with_its_flag_and_begins_with_the_first_written() -> None:
    column, nan = Standing(), np.nan
    values, flags = column.over(np.array([nan, 1.0, nan]), None, np.array([False, True, False]))
    np.testing.assert_array_equal(values, [nan, 1.0, 1.0])
    assert flags is None
    over = np.array([0, 4], np.uint16)
    values, flags = column.over(np.array([nan, nan]), over, np.array([False, True]))
    np.testing.assert_array_equal(values, [1.0, nan])
    assert flags is not None
    assert flags.tolist() == [0, 4]
    _, flags = column.over(np.array([nan, 2.0]), None, np.array([False, True]))
    assert flags is not None
    assert flags.tolist() == [int(Flag.SATURATED), 0]


def test_a_name_that_no_column_has_is_refused() -> None:
    with pytest.raises(UsageError, match="no column 'sped'"):
        declared_standing(["sped"], ["speed", "T"], "a.csv")
    assert declared_standing("all", ["speed", "T"], "a.csv") == {"speed", "T"}
    assert declared_standing("none", ["speed", "T"], "a.csv") == frozenset()


def written(path: Path, *columns: Sequence[str], newest_first: bool = False) -> Path:
    """Columns under T [degC], n [rpm] and mode; rows in which none is written are left out."""
    rows = [
        f"2026-03-01T08:{k // 60 % 60:02}:{k % 60:02}Z;" + ";".join(cells) if k < 3600 else ""
        for k, cells in enumerate(zip(*columns, strict=True))
        if any(cells)
    ]
    lines = ["time;T [degC];n [rpm];mode", *(rows[::-1] if newest_first else rows)]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def read(path: Path, source: Source) -> tuple[dict[str, bool], dict[str, np.ndarray], int]:  # type: ignore[type-arg]
    table = delimited.open_table(path, source)
    blocks = [b for b in delimited.blocks(path, table, source) if isinstance(b, Block)]
    values = {name: np.concatenate([b.values[name] for b in blocks]) for name in blocks[0].values}
    return {s.name: s.held for s in delimited.signals(table)}, values, sum(b.t_ns.size for b in blocks)


@pytest.mark.parametrize("block_rows", [7, 100_000])
def test_values_of_a_log_of_changes_stand_over_its_empty_cells(tmp_path: Path, block_rows: int) -> None:
    mode = ["AUTO" if k < 300 else "MDI" for k in range(N)]
    path = written(tmp_path / "a.csv", changes(T), changes(S), changes(mode))
    held, values, rows = read(path, Source(options={"block_rows": block_rows}))
    assert all(held.values())
    kept = [k for k in range(N) if not k or T[k] != T[k - 1] or S[k] != S[k - 1] or mode[k] != mode[k - 1]]
    assert rows == len(kept)
    assert values["T [degC]"].tolist() == [float(T[k]) for k in kept]
    assert values["n [rpm]"].tolist() == [float(S[k]) for k in kept]
    assert values["mode"].tolist() == [mode[k] for k in kept]


def test_the_campaign_file_has_the_last_word(tmp_path: Path) -> None:
    path = written(tmp_path / "a.csv", changes(T), changes(S), [""] * N)
    held, values, _ = read(path, Source(table={"stands": "none"}))
    assert not any(held.values())
    assert np.isnan(values["n [rpm]"]).sum() > 100
    held, values, _ = read(path, Source(table={"stands": ["n [rpm]"]}))
    assert held == {"T [degC]": False, "n [rpm]": True, "mode": False}
    assert np.isfinite(values["n [rpm]"]).all()


def test_a_log_that_stands_newest_first_is_left_as_it_is(tmp_path: Path) -> None:
    path = written(tmp_path / "a.csv", changes(T), changes(S), [""] * N, newest_first=True)
    held, _, _ = read(path, Source())
    assert not any(held.values())


def test_a_bad_quality_stands_as_long_as_its_value(tmp_path: Path) -> None:
    texts = changes(T)
    quality = ["192" if cell else "" for cell in texts]
    bad = next(k for k in range(50, N) if texts[k] and not texts[k + 1])
    quality[bad] = "0"
    rows = [f"2026-03-01T08:{k // 60:02}:{k % 60:02}Z;{texts[k]};{quality[k]};{k % 7}" for k in range(N)]
    path = tmp_path / "a.csv"
    path.write_text("\n".join(["time;T;T.Quality;n", *rows, ""]), encoding="utf-8")
    table = delimited.open_table(path, Source())
    flags = np.concatenate(
        [b.flags["T"] for b in delimited.blocks(path, table, Source()) if isinstance(b, Block) and b.flags]
    )
    until = next(k for k in range(bad + 1, N) if texts[k])
    assert np.flatnonzero(flags & Flag.NOT_MEASURING).tolist() == list(range(bad, until))


def test_few_whole_readings_in_a_unit_that_nobody_sets_are_left_alone() -> None:
    hand = [""] * N
    for k, value in ((0, "0"), (170, "3"), (390, "8"), (401, "10")):
        hand[k] = value
    assert find_standing({"T": FINE, "Dial [um]": hand})[0] == frozenset()
    assert find_standing({"T": FINE, "Dial": hand})[0] == {"Dial"}


def test_numbers_with_fractions_are_no_quality_and_a_unit_may_be_spelled_twice(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    rows = [f"2026-03-01T08:00:{k:02}Z;{30 + k};0.9{k:02}" for k in range(60)]
    path.write_text("\n".join(["time;Oil;Oil quality", *rows, ""]), encoding="utf-8")
    assert not delimited.open_table(path, Source()).qualities.of_values
    rows = [f"2026-03-01T08:00:{k:02}Z;{'C' if k < 30 else '°C'};{30 + k}" for k in range(60)]
    path.write_text("\n".join(["time;Unit;Value", *rows, ""]), encoding="utf-8")
    assert read(path, Source())[2] == 60
    assert delimited.signals(delimited.open_table(path, Source()))[1].unit == "C"


def test_a_column_that_is_sparse_behind_a_sound_head_is_proposed() -> None:
    turned = np.searchsorted([90, 130, 250, 390, 420], np.arange(N), side="right")
    speed = as_text(np.where(turned % 2, 4000.0, 0.0), 1)
    late = [*speed[:60], *changes(speed)[60:]]
    found, note = find_standing({"T": T, "n": late})
    assert not found
    assert "'n': most cells are empty" in (note or "")
    lost = [c if k < 120 or k % 10 == 0 else "" for k, c in enumerate(FINE)]  # at another rate from there on
    assert find_standing({"T": T, "F": lost}) == (frozenset(), None)


@pytest.mark.parametrize("told", ["column 3", "3", 3, "n"])
@pytest.mark.parametrize("head", ["time;T [degC];n [rpm];mode", None])
def test_a_column_is_declared_by_its_name_or_its_place(tmp_path: Path, told: str | int, head: str | None) -> None:
    path = written(tmp_path / "a.csv", changes(T), changes(S), [""] * N)
    lines = path.read_text(encoding="utf-8").splitlines(keepends=True)
    path.write_text("".join(([head + "\n"] if head else []) + lines[1:]), encoding="utf-8")
    source = Source(table={"stands": [told]})
    if head is None and told == "n":
        with pytest.raises(UsageError, match="no column 'n'"):
            read(path, source)
        return
    held, values, _ = read(path, source)
    (name,) = [name for name, stands in held.items() if stands]
    assert name == ("n [rpm]" if head else "column 3")
    assert np.isfinite(values[name]).all()


def test_a_column_called_by_the_word_before_its_values_is_declared_by_its_place_too(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    rows = [f"2026-03-01T08:{k // 60:02}:{k % 60:02}Z;T_front;{T[k]};speed;{s}" for k, s in enumerate(changes(S))]
    path.write_text("\n".join(rows) + "\n", encoding="utf-8")
    for told in ("column 5", "speed"):
        held, values, _ = read(path, Source(table={"stands": [told]}))
        assert [name for name, stands in held.items() if stands] == ["speed"]
        assert np.isfinite(values["speed"]).all()


def test_a_declared_column_without_a_cell_in_one_file_is_no_fault_of_it(tmp_path: Path) -> None:
    held, _, rows = read(written(tmp_path / "a.csv", T, [""] * N, [""] * N), Source(table={"stands": ["n", "mode"]}))
    assert rows == N
    assert not held["T [degC]"]
