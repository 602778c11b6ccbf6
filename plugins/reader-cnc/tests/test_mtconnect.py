"""Logs of changes: SHDR of an adapter, stream documents of an agent."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from thermodata_reader_cnc import Reader
from thermodata_reader_cnc.mtconnect import documents, streams

from thermodata.errors import FormatError
from thermodata.plugin import Head, Source
from thermodata.reader.finding.registry import head
from thermodata.schema.flag import Flag
from thermodata.testing.reader import Data, load, reader_checks

from .logs import written

REAL = Path(__file__).resolve().parents[4] / "shared" / "data" / "mtconnect"
needs_real = pytest.mark.skipif(not REAL.exists(), reason="shared/data/mtconnect is not here")
SHDR = """2026-03-02T08:00:00.000000Z|avail|AVAILABLE|S1speed|0|Xpos|1.5|Prog|A 1
* adapterVersion: 2
2026-03-02T08:00:00.000000Z|Tspindle|20.5|path|1.0 2.0 3.0
2026-03-02T08:00:01.500000Z|system|NORMAL||||
2026-03-02T08:00:02.000000Z|S1speed|3000
2026-03-02T08:00:02.000000Z|@ASSET@|4711|CuttingTool|--multiline--AB
<CuttingTool><a>1|2|3</a></CuttingTool>
--multiline--AB
2026-03-02T08:00:03.250000Z|Tspindle|UNAVAILABLE|Xpos|2.5
2026-03-02T08:00:04.000000Z|Tspindle|21.5|path|4.0 5.0 6.0
2026-03-02T08:00:05.000000Z|note|17|a message
"""
T0 = int(np.datetime64("2026-03-02T08:00:00", "ns").astype(np.int64))


def column(data: Data, name: str) -> list[object]:
    return list(data.values["nc", name].tolist())


def test_values_are_held_until_they_change(tmp_path: Path) -> None:
    path = written(tmp_path, SHDR, "log.txt")
    assert "SHDR" in (Reader().sniff(head(path)) or "")
    said = Reader().describe(path, Source("nc"))
    assert any("the lines say no units" in note for note in said.notes)
    assert {s.properties.get("protocol") for s in said.signals} == {"SHDR"}
    data = load(Reader(), path, Source())
    assert not data.losses
    assert ((data.t_ns["nc"] - T0) / 1e9).tolist() == [0, 1.5, 2, 3.25, 4, 5]
    np.testing.assert_array_equal(column(data, "Tspindle"), [20.5, 20.5, 20.5, np.nan, 21.5, 21.5])
    assert column(data, "S1speed") == [0, 0, 3000, 3000, 3000, 3000]
    assert column(data, "Xpos") == [1.5, 1.5, 1.5, 2.5, 2.5, 2.5]
    assert column(data, "path[2]") == [3, 3, 3, 3, 6, 6]
    assert column(data, "Prog") == ["A 1"] * 6
    assert column(data, "system") == [None] + ["NORMAL"] * 5
    assert column(data, "note") == [None] * 5 + ["a message"]


def test_bad_lines_are_named_and_the_rest_is_kept(tmp_path: Path) -> None:
    lines = SHDR.splitlines(keepends=True)
    lines.insert(4, "garbage\n")
    lines.insert(6, "2026-13-02T08:00:02.000000Z|S1speed|1\n")
    data = load(Reader(), written(tmp_path, "".join(lines) + "2026-03-02T08:00:06Z|S1sp", "log.txt"), Source())
    assert {loss.where for loss in data.losses} == {"log.txt line 5", "log.txt line 7", "log.txt last line"}
    assert data.t_ns["nc"].size == 6
    assert data.recording.complete is False


def test_blocks_of_a_long_log_hold_over_their_borders(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from thermodata_reader_cnc import events

    path = written(
        tmp_path,
        SHDR + "".join(f"2026-03-02T09:{k // 60:02d}:{k % 60:02d}.000Z|S1speed|{k}\n" for k in range(3000)),
        "log.txt",
    )
    whole = load(Reader(), path, Source())
    monkeypatch.setattr(events, "_MOST_VALUES", 1)
    small = load(Reader(), path, Source())
    assert column(whole, "S1speed") == column(small, "S1speed")
    assert set(column(small, "Xpos")[5:]) == {2.5}


def shdr(tmp_path: Path, *lines: str) -> Data:
    return load(Reader(), written(tmp_path, "\n".join(lines) + "\n", "log.txt"), Source())


def test_the_special_forms_of_the_adapter_protocol(tmp_path: Path) -> None:
    data = shdr(
        tmp_path,
        '2026-03-02T08:00:00Z@100.5|Xload|5|text|"a \\| b"',
        "2026-03-02T08:00:01Z|servo|FAULT|E17|100|HIGH|too hot",
        "|Xload|6",
        "2026-03-02T08:00:02Z|accel|4|100|1 2 3 4",
        "2026-03-02T08:00:03Z|servo|NORMAL||||",
        "2026-03-02T08:00:04Z|accel|1|100|UNAVAILABLE",
    )
    assert ((data.t_ns["nc"] - T0) / 1e9).tolist() == [0, 1, 3]
    assert column(data, "Xload") == [5, 6, 6]
    assert data.flags["nc", "Xload"].tolist() == [0, Flag.CLOCK_SUSPECT, Flag.CLOCK_SUSPECT]
    assert column(data, "text")[0] == "a | b"
    assert column(data, "servo") == [None, "FAULT", "NORMAL"]
    assert column(data, "servo[message]") == [None, "E17; 100; HIGH; too hot", None]
    assert data.values["series accel", "accel"].tolist() == [1, 2, 3, 4]
    assert (data.t_ns["series accel"] - T0).tolist() == [1_970_000_000, 1_980_000_000, 1_990_000_000, 2_000_000_000]
    assert not data.losses


def test_times_relative_to_the_adapter(tmp_path: Path) -> None:
    data = shdr(tmp_path, "0|Xpos|1.5|mode|AUTO", "100.25|Xpos|2.5", "250|mode|MDI")
    assert data.recording.clock == "relative"
    assert data.t_ns["nc"].tolist() == [0, 100_250_000, 250_000_000]
    assert column(data, "Xpos") == [1.5, 2.5, 2.5]


def test_an_asset_without_an_end_is_a_loss(tmp_path: Path) -> None:
    data = shdr(
        tmp_path,
        "2026-03-02T08:00:00Z|Xpos|1",
        "2026-03-02T08:00:01Z|@ASSET@|1|Part|--multiline--A",
        "<Part>",
        "2026-03-02T08:00:02Z|Xpos|2",
    )
    assert column(data, "Xpos") == [1]
    assert ["asset without its end" in loss.reason for loss in data.losses] == [True]


@needs_real
def test_a_real_log_of_an_okuma() -> None:
    data = load(Reader(), REAL / "okuma.txt", Source())
    assert data.t_ns["nc"].size > 10_000
    assert 300 < (data.t_ns["nc"][-1] - data.t_ns["nc"][0]) / 1e9 < 600
    speed = np.array(column(data, "S1speed"), float)
    assert np.nanmax(speed) > 100
    assert len(data.values) > 80
    assert all("line" in loss.where for loss in data.losses)


def document(instance: int, first: int, last: int, items: str) -> str:
    return (
        f'<?xml version="1.0" encoding="UTF-8"?>\n<MTConnectStreams xmlns="urn:mtconnect.org:MTConnectStreams:1.5">'
        f'<Header instanceId="{instance}" firstSequence="{first}" lastSequence="{last}" nextSequence="{last + 1}"/>'
        f'<Streams><DeviceStream name="M1"><ComponentStream component="Rotary" name="C" componentId="c">'
        f"<Samples>{items}</Samples></ComponentStream></DeviceStream></Streams></MTConnectStreams>\n"
    )


def item(sequence: int, second: float, value: object, name: str = "Stemp") -> str:
    at = f"2026-03-02T08:00:{second:06.3f}Z"
    return (
        f'<Temperature dataItemId="{name.lower()}" name="{name}" sequence="{sequence}" timestamp="{at}">{value}'
        "</Temperature>"
    )


def test_documents_are_put_in_the_agents_order_each_observation_once(tmp_path: Path) -> None:
    log = document(7, 1, 4, item(3, 2, 22) + item(1, 0, 20) + item(2, 1, 21) + item(4, 2.5, 5, "Sload")) + document(
        7, 1, 6, item(3, 2, 22) + item(5, 3, 23) + item(6, 4, "UNAVAILABLE")
    )
    path = written(tmp_path, log, "streams.xml")
    assert "MTConnect" in (Reader().sniff(head(path)) or "")
    data = load(Reader(), path, Source())
    assert not data.losses
    assert data.recording.complete is None
    assert ((data.t_ns["nc"] - T0) / 1e9).tolist() == [0, 1, 2, 2.5, 3, 4]
    np.testing.assert_array_equal(column(data, "Stemp"), [20, 21, 22, 22, 23, np.nan])
    np.testing.assert_array_equal(column(data, "Sload"), [np.nan, np.nan, np.nan, 5, 5, 5])
    assert data.recording.signals[0].properties["component"] == "C"


def test_missing_sequences_are_a_loss_and_a_restart_repeats_nothing(tmp_path: Path) -> None:
    log = (
        document(7, 1, 2, item(1, 0, 20) + item(2, 1, 21))
        + document(7, 9, 10, item(9, 5, 25) + item(10, 6, 26))
        + document(8, 1, 2, item(1, 6, 26) + item(2, 7, 27))
    )
    data = load(Reader(), written(tmp_path, log, "streams.xml"), Source())
    assert column(data, "Stemp") == [20, 21, 25, 26, 27]
    assert len(data.losses) == 1
    assert "sequences 3 to 8 are lost" in data.losses[0].reason


def test_a_cut_document_keeps_its_whole_observations(tmp_path: Path) -> None:
    log = document(7, 1, 2, item(1, 0, 20) + item(2, 1, 21)) + document(7, 1, 4, item(3, 2, 22) + item(4, 3, 23))
    data = load(Reader(), written(tmp_path, log[: log.rindex("23<") + 1], "streams.xml"), Source())
    assert column(data, "Stemp") == [20, 21, 22]
    assert data.recording.complete is False
    assert "cut" in data.losses[-1].reason


def test_sequences_that_are_not_in_the_log_are_a_loss(tmp_path: Path) -> None:
    def part(first: int, last: int) -> str:
        return document(7, 1, last, "".join(item(s, s, 20 + s) for s in range(first, last + 1) if s != 17))

    gone = load(Reader(), written(tmp_path, part(1, 5) + part(9, 12), "streams.xml"), Source())
    assert [loss.reason for loss in gone.losses] == ["sequences 6 to 8 are not in the log"]
    holed = load(Reader(), written(tmp_path, part(1, 11) + part(12, 24), "streams.xml"), Source())
    assert [loss.reason for loss in holed.losses] == ["1 of the sequences 12 to 24 are missing"]


def test_what_stands_between_documents_is_passed_over_and_a_cut_one_does_not_take_the_next(tmp_path: Path) -> None:
    one, two, three = (document(7, 1, 2 * k, item(2 * k - 1, k, k) + item(2 * k, k + 0.5, k)) for k in (1, 2, 3))
    boundary = "\r\n--a1b2\r\nContent-type: text/xml\r\nContent-length: 700\r\n\r\n"
    data = load(Reader(), written(tmp_path, one + boundary + two + boundary + three, "streams.xml"), Source())
    assert not data.losses
    assert column(data, "Stemp") == [1, 1, 2, 2, 3, 3]
    for rest in (three, three.split("\n", 1)[1]):  # with and without its XML declaration
        data = load(Reader(), written(tmp_path, one + two[: two.index("</Samples>")] + rest, "streams.xml"), Source())
        assert column(data, "Stemp") == [1, 1, 2, 2, 3, 3]
        assert ["cut or damaged" in loss.reason for loss in data.losses] == [True]


def test_data_sets_time_series_and_messages_of_conditions(tmp_path: Path) -> None:
    at = 'timestamp="2026-03-02T08:00:0{}Z" dataItemId="{}" sequence="{}"'
    items = (
        f'<VariableDataSet {at.format(0, "vars", 1)}><Entry key="a">1</Entry><Entry key="b">x</Entry>'
        f'</VariableDataSet><WorkOffsetTable {at.format(0, "wcs", 2)}><Entry key="G54"><Cell key="X">1.5</Cell>'
        f'<Cell key="Y">2.5</Cell></Entry></WorkOffsetTable><AccelerationTimeSeries {at.format(1, "acc", 3)} '
        'sampleCount="2" sampleRate="1000">0.5 0.75</AccelerationTimeSeries>'
        f'<VariableDataSet {at.format(2, "vars", 4)}><Entry key="a" removed="true"/></VariableDataSet>'
        f"<VariableDataSet {at.format(3, 'vars', 5)}>UNAVAILABLE</VariableDataSet></Samples><Condition>"
        f'<Fault {at.format(4, "servo", 6)} nativeCode="17">too hot</Fault></Condition><Samples>'
    )
    data = load(Reader(), written(tmp_path, document(7, 1, 6, items), "streams.xml"), Source())
    np.testing.assert_array_equal(column(data, "vars[a]"), [1, np.nan, np.nan, np.nan])
    assert column(data, "vars[b]") == ["x", "x", None, None]
    assert column(data, "wcs[G54][Y]") == [2.5] * 4
    assert column(data, "servo") == [None, None, None, "FAULT"]
    assert column(data, "servo[message]")[-1] == "17; too hot"
    assert data.values["series acc", "acc"].tolist() == [0.5, 0.75]
    assert (data.t_ns["series acc"] - T0).tolist() == [999_000_000, 1_000_000_000]
    assert not data.losses
    items = items.replace('Count="2"', 'Count="3"')
    wrong = load(Reader(), written(tmp_path, document(7, 1, 6, items), "s.xml"), Source())
    assert "announces 3 samples" in wrong.losses[0].reason


def test_a_document_larger_than_what_waits_is_read_in_parts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    log = document(7, 1, 900, "".join(item(s, s / 100, s) for s in range(1, 901)))
    path = written(tmp_path, log * 4, "streams.xml")
    whole = load(Reader(), path, Source())
    monkeypatch.setattr(documents, "_MOST", 50)
    monkeypatch.setattr(documents, "_PART", 4096)
    monkeypatch.setattr(streams, "_LOOK", 1000)
    monkeypatch.setattr(streams, "_PIECE", 3000)
    parts = load(Reader(), path, Source())
    assert not whole.losses
    assert not parts.losses
    assert column(parts, "Stemp") == column(whole, "Stemp") == list(range(1, 901))


def test_entities_are_not_expanded(tmp_path: Path) -> None:
    bomb = '<!DOCTYPE x [<!ENTITY a "aaaa"><!ENTITY b "&a;&a;&a;">]>'
    text = document(7, 1, 2, item(1, 0, 20)).replace("<MTConnectStreams", bomb + "<MTConnectStreams", 1)
    path = written(tmp_path, text.replace(">20<", ">&b;<"), "streams.xml")
    with pytest.raises(FormatError):
        load(Reader(), path, Source())


@needs_real
def test_a_real_document_of_a_mazak() -> None:
    data = load(Reader(), REAL / "Current-Mazak-1.5.xml", Source())
    kinds = {s.name: s.dtype for s in data.recording.signals}
    assert (kinds["Stemp"], kinds["crfunc"], kinds["S3temp"]) == ("float64", "str", "float64")
    assert column(data, "Stemp")[-1] == 24
    assert np.isnan(column(data, "S3temp")).all()
    assert load(Reader(), REAL / "Current-Simple.xml", Source()).values["nc", "comms_cond"].tolist() == [
        "FAULT",
        "NORMAL",
    ]


@pytest.mark.parametrize("text", ["<MTConnectDevices/>", '<?xml version="1.0"?><traceOther/>', "a|b|c\n1|2|3\n"])
def test_other_text_is_not_claimed(text: str) -> None:
    assert Reader().sniff(Head("x.xml", len(text), text.encode())) is None


@pytest.fixture(scope="module")
def samples(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    folder = tmp_path_factory.mktemp("kit")
    log = "".join(
        document(7, 1, 3 * k, "".join(item(s, s, 20 + s) for s in range(3 * k - 2, 3 * k + 1))) for k in range(1, 9)
    )
    return {"shdr": written(folder, SHDR, "log.txt"), "xml": written(folder, log, "streams.xml")}


@pytest.mark.parametrize("number", range(len(reader_checks(Reader, [(Path("x"), Source())]))))
@pytest.mark.parametrize("kind", ["shdr", "xml"])
def test_they_keep_the_rules_of_readers(samples: dict[str, Path], kind: str, number: int) -> None:
    reader_checks(Reader, [(samples[kind], Source())])[number]()
