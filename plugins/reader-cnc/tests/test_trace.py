"""Sinumerik Trace: XML with servo signals on change, and CSV."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from thermodata_reader_cnc import Reader
from thermodata_reader_cnc.sinumerik import trace_records

from thermodata.errors import FormatError, QuestionError
from thermodata.plugin import Source
from thermodata.reader.finding.registry import head
from thermodata.reader.times.zone import NO_ZONE
from thermodata.schema.flag import Flag
from thermodata.testing.reader import load, reader_checks

from .logs import written

CURRENT, POSITION, CHANNEL = (
    "/Nck/!SD/nckServoDataActCurr32 [u1, 7]",
    "/Nck/!SD/nckServoDataActPos1stEnc32 [u1, 1]",
    "/Channel/!RP/rpa [u1, 15]",
)


def xml(rows: int = 300, count: int | None = None, start: str = "2026-03-02T09:00:00", more: str = "") -> str:
    """Current changes every third row, the position every row but between 100 and 200, the channel every fourth."""
    recs = []
    for k in range(rows):
        cells = f' f3="{k}"' if k % 4 == 0 else ""
        cells += f' f1="{k / 3:.6f}"' if k % 3 == 0 else ""
        cells += f' f2="{k / 8}"' if not 100 < k < 200 else ""
        if cells:
            recs.append(f'<rec time="{k * 0.002:.3f}"{cells}/>')
    recs.append(f'<rec time="{rows * 0.002:.3f}" f1="{rows / 3:.6f}" f2="{rows / 8}"/>')  # the stop writes them all
    count = rows + 1 if count is None else count
    signals = "".join(
        f'<dataSignal id="f{n}" name="{name}" interval="{step}" event="{event}" datapointCount="{size}" unitsType="x"/>'
        for n, (name, step, event, size) in enumerate(
            ((CURRENT, 0.002, 255, count), (POSITION, 0.002, 255, count), (CHANNEL, 0.008, 1, -(-rows // 4))), 1
        )
    )
    return (
        f'<?xml version="1.0" encoding="UTF-8"?>\n<traceSession version="1.0">\n<traceData><dataFrame>\n'
        f'<frameHeader startTime="{start}" startTriggerInc="0" {more}/>\n{signals}\n'
        + "\n".join(recs)
        + "\n</dataFrame></traceData>\n</traceSession>\n"
    )


@pytest.mark.parametrize("feed", [1 << 20, 1000])
def test_servo_signals_are_held_on_their_grid(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, feed: int) -> None:
    monkeypatch.setattr(trace_records, "FEED", feed)
    path = written(tmp_path, xml(), "trace.xml")
    assert "Sinumerik" in (Reader().sniff(head(path)) or "")
    data = load(Reader(), path, Source(timezone="Europe/Prague"))
    assert not data.losses
    assert data.recording.complete is True
    assert data.recording.start_ns == np.datetime64("2026-03-02T08:00:00", "ns").astype(np.int64)
    servo = data.t_ns["servo@0.002"] - data.recording.start_ns
    k = np.arange(servo.size)
    np.testing.assert_array_equal(servo, k * 2_000_000)
    assert servo.size == 301
    np.testing.assert_allclose(data.values["servo@0.002", CURRENT], (k - k % 3) / 3, atol=1e-5)
    np.testing.assert_array_equal(data.values["servo@0.002", POSITION], np.where((k > 100) & (k < 200), 100, k) / 8)
    assert data.values["ipo@0.008", CHANNEL].tolist() == list(range(0, 300, 4))
    assert data.recording.signals[0].unit is None
    assert data.recording.signals[0].properties["unitsType"] == "x"


def test_counts_and_dropouts_are_checked(tmp_path: Path) -> None:
    data = load(Reader(), written(tmp_path, xml(count=400, more='dropOuts="3"'), "trace.xml"), Source())
    reasons = [loss.reason for loss in data.losses]
    assert any("drop-outs: 3" in r for r in reasons)
    assert (data.flags["servo@0.002", CURRENT] & Flag.CLOCK_SUSPECT).all()
    assert sum("datapointCount is 400" in r for r in reasons) == 2


def test_a_cut_trace_keeps_what_is_there(tmp_path: Path) -> None:
    text = xml()
    data = load(Reader(), written(tmp_path, text[: len(text) // 2], "trace.xml"), Source())
    assert data.recording.complete is False
    assert 50 < data.t_ns["servo@0.002"].size < 250
    assert any("ends or is damaged" in loss.reason for loss in data.losses)


def test_a_start_that_is_no_date_makes_times_relative_and_entities_are_refused(tmp_path: Path) -> None:
    data = load(Reader(), written(tmp_path, xml(start="0"), "trace.xml"), Source())
    assert (data.recording.clock, data.t_ns["servo@0.002"][0]) == ("relative", 0)
    bomb = xml().replace("<traceSession", '<!DOCTYPE t [<!ENTITY a "aa">]><traceSession', 1)
    with pytest.raises(FormatError, match="entities"):
        load(Reader(), written(tmp_path, bomb, "bomb.xml"), Source())


@pytest.mark.parametrize(
    ("start", "zone", "open_"),
    [
        ("2026-03-02T09:00:00", None, True),
        ("2026-03-02T09:00:00", "Europe/Prague", False),
        ("2026-03-02T09:00:00Z", None, False),
        ("0", None, False),
    ],
)
def test_a_start_without_a_zone_says_so(tmp_path: Path, start: str, zone: str | None, open_: bool) -> None:
    recording = Reader().describe(written(tmp_path, xml(start=start), "trace.xml"), Source(timezone=zone))
    assert any(NO_ZONE in note for note in recording.notes) == open_


def test_every_sample_is_counted(tmp_path: Path) -> None:
    whole = xml()
    at = whole.index('<rec time="0.400"')
    data = load(Reader(), written(tmp_path, whole[:at] + whole[whole.index("/>", at) + 3 :], "trace.xml"), Source())
    assert ["datapointCount is 75, the file holds 74" in loss.reason for loss in data.losses] == [True]
    last = whole.rindex("<rec")
    data = load(Reader(), written(tmp_path, whole[:last] + whole[whole.index("/>", last) + 3 :], "trace.xml"), Source())
    assert {"datapointCount is 301, the grid holds 300" in loss.reason for loss in data.losses} == {True}


def test_several_frames_of_one_and_of_other_signals(tmp_path: Path) -> None:
    """Each frame starts by its own clock and count; one of other signals is a stream of its own."""
    first, second, third = xml(40), xml(20, start="2026-03-02T10:00:00"), xml(30).replace("ActCurr32", "DrvLoad32")
    frames = [text[text.index("<dataFrame>") : text.index("</traceData>")] for text in (first, second, third)]
    head = first[: first.index("<dataFrame>")].replace("<traceData>", '<traceData dataFrames="3">')
    tail = first[first.index("</traceData>") :]
    data = load(Reader(), written(tmp_path, head + "".join(frames) + tail, "trace.xml"), Source())
    assert not data.losses
    servo = data.t_ns["servo@0.002"] - data.recording.start_ns
    assert servo.tolist() == [k * 2_000_000 for k in range(41)] + [3600 * 10**9 + k * 2_000_000 for k in range(21)]
    assert data.values["servo@0.002 #2", CURRENT.replace("ActCurr32", "DrvLoad32")].size == 31
    data = load(Reader(), written(tmp_path, head + "".join(frames[:2]) + tail, "trace.xml"), Source())
    assert [loss.reason for loss in data.losses] == ["3 frames are announced, 2 are there"]


@pytest.mark.parametrize(("interval", "scale"), [("0.002", 1.0), ("2", 1000.0), ("2000", 1e6)])
def test_an_interval_may_be_in_seconds_or_less(tmp_path: Path, interval: str, scale: float) -> None:
    """The unit is what the records lie on, whatever other rates are in the frame."""
    text = xml(60).replace('interval="0.002"', f'interval="{interval}"')
    text = text.replace('interval="0.008"', 'interval="0.000125"')
    text = text.replace('<rec time="0.004"', '<rec time="0.002125" f3="9"/><rec time="0.004"')
    text = text.replace('datapointCount="15"', 'datapointCount="16"')
    data = load(Reader(), written(tmp_path, text, "trace.xml"), Source())
    assert not data.losses
    stream = next(s for s in data.t_ns if s.startswith("servo"))
    assert np.diff(data.t_ns[stream]).tolist() == [2_000_000] * 60


def test_a_rounded_interval_is_taken_from_length_and_count(tmp_path: Path) -> None:
    recs = "".join(f'<rec time="{k * 62.5e-6:.6f}" f1="{k}"/>' for k in range(2001))
    text = (
        '<traceSession><traceData><dataFrame><frameHeader startTime="2026-03-02T09:00:00Z" stopInc="0.125000"/>'
        '<dataSignal id="f1" name="a" interval="0.000063" event="255" datapointCount="2001"/>'
        + recs
        + "</dataFrame></traceData></traceSession>"
    )
    data = load(Reader(), written(tmp_path, text, "trace.xml"), Source())
    assert not data.losses
    assert np.diff(data.t_ns["servo"]).tolist() == [62_500] * 2000


def test_signals_that_the_first_look_meets_in_two_parts(tmp_path: Path) -> None:
    """A frame's signals may stand on both sides of a border between the parts that are read."""
    text = (
        xml(40)
        .replace("<traceData>", '<traceData dataFrames="1">')
        .replace("<dataSignal", "<!--" + "x" * 30_000 + "--><dataSignal")
    )
    data = load(Reader(), written(tmp_path, text, "trace.xml"), Source())
    assert not data.losses
    assert len(data.recording.signals) == 3


