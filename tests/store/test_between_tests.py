"""What shows only beside other tests, or of a test as a whole: failed sensors, foreign parts, held displacements."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from store_fakes import START_NS, write_campaign, write_log

from thermodata.schema.flag import Flag
from thermodata.store import Store
from thermodata.store.ingest.run import ingest

HEAD = """
schema: thermodata/campaign/1
id: days
machine: {id: m}
sources:
  daq: {reader: npz, files: "raw/{test}.npz"}
channels:
  n: {source: daq, signal: n, quantity: rotational_speed, unit: rpm, at: spindle}
  dZ: {source: daq, signal: dZ, quantity: displacement, unit: um}
"""
TEMPERATURES = "".join(f"  T_{i}: {{source: daq, signal: T{i}, quantity: temperature, unit: degC}}\n" for i in range(5))
TESTS = "tests:\n" + "".join(f"  - {{id: day{k}, kind: spindle}}\n" for k in (1, 2, 3, 4))
N = 600


def day(number: int, *, dated: bool = True, **off: Any) -> tuple[dict[str, dict[str, Any]], dict[str, str]]:
    """5 h at 30 s: the spindle turns from 1 h to 3 h, five parts warm by 0 to 12 K, a probe moves by 20 um."""
    rng = np.random.default_rng(number)
    t = START_NS * dated + number * 86_400 * 10**9 * dated + np.arange(N, dtype=np.int64) * 30 * 10**9
    on = (np.arange(N) >= 120) & (np.arange(N) < 360)
    heat, level = np.zeros(N), 0.0
    for i in range(N):
        level += (on[i] - level) / 80
        heat[i] = level
    columns: dict[str, Any] = {"t_ns": t, "n": 4000.0 * on, "dZ": 20 * heat + rng.normal(0, 0.2, N)}
    columns |= {f"T{i}": 22 + 3 * i * heat + rng.normal(0, 0.05, N) + off.get(f"T{i}", 0.0) for i in range(5)}
    return {"main": columns}, {} if dated else {"clock": "relative"}


def lab(folder: Path, logs: list[tuple[dict[str, dict[str, Any]], dict[str, str]]], extra: str = "") -> Path:
    path = write_campaign(folder / "lab", HEAD + TEMPERATURES + TESTS + extra, logs=False)
    for number, (log, meta) in enumerate(logs, 1):
        write_log(path.parent / f"raw/day{number}.npz", log, **meta)
    return path


def flagged(store: Store, channel: str, flag: Flag) -> dict[str, list[int]]:
    """Test -> rows with a flag."""
    with store.reader() as con:
        rows = con.execute(
            "select test, cast(round(t_s / 30) as int) from sample where channel = ? and flag & ? <> 0 order by all",
            [channel, int(flag)],
        ).fetchall()
    found: dict[str, list[int]] = {}
    for test, row in rows:
        found.setdefault(test, []).append(row)
    return found


def events(store: Store, flag: str) -> list[tuple[Any, ...]]:
    with store.reader() as con:
        return con.execute(
            "select test, channel, n, detail from quality where flag = ? order by 1, 2, from_s", [flag]
        ).fetchall()


def test_without_dates_a_drift_is_flagged_where_it_starts_and_in_every_later_test(store: Store, tmp_path: Path) -> None:
    drift = 30 * np.clip((np.arange(N) - 400) / 60, 0, 1)
    logs = [day(1, dated=False), day(2, dated=False), day(3, dated=False, T1=drift), day(4, dated=False, T1=30.0)]
    path = lab(tmp_path, logs)
    ingest(store, path)
    found = flagged(store, "T_1", Flag.OFFSET)
    assert found["day4"] == list(range(N))
    begin = found["day3"][0]
    assert found["day3"] == list(range(begin, N))
    assert 400 - N // 31 <= begin <= 420
    assert set(found) == {"day3", "day4"}
    assert [(e[:3]) for e in events(store, "offset")] == [("day3", "T_1", N - begin), ("day4", "T_1", N)]
    assert all(not flagged(store, f"T_{i}", Flag.OFFSET) for i in (0, 2, 3, 4))
    assert ingest(store, path).changed is False


def told(store: Store) -> tuple[list[Any], list[Any]]:
    """Samples with their flags, and the events."""
    with store.reader() as con:
        samples = con.execute("select test, channel, t_s, value, flag from sample order by all").fetchall()
        return samples, con.execute("select test, channel, flag, from_s, n from quality order by all").fetchall()


def test_an_edit_of_one_test_changes_the_verdict_on_others_as_a_first_ingest_would(
    store: Store, tmp_path: Path
) -> None:
    drift = 30 * np.clip((np.arange(N) - 400) / 60, 0, 1)
    logs = [day(1, dated=False), day(2, dated=False), day(3, dated=False, T1=drift), day(4, dated=False, T1=30.0)]
    path = lab(tmp_path, logs)
    ingest(store, path)
    # the sensor was off on the first day too: then nothing failed between the tests, and nobody is judged
    log, meta = day(1, dated=False, T1=30.0)
    write_log(path.parent / "raw/day1.npz", log, **meta)
    summary = ingest(store, path)
    assert summary.read == 1
    assert "day4" not in flagged(store, "T_1", Flag.OFFSET)
    anew = Store(tmp_path / "anew", create=True)
    ingest(anew, path)
    assert told(store) == told(anew)
    # and back
    log, meta = day(1, dated=False)
    write_log(path.parent / "raw/day1.npz", log, **meta)
    assert ingest(store, path).made >= 2
    assert flagged(store, "T_1", Flag.OFFSET)["day4"] == list(range(N))


def test_a_part_of_another_recording_is_told_once_and_does_not_count(store: Store, tmp_path: Path) -> None:
    log, meta = day(2)
    main = log["main"]
    main["t_ns"][500:] += 600 * 10**9
    main["dZ"][500:] += 150.0
    for i in range(5):
        main[f"T{i}"][500:] += 18.0
    ingest(store, lab(tmp_path, [day(1), (log, meta), day(3), day(4)]))
    for channel in ("dZ", "T_0", "n"):
        assert flagged(store, channel, Flag.FOREIGN) == {"day2": list(range(520, 620))}
    assert [(e[:3]) for e in events(store, "foreign")] == [("day2", None, 100)]
    assert "6 of 6 channels" in events(store, "foreign")[0][3]


def test_a_displacement_held_while_the_spindle_stands_is_one_event_in_every_test(store: Store, tmp_path: Path) -> None:
    """On two days it is logged only while the spindle turns; of one of them it hardly moves at all."""
    logs = [day(n) for n in (1, 2, 3, 4)]
    for log, _ in (logs[1], logs[2]):
        main = log["main"]
        stands = main["n"] == 0
        main["dZ"][:120], main["dZ"][360:] = main["dZ"][0], main["dZ"][359]
        assert stands.sum() == 360
    logs[2][0]["main"]["n"][:] = 0.0
    logs[2][0]["main"]["dZ"][:] = 3.25
    path = lab(tmp_path, logs)
    ingest(store, path)
    found = flagged(store, "dZ", Flag.HELD)
    assert found["day3"] == list(range(N))
    assert set(found["day2"]) >= set(range(1, 120)) | set(range(361, N))
    assert set(found) == {"day2", "day3"}
    told = events(store, "held")
    assert [e[:2] for e in told] == [("day2", "dZ"), ("day3", "dZ")]
    assert told[0][3].startswith("while the spindle stands: 2 stretches, the first: exactly ")
    assert ingest(store, path).changed is False


def test_a_probe_that_stands_at_an_end_that_other_tests_show_is_saturated(store: Store, tmp_path: Path) -> None:
    """It leaves its range for a part of one day, and soon and for good on the next one."""
    logs = [day(n) for n in (1, 2, 3, 4)]
    limit = 12.345678
    for k, faster in ((0, 1.0), (1, 6.0), (2, 0.5), (3, 0.5)):
        main = logs[k][0]["main"]
        main["dZ"] = np.minimum(main["dZ"] * faster + (0.02 * np.arange(N) if k == 1 else 0.0), limit)
    at = [[int(i) for i in np.flatnonzero(log["main"]["dZ"] == limit)] for log, _ in logs[:2]]
    assert len(at[0]) > 20
    assert len(at[1]) > 0.6 * N
    path = lab(tmp_path, logs)
    ingest(store, path)
    assert flagged(store, "dZ", Flag.SATURATED) == {"day1": at[0], "day2": at[1]}
    assert flagged(store, "dZ", Flag.HELD | Flag.STUCK) == {}
    assert {e[3].partition(",")[0] for e in events(store, "saturated")} == {"upper limit 12.3457"}
    assert ingest(store, path).changed is False


RULE = """
overrule:
  - {flag: offset, channel: T_1, tests: [day4], because: the chiller was set to 50 degC that day}
