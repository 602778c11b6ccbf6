"""The whole way back: a file is ingested, a sample traced, and what stands at the place that the reader tells is the
value in the store. Each check reads the file with nothing of ours."""

from __future__ import annotations

import io
import json
import re
import struct
import zipfile
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from thermodata.store import Store
from thermodata.store.ingest.run import ingest
from thermodata.store.trace.lineage import trace

ROWS, AT = 40, 23
VALUES = [20.0 + 0.125 * i for i in range(ROWS)]
Check = Callable[[Path, str], float]


@dataclass(frozen=True)
class Case:
    """A file whose row AT is traced. read: (file, place) -> the value that stands there."""

    reader: str
    name: str
    signal: str
    make: Callable[[], bytes]
    read: Check
    source: dict[str, Any] = field(default_factory=dict)
    step_s: float = 1.0


def _numbers(place: str) -> list[int]:
    return [int(n) for n in re.findall(r"\d+", place)]


def _line(cell: int, delimiter: str, start: str = "line ") -> Check:
    def read(path: Path, place: str) -> float:
        assert place.startswith(start), place
        text = path.read_text("latin-1").split("\n")[_numbers(place)[0] - 1]
        return float(text.split(delimiter)[cell].strip().replace(",", "."))

    return read


# ---- files ---------------------------------------------------------------------------------------


def _tdms() -> bytes:
    def text(t: str) -> bytes:
        return struct.pack("<I", len(t)) + t.encode()

    made = b""
    for k in range(4):  # four segments of ten rows, two channels one after another
        objects = b""
        for name in ("T", "U"):
            objects += text(f"/'G'/'{name}'") + struct.pack("<IIIQ", 20, 10, 1, 10) + struct.pack("<I", 2)
            objects += text("wf_start_time") + struct.pack("<IQq", 0x44, 0, 3_855_000_000)
            objects += text("wf_increment") + struct.pack("<Id", 10, 1.0)
        meta = struct.pack("<I", 2) + objects
        part = VALUES[10 * k : 10 * k + 10]
        raw = struct.pack("<20d", *part, *(-v for v in part))
        made += b"TDSm" + struct.pack("<IIQQ", 0xE, 4713, len(meta) + len(raw), len(meta)) + meta + raw
    return made


def _tdms_value(path: Path, place: str) -> float:
    found = re.match(r"segment 3 of 4, byte (\d+) \(G/T\), byte \d+ \(G/U\)$", place)
    assert found is not None, place
    return float(struct.unpack_from("<d", path.read_bytes(), int(found[1]))[0])


def _lvm() -> bytes:
    head = [
        "LabVIEW Measurement",
        "Writer_Version\t2",
        "Separator\tTab",
        "Decimal_Separator\t,",
        "Multi_Headings\tNo",
        "X_Columns\tOne",
        "Date\t2026/03/02",
        "Time\t06:00:00,0",
        "***End_of_Header***",
        "",
        "Channels\t1",
        f"Samples\t{ROWS}",
        "X0\t0,0",
        "Delta_X\t1,0",
        "***End_of_Header***",
        "X_Value\tT\tComment",
    ]
    rows = [f"{i},0\t{v:.3f}\t".replace(".", ",") for i, v in enumerate(VALUES)]
    return "\n".join([*head, *rows[:9], "no row at all", *rows[9:], ""]).encode()


def _labview() -> bytes:
    return "".join(f"{i}.0\t{v}\t{-v}\n" for i, v in enumerate(VALUES)).encode()


def _stamp(i: int, mark: str = "-") -> str:
    return f"2026{mark}03{mark}02T08:00:{i:02d}Z"


def _control() -> bytes:
    rows = [f"02.03.2026 08:00:{i:02d};{v:.3f}".replace(".", ",", 0) for i, v in enumerate(VALUES)]
    rows.insert(5, "")
    return ("Zeit;T\n;degC\n" + "\n".join(r[:20] + r[20:].replace(".", ",") for r in rows) + "\n").encode()


def _shdr() -> bytes:
    return "".join(f"{_stamp(i)}|T|{v}\n" for i, v in enumerate(VALUES)).encode()


def _json_lines() -> bytes:
    return "".join(f'{{"ts":"{_stamp(i)}","topic":"T","value":{v}}}\n' for i, v in enumerate(VALUES)).encode()


def _json_value(path: Path, place: str) -> float:
    line = path.read_text(encoding="utf-8").split("\n")[int(place.removeprefix("line ")) - 1]
    return float(json.loads(line)["value"])


