"""Folders of made-up labs as labs leave them: their formats, names and habits, and what is true of them.

Each writes raw files only, and returns what is true: signal -> (quantity, place,
                                                                 axis); None where a stranger can't know.
"""

from __future__ import annotations

import json
import zipfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from pathlib import Path
from xml.sax.saxutils import escape
from zoneinfo import ZoneInfo

import numpy as np
import numpy.typing as npt

Float1D = npt.NDArray[np.float64]
START = datetime(2026, 3, 2, 7, 0, tzinfo=UTC)
Truth = dict[str, tuple[str | None, str | None, str | None]]


@dataclass
class Lab:
    """What is true of a folder. jumps: file -> signal; kinds: test -> kind."""

    tests: set[str]
    signals: Truth
    jumps: dict[str, str] = field(default_factory=dict)
    kinds: dict[str, str] = field(default_factory=dict)
    sources: int = 1


def warm(n: int, low: float, rise: float, tau: float, seed: int) -> Float1D:
    """A temperature that creeps from `low` by `rise`, with the noise of a Pt100."""
    noise = np.random.default_rng(seed).normal(0, 0.02, n)
    return np.asarray(low + rise * (1 - np.exp(-np.arange(n) / (tau * n))) + noise)


def speeds(n: int, levels: Sequence[float]) -> Float1D:
    """A spindle programme: the levels one after the other, a rest before, between and at the end, none as long as
    another."""
    shares = np.cumsum(np.arange(3, 4 + 2 * len(levels)))
    cut = np.split(np.arange(n), (n * shares[:-1] / shares[-1]).astype(int))
    out = np.zeros(n)
    for i, level in enumerate(levels):
        out[cut[2 * i + 1]] = level
    return out


def staircase(moves: Sequence[float], um_per_v: float, dwell_s: float, rate: float, seed: int) -> Float1D:
    """A probe's volts in a jump test."""
    levels = np.concatenate([[0.0], np.cumsum(moves)]) / um_per_v + 5.0
    rows = int(dwell_s * rate)
    return np.asarray(np.repeat(levels, rows) + np.random.default_rng(seed).normal(0, 0.002, rows * len(levels)))


def tdms(
    path: Path, groups: Mapping[str, Mapping[str, tuple[Float1D, str | None]]], start: datetime, step_s: float
) -> None:
    """A TDMS file with waveform properties, UTC."""
    from nptdms import ChannelObject, TdmsWriter

    path.parent.mkdir(parents=True, exist_ok=True)
    with TdmsWriter(str(path)) as writer:
        writer.write_segment(
            [
                ChannelObject(
                    group,
                    name,
                    values,
                    properties={
                        "wf_start_time": np.datetime64(start.replace(tzinfo=None)),
                        "wf_start_offset": 0.0,
                        "wf_increment": step_s,
                        "wf_samples": len(values),
                        **({"unit_string": unit} if unit else {}),
                    },
                )
                for group, channels in groups.items()
                for name, (values, unit) in channels.items()
            ]
        )


def text(
    path: Path,
    header: Sequence[str],
    columns: Sequence[Sequence[str]],
    *,
    mark: str = ";",
    encoding: str = "utf-8",
    before: Sequence[str] = (),
) -> None:
    """Delimited text, one row a line."""
    path.parent.mkdir(parents=True, exist_ok=True)
    rows = [mark.join(r) for r in zip(*columns, strict=True)]
    path.write_bytes(("\r\n".join([*before, mark.join(header), *rows]) + "\r\n").encode(encoding))


