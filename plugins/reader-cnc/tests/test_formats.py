"""The list of formats: each claims its own example, and says where its rows stand."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

import pytest
from thermodata_reader_cnc import Reader, export
from thermodata_reader_cnc.formats import FORMATS, Format, claimed, module_of

from thermodata.plugin import Block, Head, Source
from thermodata.reader.finding.registry import head
from thermodata.testing.reader import load

START = "2026-03-02T08:00:0"
SCO = (
    "%[GLOBAL]\r\n%\r\n%[CURVE]\r\n%NAME=a\r\n%CYCLETIME=3000\r\n%\r\n%[DATA]\r\n"
    "0;1\r\nx;2\r\n6000;3\r\n9000;4\r\n%\r\n"
)
SCOPE = (
    "Name\tp\nStarttime of export\t134169120000000000\n\nName\ta\tName\tb\n"
    "0\t1\t0\t5\n\n1\t2\t2\t6\n2\t3\t\t\n3\t4\t\t\nEOF\n"
)
TRACE = (
    '<traceSession><traceData><dataFrame><frameHeader startTime="2026-03-02T09:00:00Z"/>'
    '<dataSignal id="f1" name="a" interval="0.002" event="255"/>\n'
    '<rec time="0.000" f1="1"/>\n<rec time="0.002" f1="2"/>\n<rec time="0.008" f1="3"/>\n'
    "</dataFrame></traceData></traceSession>\n"
)
REC = [match.start() for match in re.finditer("<rec", TRACE)]
STREAMS = (
    '<MTConnectStreams><Header instanceId="1" nextSequence="9"/><Streams><DeviceStream name="M"><ComponentStream '
    f'component="C"><Samples><Load dataItemId="a" sequence="4" timestamp="{START}0Z">1</Load>'
    f'<Load dataItemId="b" sequence="5" timestamp="{START}0Z">1</Load>'
    f'<Load dataItemId="a" sequence="6" timestamp="{START}1Z">2</Load>'
    f'<XTimeSeries dataItemId="s" sequence="8" timestamp="{START}1Z" sampleCount="2" sampleRate="10">1 2</XTimeSeries>'
    "</Samples></ComponentStream></DeviceStream></Streams></MTConnectStreams>\n"
)
SHDR = f"{START}0Z|a|1\n{START}0Z|b|1\n* note\n{START}1Z|a|2\n{START}2Z|s|2|10|1 2\n"
BY_TAG = "DateTime,TagName,TagVal,TagQuality\n" + "".join(
    f"2026-03-02 08:00:{k:02d},{tag},{k},192\n" for tag in ("T1", "T2") for k in range(30)
)


@pytest.mark.parametrize("each", FORMATS, ids=lambda each: each.name)
def test_a_format_claims_its_own_example(each: Format) -> None:
    head = Head("x.dat", len(each.module.EXAMPLE), each.module.EXAMPLE)
    found = claimed(head)
    assert found is not None
    assert found[0] is each
    assert module_of(head) is each.module
    assert Reader().heads[each.name] == each.module.EXAMPLE
    assert Reader().sniff(head) == found[1]


def test_a_file_is_told_once_for_its_claim_its_signals_and_its_rows(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[int] = []
    claims = export.claims

    def counted(lines: Sequence[str]) -> str | None:
        asked.append(len(lines))
        return claims(lines)

    monkeypatch.setattr(export, "claims", counted)
    path, reader = tmp_path / "a.csv", Reader()
    rows = [f"02.03.2026;08:{k // 60:02d}:{k % 60:02d};{k}" for k in range(300)]
    for more in ([], ["02.03.2026;08:05:00;300"]):  # what was written since is another file
        path.write_text("\n".join(["Datum;Uhrzeit;n [1/min]", *rows, *more, ""]))
        assert reader.sniff(head(path)) is not None
        assert len(reader.describe(path, Source()).signals) == 1
        assert sum(len(b.t_ns) for b in reader.blocks(path, Source()) if isinstance(b, Block)) == 300 + len(more)
    assert len(asked) == 2


@pytest.mark.parametrize(
    ("text", "stream", "places"),
    [
        (SCO, "scope_3000us", ["line 8", "line 10", "line 11", "row 4"]),
        (SCOPE, "scope1", ["line 5", "line 7", "line 8", "line 9"]),
        (SCOPE, "scope2", ["line 5", "line 7", "row 3"]),
        (
            TRACE,
            "servo",
            [
                f"record 1, byte {REC[0]}",
                f"record 2, byte {REC[1]}",
                f"record 2, byte {REC[1]} (held since then)",
                f"record 2, byte {REC[1]} (held since then)",
                f"record 3, byte {REC[2]}",
            ],
        ),
        (STREAMS, "nc", ["sequence 4", "sequence 6"]),
        (STREAMS, "series s", ["sequence 8, sample 1 of 2", "sequence 8, sample 2 of 2", "row 3"]),
        (SHDR, "nc", ["lines 1 to 3", "line 4"]),
        (SHDR, "series s", ["line 5, sample 1 of 2", "line 5, sample 2 of 2"]),
        (BY_TAG, "T2", ["line 32", "line 33"]),
    ],
    ids=["sco", "scope", "slower group", "trace", "streams", "time series", "shdr", "shdr series", "opc ua by tag"],
)
def test_a_row_says_where_it_stands(tmp_path: Path, text: str, stream: str, places: list[str]) -> None:
    path = tmp_path / "log.dat"
    path.write_text(text, encoding="utf-8", newline="")
    assert stream in load(Reader(), path, Source()).t_ns
    reader = Reader()
    assert [reader.locate(path, Source(), stream, row) for row in range(len(places))] == places
    assert reader.place(path, Source(), stream, 0) == places[0]


@pytest.mark.parametrize(
    "text",
    [
        SCO,
        TRACE.replace("2026-03-02T09:00:00Z", "0"),
        "Time,/Nck/!SD/nckServoDataActVelMot64 [u1; 5]\n0.000,0\n2.000,3000\n4.000,3000\n",
        "0|Xpos|1.5\n100.25|Xpos|2.5\n250|Xpos|3\n",
    ],
    ids=["sco", "trace xml", "trace csv", "shdr"],
)
def test_a_log_without_dates_starts_at_none(tmp_path: Path, text: str) -> None:
    """0 would put it at 1970 beside a log that has dates."""
    path = tmp_path / "log.dat"
    path.write_text(text, encoding="utf-8", newline="")
    recording = load(Reader(), path, Source()).recording
    assert (recording.clock, recording.start_ns) == ("relative", None)
    assert recording.is_undated