def test_values_that_are_none_and_times_of_another_world(tmp_path: Path) -> None:
    text = (
        xml(60)
        .replace('f1="4.000000"', 'f1="9218868437227405312"')
        .replace("</dataFrame>", '<rec time="999999.0" f1="7"/></dataFrame>')
    )
    data = load(Reader(), written(tmp_path, text, "trace.xml"), Source())
    values = data.values["servo@0.002", CURRENT]
    assert np.flatnonzero(np.isnan(values)).tolist() == [12, 13, 14]
    assert (data.flags["servo@0.002", CURRENT][12:15] == Flag.NOT_MEASURING).all()
    assert values.size == 61
    assert ["lie more than" in loss.reason for loss in data.losses] == [True]


@pytest.mark.parametrize(("delimiter", "decimal"), [(",", "."), (";", ","), ("\t", ".")])
def test_trace_csv_with_a_block_of_rows_before_the_header(tmp_path: Path, delimiter: str, decimal: str) -> None:
    names = delimiter.join(f'"{n}"' for n in ("Time", "/Nck/!SD/nckServoDataActCurr32 [u1; 1]", "+/Channel/!RP/rpa"))
    rows = "".join(
        delimiter.join((f"{k * 0.002:.3f}", f"{k / 8}", f"{k}")).replace(".", decimal) + "\n" for k in range(50)
    )
    path = written(tmp_path, "Session 1\n\n" + names + "\n" + rows + "x\n", "trace.csv")
    assert "Trace CSV" in (Reader().sniff(head(path)) or "")
    data = load(Reader(), path, Source())
    assert [loss.where for loss in data.losses] == ["trace.csv line 54"]
    assert data.t_ns["trace"].tolist() == [k * 2_000_000 for k in range(50)]
    assert data.values["trace", "/Nck/!SD/nckServoDataActCurr32 [u1; 1]"].tolist() == [k / 8 for k in range(50)]