def _opcua() -> bytes:
    return (
        "DateTime,TagName,TagVal,TagQuality\n"
        + "".join(f"2026-03-02 08:00:{i:02d}.000,T,{v},Good\n" for i, v in enumerate(VALUES))
    ).encode()


def _trace_csv() -> bytes:
    name = "/Nck/!SD/nckServoDataActCurr32 [u1; 1]"
    return (f"Time,{name}\n" + "".join(f"{i},{v:.3f}\n" for i, v in enumerate(VALUES))).encode()


def _trace_xml() -> bytes:
    rows = "".join(f'<rec time="{i}.000000" f1="{v}"/>\n' for i, v in enumerate(VALUES))
    return (
        '<?xml version="1.0"?><traceSession><traceData><dataFrame><frameHeader startTime="2026-03-02T08:00:00Z"/>'
        '<dataSignal id="1" name="T" interval="1" event="1" datapointCount="40" unitsType="posn"/>\n'
        f"{rows}</dataFrame></traceData></traceSession>"
    ).encode()


def _trace_value(path: Path, place: str) -> float:
    found = re.match(rf"record {AT + 1}, byte (\d+)$", place)
    assert found is not None, place
    said = re.match(rb'<rec time="[\d.]+" f1="([\d.]+)"', path.read_bytes()[int(found[1]) :])
    assert said is not None
    return float(said[1])


def _mcap() -> bytes:
    from mcap.writer import CompressionType, Writer

    out = io.BytesIO()
    writer = Writer(out, compression=CompressionType.NONE, chunk_size=400)
    writer.start()
    schema = writer.register_schema("s", "jsonschema", b'{"type": "object"}')
    channel = writer.register_channel("/m", "json", schema)
    for i, v in enumerate(VALUES):
        t = 1_772_438_400_000_000_000 + i * 1_000_000_000
        writer.add_message(channel, t, json.dumps({"T": v}).encode(), t)
    writer.finish()
    return out.getvalue()


def _mcap_value(path: Path, place: str) -> float:
    found = re.match(
        rf"message {AT + 1}, chunk \d+ \(at byte (\d+)\), byte (\d+) of its records, log_time (\d+)$", place
    )
    assert found is not None, place
    data, chunk, inside, log_ns = path.read_bytes(), int(found[1]), int(found[2]), int(found[3])
    assert data[chunk] == 6
    name = struct.unpack_from("<I", data, chunk + 9 + 28)[0]  # behind times, size and checksum
    record = chunk + 9 + 28 + 4 + name + 8 + inside
    assert data[record] == 5
    assert struct.unpack_from("<Q", data, record + 15)[0] == log_ns
    length = struct.unpack_from("<Q", data, record + 1)[0]
    return float(json.loads(data[record + 31 : record + 9 + length])["T"])


def _csv() -> bytes:
    rows = [f"{_stamp(i)},{v}" for i, v in enumerate(VALUES)]
    rows[7:7] = ["", "no time,99"]
    return ("time,T\n" + "\n".join(rows) + "\n").encode()


def _xlsx() -> bytes:
    def row(number: int, *cells: str | float) -> str:
        return (
            f'<row r="{number}">'
            + "".join(
                f'<c r="{column}{number}" t="inlineStr"><is><t>{cell}</t></is></c>'
                if isinstance(cell, str)
                else f'<c r="{column}{number}"><v>{cell}</v></c>'
                for column, cell in zip("AB", cells, strict=True)
            )
            + "</row>"
        )

    rows = [
        row(1, "Machine", "138"),
        row(2, "Time [s]", "T [degC]"),
        *(row(i + 3, float(i), v) for i, v in enumerate(VALUES)),
    ]
    main, rel = "http://schemas.openxmlformats.org/spreadsheetml/2006/main", "http://schemas.openxmlformats.org/"
    office, packed = f"{rel}officeDocument/2006/relationships", f"{rel}package/2006/relationships"
    kind = "application/vnd.openxmlformats-officedocument.spreadsheetml"
    parts = {
        "[Content_Types].xml": f'<Types xmlns="{rel}package/2006/content-types">'
        '<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
        f'<Override PartName="/xl/workbook.xml" ContentType="{kind}.sheet.main+xml"/>'
        f'<Override PartName="/xl/worksheets/sheet1.xml" ContentType="{kind}.worksheet+xml"/></Types>',
        "_rels/.rels": f'<Relationships xmlns="{packed}"><Relationship Id="r1" Type="{office}/officeDocument" '
        'Target="xl/workbook.xml"/></Relationships>',
        "xl/workbook.xml": f'<workbook xmlns="{main}" xmlns:r="{office}"><sheets>'
        '<sheet name="log" sheetId="1" r:id="r1"/></sheets></workbook>',
        "xl/_rels/workbook.xml.rels": f'<Relationships xmlns="{packed}"><Relationship Id="r1" '
        f'Type="{office}/worksheet" Target="worksheets/sheet1.xml"/></Relationships>',
        "xl/worksheets/sheet1.xml": f'<worksheet xmlns="{main}"><sheetData>{"".join(rows)}</sheetData></worksheet>',
    }
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, text in parts.items():
            archive.writestr(name, text)
    return out.getvalue()


