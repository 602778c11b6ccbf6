"""A test that began before the machine had cooled is asked about: its free run would begin at balance."""

from __future__ import annotations

from datetime import datetime, timedelta
from pathlib import Path

import numpy as np
import pytest

from tests.commands import Say
from tests.draft.labs import numbers, text
from thermodata.schema.files.load import load_campaign


def lab(folder: Path, third_k: float, *, air: bool = True) -> Path:
    """Three tests on days of 20, 26 and 23 degC; the bearing's sensor reads 1.5 K too much. third_k: by how much it is
    warmer when the third begins."""
    n = 200
    t = np.arange(n) * 30.0
    for day, (hall, above) in enumerate(((20.0, 0.0), (26.0, 0.4), (23.0, third_k)), 1):
        bearing = hall + 1.5 + above + 8 * (1 - np.exp(-t / 1500))
        columns = [numbers(t, 0), numbers(bearing, 2), numbers(hall + t / 9000, 2), numbers(t / 300, 2)]
        header = ["t [s]", "Front bearing [degC]", "Hall air [degC]" if air else "T7 [degC]", "Displ. Z [um]"]
        text(folder / f"warm_{day}.csv", header, columns, mark=",")
    return folder


@pytest.mark.parametrize(("third_k", "asked"), [(8.0, True), (2.9, False)])
def test_a_bearing_that_begins_far_above_the_air_is_asked_about(
    tmp_path: Path, say: Say, third_k: float, asked: bool
) -> None:
    say("init", lab(tmp_path, third_k))
    written = (tmp_path / "campaign.yaml").read_text("utf-8")
    lines = [x for x in written.splitlines() if "start_state: warm?" in x]
    assert len(lines) == asked
    if asked:
        assert "id: warm_3" in lines[0]
        assert "Front_bearing begins 8.0 K further above air and castings than in the coolest test" in lines[0]
    assert all(t.start_state == "balance" for t in load_campaign(tmp_path / "campaign.yaml").tests)  # never made up


@pytest.mark.parametrize(("third_k", "asked"), [(8.0, True), (0.0, False)])
def test_of_a_test_in_parts_the_first_one_tells(tmp_path: Path, say: Say, third_k: float, asked: bool) -> None:
    lab(tmp_path, third_k)
    for day, file in enumerate(sorted(tmp_path.glob("warm_*.csv")), 1):
        start = datetime(2026, 3, day, 8)
        header, *rows = [line.split(",", 1) for line in file.read_text("utf-8").splitlines()]
        dated = [f"{start + timedelta(seconds=float(t))},{rest}" for t, rest in rows]
        for part, own in enumerate((dated[:100], dated[100:]), 1):
            lines = "\n".join([f"timestamp,{header[1]}", *own]) + "\n"
            file.with_name(f"{file.stem}_{part:03d}.csv").write_text(lines, "utf-8")
        file.unlink()
    say("init", tmp_path)
    assert len(load_campaign(tmp_path / "campaign.yaml").tests) == 3
    assert ("start_state: warm?" in (tmp_path / "campaign.yaml").read_text("utf-8")) == asked


def test_without_the_air_a_warm_day_is_no_warm_start(tmp_path: Path, say: Say) -> None:
    say("init", lab(tmp_path, 8.0, air=False))
    assert "start_state" not in (tmp_path / "campaign.yaml").read_text("utf-8")


def begins(folder: Path, tests: dict[str, dict[str, tuple[float, float]]]) -> Path:
    """Tests of a first reading and a rise by the minute (which ends) for each channel."""
    n = 120
    t = np.arange(n) * 60.0
    for name, channels in tests.items():
        columns = [numbers(first + rise * 5 * (1 - np.exp(-t / 300)), 2) for first, rise in channels.values()]
        header = ["t [s]", *(f"{c} [degC]" for c in channels), "Displ. Z [um]"]
        text(folder / f"{name}.csv", header, [numbers(t, 0), *columns, numbers(t / 300, 2)], mark=",")
    return folder


@pytest.mark.parametrize(("bearing", "asked"), [(20.7, False), (33.0, True)])
def test_a_part_as_cold_as_the_lowest_air_is_at_rest_where_air_lies_in_layers(
    tmp_path: Path, say: Say, bearing: float, asked: bool
) -> None:
    layered = {"Hall top": (25.0, 0.1), "Hall bottom": (20.6, 0.1), "Front bearing": (20.7, 0.2)}
    even = {"Hall top": (17.0, 0.1), "Hall bottom": (16.6, 0.1), "Front bearing": (17.5, 0.2)}
    say("init", begins(tmp_path, {"a": even, "b": layered, "c": layered | {"Front bearing": (bearing, -0.2)}}))
    written = (tmp_path / "campaign.yaml").read_text("utf-8")
    assert [x.split("id: ")[1][0] for x in written.splitlines() if "start_state: warm?" in x] == ["c"] * asked


@pytest.mark.parametrize(("rise", "asked"), [(3.6, False), (-0.1, True)])
def test_what_the_test_itself_heats_from_its_first_row_on_is_no_warm_start(
    tmp_path: Path, say: Say, rise: float, asked: bool
) -> None:
    cold = {"Hall air": (20.0, 0.1), "Front bearing": (20.2, 0.2)}
    say("init", begins(tmp_path, {"a": cold, "b": cold, "c": cold | {"Front bearing": (24.0, rise)}}))
    assert ("start_state: warm?" in (tmp_path / "campaign.yaml").read_text("utf-8")) == asked


@pytest.mark.parametrize(("bearing", "asked"), [(26.0, False), (33.0, True)])
def test_a_casting_that_lags_behind_the_air_explains_a_part_that_does_so_too(
    tmp_path: Path, say: Say, bearing: float, asked: bool
) -> None:
    cold = {"Hall air": (20.0, 0.1), "Column front": (20.0, 0.1), "Front bearing": (20.2, 0.2)}
    after = {"Hall air": (20.0, 0.1), "Column front": (25.5, -0.1), "Front bearing": (bearing, -0.1)}
    say("init", begins(tmp_path, {"a": cold, "b": cold, "c": after}))
    assert ("start_state: warm?" in (tmp_path / "campaign.yaml").read_text("utf-8")) == asked


@pytest.mark.parametrize(("warm", "asked"), [("bc", ["b", "c"]), ("bcd", ["b"])])
def test_what_begins_above_the_air_in_most_tests_is_asked_once(
    tmp_path: Path, say: Say, warm: str, asked: list[str]
) -> None:
    """A turret follows the air of the night late: in 5 of 9 tests of a machine that rested it was asked for itself."""
    cold = {"Hall air": (20.0, 0.1), "Turret": (20.2, -0.1)}
    tests = {n: cold | {"Turret": (24.0 + i / 10, -0.1)} if n in warm else cold for i, n in enumerate("abcde")}
    say("init", begins(tmp_path, tests))
    written = (tmp_path / "campaign.yaml").read_text("utf-8")
    lines = [x for x in written.splitlines() if "start_state: warm?" in x]
    assert [x.split("id: ")[1][0] for x in lines] == asked
    once = (
        "begins 3.9 to 4.1 K further above air and castings than in the coolest test here and in c and d: warm in all"
    )
    assert (once in lines[0]) is (warm == "bcd")
