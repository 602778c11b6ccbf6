"""Messages that hold several samples each: each sample stands at its own time."""

from __future__ import annotations

from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from thermodata_reader_mcap import Reader

from thermodata.plugin import Source

T0 = 1_772_434_800_000_000_000
N = 5  # samples of a message
STEP = 6_000_000_000


def batches(many: int, made: Any) -> list[tuple[str, int, dict[str, Any]]]:
    """Messages, each logged with its last sample. made: what one holds, of the numbers of its samples."""
    rows = [list(range(k * N, (k + 1) * N)) for k in range(many)]
    return [("/daq", T0 + STEP * ks[-1] + 3_000_000, made(ks)) for ks in rows]


def at(k: int, scale: float = 1e9) -> float:
    return (T0 + STEP * k) / scale


FORMS: dict[str, Any] = {
    "times beside": lambda ks: {"t": [at(k) for k in ks], "dZ": ks},
    "texts beside": lambda ks: {"timestamps": [datetime.fromtimestamp(at(k), UTC).isoformat() for k in ks], "dZ": ks},
    "ms beside": lambda ks: {"time": [at(k, 1e6) for k in ks], "dZ": ks},
    "step in s": lambda ks: {"t0": at(ks[0]), "dt": 6.0, "dZ": ks},
    "step in ms": lambda ks: {"t0": at(ks[0]), "dt_ms": 6000, "dZ": ks},
    "step in ms by what follows": lambda ks: {"start": at(ks[0], 1e6), "period": 6000, "dZ": ks},
    "rate": lambda ks: {"timestamp": at(ks[0]), "sample_rate": 1 / 6, "dZ": ks},
    "text and step": lambda ks: {"t0": datetime.fromtimestamp(at(ks[0]), UTC).isoformat(), "dt": 6, "dZ": ks},
    "inside": lambda ks: {"id": 4, "data": {"t0": at(ks[0]), "dt": 6.0, "dZ": ks}},
}


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("many", [3, 60])
def test_each_sample_stands_at_its_own_time(tmp_path: Path, write: Any, read: Any, form: str, many: int) -> None:
    path = write(tmp_path / "a.mcap", batches(many, FORMS[form]))
    recording, times, values, _, losses = read(path)
    name = "/daq.data.dZ" if form == "inside" else "/daq.dZ"
    assert not losses
    assert values[name] == list(range(many * N))
    np.testing.assert_allclose(times["/daq"], T0 + STEP * np.arange(many * N), atol=1000)
    assert any("holds several samples" in n and "wrong" not in n for n in recording.notes)
    assert not any("[0]" in s.name or "dt" in s.name for s in recording.signals)


SEVERAL: dict[str, Any] = {
    "fields with values": lambda ks: {
        "t": [at(k) for k in ks],
        "T": {"values": [20.0 + k for k in ks], "unit": "degC"},
        "dZ": {"values": ks, "unit": "um"},
    },
    "times in a field": lambda ks: {
        "time": {"values": [at(k) for k in ks], "unit": "s"},
        "T": {"values": [20.0 + k for k in ks], "unit": "degC"},
        "dZ": {"values": ks, "unit": "um"},
    },
    "times of a header": lambda ks: {
        "header": {"stamps": [at(k) for k in ks]},
        "T": {"values": [20.0 + k for k in ks], "unit": "degC"},
        "dZ": {"values": ks, "unit": "um"},
    },
    "step of a header": lambda ks: {
        "header": {"t0": at(ks[0]), "dt": 6.0},
        "T": {"values": [20.0 + k for k in ks], "unit": "degC"},
        "dZ": {"values": ks, "unit": "um"},
    },
    "times of each": lambda ks: {
        "T": {"t": [at(k) for k in ks], "values": [20.0 + k for k in ks], "unit": "degC"},
        "dZ": {"t": [at(k) for k in ks], "values": ks, "unit": "um"},
    },
    "objects": lambda ks: [
        {"t": at(k), "T": {"values": 20.0 + k, "unit": "degC"}, "dZ": {"values": k, "unit": "um"}} for k in ks
    ],
    "objects inside": lambda ks: {
        "rig": "B",
        "samples": [{"ts": at(k, 1e6), "T": {"values": 20.0 + k}, "dZ": {"values": k}} for k in ks],
    },
}