@pytest.mark.parametrize("names", ["", "time, f2, f1\n"])
def test_trace_csv_with_a_row_a_signal_before_the_data(tmp_path: Path, names: str) -> None:
    """The control replaces the comma in a signal's path, as it stands between the cells."""
    text = (
        "id, key, domain, interval, name\nf1, s1, NCU_1, 0.002, /Nck/!SEMA/cmdContrPos [u1  1]\n"
        "f2, s2, NCU_1, 0.002, /Nck/!SD/nckServoDataActCurr64 [u1  1]\n\n"
        + names
        + "".join(f"{k * 0.002:.6f}, {k / 8}, {-k}\n" for k in range(20))
    )
    data = load(Reader(), written(tmp_path, text, "trace.csv"), Source())
    assert not data.losses
    first, second = "/Nck/!SEMA/cmdContrPos [u1  1]", "/Nck/!SD/nckServoDataActCurr64 [u1  1]"
    first, second = (second, first) if names else (first, second)
    assert data.values["trace", first].tolist() == [k / 8 for k in range(20)]
    assert data.values["trace", second].tolist() == [-k for k in range(20)]
    assert data.t_ns["trace"].tolist() == [k * 2_000_000 for k in range(20)]


@pytest.fixture(scope="module")
def kit_files(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    folder = tmp_path_factory.mktemp("kit")
    rows = "".join(f"{k * 0.002:.3f},{k / 8}\n" for k in range(50))
    return {
        "xml": written(folder, xml(60), "trace.xml"),
        "csv": written(folder, '"Time","/Nck/!SD/nckServoDataActCurr32 [u1; 1]"\n' + rows, "trace.csv"),
    }


def counted(name: str, step: float = 10.0) -> str:
    rows = "".join(f"{i * step:g},{20 + i / 4}\n" for i in range(40))
    return f"{name},/Nck/MachineAxis/aaTemp[1]\n{rows}"


@pytest.mark.parametrize(
    ("name", "step_ns"),
    [("Time", 10_000_000_000), ("Time [ms]", 10_000_000), ("Tick_ms", 10_000_000), ("t / min", 600_000_000_000)],
)
def test_the_time_of_a_trace_csv_is_in_the_unit_that_its_name_says(tmp_path: Path, name: str, step_ns: int) -> None:
    data = load(Reader(), written(tmp_path, counted(name), "trace.csv"), Source())
    assert set(np.diff(data.t_ns["trace"])) == {step_ns}


def test_a_count_that_is_called_no_time_is_asked_for_its_unit(tmp_path: Path) -> None:
    path = written(tmp_path, counted("Tick"), "trace.csv")
    with pytest.raises(QuestionError, match="'Tick' has no unit"):
        load(Reader(), path, Source())
    data = load(Reader(), path, Source(table={"time": {"unit": "ms"}}))
    assert set(np.diff(data.t_ns["trace"])) == {10_000_000}


@pytest.mark.parametrize("number", range(len(reader_checks(Reader, [(Path("x"), Source())]))))
@pytest.mark.parametrize("kind", ["xml", "csv"])
def test_they_keep_the_rules_of_readers(kit_files: dict[str, Path], kind: str, number: int) -> None:
    reader_checks(Reader, [(kit_files[kind], Source())])[number]()