def workbook(path: Path, rows: Sequence[Sequence[object]] | Mapping[str, Sequence[Sequence[object]]]) -> None:
    """An XLSX file, as small as the format allows. rows: of its one sheet, or sheet -> rows."""

    def cell(value: object) -> str:
        if isinstance(value, int | float):
            return f"<c><v>{value}</v></c>"
        return f'<c t="inlineStr"><is><t>{escape(str(value))}</t></is></c>'

    book = rows if isinstance(rows, Mapping) else {"Data": rows}
    main = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
    rels = "http://schemas.openxmlformats.org/package/2006/relationships"
    office = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
    kind = "application/vnd.openxmlformats-officedocument.spreadsheetml"
    numbered = list(enumerate(book, 1))
    parts = {
        "[Content_Types].xml": '<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">'
        '<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
        f'<Override PartName="/xl/workbook.xml" ContentType="{kind}.sheet.main+xml"/>'
        + "".join(
            f'<Override PartName="/xl/worksheets/sheet{i}.xml" ContentType="{kind}.worksheet+xml"/>'
            for i, _ in numbered
        )
        + "</Types>",
        "_rels/.rels": f'<Relationships xmlns="{rels}"><Relationship Id="r1" '
        f'Type="{office}/officeDocument" Target="xl/workbook.xml"/></Relationships>',
        "xl/workbook.xml": f'<workbook xmlns="{main}" xmlns:r="{office}"><sheets>'
        + "".join(f'<sheet name="{escape(name)}" sheetId="{i}" r:id="r{i}"/>' for i, name in numbered)
        + "</sheets></workbook>",
        "xl/_rels/workbook.xml.rels": f'<Relationships xmlns="{rels}">'
        + "".join(
            f'<Relationship Id="r{i}" Type="{office}/worksheet" Target="worksheets/sheet{i}.xml"/>' for i, _ in numbered
        )
        + "</Relationships>",
    }
    for i, name in numbered:
        body = "".join(f"<row>{''.join(map(cell, row))}</row>" for row in book[name])
        parts[f"xl/worksheets/sheet{i}.xml"] = f'<worksheet xmlns="{main}"><sheetData>{body}</sheetData></worksheet>'
    path.parent.mkdir(parents=True, exist_ok=True)
    with zipfile.ZipFile(path, "w") as file:
        for name, content in parts.items():
            file.writestr(name, content)


def numbers(values: Float1D, digits: int = 2, comma: bool = False) -> list[str]:
    shown = [f"{v:.{digits}f}" for v in values]
    return [s.replace(".", ",") for s in shown] if comma else shown


def local(n: int, step_s: float, start: datetime, zone: str, form: str) -> list[str]:
    first = start.astimezone(ZoneInfo(zone))
    return [(first + timedelta(seconds=i * step_s)).strftime(form) for i in range(n)]


def german(folder: Path) -> Lab:
    """Control CSV with decimal commas and local time beside TDMS of probes and Pt100s; jump tests called Sprung."""
    n = 400
    for k, (test, levels) in enumerate([("Umgebung", ()), ("Spindel_6000", (6000,)), ("Spektrum", (2000, 8000, 4000))]):
        start, speed = START + timedelta(days=k), speeds(n, levels)
        heat = 0 if not levels else 12
        tdms(
            folder / "Messdaten" / f"{test}_DAQ.tdms",
            {
                "Wirbelstrom": {a: (5 + warm(n, 0, 0.1 * heat / 12, 0.3, i), "V") for i, a in enumerate("XYZ")},
                "Temperatur": {
                    "Lager vorne": (warm(n, 21, heat, 0.2, 3), "°C"),
                    "Lager hinten": (warm(n, 21, heat / 2, 0.2, 4), "°C"),
                    "Ständer hinten": (warm(n, 20, 2, 1, 5), "°C"),
                    "Umgebung unten": (warm(n, 20, 1, 1, 6), "°C"),
                },
            },
            start,
            10,
        )
        text(
            folder / "Steuerung" / f"{test}.csv",
            [
                "Datum/Uhrzeit",
                "Spindeldrehzahl [U/min]",
                "Kühlmitteltemperatur [°C]",
                "Wirkleistung Spindel [kW]",
                "Vorschub X [mm/min]",
                "Motortemperatur X [°C]",
            ],
            [
                local(n, 10, start, "Europe/Berlin", "%d.%m.%Y %H:%M:%S"),
                numbers(speed, 0),
                numbers(warm(n, 22, 1, 1, 7), 1, True),
                numbers(speed / 2000, 2, True),
                numbers(np.zeros(n), 1, True),
                numbers(warm(n, 23, 1, 1, 8), 1, True),
            ],
            encoding="cp1252",
        )
    for a in "XZ":
        tdms(
            folder / "Messdaten" / f"Sprung_{a}.tdms",
            {
                "Wirbelstrom": {
                    b: (staircase([100, -50, -50], 80, 10, 10, 1) if a == b else np.full(400, 5.0), "V") for b in "XYZ"
                }
            },
            START,
            0.1,
        )
    return Lab(
        {"Umgebung", "Spindel_6000", "Spektrum"},
        {
            "Wirbelstrom/X": ("displacement", "tcp", "X"),
            "Wirbelstrom/Y": ("displacement", "tcp", "Y"),
            "Wirbelstrom/Z": ("displacement", "tcp", "Z"),
            "Temperatur/Lager vorne": ("temperature", "spindle.bearing.front", None),
            "Temperatur/Lager hinten": ("temperature", "spindle.bearing.rear", None),
            "Temperatur/Ständer hinten": ("temperature", "column.rear", None),
            "Temperatur/Umgebung unten": ("temperature", "hall.bottom", None),
            "Spindeldrehzahl [U/min]": ("rotational_speed", "spindle", None),
            "Kühlmitteltemperatur [°C]": ("temperature", "coolant", None),
            "Wirkleistung Spindel [kW]": ("power", "spindle", None),
            "Vorschub X [mm/min]": ("feed", "axis.x", None),
            "Motortemperatur X [°C]": ("temperature", "axis.x.motor", None),
        },
        {"Messdaten/Sprung_X.tdms": "Wirbelstrom/X", "Messdaten/Sprung_Z.tdms": "Wirbelstrom/Z"},
        {"Umgebung": "etve", "Spindel_6000": "spindle", "Spektrum": "spectrum"},
        2,
    )