@pytest.mark.parametrize("form", SEVERAL)
def test_arrays_of_several_fields_stand_at_the_times_of_their_samples(
    tmp_path: Path, write: Any, read: Any, form: str
) -> None:
    uneven = [[0], [1, 2, 3], [4, 5], [6, 7, 8, 9, 10, 11, 12], [13, 14]]
    sent = [("/daq", T0 + STEP * ks[-1] + 3_000_000, SEVERAL[form](ks)) for ks in uneven]
    recording, times, values, _, losses = read(write(tmp_path / "a.mcap", sent))
    assert not losses
    np.testing.assert_allclose(times["/daq"], T0 + STEP * np.arange(15), atol=1000)
    before = "/daq.samples" if form == "objects inside" else "/daq"
    assert values[f"{before}.dZ.values"] == list(range(15))
    assert values[f"{before}.T.values"] == [20.0 + k for k in range(15)]
    assert any("holds several samples" in n and "wrong" not in n for n in recording.notes)
    if form != "objects inside":
        assert {s.name: s.unit for s in recording.signals if s.dtype != "str"} == {
            "/daq.T.values": "degC",
            "/daq.dZ.values": "um",
        }


def test_clocks_of_their_own_make_rows_of_their_own(tmp_path: Path, write: Any, read: Any) -> None:
    def made(ks: list[int]) -> dict[str, Any]:
        half = [k + 0.5 for k in ks[::2]]
        return {"T": {"t": [at(k) for k in ks], "v": ks}, "dZ": {"t": [at(k) for k in half], "v": half}}

    _, times, values, _, losses = read(write(tmp_path / "a.mcap", batches(4, made)))
    assert not losses
    dz = np.array(values["/daq.dZ.v"], float)
    good = np.isfinite(dz)
    np.testing.assert_allclose(times["/daq"][good], T0 + STEP * dz[good], atol=1000)
    assert int(good.sum()) == 12
    assert (np.diff(times["/daq"]) > 0).all()


@pytest.mark.parametrize("early", [{}, {"T": []}])
@pytest.mark.parametrize(("begins", "ends"), [(25, 60), (350, 420), (350, 360)])
def test_an_array_that_begins_late_is_one(
    tmp_path: Path, write: Any, read: Any, early: dict[str, Any], begins: int, ends: int
) -> None:
    def made(ks: list[int]) -> dict[str, Any]:
        late = {"T": [20.0 + k for k in ks]} if begins * N <= ks[0] < ends * N else early
        return {"t": [at(k) for k in ks], "dZ": ks, **late}

    many = 60 if ends == 60 else 420
    recording, times, values, _, losses = read(write(tmp_path / "a.mcap", batches(many, made)))
    assert not losses
    assert {s.name for s in recording.signals} == {"/daq.dZ", "/daq.T"}
    np.testing.assert_allclose(times["/daq"], T0 + STEP * np.arange(many * N), atol=1000)
    held = [20.0 + k if begins * N <= k < ends * N else np.nan for k in range(many * N)]
    np.testing.assert_array_equal(values["/daq.T"], held)


def test_samples_that_begin_after_a_long_wait_stand_at_their_times(tmp_path: Path, write: Any, read: Any) -> None:
    def made(ks: list[int]) -> dict[str, Any]:
        return {"t": [at(k) for k in ks], "dZ": ks} if ks[0] >= 250 * N else {"state": "waiting"}

    _, times, values, _, losses = read(write(tmp_path / "a.mcap", batches(300, made)))
    assert not losses
    dz = np.array(values["/daq.dZ"], float)
    good = np.isfinite(dz)
    np.testing.assert_array_equal(dz[good], np.arange(250 * N, 300 * N))
    np.testing.assert_allclose(times["/daq"][good], T0 + STEP * dz[good], atol=1000)


def test_a_vector_that_comes_late_beside_samples_stays_one(tmp_path: Path, write: Any, read: Any) -> None:
    def made(ks: list[int]) -> dict[str, Any]:
        late = {"xyz": [1.0, 2.0, 3.0]} if ks[0] >= 300 * N else {}
        return {"t": [at(k) for k in ks], "dZ": ks, **late}

    recording, *_ = read(write(tmp_path / "a.mcap", batches(320, made)))
    assert {s.name for s in recording.signals} == {"/daq.dZ", *(f"/daq.xyz[{k}]" for k in range(3))}


