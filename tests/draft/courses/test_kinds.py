"""What kind of test a recording is: by its name in many languages, and by what worked in it, and when."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from thermodata.draft.courses.cuts import feeds_with_spindle, is_loaded
from thermodata.draft.courses.kinds import kind_of
from thermodata.draft.files.sample import Course
from thermodata.plugin import Float1D
from thermodata.schema.files.load import load_campaign

Say = Callable[..., Any]
N = 600
T_NS = np.arange(N, dtype=np.int64) * 10**10


@pytest.mark.parametrize(
    ("name", "kind"),
    [
        ("01_mecanizado", "cutting"),
        ("usinage_3", "cutting"),
        ("essai coupe", "cutting"),
        ("07_Zerspanung", "cutting"),
        ("lavorazione2", "cutting"),
        ("usinagem", "cutting"),
        ("obróbka_1", "cutting"),
        ("verspanen", "cutting"),
        ("02_husillo", "spindle"),
        ("broche 2", "spindle"),
        ("04_avanceZ", "linear_axis"),
        ("03_reposo", "etve"),
        ("repos", "etve"),
        ("07_mixto", "mixed"),
        ("espectro", "spectrum"),
        ("cutting fluid", "other"),
        ("07_Arbeitstag", "mixed"),
        ("Dauerlauf_Tag1", "other"),  # a date
        ("day_2", "other"),
    ],
)
def test_a_kind_is_told_by_the_name_in_many_languages(name: str, kind: str) -> None:
    assert kind_of(name, []).kind == kind


def worked(alone: bool) -> tuple[Float1D, Float1D]:
    """(speed [rpm], feed [m/min]): the spindle turns in every other sixth of the time at two speeds; the axis feeds
    then, or also while the spindle stands."""
    sixth = np.arange(N) * 6 // N
    turns = sixth % 2 == 1
    speed = np.where(turns, np.where(sixth < 3, 2000.0, 8000.0), 0.0)
    return speed, np.where(turns | (alone & (sixth == 2)), 3.0, 0.0)


def unloaded(speed: Float1D) -> Float1D:
    return np.asarray(0.1 + 0.5 * speed / 8000 + np.random.default_rng(1).normal(0, 0.004, N), dtype=np.float64)


def loaded(speed: Float1D) -> Float1D:
    return np.asarray(unloaded(speed) + np.where(speed == 2000.0, 6.0, 0.0) + np.where(speed == 8000.0, 1.0, 0.0))


@pytest.mark.parametrize(("power", "under_load"), [(unloaded, False), (loaded, True)])
def test_a_power_that_the_speed_does_not_explain_is_a_load(
    power: Callable[[Float1D], Float1D], under_load: bool
) -> None:
    speed, _ = worked(False)
    assert is_loaded(Course(T_NS, speed), Course(T_NS, power(speed))) is under_load


def test_a_spindle_whose_grease_warms_is_not_under_load() -> None:
    speed, _ = worked(False)
    warms = 0.6 + 0.4 * np.exp(-np.arange(N) / 100)
    assert not is_loaded(Course(T_NS, speed), Course(T_NS, unloaded(speed) * warms))


def test_a_power_that_varies_at_one_speed_is_a_load() -> None:
    speed, _ = worked(False)
    power = unloaded(speed) + np.where((speed == 8000.0) & (np.arange(N) % 20 < 10), 1.0, 0.0)
    assert is_loaded(Course(T_NS, speed), Course(T_NS[::2], power[::2]))


def test_an_axis_that_feeds_while_the_spindle_stands_does_not_cut() -> None:
    for alone in (False, True):
        speed, feed = worked(alone)
        assert feeds_with_spindle(Course(T_NS, speed), [Course(T_NS, feed)]) is not alone
    assert not feeds_with_spindle(Course(T_NS, speed), [Course(T_NS, 0 * feed)])


@pytest.mark.parametrize(
    ("alone", "power", "kind", "asked"),
    [
        (False, loaded, "cutting", False),
        (False, unloaded, "mixed", False),
        (True, loaded, "mixed", False),
        (False, None, "mixed", True),  # nobody knows whether it was under load
    ],
)
def test_a_spindle_under_load_while_the_axes_feed_is_cutting(
    tmp_path: Path, say: Say, alone: bool, power: Callable[[Float1D], Float1D] | None, kind: str, asked: bool
) -> None:
    speed, feed = worked(alone)
    kw = np.zeros(N) if power is None else power(speed)
    head = "Time [s];Spindle speed [rpm];Feed X [m/min];Spindle bearing front [°C]"
    rows = [
        f"{10 * i};{speed[i]:.0f};{feed[i]:.2f};{20 + 0.01 * i:.2f}" + (f";{kw[i]:.3f}" if power else "")
        for i in range(N)
    ]
    text = "\n".join([head + (";Spindle power [kW]" if power else ""), *rows])
    (tmp_path / "t1.csv").write_text(text + "\n", "utf-8")
    assert say("init", tmp_path).code == 0
    (found,) = load_campaign(tmp_path / "campaign.yaml").tests
    assert found.kind == kind
    assert ("kind: mixed, or cutting?" in (tmp_path / "campaign.yaml").read_text("utf-8")) is asked


@pytest.mark.parametrize(
    ("test", "switch", "said"),
    [
        ("t1", True, "kind: other? switches change, nothing moves"),
        ("04_Tor", False, "kind: the name speaks of a door or a draught"),
        ("05_enfriadora", False, "kind: the name speaks of pumps or fluids"),
        ("reposo", False, ""),
    ],
)
def test_a_test_that_is_more_than_its_environment_is_asked(
    tmp_path: Path, say: Say, test: str, switch: bool, said: str
) -> None:
    rows = [f"{10 * i};0;{20 + 0.01 * i:.2f};{int(switch and 20 < i < 80)}" for i in range(120)]
    head = "Time [s];Spindle speed [rpm];Spindle bearing front [°C];Coolant on"
    (tmp_path / f"{test}.csv").write_text("\n".join([head, *rows]) + "\n", "utf-8")
    assert say("init", tmp_path).code == 0
    (found,) = load_campaign(tmp_path / "campaign.yaml").tests
    assert found.kind == ("other" if said else "etve")
    assert said in (tmp_path / "campaign.yaml").read_text("utf-8")


@pytest.mark.parametrize(
    ("head", "rpm", "feed", "kind", "said"),
    [
        ("Giri utensile motorizzato [1/min]", 4000, 0, "other", "kind: other? turret at 4000 rpm"),
        ("Turret tool speed [rpm]", 4000, 2, "mixed", "turret at 4000 rpm"),
        ("Counter spindle speed [rpm]", 4000, 0, "spindle", "spindle at 4000 rpm"),
        ("Drehzahl B-Achse [1/min]", 30, 0, "rotary_axis", "the table turns"),
        ("Speed workhead [rpm]", 300, 0, "rotary_axis", "the table turns"),
        ("Speed X motor [rpm]", 900, 0, "linear_axis", "X moves"),
        ("Turret tool speed [rpm]", 0, 0, "etve", "nothing moves"),
        ("Fan speed [rpm]", 1500, 0, "etve", "nothing moves"),
    ],
)
def test_whatever_turns_moves(tmp_path: Path, say: Say, head: str, rpm: int, feed: int, kind: str, said: str) -> None:
    rows = [f"{10 * i};0;{rpm * (20 < i < 80)};{feed * (20 < i < 80)};{20 + 0.01 * i:.2f}" for i in range(120)]
    names = f"Time [s];Main spindle speed [rpm];{head};Feed X [m/min];Spindle bearing front [°C]"
    (tmp_path / "t1.csv").write_text("\n".join([names, *rows]) + "\n", "utf-8")
    assert say("init", tmp_path).code == 0
    (found,) = load_campaign(tmp_path / "campaign.yaml").tests
    assert found.kind == kind
    assert said in (tmp_path / "campaign.yaml").read_text("utf-8")


def test_a_name_that_says_rest_is_asked_where_a_tool_turns(tmp_path: Path, say: Say) -> None:
    rows = [f"{10 * i};{4000 * (20 < i < 80)};{20 + 0.01 * i:.2f}" for i in range(120)]
    (tmp_path / "reposo.csv").write_text(
        "\n".join(["Time [s];Turret tool speed [rpm];Bed [°C]", *rows]) + "\n", "utf-8"
    )
    assert say("init", tmp_path).code == 0
    assert "? kind: the name says etve, the data that something turns" in (tmp_path / "campaign.yaml").read_text(
        "utf-8"
    )


def spindle_log(folder: Path, name: str, rows: list[tuple[float, float]]) -> Path:
    """rows: (time [s], speed [rpm])."""
    lines = ["Time [s];Spindle speed [rpm];Feed X [m/min];Coolant on"]
    lines += [f"{t:g};{speed:g};{3 * (speed == 4000):g};{int(speed > 0)}" for t, speed in rows]
    (folder / f"{name}.csv").write_text("\n".join(lines) + "\n", "utf-8")
    return folder


@pytest.mark.parametrize(
    ("rows", "kind", "speed"),
    [
        ([(0, 0), (1800, 8000), (10800, 0)], "spindle", "8000 rpm"),  # written on change
        ([(0, 0), (60, 6000), (4000, 7000), (5000, 8000), (5001, 8500), (9000, 0)], "spectrum", None),
        ([(0, 0), (1, 2000), (2, 6500), (3, 8000), (9000, 0), (9001, 0)], "spindle", "8000 rpm"),  # the ramps pass
        ([(0, 0), (3600, 8000), (7200, 0)], "spindle", "8000 rpm"),  # each row is a third of it
        ([(10 * i, 8000 * (i == 50)) for i in range(100)], "other", None),  # one row of many is a glitch
        ([(10 * i, 65535 if 40 <= i < 50 else 8000) for i in range(100)], "spindle", "8000 rpm"),  # a code for no value
    ],
)
def test_a_speed_is_one_by_how_long_it_stands(
    tmp_path: Path, say: Say, rows: list[tuple[float, float]], kind: str, speed: str | None
) -> None:
    assert say("init", spindle_log(tmp_path, "t1", rows)).code == 0
    (found,) = load_campaign(tmp_path / "campaign.yaml").tests
    assert (found.kind, found.conditions.get("speed")) == (kind, speed)


@pytest.mark.parametrize(("low", "kind"), [(8000, "spindle"), (4000, "mixed")])
def test_a_day_in_a_name_is_a_mix_of_loads_where_the_data_show_them(
    tmp_path: Path, say: Say, low: float, kind: str
) -> None:
    rows = [(10 * i, float(0 if i < 20 else 8000 if i < 60 else low)) for i in range(100)]
    assert say("init", spindle_log(tmp_path, "2026-02-10_Tag8000", rows)).code == 0
    (found,) = load_campaign(tmp_path / "campaign.yaml").tests
    assert found.kind == kind
    text = (tmp_path / "campaign.yaml").read_text("utf-8")
    assert ("kind sure: name and data" in text) is (kind == "mixed")