def czech(folder: Path) -> Lab:
    """Czech names in cp1250; each test a folder; one logger writes an hour a file."""
    n = 300
    for k, (test, level) in enumerate([("zahrivani_8000", 8000.0), ("klid", 0.0)]):
        start = START + timedelta(days=k)
        for part in range(3):
            when = start + timedelta(seconds=part * n * 5)
            tdms(
                folder / test / f"mereni_{part + 1}.tdms",
                {
                    "teploty": {
                        "ložisko přední": (warm(n, 22 + part, 1, 1, part), "°C"),
                        "matice Z": (warm(n, 21, 1, 1, part + 3), "°C"),
                        "teplota haly": (warm(n, 20, 0.5, 1, part + 6), "°C"),
                        "lože": (warm(n, 20, 0.2, 1, part + 9), "°C"),
                    },
                    "posunutí": {
                        "dX1": (warm(n, 5, 0.1, 1, part + 20), "V"),
                        "dZ": (warm(n, 5, 0.2, 1, part + 30), "V"),
                    },
                },
                when,
                5,
            )
        text(
            folder / test / "rs.csv",
            [
                "Datum a čas",
                "otáčky vřetene [ot/min]",
                "proud vřetene [A]",
                "průtok chladicí kapaliny [l/min]",
                "posuv Z [mm/min]",
                "poloha Z [mm]",
            ],
            [
                local(3 * n, 5, start, "Europe/Prague", "%d.%m.%Y %H:%M:%S"),
                numbers(speeds(3 * n, [level] if level else []), 0),
                numbers(np.full(3 * n, 3.2), 1, True),
                numbers(np.full(3 * n, 12.0), 1, True),
                numbers(np.zeros(3 * n), 0),
                numbers(np.full(3 * n, 210.0), 3, True),
            ],
            encoding="cp1250",
        )
    return Lab(
        {"zahrivani_8000", "klid"},
        {
            "teploty/ložisko přední": ("temperature", "spindle.bearing.front", None),
            "teploty/matice Z": ("temperature", "axis.z.nut", None),
            "teploty/teplota haly": ("temperature", "hall", None),
            "teploty/lože": ("temperature", "bed", None),
            "posunutí/dX1": ("displacement", "tcp", "X"),
            "posunutí/dZ": ("displacement", "tcp", "Z"),
            "otáčky vřetene [ot/min]": ("rotational_speed", "spindle", None),
            "proud vřetene [A]": ("current", "spindle", None),
            "průtok chladicí kapaliny [l/min]": ("flow", "coolant", None),
            "posuv Z [mm/min]": ("feed", "axis.z", None),
            "poloha Z [mm]": ("position", "axis.z", None),
        },
        kinds={"zahrivani_8000": "spindle", "klid": "etve"},
        sources=2,
    )


def chinese(folder: Path) -> Lab:
    """Chinese names, one CSV a test with comma and relative minutes; conditions stand in the file names."""
    n = 240
    header = [
        "时间(min)",
        "主轴前轴承温度(℃)",
        "主轴后轴承温度(℃)",
        "主轴电机温度(℃)",
        "Z轴螺母温度(℃)",
        "立柱温度(℃)",
        "冷却液温度(℃)",
        "环境温度(℃)",
        "主轴转速(rpm)",
        "X向热误差(um)",
        "Z向热误差(um)",
    ]
    for speed, nr in [(2000, 1), (4000, 2), (6000, 3), (8000, 4)]:
        columns = [numbers(np.arange(n) * 1.0, 1)]
        columns += [numbers(warm(n, 20 + i, 10 - i, 0.3, i + nr)) for i in range(7)]
        columns += [
            numbers(speeds(n, [speed]), 0),
            numbers(warm(n, 0, 12, 0.3, nr)),
            numbers(warm(n, 0, 40, 0.3, nr + 50)),
        ]
        text(folder / "数据" / f"S{speed}_F500_{nr}.csv", header, columns, mark=",")
    places = [
        "spindle.bearing.front",
        "spindle.bearing.rear",
        "spindle.motor",
        "axis.z.nut",
        "column",
        "coolant",
        "hall",
    ]
    signals: Truth = {h: ("temperature", p, None) for h, p in zip(header[1:8], places, strict=True)}
    signals |= {
        header[8]: ("rotational_speed", "spindle", None),
        header[9]: ("displacement", "tcp", "X"),
        header[10]: ("displacement", "tcp", "Z"),
    }
    tests = {f"S{s}_F500_{i}" for i, s in enumerate((2000, 4000, 6000, 8000), 1)}
    return Lab(tests, signals, kinds=dict.fromkeys(tests, "spindle"))