"""


def test_a_flag_is_overruled_with_a_reason_that_stays(store: Store, tmp_path: Path) -> None:
    path = lab(tmp_path, [day(1), day(2), day(3, T1=30.0), day(4, T1=30.0)], RULE)
    ingest(store, path)
    assert set(flagged(store, "T_1", Flag.OFFSET)) == {"day3"}
    by_test = {e[0]: e[3] for e in events(store, "offset")}
    assert "K against its neighbours since an earlier test; by a constant" in by_test["day3"]
    assert by_test["day4"] == f"overruled: the chiller was set to 50 degC that day (was: {by_test['day3']})"
    # a window in it, for a rule that did not exist when the files were made
    text = path.read_text(encoding="utf-8")
    path.write_text(text.replace("tests: [day4], ", "tests: [day4], window: [0 h, 1 h], "), encoding="utf-8")
    assert ingest(store, path).made == 2  # of day4 only: once for itself, once beside the others
    assert flagged(store, "T_1", Flag.OFFSET)["day4"] == list(range(121, N))
    assert "from 0 to 3600 s overruled: the chiller" in {e[0]: e[3] for e in events(store, "offset")}["day4"]
    # what is not there is said
    path.write_text(text.replace("flag: offset", "flag: held").replace("tests: [day4], ", ""), encoding="utf-8")
    assert [n for n in ingest(store, path).notes if n.startswith("overrule")] == [
        "overrule: no test has a flag 'held' on T_1 (the chiller was set to 50 degC that day)"
    ]
    path.write_text(text.replace(RULE, ""), encoding="utf-8")
    ingest(store, path)
    assert set(flagged(store, "T_1", Flag.OFFSET)) == {"day3", "day4"}


MODEL = """
schema: thermodata/model/1
name: baseline
campaign: days
response: {channel: dZ}
step: 60 s
effects:
  - {effect: lag, drivers: {u: n}}
