"""Times of day in a file whose name has the date: the start of its test, and the next day's
file that goes on with it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import yaml

from .conftest import Said

Say = Callable[..., Said]


def _drafted(folder: Path, say: Say, files: dict[str, tuple[float, float]], date: str = "") -> list[dict[str, Any]]:
    """files: name -> from and to [h of a day]."""
    folder.mkdir(exist_ok=True)
    for name, (begin, end) in files.items():
        seconds = range(round(begin * 3600), round(end * 3600), 20)
        rows = [f"{date}{t // 3600:02d}:{t // 60 % 60:02d}:{t % 60:02d}\t{20 + t / 9e3:.3f}" for t in seconds]
        (folder / name).write_text("\n".join(["Time\tT_bed (C)", *rows, ""]), encoding="utf-8")
    assert say("init", folder).code == 0
    tests = yaml.safe_load((folder / "campaign.yaml").read_text(encoding="utf-8"))["tests"]
    return [{k: t.get(k) for k in ("id", "start", "files")} for t in tests]


@pytest.mark.parametrize("name", ["Thermo_{}.txt", "{}.txt", "log-{}.txt"])
def test_the_start_and_what_goes_on_behind_midnight(tmp_path: Path, say: Say, name: str) -> None:
    names = [name.format(f"202604{day:02d}") for day in (7, 8, 9)]
    files = {names[0]: (20.0, 24.0), names[1]: (0.0, 4.0), names[2]: (8.0, 13.0)}
    stem = [n.removesuffix(".txt") for n in names]
    assert _drafted(tmp_path, say, files) == [
        {"id": stem[0], "start": "2026-04-07 20:00:00", "files": {"log": names[:2]}},
        {"id": stem[2], "start": "2026-04-09 08:00:00", "files": {"log": names[2]}},
    ]


@pytest.mark.parametrize(
    ("first", "second"), [((8.0, 12.0), (0.0, 4.0)), ((20.0, 24.0), (0.5, 4.0)), ((20.0, 23.5), (0.0, 4.0))]
)
def test_what_does_not_go_on_stays_apart(
    tmp_path: Path, say: Say, first: tuple[float, float], second: tuple[float, float]
) -> None:
    found = _drafted(tmp_path, say, {"Thermo_20260407.txt": first, "Thermo_20260408.txt": second})
    assert [t["id"] for t in found] == ["Thermo_20260407", "Thermo_20260408"]
    assert all(t["start"] for t in found)


def test_rows_with_dates_and_names_without_say_no_start(tmp_path: Path, say: Say) -> None:
    dated = {"Thermo_20260407.txt": (8.0, 12.0), "Thermo_20260409.txt": (8.0, 12.0)}
    assert [t["start"] for t in _drafted(tmp_path / "dated", say, dated, "2026-04-07 ")] == [None, None]
    numbered = {"run_1.txt": (20.0, 24.0), "run_2.txt": (0.0, 4.0)}
    assert [t["start"] for t in _drafted(tmp_path / "numbered", say, numbered)] == [None, None]


def test_tests_of_other_names_stay_apart_though_one_ends_where_the_other_begins(tmp_path: Path, say: Say) -> None:
    files = {"S4000_20260407.txt": (20.0, 24.0), "S8000_20260408.txt": (0.0, 4.0)}
    found = _drafted(tmp_path, say, files)
    assert [t["id"] for t in found] == ["S4000_20260407", "S8000_20260408"]
