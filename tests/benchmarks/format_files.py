"""Files of every format for the benchmark, all with columns S00, S01, ... of temperatures [degC] on a UTC clock.

Each maker writes `rows` rows into a path, fast enough for files of gigabytes where the format allows it.
"""

from __future__ import annotations

import json
import struct
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

START = np.datetime64("2026-03-02T06:00:00", "ns")
CHUNK = 6000


def names(columns: int) -> list[str]:
    return [f"S{i:02d}" for i in range(columns)]


def chunks(rows: int, columns: int, step_s: float, size: int = CHUNK) -> Iterator[tuple[Any, Any]]:
    """(times as datetime64[ns], values of shape (columns, n)) in pieces; values with three decimals."""
    rng = np.random.default_rng(0)
    for at in range(0, rows, size):
        n = min(size, rows - at)
        i = at + np.arange(n)
        t_h = i * step_s / 3600
        values = np.stack([20 + 5 * np.sin(t_h / (k + 1)) + 0.01 * rng.standard_normal(n) for k in range(columns)])
        yield START + (i * round(step_s * 1e9)).astype("timedelta64[ns]"), np.round(values, 3)


def tdms(path: Path, rows: int, columns: int = 40, step_s: float = 0.1) -> None:
    """A segment every ten minutes of samples, as a logger with a buffer writes it."""
    from nptdms import ChannelObject, TdmsWriter

    with TdmsWriter(str(path)) as writer:
        for _, values in chunks(rows, columns, step_s):
            writer.write_segment(
                [
                    ChannelObject(
                        "Log",
                        name,
                        column,
                        {
                            "wf_start_time": START.astype("datetime64[us]"),
                            "wf_increment": step_s,
                            "wf_start_offset": 0.0,
                            "unit_string": "degC",
                        },
                    )
                    for name, column in zip(names(columns), values, strict=True)
                ]
            )


def tdms_rows(path: Path, rows: int, columns: int = 40) -> None:
    """A segment every row (one a second): the first with its metadata, the others bare, as LabVIEW leaves them."""
    from nptdms import ChannelObject, TdmsWriter

    lead = b"TDSm" + struct.pack("<IIQQ", 0x08, 4713, 8 * columns, 0)
    first = True
    for _, values in chunks(rows, columns, 1.0):
        if first:
            with TdmsWriter(str(path)) as writer:
                writer.write_segment(
                    [
                        ChannelObject(
                            "Log",
                            name,
                            column[:1],
                            {
                                "wf_start_time": START.astype("datetime64[us]"),
                                "wf_increment": 1.0,
                                "wf_start_offset": 0.0,
                                "unit_string": "degC",
                            },
                        )
                        for name, column in zip(names(columns), values, strict=True)
                    ]
                )
        with path.open("ab") as file:
            file.write(b"".join(lead + row.tobytes() for row in np.ascontiguousarray(values.T[int(first) :])))
        first = False


def _comma(values: Any, separator: str) -> list[str]:
    return [separator.join(f"{v:.3f}" for v in row).replace(".", ",") for row in values.T.tolist()]


def lvm(path: Path, rows: int, columns: int = 8) -> None:
    none = "\t" * columns
    head = (
        "LabVIEW Measurement\t\nWriter_Version\t2\nSeparator\tTab\nDecimal_Separator\t,\nMulti_Headings\tNo\n"
        "X_Columns\tOne\nTime_Pref\tAbsolute\nDate\t2026/03/02\nTime\t06:00:00,0\n***End_of_Header***\t\n\t\n"
        f"Channels\t{columns}{none}\nSamples{f'{chr(9)}{rows}' * columns}\t\n"
        f"Date{f'{chr(9)}2026/03/02' * columns}\t\nTime{f'{chr(9)}06:00:00,0' * columns}\t\n"
        f"Y_Unit_Label{f'{chr(9)}degC' * columns}\t\nX0{f'{chr(9)}0,0E+0' * columns}\t\n"
        f"Delta_X{f'{chr(9)}0,1' * columns}\t\n***End_of_Header***{none}\t\n"
        "X_Value\t" + "\t".join(names(columns)) + "\tComment\n"
    )
    with path.open("w", encoding="cp1252", newline="") as file:
        file.write(head)
        at = 0
        for times, values in chunks(rows, columns, 0.1):
            x = [f"{(at + i) / 10:.6f}".replace(".", ",") for i in range(len(times))]
            file.writelines(f"{a}\t{b}\t\n" for a, b in zip(x, _comma(values, "\t"), strict=True))
            at += len(times)


def control_csv(path: Path, rows: int, columns: int = 8) -> None:
    """A German control: ';', decimal comma, cp1252, a row of names and one of units."""
    with path.open("w", encoding="cp1252", newline="") as file:
        file.write("Zeit;" + ";".join(names(columns)) + "\r\n" + ";°C" * columns + "\r\n")
        for times, values in chunks(rows, columns, 0.1):
            texts = times.astype("datetime64[ms]").astype(str)
            stamps = [f"{s[8:10]}.{s[5:7]}.{s[:4]} {s[11:19]},{s[20:23]}" for s in texts]
            file.writelines(f"{a};{b}\r\n" for a, b in zip(stamps, _comma(values, ";"), strict=True))


def iso_csv(path: Path, rows: int, columns: int = 8) -> None:
    import pyarrow as pa
    from pyarrow import csv

    with path.open("wb") as file:
        file.write(("time," + ",".join(f"{n} [degC]" for n in names(columns)) + "\n").encode())
        options = csv.WriteOptions(include_header=False, quoting_style="none")
        for times, values in chunks(rows, columns, 0.1, 50_000):
            named = dict(zip(names(columns), values, strict=True))
            csv.write_csv(pa.table({"time": times.astype("datetime64[ms]"), **named}), file, options)


