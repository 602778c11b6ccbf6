"""A clock that was set back in the middle of a file: asked before an ingest loses what follows."""

from __future__ import annotations

import random
from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path

import pytest

from tests.commands import Say


def _asked(folder: Path, say: Say, seconds: Sequence[int], values: Sequence[float] | None = None) -> str:
    for test in ("R1", "R2"):
        at = range(0, 10 * len(seconds), 10) if test == "R1" else seconds
        rows = [
            f"2026-04-26T{8 + t // 3600:02d}:{t // 60 % 60:02d}:{t % 60:02d}Z,{value:.3f}"
            for t, value in zip(at, values or [20 + k / 99 for k in range(len(at))], strict=True)
        ]
        (folder / f"{test}.csv").write_text("\n".join(["time,T_bed [degC]", *rows, ""]), encoding="utf-8")
    assert say("init", folder).code == 0
    text = (folder / "campaign.yaml").read_text(encoding="utf-8")
    return next((line for line in text.splitlines() if "resets: allow" in line), "")


EVEN = [10 * k for k in range(400)]


@pytest.mark.parametrize(("by", "told"), [(137, "2 min 7 s"), (150, "2 min 20 s"), (3600, "59 min 50 s")])
def test_a_long_step_back_is_asked(tmp_path: Path, say: Say, by: int, told: str) -> None:
    asked = _asked(tmp_path, say, [t if t < 2000 else t - by for t in [*EVEN, *(4000 + t for t in EVEN)]])
    assert f"the clock of R2.csv goes back by {told} (from 2026-04-26 08:33:10 UTC to " in asked
    assert " UTC) at row 201, and what follows is lost: was the clock set back there?" in asked
    assert "# ?" in asked


@pytest.mark.parametrize("by", [0, 60, 130, -600])
def test_what_a_time_server_corrects_and_pauses_are_not(tmp_path: Path, say: Say, by: int) -> None:
    assert _asked(tmp_path, say, [t if t < 2000 else t - by for t in EVEN]) == ""


def test_strays_copied_rows_and_newest_first_are_not(tmp_path: Path, say: Say) -> None:
    stray = [*EVEN]
    stray[200] = 5
    assert _asked(tmp_path, say, stray) == ""
    again = [*range(200), *range(100, 400)]
    (tmp_path / "campaign.yaml").unlink()
    assert _asked(tmp_path, say, [10 * k for k in again], [20 + k / 99 for k in again]) == ""
    assert "set back" not in (tmp_path / "campaign.yaml").read_text(encoding="utf-8")
    (tmp_path / "campaign.yaml").unlink()
    assert _asked(tmp_path, say, EVEN[::-1]) == ""


def test_rows_in_no_order_are_to_be_sorted_and_not_joined(tmp_path: Path, say: Say) -> None:
    shuffled = random.Random(5).sample(EVEN, len(EVEN))
    assert _asked(tmp_path, say, shuffled) == ""
    text = (tmp_path / "campaign.yaml").read_text(encoding="utf-8")
    assert "the rows of R2.csv stand in no order of their times" in text
    out = say("--store", tmp_path / "store", "ingest", tmp_path / "campaign.yaml").out
    assert "sort the file by them" in out
    assert "resets" not in out


def test_the_end_of_summer_time_is_named_and_left_to_the_zone(tmp_path: Path, say: Say) -> None:
    local = [t if t < 10800 else t - 3600 for t in range(3600, 18000, 60)]
    rows = [f"2026-10-25 {t // 3600:02d}:{t // 60 % 60:02d}:00,{20 + k / 99:.3f}" for k, t in enumerate(local)]
    (tmp_path / "night.csv").write_text("\n".join(["time,T_bed [degC]", *rows, ""]), encoding="utf-8")
    assert say("init", tmp_path).code == 0
    text = (tmp_path / "campaign.yaml").read_text(encoding="utf-8")
    assert "timezone?" in text
    assert "the end of summer time? then declare the timezone" in text
    assert "resets: allow" not in text


def _noted(folder: Path, say: Say, files: dict[str, Sequence[int]]) -> list[str]:
    """files: name -> seconds since 1970 of its rows, in their order."""
    folder.mkdir(exist_ok=True)
    for name, seconds in files.items():
        rows = [f"{datetime.fromtimestamp(t, UTC):%Y-%m-%dT%H:%M:%SZ},{20 + k / 99:.3f}" for k, t in enumerate(seconds)]
        (folder / name).write_text("\n".join(["time,T_bed [degC]", *rows, ""]), encoding="utf-8")
    assert say("init", folder).code == 0
    text = (folder / "campaign.yaml").read_text(encoding="utf-8")
    return [line for line in text.splitlines() if line.startswith("# note:") and ".csv" in line]


NOW = 1_777_190_400
SOUND = [NOW + t for t in EVEN]


def test_a_leap_of_years_is_told_as_an_ingest_tells_it(tmp_path: Path, say: Say) -> None:
    leapt = [*EVEN[:100], *SOUND]
    (note,) = _noted(tmp_path, say, {"R1.csv": SOUND, "R2.csv": leapt, "R3.csv": leapt})
    assert note.startswith("# note: R2.csv and 1 more file: the clock was set ahead by 56.3 years while it ran")
    out = say("--store", tmp_path / "store", "ingest", tmp_path / "campaign.yaml").out
    assert "the clock was set ahead by 56.3 years while it ran" in out


def test_what_an_ingest_mends_is_told(tmp_path: Path, say: Say) -> None:
    server = [t if t < NOW + 2000 else t - 60 for t in SOUND]
    assert "the clock was set back once, by 50 s" in _noted(tmp_path / "server", say, {"R1.csv": server})[0]
    stray = [*SOUND]
    stray[200] = 5
    assert "1 row with a stray time" in _noted(tmp_path / "stray", say, {"R1.csv": stray})[0]


@pytest.mark.parametrize(
    "rows",
    [
        SOUND,
        SOUND[::-1],
        [*SOUND[:200], *(t + 80_000 for t in SOUND[200:])],  # a pause
        [t for k in range(0, 400, 2) for t in (SOUND[k], SOUND[k] - 1)][:390],  # within what is disorder
    ],
)
def test_a_sound_clock_is_not_told(tmp_path: Path, say: Say, rows: list[int]) -> None:
    assert _noted(tmp_path, say, {"R1.csv": rows}) == []


def test_a_second_list_of_other_columns_is_no_clock_that_was_set(tmp_path: Path, say: Say) -> None:
    probes = [f"2026-04-26T08:{k // 6:02d}:{k % 6}0Z,{12 + k % 7 / 10:.2f},{k % 5 / 10}," for k in range(360)]
    rows = [*probes, *(f"2026-04-26T08:{k:02d}:00Z,,,{20 + k / 99:.3f}" for k in range(60))]
    (tmp_path / "R1.csv").write_text(
        "\n".join(["time,disp_z [um],disp_y [um],T_bed [degC]", *rows, ""]), encoding="utf-8"
    )
    assert say("init", tmp_path).code == 0
    text = (tmp_path / "campaign.yaml").read_text(encoding="utf-8")
    assert "rows from there on fill other columns than those before, so no clock was set back" in text
    assert "clock: {resets: allow}" not in text