"""


def test_a_fit_says_what_it_loses_to_flags_and_a_faulty_sensor_is_no_candidate(store: Store, tmp_path: Path) -> None:
    import yaml

    from thermodata.diagnosis.candidates.of_library import candidates
    from thermodata.diagnosis.sensors.logging_faults import faulty_sensors
    from thermodata.effect.registry import effects
    from thermodata.modelling.fit.model import fit_model
    from thermodata.schema.files.model import Model
    from thermodata.view.grid.load import load_dataset

    wanders = 30 + 8 * np.sin(np.arange(N) / 20)
    logs = [day(1), day(2), day(3, T1=wanders), day(4, T1=wanders)]
    logs[1][0]["main"]["dZ"][450:] = logs[1][0]["main"]["dZ"][450]
    extra = "".join(f"  - {{id: day{k}, kind: spindle, role: calibration}}\n" for k in (1, 2, 3, 4))
    path = lab(tmp_path, logs)
    text = path.read_text(encoding="utf-8")
    path.write_text(text.replace(TESTS, "tests:\n" + extra), encoding="utf-8")
    ingest(store, path)
    data = load_dataset(store, ["days"], 60.0)
    assert {n for n, c in data.channels.items() if c.faulty} == {"T_1"}, "one of four is few"
    fitted = fit_model(Model.model_validate(yaml.safe_load(MODEL)), data)
    failed = {c.name: c for c in fitted.checks() if c.name.startswith("lost_to_flags")}
    assert list(failed) == ["lost_to_flags:days/day2"]
    assert failed["lost_to_flags:days/day2"].advice.startswith("25 % of 'dZ' does not count in 'day2'")
    asked = candidates(effects(), data.channels, [], "dZ")
    assert asked
    assert not [c for c in asked if "T_1" in c.channels]
    assert [c for c in asked if "T_2" in c.channels]
    told = faulty_sensors(data, "dZ")
    assert [(a.kind, a.test) for a in told] == [("sensor", "day3"), ("sensor", "day4")]
    assert "has lost this test" not in told[0].why
    assert "and the model, which reads it, has lost this test" in faulty_sensors(data, "dZ", {"T_1"})[0].why


def test_a_constant_through_whole_tests_changes_nothing_in_what_counts_from_their_start(
    store: Store, tmp_path: Path
) -> None:
    """The same fit as if the sensor were sound; a product with it, and a sensor that wanders, lose the tests."""
    import yaml

    from thermodata.modelling.run import fit
    from thermodata.schema.files.model import Model
    from thermodata.view.grid.load import load_dataset

    extra = "tests:\n" + "".join(f"  - {{id: day{k}, kind: spindle, role: calibration}}\n" for k in (1, 2, 3, 4))

    def fitted(name: str, driver: str, **off: Any) -> Any:
        logs = [day(k, **(off if k > 2 else {})) for k in (1, 2, 3, 4)]
        path = lab(tmp_path / name, logs)
        path.write_text(path.read_text(encoding="utf-8").replace(TESTS, extra), encoding="utf-8")
        ingest(store, path)
        return fit(store, Model.model_validate(yaml.safe_load(MODEL.replace("u: n", f"u: {driver}"))))

    sound = fitted("sound", "T_1")
    assert sound.notes == []
    off = fitted("off", "T_1", T1=30.0)
    assert set(flagged(store, "T_1", Flag.OFFSET)) == {"day3", "day4"}, "the flag stands"
    assert {k: p.value for k, p in off.parameters.items()} == pytest.approx(
        {k: p.value for k, p in sound.parameters.items()}, rel=1e-6
    )
    assert [s.test for s in off.scores if s.phase == "all"] == ["day1", "day2", "day3", "day4"]
    assert [n for n in off.notes if "'offset' through all of day3, day4, by one number" in n]
    difference = fitted("off", "T_1 - T_2", T1=30.0)
    assert not [c for c in difference.checks if c.name.startswith("skipped")]
    data = load_dataset(store, ["days"], 60.0)
    assert [t.channels["T_1"].shifted for t in data.tests] == [False, False, True, True]

    for lost in (fitted("off", "T_1 * n", T1=30.0), fitted("wanders", "T_1", T1=30 + 8 * np.sin(np.arange(N) / 20))):
        skipped = {c.name: c.advice for c in lost.checks if c.name.startswith("skipped")}
        assert sorted(skipped) == ["skipped:days/day3", "skipped:days/day4"]
        assert (
            "no driver for lag: 'T_1' is flagged 'offset' there, so the fit lost this test"
            in skipped["skipped:days/day3"]
        )


def test_a_sensor_that_failed_in_one_test_of_many_drives_in_the_others(store: Store, tmp_path: Path) -> None:
    from thermodata.diagnosis.candidates.of_library import candidates
    from thermodata.diagnosis.sensors.logging_faults import faulty_sensors
    from thermodata.effect.registry import effects
    from thermodata.view.grid.load import load_dataset

    count = 5
    logs = [day(k) for k in range(1, count)] + [day(count, T1=30.0)]
    extra = "".join(f"  - {{id: day{k}, kind: spindle, role: calibration}}\n" for k in range(1, count + 1))
    path = lab(tmp_path, logs)
    text = path.read_text(encoding="utf-8")
    path.write_text(text.replace(TESTS, "tests:\n" + extra), encoding="utf-8")
    ingest(store, path)
    data = load_dataset(store, ["days"], 60.0)
    assert data.channels["T_1"].faulty is None
    (one,) = [c for c in candidates(effects(), data.channels, [], "dZ") if c.id == "lag:T_1"]
    p = {"tau": 30.0}
    assert [bool(np.any(one.in_test(t)(p))) for t in data.tests] == [True] * 4 + [False]
    (told,) = faulty_sensors(data, "dZ")
    assert told.test == "day5"
    assert "drives no candidate in this test, and does in those" in told.why


def test_tests_that_are_said_to_start_warm_tell_nothing_of_a_sensor(store: Store, tmp_path: Path) -> None:
    path = lab(tmp_path, [day(1), day(2), day(3, T1=30.0), day(4, T1=30.0)])
    ingest(store, path)
    assert set(flagged(store, "T_1", Flag.OFFSET)) == {"day3", "day4"}
    text = path.read_text("utf-8")
    path.write_text(re.sub(r"(id: day[34], kind: spindle)", r"\1, start_state: warm", text), "utf-8")
    ingest(store, path)
    assert flagged(store, "T_1", Flag.OFFSET) == {}
    path.write_text(text, "utf-8")
    ingest(store, path)
    assert set(flagged(store, "T_1", Flag.OFFSET)) == {"day3", "day4"}


@pytest.mark.parametrize(("place", "told"), [(", at: spindle.motor", {"day4", "day5"}), ("", set())])
def test_starts_are_asked_of_what_is_known_to_be_of_the_machine(
    store: Store, tmp_path: Path, place: str, told: set[str]
) -> None:
    """What has no place may be oil, which a chiller holds."""
    heat = (day(1)[0]["main"]["T4"] - 22) / 12
    heats = [day(k, T1=heat * 30 if k < 4 else 30 + heat * 15) for k in range(1, 6)]
    path = lab(tmp_path, heats, "  - {id: day5, kind: spindle}\n")
    path.write_text(path.read_text("utf-8").replace("signal: T1,", f"signal: T1{place},"), "utf-8")
    ingest(store, path)
    assert set(flagged(store, "T_1", Flag.OFFSET)) == told


@pytest.mark.parametrize(("first", "said"), [(320, None), (280, "33 % of 'dZ' does not count in 'day2'")])
def test_what_measuring_excludes_is_not_lost_to_a_flag_too(
    store: Store, tmp_path: Path, first: int, said: str | None
) -> None:
    """A probe that is held from the end of the measured phase on, and through all that comes after it."""
    import yaml

    from thermodata.modelling.fit.model import fit_model
    from thermodata.schema.files.model import Model
    from thermodata.view.grid.load import load_dataset

    logs = [day(k) for k in (1, 2, 3, 4)]
    logs[1][0]["main"]["dZ"][first:] = logs[1][0]["main"]["dZ"][first]
    path = lab(tmp_path, logs)
    extra = "".join(f"  - {{id: day{k}, kind: spindle, role: calibration}}\n" for k in (1, 2, 3, 4))
    measured = extra.replace("}", ", measuring: n > 100}")
    path.write_text(path.read_text(encoding="utf-8").replace(TESTS, "tests:\n" + measured), encoding="utf-8")
    ingest(store, path)
    assert [e[2] for e in events(store, "held") if e[0] == "day2"] == [N - first], "one stretch, behind it too"
    data = load_dataset(store, ["days"], 60.0)
    fitted = fit_model(Model.model_validate(yaml.safe_load(MODEL)), data)
    told = [c.advice for c in fitted.checks() if c.name == "lost_to_flags:days/day2"]
    assert data.test("days", "day2").channels["dZ"].faulty == ("held" if said else None)
    assert [text.partition(":")[0] for text in told] == ([said] if said else [])