def mcap_json(path: Path, rows: int, columns: int = 8) -> None:
    from mcap.writer import CompressionType, Writer

    with path.open("wb") as file:
        writer = Writer(file, compression=CompressionType.ZSTD)
        writer.start()
        schema = writer.register_schema("sample", "jsonschema", b'{"type": "object"}')
        channel = writer.register_channel("/log", "json", schema)
        keys = names(columns)
        for times, values in chunks(rows, columns, 0.1):
            for t, row in zip(times.astype(np.int64).tolist(), values.T.tolist(), strict=True):
                writer.add_message(channel, t, json.dumps(dict(zip(keys, row, strict=True))).encode(), t)
        writer.finish()


def xlsx(path: Path, rows: int, columns: int = 8) -> None:
    """The least workbook there is: seconds and numbers."""
    main = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
    package = "http://schemas.openxmlformats.org/package/2006"
    office = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
    sheet = "application/vnd.openxmlformats-officedocument.spreadsheetml.{}+xml"
    letters = [chr(ord("A") + i) for i in range(columns + 1)]
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as book:
        book.writestr(
            "[Content_Types].xml",
            f'<Types xmlns="{package}/content-types"><Default Extension="rels" '
            f'ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
            '<Default Extension="xml" ContentType="application/xml"/><Override PartName="/xl/workbook.xml" '
            f'ContentType="{sheet.format("sheet.main")}"/><Override PartName="/xl/worksheets/sheet1.xml" '
            f'ContentType="{sheet.format("worksheet")}"/></Types>',
        )
        book.writestr(
            "_rels/.rels",
            f'<Relationships xmlns="{package}/relationships"><Relationship Id="r1" '
            f'Target="xl/workbook.xml" Type="{office}/officeDocument"/></Relationships>',
        )
        book.writestr(
            "xl/workbook.xml",
            f'<workbook xmlns="{main}" xmlns:r="{office}"><sheets>'
            '<sheet name="data" sheetId="1" r:id="r1"/></sheets></workbook>',
        )
        book.writestr(
            "xl/_rels/workbook.xml.rels",
            f'<Relationships xmlns="{package}/relationships"><Relationship '
            f'Id="r1" Target="worksheets/sheet1.xml" Type="{office}/worksheet"/></Relationships>',
        )
        with book.open("xl/worksheets/sheet1.xml", "w", force_zip64=True) as out:
            out.write(f'<worksheet xmlns="{main}"><sheetData>'.encode())
            header = ["time [s]", *(f"{n} [degC]" for n in names(columns))]
            out.write(
                (
                    '<row r="1">'
                    + "".join(
                        f'<c r="{c}1" t="inlineStr"><is><t>{h}</t></is></c>'
                        for c, h in zip(letters, header, strict=True)
                    )
                    + "</row>"
                ).encode()
            )
            at = 0
            for _, values in chunks(rows, columns, 1.0):
                for row in values.T.tolist():
                    cells = "".join(
                        f'<c r="{c}{at + 2}"><v>{v}</v></c>' for c, v in zip(letters, [float(at), *row], strict=True)
                    )
                    out.write(f'<row r="{at + 2}">{cells}</row>'.encode())
                    at += 1
            out.write(b"</sheetData></worksheet>")


def parquet(path: Path, rows: int, columns: int = 40) -> None:
    import pyarrow as pa
    import pyarrow.parquet as pq

    writer = None
    for times, values in chunks(rows, columns, 0.1, 60_000):
        piece = pa.table({"time": times, **dict(zip(names(columns), values, strict=True))})
        writer = writer or pq.ParquetWriter(path, piece.schema)
        writer.write_table(piece)
    if writer is not None:
        writer.close()


def _whole(rows: int, columns: int, step_s: float) -> tuple[Any, Any]:
    pieces = list(chunks(rows, columns, step_s))
    return (np.arange(rows) * step_s, np.concatenate([v for _, v in pieces], axis=1))


def mat5(path: Path, rows: int, columns: int = 20) -> None:
    from scipy.io import savemat

    t, values = _whole(rows, columns, 0.5)
    savemat(path, {"time": t[:, None], **{n: v[:, None] for n, v in zip(names(columns), values, strict=True)}})


def mat73(path: Path, rows: int, columns: int = 20) -> None:
    """As MATLAB writes it: HDF5 behind a header of 512 bytes, each array transposed and with its class."""
    import h5py

    t, values = _whole(rows, columns, 0.5)
    with h5py.File(path, "w", userblock_size=512) as file:
        for name, column in {"time": t, **dict(zip(names(columns), values, strict=True))}.items():
            made = file.create_dataset(name, data=column[None, :], chunks=(1, min(rows, 65536)), compression=3)
            made.attrs["MATLAB_class"] = np.bytes_("double")
    text = b"MATLAB 7.3 MAT-file, Platform: PCWIN64, Created on: Mon Mar 02 06:00:00 2026 HDF5 schema 1.00 ."
    with path.open("r+b") as raw:
        raw.write(text.ljust(116) + bytes(8) + b"\x00\x02IM")


def mdf4(path: Path, rows: int, columns: int = 40) -> None:
    from datetime import UTC, datetime

    from asammdf import MDF, Signal

    t, values = _whole(rows, columns, 0.1)
    with MDF(version="4.10") as file:
        file.start_time = datetime(2026, 3, 2, 6, tzinfo=UTC)
        file.append(
            [Signal(v, t, name=n, unit="degC") for n, v in zip(names(columns), values, strict=True)],
            common_timebase=True,
        )
        file.save(path, overwrite=True)
