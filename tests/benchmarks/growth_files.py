"""The campaigns and files of `growth.py`: many small tests, long tests, very wide files and a very dense workbook."""

from __future__ import annotations

import zipfile
from pathlib import Path

import numpy as np

START = np.datetime64("2026-03-02T06:00:00", "us")
_CONTENT_TYPES = (
    '<?xml version="1.0" encoding="UTF-8"?><Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">'
    '<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
    '<Default Extension="xml" ContentType="application/xml"/><Override PartName="/xl/workbook.xml" '
    'ContentType="application/vnd.openxmlformats-officedocument.spreadsheetml.sheet.main+xml"/></Types>'
)
_RELATIONS = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
_PACKAGE = "http://schemas.openxmlformats.org/package/2006/relationships"
_MAIN = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"


def _wave(at: np.datetime64, step_s: float) -> dict[str, object]:
    return {"wf_start_time": at, "wf_increment": step_s, "wf_start_offset": 0.0}


def many_tests(folder: Path, tests: int, rows: int = 720) -> None:
    """raw/tNNNNN.tdms (probes in volts and four temperatures, 2 h at 10 s), raw/tNNNNN_nc.csv (the control, every
    10 s), and campaign.yaml with both, ten channels."""
    from nptdms import ChannelObject, TdmsWriter

    (folder / "raw").mkdir(parents=True)
    rng = np.random.default_rng(0)
    t_s = 10.0 * np.arange(rows)
    for test in range(tests):
        at = START + np.timedelta64(test, "D")
        warm = 1 - np.exp(-t_s / rng.uniform(1200, 3600))
        probes = {n: 5 + g * warm + 0.002 * rng.standard_normal(rows) for n, g in (("X", 0.2), ("Y", 0.4), ("Z", 1.1))}
        places = {f"T{i}": 20 + (i + 1) * warm + 0.02 * rng.standard_normal(rows) for i in range(4)}
        with TdmsWriter(str(folder / "raw" / f"t{test:05d}.tdms")) as writer:
            writer.write_segment(
                [ChannelObject("Eddy", n, x, _wave(at, 10.0) | {"unit_string": "V"}) for n, x in probes.items()]
                + [ChannelObject("Temp", n, x, _wave(at, 10.0) | {"unit_string": "degC"}) for n, x in places.items()]
            )
        speed = np.where(t_s < 5400, 6000 + 10 * (test % 300), 0)
        load, motor = 12 + 8 * warm, 25 + 20 * warm
        begin_ms = int(at.astype("datetime64[ms]").astype(np.int64))
        with (folder / "raw" / f"t{test:05d}_nc.csv").open("w", encoding="utf-8") as out:
            out.write("time [ms],nActSpeed [rpm],Load [%],Tmotor [degC]\n")
            out.writelines(
                f"{begin_ms + 1000 * int(t)},{n},{p:.2f},{m:.1f}\n"
                for t, n, p, m in zip(t_s, speed, load, motor, strict=True)
            )
    lines = [
        "schema: thermodata/campaign/1",
        "id: many",
        "machine: {id: m}",
        "sources:",
        "  daq: {reader: crio, files: 'raw/{test}.tdms'}",
        "  nc: {reader: table, files: 'raw/{test}_nc.csv', table: {time: {column: 1, unit: ms}}}",
        "calibrations:",
        *(
            f"  probe_{a}: {{kind: scale, axis: {a}, gain: 31.7 um/V, facing: +{a}, increases_with: gap}}"
            for a in "XYZ"
        ),
        "channels:",
        *(
            f"  d{a}: {{source: daq, signal: Eddy/{a}, quantity: displacement, unit: V, axis: {a}, at: tcp, "
            f"calibration: probe_{a}}}"
            for a in "XYZ"
        ),
        *(f"  T{i}: {{source: daq, signal: Temp/T{i}, quantity: temperature, at: column.front}}" for i in range(4)),
        "  speed: {source: nc, signal: nActSpeed, quantity: rotational_speed, at: spindle}",
        "  load: {source: nc, signal: Load, quantity: load, at: spindle}",
        "  T_motor: {source: nc, signal: Tmotor, quantity: temperature, at: spindle.motor}",
        "tests:",
        *(f"  - {{id: t{test:05d}, kind: spindle, role: calibration}}" for test in range(tests)),
    ]
    (folder / "campaign.yaml").write_text("\n".join(lines) + "\n", encoding="utf-8")


