"""Lines of a time and of names with their values: a column a name, wherever it stands; others are lost and told."""

from __future__ import annotations

from collections.abc import Callable
from datetime import datetime, timedelta
from pathlib import Path

import numpy as np
import pytest

from thermodata.errors import FormatError
from thermodata.plugin import Array, Block, Loss, Source
from thermodata.reader.text import delimited
from thermodata.reader.text.cells.lines.named_values import in_columns, named_values

START = datetime(2026, 3, 2, 8)
N = 60


def written(path: Path, line: Callable[[str, int], str]) -> Path:
    stamps = [(START + timedelta(seconds=30 * k)).isoformat(sep=" ") for k in range(N)]
    path.write_text("".join(f"{line(stamp, k)}\n" for k, stamp in enumerate(stamps)), "utf-8")
    return path


def read(path: Path) -> tuple[dict[str, Array], list[int], list[Loss]]:
    source = Source(timezone="UTC")
    table = delimited.open_table(path, source)
    items = list(delimited.blocks(path, table, source))
    held = [b for b in items if isinstance(b, Block)]
    values = {name: np.concatenate([b.values[name] for b in held]) for name in held[0].values}
    seconds = [int(t) // 10**9 - int((START - datetime(1970, 1, 1)).total_seconds()) for b in held for t in b.t_ns]
    return values, seconds, [x for x in items if isinstance(x, Loss)]


FORMS: dict[str, Callable[[str, int], str]] = {
    "blanks": lambda t, k: f"{t} T1={20 + k / 10:.2f} T2={24 - k / 10:.2f} n={100 * k}",
    "commas and colons": lambda t, k: f"{t}, T1: {20 + k / 10:.2f}, T2: {24 - k / 10:.2f}, n: {100 * k}",
    "brackets": lambda t, k: f"[{t}] T1={20 + k / 10:.2f}; T2={24 - k / 10:.2f}; n={100 * k}",
    "a named time": lambda t, k: f"ts={t} T1={20 + k / 10:.2f} T2={24 - k / 10:.2f} n={100 * k}",
    "decimal commas": lambda t, k: f"{t} T1={20 + k / 10:.2f} T2={24 - k / 10:.2f} n={100 * k}".replace(".", ","),
    "another order": lambda t, k: (
        f"{t} n={100 * k} T1={20 + k / 10:.2f} T2={24 - k / 10:.2f}"
        if k % 2
        else f"{t} T2={24 - k / 10:.2f} T1={20 + k / 10:.2f} n={100 * k}"
    ),
}


@pytest.mark.parametrize("form", FORMS)
def test_each_value_is_of_its_name(tmp_path: Path, form: str) -> None:
    values, seconds, losses = read(written(tmp_path / "a.log", FORMS[form]))
    assert not losses
    assert seconds == [30 * k for k in range(N)]
    np.testing.assert_allclose(values["T1"], 20 + np.arange(N) / 10)
    np.testing.assert_allclose(values["T2"], 24 - np.arange(N) / 10)
    np.testing.assert_array_equal(values["n"], 100 * np.arange(N))


def test_what_a_line_lacks_is_missing_and_what_is_no_such_line_is_lost_and_told(tmp_path: Path) -> None:
    def line(t: str, k: int) -> str:
        if k == 40:
            return f"{t} sensor T2 lost"
        return f"{t} T1[degC]={20 + k / 10:.2f}" + ("" if 10 <= k < 20 else f" T2={24 - k / 10:.2f}")

    values, seconds, losses = read(written(tmp_path / "a.log", line))
    assert seconds == [30 * k for k in range(N) if k != 40]
    assert np.isnan(values["T2"]).nonzero()[0].tolist() == list(range(10, 20))
    assert np.isfinite(values["T1[degC]"]).all()
    ((lost),) = losses
    assert "line 41" in lost.where


def test_units_behind_names_are_those_of_the_columns(tmp_path: Path) -> None:
    path = written(tmp_path / "a.log", lambda t, k: f"{t} T1[degC]={20 + k / 10:.2f} n[rpm]={k}")
    units = {s.name: s.unit for s in delimited.signals(delimited.open_table(path, Source(timezone="UTC")))}
    assert units == {"T1[degC]": "degC", "n[rpm]": "rpm"}


@pytest.mark.parametrize(
    "line",
    [
        lambda t, k: f"{t} INFO T1=2{k % 9}.5 T2=24.1",  # words between: a log of messages
        lambda t, k: f"t={k} T1=2{k % 9}.5 T2=24.1",  # of no date
    ],
)
def test_other_lines_that_name_their_values_are_refused_as_they_were(
    tmp_path: Path, line: Callable[[str, int], str]
) -> None:
    with pytest.raises(FormatError, match="name each of their values"):
        delimited.open_table(written(tmp_path / "a.log", line), Source())


def test_tables_with_such_cells_stay_as_they_are() -> None:
    rows = [f"2026-03-02 08:00:{k:02d};2{k % 9}.5;mode=3 tool=2" for k in range(30)]
    assert named_values(["time;T1;note", *rows]) == ()
    assert named_values([f"2026-03-02 08:00:{k:02d} 21.5 mode=3" for k in range(30)]) == ()
    assert in_columns("# a=1 b=2", ("a", "b")) == "# a=1 b=2"