def workbooks(folder: Path) -> Lab:
    """XLSX a test, numbered, and a table of tests beside them."""
    n = 150
    plan = [
        ("Nr", "Speed [rpm]", "Tool", "Remark"),
        (1, 3000, "HSK63 dummy", ""),
        (2, 9000, "HSK63 dummy", "door open"),
        (3, 12000, "none", ""),
    ]
    for nr, speed, *_ in plan[1:]:
        rows: list[Sequence[object]] = [
            ["Time [s]", "T_spindle_front_bearing [°C]", "T_amb [°C]", "Spindle speed [rpm]", "Y1 [um]", "level [mm]"]
        ]
        data = zip(
            np.arange(n) * 30.0,
            warm(n, 22, 9, 0.3, int(nr)),
            warm(n, 20, 1, 1, 9),
            speeds(n, [float(speed)]),
            warm(n, 0, 20, 0.3, 5),
            np.full(n, 40.0),
            strict=True,
        )
        workbook(folder / f"test_{int(nr):02d}.xlsx", [*rows, *([round(float(v), 3) for v in row] for row in data)])
    workbook(folder / "test_plan.xlsx", plan)
    return Lab(
        {"test_01", "test_02", "test_03"},
        {
            "T_spindle_front_bearing [°C]": ("temperature", "spindle.bearing.front", None),
            "T_amb [°C]": ("temperature", "hall", None),
            "Spindle speed [rpm]": ("rotational_speed", "spindle", None),
            "Y1 [um]": ("displacement", "tcp", "Y"),
            "level [mm]": (None, None, None),
        },
        kinds=dict.fromkeys(("test_01", "test_02", "test_03"), "spindle"),
    )


def recorder(folder: Path) -> Lab:
    """MCAP (JSON, UTC) beside LVM of two probes and spindle pulses; both log the speed; its clock is 40 s late."""
    from mcap.writer import Writer

    n = 300
    for k, (test, levels) in enumerate([("run-A", (5000, 2500)), ("run-B", (9000, 1500, 7000)), ("calib_Z", ())]):
        start = START + timedelta(days=k)
        lvm = {
            "probe Z": ("Volts", warm(n, 4, 0.3, 0.3, k)),
            "probe X": ("Volts", warm(n, 4, 0.1, 0.3, k + 5)),
            "spindle rpm": ("rpm", speeds(n, levels)),
        }
        if test == "calib_Z":
            lvm["probe Z"] = ("Volts", staircase([50, 50, -100], 100, 75, 1, 2))
        _lvm(folder / f"{test}.lvm", lvm, start + timedelta(seconds=40), 1.0 if test == "calib_Z" else 10.0)
        if not levels:
            continue
        with (folder / f"{test}.mcap").open("wb") as file:
            writer = Writer(file)
            writer.start()
            schema = writer.register_schema(name="T", encoding="jsonschema", data=b'{"type":"object"}')
            channel = writer.register_channel(topic="/machine", message_encoding="json", schema_id=schema)
            front, air, speed = warm(n, 22, 8, 0.3, k), warm(n, 20, 1, 1, k + 9), speeds(n, levels)
            for i in range(n):
                at = int((start + timedelta(seconds=10 * i)).timestamp() * 1e9)
                writer.add_message(
                    channel,
                    log_time=at,
                    publish_time=at,
                    data=json.dumps(
                        {
                            "spindle_bearing_front_degC": round(front[i], 2),
                            "ambient_air": round(air[i], 2),
                            "spindle_speed_rpm": float(speed[i]),
                            "axis_X_load_pct": 3.0 + i % 4,
                        }
                    ).encode(),
                )
            writer.finish()
    return Lab(
        {"run-A", "run-B"},
        {
            "probe Z": ("displacement", "tcp", "Z"),
            "probe X": ("displacement", "tcp", "X"),
            "spindle rpm": ("rotational_speed", "spindle", None),
            "/machine.spindle_bearing_front_degC": ("temperature", "spindle.bearing.front", None),
            "/machine.ambient_air": ("temperature", "hall", None),
            "/machine.spindle_speed_rpm": ("rotational_speed", "spindle", None),
            "/machine.axis_X_load_pct": ("load", "axis.x", None),
        },
        {"calib_Z.lvm": "probe Z"},
        {"run-A": "spindle", "run-B": "spectrum"},
        2,
    )