def many_values(folder: Path, tests: int, hours: float = 12.0, channels: int = 8) -> None:
    """raw/tNNN.tdms (temperatures at 1 Hz) and campaign.yaml."""
    from nptdms import ChannelObject, TdmsWriter

    (folder / "raw").mkdir(parents=True)
    rng = np.random.default_rng(0)
    n = round(3600 * hours)
    noise = 0.01 * rng.standard_normal((channels, n))
    t_h = np.arange(n) / 3600
    for test in range(tests):
        more = {"unit_string": "degC"} | _wave(START + np.timedelta64(test, "D"), 1.0)
        with TdmsWriter(str(folder / "raw" / f"t{test:03d}.tdms")) as writer:
            writer.write_segment(
                [ChannelObject("Log", f"S{i}", 20 + np.sin(t_h + test + i) + noise[i], more) for i in range(channels)]
            )
    lines = [
        "schema: thermodata/campaign/1",
        "id: values",
        "machine: {id: m}",
        "sources: {daq: {reader: crio, files: 'raw/{test}.tdms'}}",
        "channels:",
        *(f"  T{i}: {{source: daq, signal: Log/S{i}, quantity: temperature, unit: degC}}" for i in range(channels)),
        "tests:",
        *(f"  - {{id: t{test:03d}, kind: other, role: none}}" for test in range(tests)),
    ]
    (folder / "campaign.yaml").write_text("\n".join(lines) + "\n", encoding="utf-8")


def wide_tdms(path: Path, channels: int = 100_000, rows: int = 10) -> None:
    """So many channels in groups of a thousand."""
    from nptdms import ChannelObject, TdmsWriter

    values = 20 + np.arange(rows) / 10
    with TdmsWriter(str(path)) as writer:
        writer.write_segment(
            [ChannelObject(f"g{i // 1000}", f"c{i}", values + i % 7, _wave(START, 1.0)) for i in range(channels)]
        )


def wide_csv(path: Path, channels: int = 2500, rows: int = 200) -> None:
    """So many columns beside a time in seconds: the most of which header and first rows are seen at first sight."""
    with path.open("w", encoding="utf-8") as out:
        out.write("Time [s]," + ",".join(f"c{i} [degC]" for i in range(channels)) + "\n")
        for row in range(rows):
            out.write(f"{row}.0," + ",".join(f"{20 + row / 10 + i % 7:.1f}" for i in range(channels)) + "\n")


def dense_workbook(path: Path, sheets: int = 20, rows: int = 1_000_000) -> None:
    """Sheets of a million rows of a time and a value: each legal, together absurd, and small when packed."""
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as book:
        book.writestr("[Content_Types].xml", _CONTENT_TYPES)
        book.writestr(
            "_rels/.rels",
            f'<Relationships xmlns="{_PACKAGE}"><Relationship Id="rId1" Type="{_RELATIONS}/officeDocument" '
            'Target="xl/workbook.xml"/></Relationships>',
        )
        listed = "".join(f'<sheet name="s{i}" sheetId="{i + 1}" r:id="rId{i + 1}"/>' for i in range(sheets))
        book.writestr(
            "xl/workbook.xml", f'<workbook xmlns="{_MAIN}" xmlns:r="{_RELATIONS}"><sheets>{listed}</sheets></workbook>'
        )
        targets = "".join(
            f'<Relationship Id="rId{i + 1}" Type="{_RELATIONS}/worksheet" Target="worksheets/sheet{i + 1}.xml"/>'
            for i in range(sheets)
        )
        book.writestr("xl/_rels/workbook.xml.rels", f'<Relationships xmlns="{_PACKAGE}">{targets}</Relationships>')
        names = "".join(f'<c t="inlineStr"><is><t>{n}</t></is></c>' for n in ("Time [s]", "T [degC]"))
        block = "".join(f"<row><c><v>{k}</v></c><c><v>{20 + k / 100}</v></c></row>" for k in range(100))
        for i in range(sheets):
            with book.open(f"xl/worksheets/sheet{i + 1}.xml", "w") as out:
                out.write(f'<worksheet xmlns="{_MAIN}"><sheetData><row>{names}</row>'.encode())
                part = (block * 100).encode()
                for _ in range(rows // 10_000):
                    out.write(part)
                out.write(b"</sheetData></worksheet>")


def folder_of_logs(folder: Path, files: int = 43, rows: int = 2400) -> None:
    """43 CSV files of 4.9 MB together: a date in the file name, local times, six columns."""
    folder.mkdir(parents=True)
    rng = np.random.default_rng(0)
    names = ["Spindle front [°C]", "Spindle rear [°C]", "Column [°C]", "Hall [°C]", "dZ [um]"]
    for nr in range(files):
        at = np.datetime64("2025-01-06T07:00:00") + np.timedelta64(nr, "D")
        warm = 1 - np.exp(-np.arange(rows) / 600)
        table = [20 + g * warm + 0.02 * rng.standard_normal(rows) for g in (12, 9, 3, 1)]
        table.append(45 * warm + 0.3 * rng.standard_normal(rows))
        day = str(at)[:10]
        with (folder / f"{day}_S{3000 + 1000 * (nr % 5)}.csv").open("w", encoding="utf-8") as out:
            out.write("Time," + ",".join(names) + "\n")
            for i in range(rows):
                stamp = str(at + np.timedelta64(10 * i, "s")).replace("T", " ")
                out.write(stamp + "," + ",".join(f"{column[i]:.2f}" for column in table) + "\n")