def _xlsx_value(path: Path, place: str) -> float:
    found = re.match(r"sheet 'log', row (\d+)$", place)
    assert found is not None, place
    sheet = zipfile.ZipFile(path).read("xl/worksheets/sheet1.xml").decode()
    cell = re.search(rf'<c r="B{found[1]}"><v>([\d.]+)</v>', sheet)
    assert cell is not None
    return float(cell[1])


def _parquet() -> bytes:
    import pyarrow as pa
    import pyarrow.parquet as pq

    out = io.BytesIO()
    pq.write_table(pa.table({"time_s": np.arange(ROWS, dtype=float), "T": VALUES}), out, row_group_size=10)
    return out.getvalue()


def _parquet_value(path: Path, place: str) -> float:
    import pyarrow.parquet as pq

    found = re.match(r"row group (\d+), row (\d+) of it", place)
    assert found is not None, place
    return float(pq.ParquetFile(path).read_row_group(int(found[1]) - 1).column("T")[int(found[2]) - 1].as_py())


def _mat() -> bytes:
    from scipy.io import savemat

    out = io.BytesIO()
    savemat(out, {"time_s": np.arange(ROWS, dtype=float), "T": np.array(VALUES)})
    return out.getvalue()


def _mat_value(path: Path, place: str) -> float:
    from scipy.io import loadmat

    found = re.match(r"index (\d+) of T$", place)
    assert found is not None, place
    return float(loadmat(path)["T"].ravel()[int(found[1]) - 1])


CASES = {
    "tdms": Case("crio", "log.tdms", "G/T", _tdms, _tdms_value),
    "lvm": Case("crio", "log.lvm", "T", _lvm, _line(1, "\t")),
    "labview ascii": Case("crio", "log.txt", "column 2", _labview, _line(1, "\t")),
    "control csv": Case("cnc", "log.csv", "T", _control, _line(1, ";")),
    "shdr": Case("cnc", "log.txt", "T", _shdr, _line(2, "|")),
    "opc ua": Case("cnc", "log.csv", "T", _opcua, _line(2, ",")),
    "json lines": Case("cnc", "log.jsonl", "T", _json_lines, _json_value),
    "trace csv": Case("cnc", "log.csv", "/Nck/!SD/nckServoDataActCurr32 [u1; 1]", _trace_csv, _line(1, ",")),
    "trace xml": Case("cnc", "log.xml", "T", _trace_xml, _trace_value),
    "mcap": Case("mcap", "log.mcap", "/m.T", _mcap, _mcap_value),
    "csv": Case("table", "log.csv", "T", _csv, _line(1, ",")),
    "xlsx": Case("table", "log.xlsx", "T [degC]", _xlsx, _xlsx_value),
    "parquet": Case("table", "log.parquet", "T", _parquet, _parquet_value),
    "mat": Case("table", "log.mat", "T", _mat, _mat_value),
}


@pytest.mark.parametrize("name", CASES)
def test_the_place_of_a_traced_sample_holds_its_value(name: str, tmp_path: Path) -> None:
    case = CASES[name]
    (tmp_path / case.name).write_bytes(case.make())
    source = json.dumps({"reader": case.reader, "files": case.name, "timezone": "UTC", **case.source})
    (tmp_path / "campaign.yaml").write_text(
        f"schema: thermodata/campaign/1\nid: shop\nmachine: {{id: m}}\nsources: {{log: {source}}}\nchannels:\n"
        f"  temp: {{source: log, signal: {json.dumps(case.signal)}, quantity: temperature, unit: degC}}\n"
        "tests:\n  - {id: one, kind: other, role: none}\n",
        encoding="utf-8",
    )
    store = Store(tmp_path / "store", create=True)
    ingest(store, tmp_path / "campaign.yaml")
    sample = trace(store, "shop", "one", "temp", AT * case.step_s, verify=True)["sample"]
    again = sample["raw"]["again"]
    assert (again["problem"], again["file"]) == (None, "unchanged")
    assert sample["raw"]["raw_value"] == again["value"] == VALUES[AT]
    assert case.read(tmp_path / case.name, again["place"]) == VALUES[AT]