def test_an_array_with_times_of_its_own_is_of_no_step_around_it(tmp_path: Path, write: Any, read: Any) -> None:
    def made(ks: list[int]) -> dict[str, Any]:
        slow = {"t": [at(ks[0]), at(ks[3])], "v": [20.0 + ks[0], 20.0 + ks[3]]}
        return {"t0": at(ks[0]), "dt": 6.0, "dZ": ks, "T": slow}

    recording, times, values, _, losses = read(write(tmp_path / "a.mcap", batches(60, made)))
    assert not losses
    assert {s.name for s in recording.signals} == {"/daq.dZ", "/daq.T.v"}
    for name, scale in (("/daq.dZ", 0), ("/daq.T.v", 20)):
        each = np.array(values[name], float)
        good = np.isfinite(each)
        assert int(good.sum()) == (120 if scale else 60 * N)
        np.testing.assert_allclose(times["/daq"][good], T0 + STEP * (each[good] - scale), atol=1000)


@pytest.mark.parametrize("n", [1, 2])
def test_events_beside_samples_stay_as_they_are(tmp_path: Path, write: Any, read: Any, n: int) -> None:
    def made(ks: list[int]) -> dict[str, Any]:
        events = [{"time": "now", "code": k} for k in ks[:n]]
        return {"t": [at(k) for k in ks], "dZ": ks, "events": events if ks[0] % 2 else []}

    recording, times, values, _, losses = read(write(tmp_path / "a.mcap", batches(60, made)))
    assert not losses
    names = {f"/daq.events[{i}].{key}" for i in range(n) for key in ("time", "code")}
    assert {s.name for s in recording.signals} == {"/daq.dZ", *names}
    assert values["/daq.dZ"] == list(range(60 * N))
    code = np.array(values["/daq.events[0].code"], float)
    good = np.isfinite(code)
    np.testing.assert_array_equal(code[good], np.arange(N, 60 * N, 2 * N))
    np.testing.assert_allclose(times["/daq"][good], T0 + STEP * code[good], atol=1000)


def test_two_samples_of_one_clock_at_one_time_are_both_there(tmp_path: Path, write: Any, read: Any) -> None:
    def made(ks: list[int]) -> dict[str, Any]:
        half = [ks[0], ks[0]] if ks[0] == 7 * N else [ks[0], ks[3]]
        return {"t": [at(k) for k in ks], "dZ": ks, "slow": {"t": [at(k) for k in half], "v": [1.0, 2.0]}}

    _, times, values, _, losses = read(write(tmp_path / "a.mcap", batches(60, made)))
    assert not losses
    slow, dz = (np.array(values[f"/daq.{name}"], float) for name in ("slow.v", "dZ"))
    assert slow[np.isfinite(slow)].tolist() == [1, 2] * 60
    assert dz[np.isfinite(dz)].tolist() == list(range(60 * N))
    assert len(times["/daq"]) == 60 * N + 1
    ((twice,),) = np.nonzero(np.diff(times["/daq"]) == 0)
    assert times["/daq"][twice] == pytest.approx(T0 + STEP * 7 * N, abs=1000)
    assert slow[twice : twice + 2].tolist() == [1, 2]


def test_a_sample_alone_may_stand_without_brackets(tmp_path: Path, write: Any, read: Any) -> None:
    def made(ks: list[int]) -> dict[str, Any]:
        return {"t": [at(k) for k in ks], "dZ": ks} if len(ks) > 1 else {"t": at(ks[0]), "dZ": ks[0]}

    sent = [("/daq", T0 + STEP * ks[-1] + 3, made(ks)) for ks in ([0, 1], [2, 3, 4], [5], [6, 7], [8])]
    _, times, values, _, losses = read(write(tmp_path / "a.mcap", sent))
    assert not losses
    assert values["/daq.dZ"] == list(range(9))
    np.testing.assert_allclose(times["/daq"], T0 + STEP * np.arange(9), atol=1000)


