"""Times of messages: log, publish and their own stamps; clocks that count from zero."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mcap.writer import CompressionType
from thermodata_reader_mcap import Reader

from thermodata.errors import FormatError
from thermodata.plugin import Source
from thermodata.reader.contract.guard import described

T0 = 1_772_434_800_000_000_000
STEP = 10_000_000
REAL = Path(__file__).resolve().parents[5] / "shared" / "data" / "mcap"
COMPRESSIONS = [CompressionType.NONE, CompressionType.LZ4, CompressionType.ZSTD]


def test_publish_times_are_kept_where_they_differ(tmp_path: Path, write: Any, read: Any, axis: Any) -> None:
    same = write(tmp_path / "a.mcap", axis(5))
    other = write(tmp_path / "b.mcap", axis(5), publish=lambda t: t - 250)
    assert "/axis.publish_time" not in read(same)[2]
    assert read(other)[2]["/axis.publish_time"] == [T0 + k * STEP - 250 for k in range(5)]


def test_order_of_the_recording_is_kept(tmp_path: Path, write: Any, read: Any) -> None:
    order = [3, 1, 2, 0, 4]
    path = write(tmp_path / "a.mcap", [("/m", T0 + k, {"k": k}) for k in order])
    assert read(path)[1]["/m"].tolist() == [T0 + k for k in order]
    assert read(path)[2]["/m.k"] == order


def test_log_times_from_zero_are_a_relative_clock(tmp_path: Path, write: Any, read: Any) -> None:
    recording, times, _, _, _ = read(write(tmp_path / "a.mcap", [("/m", k * STEP, {"k": k}) for k in range(5)]))
    assert (recording.clock, recording.start_ns) == ("relative", None)
    assert times["/m"][-1] == 4 * STEP


def stamped(k: int) -> dict[str, Any]:
    return {
        "header": {"stamp": {"sec": (T0 + k * STEP) // 10**9, "nanosec": (T0 + k * STEP) % 10**9}},
        "v": k,
        "ms": (T0 + k * STEP) / 1e6,
    }


def test_a_source_says_which_time_counts(tmp_path: Path, write: Any, read: Any) -> None:
    path = write(
        tmp_path / "a.mcap", [("/m", T0 + k * STEP + 777, stamped(k)) for k in range(50)], publish=lambda t: t - 250
    )
    t = T0 + STEP * np.arange(50)
    for options, expected in (({}, t + 777), ({"time": "publish_time"}, t + 527), ({"time": "header.stamp"}, t)):
        _, times, values, _, losses = read(path, Source(options=options))
        assert not losses
        np.testing.assert_array_equal(times["/m"], expected)
        kept = "/m.log_time" if options else "/m.publish_time"
        assert values[kept] == (t + 777 if options else t + 527).tolist()
    _, times, _, _, _ = read(path, Source(options={"time": "ms", "time_unit": "ms"}))
    assert np.abs(times["/m"] - t).max() < 1000


def test_a_message_without_its_stamp_keeps_its_log_time_and_is_flagged(tmp_path: Path, write: Any, read: Any) -> None:
    messages = [("/m", T0 + k * STEP + 5, stamped(k) if k != 7 else {"v": 7}) for k in range(20)]
    path = write(tmp_path / "a.mcap", messages)
    _, times, _, flags, losses = read(path, Source(options={"time": "header.stamp"}))
    assert times["/m"][7] == T0 + 7 * STEP + 5
    assert [bool(f & 64) for f in flags["/m.v"]] == [k == 7 for k in range(20)]
    assert ["log time stands for it" in loss.reason for loss in losses] == [True]


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"tme": "x"}, "did you mean 'time'"),
        ({"time": ""}, "header.stamp"),
        ({"time_unit": "h"}, "ms"),
        ({"enums": "both"}, "label"),
    ],
)
def test_options_that_are_none_are_refused(
    tmp_path: Path, write: Any, axis: Any, options: dict[str, str], words: str
) -> None:
    path = write(tmp_path / "a.mcap", axis(5))
    with pytest.raises(FormatError, match=words):
        described(Reader(), path, Source(options=options))


def test_publish_times_that_differ_late_are_said(
    tmp_path: Path, write: Any, read: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    from thermodata_reader_mcap.container import messages
    from thermodata_reader_mcap.signals import plan

    monkeypatch.setattr(plan, "WHOLE", 2000)
    monkeypatch.setattr(messages, "_LOOSE", 10)
    path = write(
        tmp_path / "a.mcap",
        [("/m", T0 + k, {"v": k / 2}) for k in range(500)],
        use_chunking=False,
        publish=lambda t: t - 9 * (t > T0 + 400),
    )
    _, times, values, _, losses = read(path)
    assert times["/m"].size == 500
    assert ["publish_time: true" in loss.reason for loss in losses] == [True]
    assert "/m.publish_time" not in values
    assert read(path, Source(options={"publish_time": True}))[2]["/m.publish_time"][-1] == T0 + 499 - 9


def test_times_beyond_what_is_kept_are_lost_by_name(tmp_path: Path, write: Any, read: Any) -> None:
    path = write(
        tmp_path / "a.mcap",
        [("/m", 2**64 - 1 if k == 3 else T0 + k, {"v": k / 2}) for k in range(10)],
        publish=lambda t: t if t == T0 + 5 else 2**63 + 5,
    )
    _, times, values, flags, losses = read(path)
    assert times["/m"].size == 9
    assert sum("2262" in loss.reason for loss in losses) == 2
    assert [f > 0 for f in flags["/m.publish_time"]] == [v == 0 for v in values["/m.publish_time"]]


@pytest.mark.parametrize(("unit", "scale"), [("s", 1e9), ("ms", 1e6), ("us", 1e3), ("ns", 1)])
def test_a_number_since_1970_in_the_messages_of_a_burst_is_noted_and_read(
    tmp_path: Path, write: Any, read: Any, unit: str, scale: float
) -> None:
    times = [T0 + i * 10**9 for i in range(300)]
    stamps = [t / 1e9 if unit == "s" else round(t / scale) for t in times]
    bursts = [("/m", T0 + (i // 50 + 1) * 50 * 10**9 + i, {"made": s, "T": 20.5}) for i, s in enumerate(stamps)]
    path = write(tmp_path / "a.mcap", bursts)
    assert any(f"declare options: {{time: made, time_unit: {unit}}}" in n for n in read(path)[0].notes)
    for options in ({"time": "made"}, {"time": "made", "time_unit": unit}):
        _, got, _, _, losses = read(path, Source(options=options))
        assert got["/m"].tolist() == times
        assert not losses


@pytest.mark.parametrize(
    "field", [[T0 / 1e9 - 9e7 + i for i in range(300)], [T0 / 1e9 + i // 100 for i in range(300)], list(range(300))]
)
def test_a_date_of_something_else_is_no_stamp(tmp_path: Path, write: Any, read: Any, field: list[float]) -> None:
    bursts = [("/m", T0 + (i // 50) * 10**10 + i, {"made": s, "T": 20.5}) for i, s in enumerate(field)]
    assert not any("changes its distance" in n for n in read(write(tmp_path / "a.mcap", bursts))[0].notes)


def test_a_declared_number_that_counts_from_no_date_is_refused(tmp_path: Path, write: Any, read: Any) -> None:
    path = write(tmp_path / "a.mcap", [("/m", T0 + i * STEP, {"n": i, "T": 20.5}) for i in range(50)])
    with pytest.raises(FormatError, match="does not tell its unit"):
        read(path, Source(options={"time": "n"}))


@pytest.mark.parametrize("time", [None, "t", "header.stamp"])
def test_a_whole_number_beyond_all_floats_is_lost_alone(
    tmp_path: Path, write: Any, read: Any, time: str | None
) -> None:
    def message(k: int) -> dict[str, Any]:
        huge = 10**400 if k == 12 else T0 // 10**9 + k
        return {"t": huge, "header": {"stamp": {"sec": huge, "nanosec": 0}}, "v": k / 2}

    path = write(tmp_path / "a.mcap", [("/m", T0 + k * 10**9, message(k)) for k in range(30)])
    _, times, values, _, losses = read(path, Source(options={"time": time} if time else {}))
    assert values["/m.v"] == [k / 2 for k in range(30)]
    assert times["/m"].tolist() == [T0 + k * 10**9 for k in range(30)]
    assert losses


def test_a_stamp_that_is_not_set_hides_no_unit_and_is_no_time(tmp_path: Path, write: Any, read: Any) -> None:
    stamps = [0 if k == 3 else T0 // 10**6 + k for k in range(30)]
    path = write(tmp_path / "a.mcap", [("/m", T0 + k * STEP, {"t": s, "v": k / 2}) for k, s in enumerate(stamps)])
    _, times, _, flags, losses = read(path, Source(options={"time": "t"}))
    assert times["/m"].tolist() == [T0 + 3 * STEP if k == 3 else s * 10**6 for k, s in enumerate(stamps)]
    assert [bool(f & 64) for f in flags["/m.v"]] == [k == 3 for k in range(30)]
    assert ["log time stands for it" in loss.reason for loss in losses] == [True]


def test_the_zero_of_a_clock_that_counts_from_zero_is_a_time(tmp_path: Path, write: Any, read: Any) -> None:
    path = write(tmp_path / "a.mcap", [("/m", T0 + k * STEP, {"t": k * 10, "v": k / 2}) for k in range(30)])
    _, times, _, _, losses = read(path, Source(options={"time": "t", "time_unit": "ms"}))
    assert times["/m"].tolist() == [k * STEP for k in range(30)]
    assert not losses


def test_stamps_with_dates_are_offered_where_log_times_count_from_boot(tmp_path: Path, write: Any, read: Any) -> None:
    messages = [
        ("/t", 5 * 10**9 + k * 10**9, {"header": {"stamp": {"sec": T0 // 10**9 + k, "nanosec": 0}}, "T": 20 + k / 8})
        for k in range(60)
    ]
    recording = read(write(tmp_path / "a.mcap", messages))[0]
    assert any("header.stamp has dates" in n and "options: {time: header.stamp}" in n for n in recording.notes)


def test_publish_times_are_offered_where_log_times_are_of_a_conversion(tmp_path: Path, write: Any, read: Any) -> None:
    messages = [("/t", T0 + k * 10**6, {"T": 20 + k / 8}) for k in range(60)]
    path = write(tmp_path / "a.mcap", messages, publish=lambda t: T0 - 86_400 * 10**9 + (t - T0) * 60_000)
    assert any("options: {time: publish_time}" in n for n in read(path)[0].notes)
    late = write(tmp_path / "b.mcap", messages, publish=lambda t: t - 5)
    assert not any("publish_time}" in n for n in read(late)[0].notes)


def test_one_message_that_was_published_long_before_is_no_conversion(tmp_path: Path, write: Any, read: Any) -> None:
    """As those that a recorder is given once, when it begins to listen."""
    messages = [("/t", T0 + k * 10**9, {"T": 20 + k / 8}) for k in range(60)]
    path = write(tmp_path / "a.mcap", messages, publish=lambda t: t - 3600 * 10**9 if t == T0 else t)
    assert not any("publish_time}" in n for n in read(path)[0].notes)


def test_a_count_from_boot_is_no_date(tmp_path: Path, write: Any, read: Any) -> None:
    """13 days in nanoseconds look like 36 years in microseconds."""
    boot = 13 * 86_400 * 10**9
    messages = [("/t", boot + k * 10**9, {"mono_ns": boot + k * 10**9, "T": 20 + k / 8}) for k in range(60)]
    assert not any("has dates" in n for n in read(write(tmp_path / "a.mcap", messages))[0].notes)


def test_a_message_without_a_publish_time_dates_no_recording(tmp_path: Path, write: Any, read: Any) -> None:
    messages = [("/t", T0 + k * 10**9, {"T": 20 + k / 8}) for k in range(60)]
    path = write(tmp_path / "a.mcap", messages, publish=lambda t: 0 if t == T0 else t)
    recording = read(path, Source(options={"time": "publish_time"}))[0]
    assert (recording.clock, recording.start_ns) == ("absolute", T0 + 10**9)


@pytest.mark.parametrize(
    ("off_s", "wander_s", "told"),
    [
        (427, 0, "427 s before the log times"),
        (-1800, 0, "1800 s behind the log times"),
        (30, 0, None),  # a delay
        (427, 60, None),
        (30 * 86_400, 0, None),  # a date of something else
    ],
)
def test_two_clocks_that_keep_their_distance_are_told(
    tmp_path: Path, write: Any, read: Any, off_s: int, wander_s: int, told: str | None
) -> None:
    def publish(t: int) -> int:
        return t - (off_s + wander_s * (t // 10**9 % 2)) * 10**9

    path = write(tmp_path / "a.mcap", [("/m", T0 + k * 10**9, {"k": k}) for k in range(50)], publish=publish)
    notes = [n for n in read(path)[0].notes if "two clocks" in n]
    assert bool(notes) is (told is not None)
    assert told is None or (told in notes[0] and "options: {time: publish_time}" in notes[0])


@pytest.mark.parametrize(("off_s", "told"), [(427, True), (20, False)])
def test_stamps_of_another_clock_are_told(tmp_path: Path, write: Any, read: Any, off_s: int, told: bool) -> None:
    path = write(tmp_path / "a.mcap", [("/m", T0 + k * STEP + off_s * 10**9, stamped(k)) for k in range(50)])
    notes = [n for n in read(path)[0].notes if "two clocks" in n]
    assert bool(notes) is told
    assert not told or "options: {time: header.stamp}" in notes[0]