def _lvm(path: Path, channels: Mapping[str, tuple[str, Float1D]], start: datetime, step_s: float) -> None:
    k = len(channels)
    n = len(next(iter(channels.values()))[1])
    at = start.strftime("%Y/%m/%d"), start.strftime("%H:%M:%S.%f") + "0000000000000"
    lines = [
        "LabVIEW Measurement\t",
        "Writer_Version\t2",
        "Reader_Version\t2",
        "Separator\tTab",
        "Decimal_Separator\t.",
        "Multi_Headings\tNo",
        "X_Columns\tNo",
        "Time_Pref\tAbsolute",
        f"Date\t{at[0]}",
        f"Time\t{at[1]}",
        "***End_of_Header***\t",
        "",
        f"Channels\t{k}",
        "Samples\t" + "\t".join([str(n)] * k),
        "Date\t" + "\t".join([at[0]] * k),
        "Time\t" + "\t".join([at[1]] * k),
        "Y_Unit_Label\t" + "\t".join(u for u, _ in channels.values()),
        "X_Dimension\t" + "\t".join(["Time"] * k),
        "X0\t" + "\t".join(["0.0"] * k),
        "Delta_X\t" + "\t".join([f"{step_s:.6f}"] * k),
        "***End_of_Header***\t",
        "X_Value\t" + "\t".join(channels) + "\tComment",
    ]
    lines += ["\t" + "\t".join(f"{v[i]:.6f}" for _, v in channels.values()) for i in range(n)]
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(("\r\n".join(lines) + "\r\n").encode())


def sinumerik(folder: Path) -> Lab:
    """Sinumerik Trace CSV beside plain LabVIEW ASCII with relative time; a damaged file and notes among them."""
    n = 400
    for k, test in enumerate(("Z_feed_1", "Z_feed_2")):
        t = np.arange(n) * 2.0
        text(
            folder / "trace" / f"{test}.csv",
            [
                '"Time"',
                '"/Nck/!SD/nckServoDataActPos1stEnc64 [u1; 3]"',
                '"/Nck/!SD/nckServoDataActCurr32 [u1; 3]"',
                '"/Channel/Spindle/actSpeed [u1; 1]"',
            ],
            [
                numbers(t, 3),
                numbers(200 + 150 * np.sin(t / 30), 3),
                numbers(np.abs(np.cos(t / 30)) * 4),
                numbers(np.zeros(n), 1),
            ],
            mark=",",
        )
        text(
            folder / "labview" / f"{test}.txt",
            ["Time (s)", "T_Mutter_Z (degC)", "T_Motor_Z (degC)", "T Halle (degC)", "Z (um)"],
            [
                numbers(t, 1),
                numbers(warm(n, 21, 6, 0.3, k)),
                numbers(warm(n, 23, 9, 0.3, k + 3)),
                numbers(warm(n, 20, 1, 1, k + 5)),
                numbers(warm(n, 0, 25, 0.4, k + 7)),
            ],
            mark="\t",
        )
    (folder / "labview" / "broken.txt").write_bytes(b"\x00\x01\x02 not a table \x00")
    (folder / "notes.txt").write_text("Door was open at noon.\n")
    return Lab(
        {"Z_feed_1", "Z_feed_2"},
        {
            "/Nck/!SD/nckServoDataActPos1stEnc64 [u1; 3]": ("position", None, None),
            "/Nck/!SD/nckServoDataActCurr32 [u1; 3]": ("current", None, None),
            "/Channel/Spindle/actSpeed [u1; 1]": ("rotational_speed", "spindle", None),
            "T_Mutter_Z (degC)": ("temperature", "axis.z.nut", None),
            "T_Motor_Z (degC)": ("temperature", "axis.z.motor", None),
            "T Halle (degC)": ("temperature", "hall", None),
            "Z (um)": ("displacement", "tcp", "Z"),
        },
        kinds=dict.fromkeys(("Z_feed_1", "Z_feed_2"), "linear_axis"),
        sources=2,
    )


LABS = {
    "german": german,
    "czech": czech,
    "chinese": chinese,
    "workbooks": workbooks,
    "recorder": recorder,
    "sinumerik": sinumerik,
}