def test_what_a_message_holds_once_stands_with_its_first_sample(tmp_path: Path, write: Any, read: Any) -> None:
    made = batches(4, lambda ks: {"t0": at(ks[0]), "dt": 6.0, "dZ": ks, "T": float(ks[0]), "xyz": [1.0, 2.0, 3.0]})
    _, times, values, _, _ = read(write(tmp_path / "a.mcap", made))
    good = np.isfinite(np.array(values["/daq.T"], float))
    assert times["/daq"][good].tolist() == [T0 + STEP * N * k for k in range(4)]
    assert np.array(values["/daq.T"], float)[good].tolist() == [0, 5, 10, 15]


def test_a_clock_of_the_samples_that_is_far_from_the_log_is_told(tmp_path: Path, write: Any, read: Any) -> None:
    made = [(topic, ns + 3600 * 10**9, held) for topic, ns, held in batches(4, FORMS["times beside"])]
    recording, times, *_ = read(write(tmp_path / "a.mcap", made))
    assert times["/daq"][0] == T0
    assert any("3600 s from the log times" in n for n in recording.notes)


@pytest.mark.parametrize(
    "made",
    [
        lambda ks: {"t": at(ks[0]), "position": [1.0 * k for k in ks]},  # a vector at one time
        lambda ks: {"t0": at(ks[0]), "dt": 30.0, "position": [1.0 * k for k in ks]},  # the time between messages
        lambda ks: {"t": [0, 6, 12, 18, 24], "dZ": ks},  # of which nothing says when
        lambda ks: {"names": ["a", "b", "c", "d", "e"], "dZ": ks},
        lambda ks: {"t": [0, 6, 12, 18, 24], "dZ": {"values": ks}},
        lambda ks: {"dt": 6.0, "zones": [1.0 * k for k in ks], "dZ": ks[0]},
        lambda ks: {"probes": [{"name": n, "t": at(k), "um": k} for n, k in zip("abcde", ks, strict=True)]},
        lambda ks: {"sensors": [{"t": at(ks[-1]), "um": k} for k in ks]},  # read at one time
    ],
)
def test_the_nearest_others_stay_as_they_are(tmp_path: Path, write: Any, read: Any, made: Any) -> None:
    sent = batches(6, made)
    recording, times, *_ = read(write(tmp_path / "a.mcap", sent))
    assert times["/daq"].tolist() == [ns for _, ns, _ in sent]
    assert not any("holds several samples" in n for n in recording.notes)
    assert any("counts from no date" in n for n in recording.notes) == isinstance(sent[0][2].get("t"), list)


def test_a_declared_time_keeps_messages_whole(tmp_path: Path, write: Any, read: Any) -> None:
    path = write(tmp_path / "a.mcap", batches(4, FORMS["step in s"]))
    _, times, values, _, _ = read(path, Source(options={"time": "publish_time"}))
    assert len(times["/daq"]) == 4
    assert values["/daq.dZ[1]"] == [1, 6, 11, 16]


def test_a_sample_is_found_in_its_message(tmp_path: Path, write: Any) -> None:
    path = write(tmp_path / "a.mcap", batches(4, FORMS["step in s"]))
    assert Reader().locate(path, Source(), "/daq", 12).startswith("message 3,")


@pytest.mark.parametrize(
    "form",
    [
        lambda ks, z, unit: {"t0": at(ks[0]), "dt": 6.0, "dZ": z, "unit": unit},
        lambda ks, z, unit: {"t": [at(k) for k in ks], "value": z, "unit": unit},
    ],
)
def test_a_unit_that_is_said_once_is_of_all_samples_of_its_message(
    tmp_path: Path, write: Any, read: Any, form: Any
) -> None:
    """The recorder is set to mm halfway."""

    def made(ks: list[int]) -> dict[str, Any]:
        late = ks[0] >= 20 * N
        return form(ks, [k / 1000 if late else float(k) for k in ks], "mm" if late else "um")

    recording, _, values, _, losses = read(write(tmp_path / "a.mcap", batches(40, made)))
    (name,) = [s.name for s in recording.signals if s.unit == "um"]
    assert not losses
    np.testing.assert_allclose(values[name], np.arange(40.0 * N))
