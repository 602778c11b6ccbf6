"""Folders of tests with a file a sensor: equal names of files are a channel each, and the folders are the tests.
Folders whose equal names are tests of their own stay so."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from datetime import datetime, timedelta
from pathlib import Path

import pytest
import yaml

from tests.commands import Said, Say
from thermodata.draft.writing.fill_in import filled_in
from thermodata.draft.writing.questions import questions

START = datetime(2026, 4, 17, 8)
SENSORS = {"bearing_front": (22.0, 0.05), "hall": (20.0, 0.01), "probe_Z": (0.0, -0.3), "spindle_speed": (0.0, 25.0)}


def _write(path: Path, begin: datetime | None, low: float, rise: float, head: str = "timestamp,value") -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    times = [f"{begin + timedelta(seconds=10 * k):%Y-%m-%dT%H:%M:%SZ}" if begin else f"{10 * k}.0" for k in range(240)]
    rows = [f"{t},{low + rise * k + 0.001 * (k * 7 % 11):.3f}" for k, t in enumerate(times)]
    path.write_text("\n".join([head, *rows, ""]), encoding="utf-8")


def _drafted(folder: Path, say: Say) -> dict[str, object]:
    assert say("init", folder).code == 0
    found = yaml.safe_load((folder / "campaign.yaml").read_text(encoding="utf-8"))
    assert isinstance(found, dict)
    return found


def _ids(found: Mapping[str, object]) -> list[str]:
    tests = found["tests"]
    assert isinstance(tests, list)
    return [t["id"] for t in tests]


@pytest.mark.parametrize("name", ["{test}/{sensor}.csv", "{sensor}/{test}.csv", "{test}_{sensor}.csv"])
def test_a_file_a_sensor_is_a_channel(tmp_path: Path, say: Say, name: str) -> None:
    for day, test in enumerate(("R1", "R2")):
        for sensor, (low, rise) in SENSORS.items():
            _write(tmp_path / name.format(test=test, sensor=sensor), START + timedelta(days=day), low, rise)
    found = _drafted(tmp_path, say)
    assert _ids(found) == ["R1", "R2"]
    sources, channels = found["sources"], found["channels"]
    assert isinstance(sources, dict)
    assert isinstance(channels, dict)
    assert {s["files"] for s in sources.values()} == {name.replace("{sensor}", s) for s in SENSORS}
    said = {n: (c["quantity"], c.get("at")) for n, c in channels.items()}
    assert said == {
        "bearing_front": ("temperature", "spindle.bearing.front"),
        "hall": ("temperature", "hall"),
        "probe_Z": ("displacement", "tcp"),
        "spindle_speed": ("rotational_speed", "spindle"),
    }
    assert {t["kind"] for t in found["tests"]} == {"spindle"}  # type: ignore[attr-defined]


def test_without_dates_names_of_places_say_so(tmp_path: Path, say: Say) -> None:
    for test in ("R1", "R2"):
        for sensor, (low, rise) in SENSORS.items():
            _write(tmp_path / test / f"{sensor}.csv", None, low, rise, "time [s],value")
    assert _ids(_drafted(tmp_path, say)) == ["R1", "R2"]


@pytest.mark.parametrize("head", ["timestamp,value", "timestamp,dZ [um]"])
def test_one_after_the_other_they_are_tests(tmp_path: Path, say: Say, head: str) -> None:
    for day, week in enumerate(("w1", "w2")):
        for hour, test in enumerate(("hall", "spindle", "table")):
            _write(tmp_path / week / f"{test}.csv", START + timedelta(days=7 * day, hours=4 * hour), 0, 0.1, head)
    assert len(_ids(_drafted(tmp_path, say))) == 6


def test_without_dates_names_of_tests_stay_tests(tmp_path: Path, say: Say) -> None:
    for week in ("w1", "w2"):
        for test in ("run_1", "run_2", "run_3"):
            _write(tmp_path / week / f"{test}.csv", None, 0, 0.1, "time [s],value")
    assert len(_ids(_drafted(tmp_path, say))) == 6


def test_without_dates_places_alone_may_be_tests(tmp_path: Path, say: Say) -> None:
    """A test of the spindle and one of the X axis, on two machines: nothing says that these are sensors."""
    for machine in ("M1", "M2"):
        for test in ("spindle", "axis_X"):
            _write(tmp_path / machine / f"{test}.csv", None, 0.0, 0.1, "time [s],value")
    assert len(_ids(_drafted(tmp_path, say))) == 4


def test_a_start_in_names_counts_beside_loggers_that_have_dates(tmp_path: Path, say: Say) -> None:
    for day, test in enumerate(("prova_A", "prova_B")):
        begin = START + timedelta(days=day)
        for sensor in ("hall", "bearing_front"):
            _write(tmp_path / test / f"{sensor}.csv", begin, 20, 0.01)
        for axis in "XYZ":
            _write(
                tmp_path / test / f"spost_{axis}_{begin:%Y%m%d_%H%M03}.txt", None, 0, 0.1, f"t [s],spost_{axis} [um]"
            )
    found = _drafted(tmp_path, say)
    assert [(t["id"], t["start"]) for t in found["tests"]] == [  # type: ignore[attr-defined]
        ("prova_A", "2026-04-17 08:00:03"),
        ("prova_B", "2026-04-18 08:00:03"),
    ]


@pytest.mark.parametrize(("units", "drafted"), [("CC", "C"), ("FF", "F"), ("CF", None)])
def test_a_column_of_units_gives_the_unit(tmp_path: Path, say: Say, units: str, drafted: str | None) -> None:
    for day in (2, 3):
        rows = [f"2026-03-{day + 12} 08:{k:02d}:00,{units[k % 2]},{70 + k / 10:.1f}" for k in range(60)]
        (tmp_path / f"t{day}.csv").write_text("\n".join(["Date/Time,Unit,Value", *rows, ""]), encoding="utf-8")
    text = str(_drafted(tmp_path, say)["channels"])
    assert ("'unit': 'C'" in text, "'unit': 'F'" in text) == (drafted == "C", drafted == "F")
    assert ("'Unit': {" in text) == (drafted is None)


@pytest.mark.parametrize(
    ("day", "asked"), [("{d:02d}.04.2026", ["timezone"]), ("04/{d:02d}/2026", ["format of the dates", "timezone"])]
)
def test_what_is_open_for_all_sensors_alike_is_written_out_once(
    tmp_path: Path, say: Callable[..., Said], day: str, asked: list[str]
) -> None:
    for test, d in (("T1", 3), ("T2", 4)):
        (tmp_path / test).mkdir()
        for sensor in ("bed", "hall", "probe_Z"):
            rows = [f"{day.format(d=d)} 08:{k // 6:02d}:{k % 6 * 10:02d};{20 + k % 7 / 10:.1f}" for k in range(200)]
            (tmp_path / test / f"{sensor}.csv").write_text("\n".join(["time;value", *rows, ""]))
    assert say("init", tmp_path).code == 0
    text = (tmp_path / "campaign.yaml").read_text()
    for what in asked:
        assert text.count(f"{what}? as in 'bed'") == 2
    assert text.count("; the same in each of hall, probe_Z") == len(asked)


def _through(folder: Path, names: list[str], apart_h: int = 0) -> None:
    """Two tests of an hour, and loggers of a value a minute that ran through both, or each in its own hours."""
    for hour in (1, 4):
        lines = ["time,dZ [um],spindle speed [rpm]"]
        for k in range(360):
            t = START + timedelta(hours=hour, seconds=10 * k)
            lines.append(f"{t:%Y-%m-%dT%H:%M:%SZ},{k / 9:.2f},{9000 * (k > 5)}")
        (folder / f"run{hour}.csv").write_text("\n".join([*lines, ""]), encoding="utf-8")
    for n, name in enumerate(names):
        lines = ["Date/Time,Unit,Value"]
        for k in range(360):
            t = START + timedelta(hours=apart_h * n, minutes=k)
            lines.append(f"{t:%Y-%m-%dT%H:%M:%S},C,{20 + n + k / 100:.2f}")
        (folder / f"{name}.csv").write_text("\n".join([*lines, ""]), encoding="utf-8")


@pytest.mark.parametrize("name", ["ibutton_{}", "{}", "{}_2026-04-17", "btn {} log"])
def test_loggers_that_ran_through_all_tests_are_a_source_each(tmp_path: Path, say: Say, name: str) -> None:
    _through(tmp_path, [name.format(place) for place in ("bed", "hall", "column_left")])
    found = _drafted(tmp_path, say)
    assert _ids(found) == ["run1", "run4"]
    channels, sources = found["channels"], found["sources"]
    assert isinstance(channels, dict)
    assert isinstance(sources, dict)
    temperatures = {c["at"]: c["source"] for c in channels.values() if c["quantity"] == "temperature"}
    assert set(temperatures) == {"bed", "hall", "column.left"}
    assert {sources[s]["files"] for s in temperatures.values()} == {
        name.format(place) + ".csv" for place in ("bed", "hall", "column_left")
    }


def test_a_legend_says_what_their_serials_are(tmp_path: Path, say: Say) -> None:
    serials = {"3F00A4B5": "spindle bearing front", "8E00198F": "bed", "D20021B0": "hall top"}
    _through(tmp_path, list(serials))
    (tmp_path / "sensors.txt").write_text("\n".join([f"{s} = {place}" for s, place in serials.items()]))
    channels = _drafted(tmp_path, say)["channels"]
    assert isinstance(channels, dict)
    at = {c["at"] for c in channels.values() if c["quantity"] == "temperature"}
    assert at == {"spindle.bearing.front", "bed", "hall.top"}


@pytest.mark.parametrize(("names", "apart_h"), [(["1", "2", "3"], 0), (["bed", "hall", "column"], 12)])
def test_numbers_and_loggers_that_ran_one_after_the_other_are_no_sensors(
    tmp_path: Path, say: Say, names: list[str], apart_h: int
) -> None:
    _through(tmp_path, names, apart_h)
    sources = _drafted(tmp_path, say)["sources"]
    assert isinstance(sources, dict)
    assert len(sources) == 2


def test_the_form_asks_once_what_is_open_for_all_alike_and_fills_each(tmp_path: Path, say: Say) -> None:
    _through(tmp_path, ["bed", "hall", "column"])
    assert say("init", tmp_path).code == 0
    path = tmp_path / "campaign.yaml"
    zones = [q.name for q in questions(path.read_text()) if q.kind == "zone"]
    assert zones == ["sources.bed.timezone"]
    text = filled_in(path.read_text(), {"sources.bed.timezone": "Europe/Prague"})
    sources = yaml.safe_load(text)["sources"]
    assert [sources[s].get("timezone") for s in ("bed", "hall", "column")] == ["Europe/Prague"] * 3
    assert not any("# ? timezone" in line for line in text.splitlines())
    own = filled_in(path.read_text(), {"sources.bed.timezone": "Europe/Prague", "sources.hall.timezone": "UTC"})
    assert yaml.safe_load(own)["sources"]["hall"]["timezone"] == "UTC"
    assert yaml.safe_load(own)["sources"]["column"]["timezone"] == "Europe/Prague"
