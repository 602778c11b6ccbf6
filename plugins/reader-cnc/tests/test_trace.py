"""Sinumerik Trace: XML with servo signals on change, and CSV."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from thermodata_reader_cnc import Reader, tracexml

from thermodata.errors import FormatError
from thermodata.plugin import Source
from thermodata.reader.registry import head
from thermodata.testing.reader import load, reader_checks

CLAIMS = ["SHDR", "MTCONNECT", "TWINCAT", "SCO", "TRACE_XML", "TRACE_CSV", "OPCUA"]
CURRENT, POSITION, CHANNEL = ("/Nck/!SD/nckServoDataActCurr32 [u1, 7]", "/Nck/!SD/nckServoDataActPos1stEnc32 [u1, 1]",
                              "/Channel/!RP/rpa [u1, 15]")


def xml(rows: int = 300, count: int | None = None, start: str = "2026-03-02T09:00:00", more: str = "") -> str:
    """Current changes every third row, the position every row but between 100 and 200, the channel every fourth."""
    recs = []
    for k in range(rows):
        cells = f' f3="{k}"' if k % 4 == 0 else ""
        cells += f' f1="{k / 3:.6f}"' if k % 3 == 0 else ""
        cells += f' f2="{k / 8}"' if not 100 < k < 200 else ""
        if cells:
            recs.append(f'<rec time="{k * 0.002:.3f}"{cells}/>')
    count = rows if count is None else count
    signals = "".join(
        f'<dataSignal id="f{n}" name="{name}" interval="{step}" event="{event}" datapointCount="{size}" unitsType="x"/>'
        for n, (name, step, event, size) in enumerate(
            ((CURRENT, 0.002, 255, count), (POSITION, 0.002, 255, count), (CHANNEL, 0.008, 1, rows // 4)), 1))
    return (f'<?xml version="1.0" encoding="UTF-8"?>\n<traceSession version="1.0">\n<traceData><dataFrame>\n'
            f'<frameHeader startTime="{start}" startTriggerInc="0" {more}/>\n{signals}\n' + "\n".join(recs)
            + "\n</dataFrame></traceData>\n</traceSession>\n")


def written(tmp_path: Path, text: str, name: str) -> Path:
    path = tmp_path / name
    path.write_bytes(text.encode())
    return path


@pytest.mark.parametrize("feed", [1 << 20, 1000])
def test_servo_signals_are_held_on_their_grid(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, feed: int) -> None:
    monkeypatch.setattr(tracexml, "_FEED", feed)
    path = written(tmp_path, xml(), "trace.xml")
    assert "Sinumerik" in (Reader().sniff(head(path)) or "")
    data = load(Reader(), path, Source(timezone="Europe/Prague"))
    assert not data.losses
    assert data.recording.complete is True
    assert data.recording.start_ns == np.datetime64("2026-03-02T08:00:00", "ns").astype(np.int64)
    servo = data.t_ns["servo@0.002"] - data.recording.start_ns
    k = np.arange(servo.size)
    np.testing.assert_array_equal(servo, k * 2_000_000)
    assert servo.size in (299, 300)
    np.testing.assert_allclose(data.values["servo@0.002", CURRENT], (k - k % 3) / 3, atol=1e-5)
    np.testing.assert_array_equal(data.values["servo@0.002", POSITION], np.where((k > 100) & (k < 200), 100, k) / 8)
    assert data.values["ipo@0.008", CHANNEL].tolist() == list(range(0, 300, 4))
    assert data.recording.signals[0].unit is None
    assert data.recording.signals[0].properties["unitsType"] == "x"


def test_counts_and_dropouts_are_checked(tmp_path: Path) -> None:
    data = load(Reader(), written(tmp_path, xml(count=400, more='dropOuts="3"'), "trace.xml"), Source())
    reasons = [loss.reason for loss in data.losses]
    assert any("drop-outs: 3" in r for r in reasons)
    assert sum("datapointCount is 400" in r for r in reasons) == 2


def test_a_cut_trace_keeps_what_is_there(tmp_path: Path) -> None:
    text = xml()
    data = load(Reader(), written(tmp_path, text[:len(text) // 2], "trace.xml"), Source())
    assert data.recording.complete is False
    assert 50 < data.t_ns["servo@0.002"].size < 250
    assert any("ends or is damaged" in loss.reason for loss in data.losses)


def test_a_start_that_is_no_date_makes_times_relative_and_entities_are_refused(tmp_path: Path) -> None:
    data = load(Reader(), written(tmp_path, xml(start="0"), "trace.xml"), Source())
    assert (data.recording.clock, data.t_ns["servo@0.002"][0]) == ("relative", 0)
    bomb = xml().replace("<traceSession", '<!DOCTYPE t [<!ENTITY a "aa">]><traceSession', 1)
    with pytest.raises(FormatError, match="entities"):
        load(Reader(), written(tmp_path, bomb, "bomb.xml"), Source())


@pytest.mark.parametrize(("delimiter", "decimal"), [(",", "."), (";", ","), ("\t", ".")])
def test_trace_csv_with_a_block_of_rows_before_the_header(tmp_path: Path, delimiter: str, decimal: str) -> None:
    names = delimiter.join(f'"{n}"' for n in ("Time", "/Nck/!SD/nckServoDataActCurr32 [u1; 1]", "+/Channel/!RP/rpa"))
    rows = "".join(delimiter.join((f"{k * 0.002:.3f}", f"{k / 8}", f"{k}")).replace(".", decimal) + "\n"
                   for k in range(50))
    path = written(tmp_path, "Session 1\n\n" + names + "\n" + rows + "x\n", "trace.csv")
    assert "Trace CSV" in (Reader().sniff(head(path)) or "")
    data = load(Reader(), path, Source())
    assert [loss.where for loss in data.losses] == ["trace.csv line 54"]
    assert data.t_ns["trace"].tolist() == [k * 2_000_000 for k in range(50)]
    assert data.values["trace", "/Nck/!SD/nckServoDataActCurr32 [u1; 1]"].tolist() == [k / 8 for k in range(50)]


@pytest.fixture(scope="module")
def kit_files(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    folder = tmp_path_factory.mktemp("kit")
    rows = "".join(f"{k * 0.002:.3f},{k / 8}\n" for k in range(50))
    return {"xml": written(folder, xml(60), "trace.xml"),
            "csv": written(folder, '"Time","/Nck/!SD/nckServoDataActCurr32 [u1; 1]"\n' + rows, "trace.csv")}


@pytest.mark.parametrize("number", range(len(reader_checks(Reader, [(Path("x"), Source())]))))
@pytest.mark.parametrize("kind", ["xml", "csv"])
def test_they_keep_the_rules_of_readers(kit_files: dict[str, Path], kind: str, number: int) -> None:
    reader_checks(Reader, [(kit_files[kind], Source())], claims=CLAIMS)[number]()
