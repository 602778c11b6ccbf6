"""Five folders as labs hand them over, none like another: without a time column, without a header, with comments above
it, in minutes, and a sheet a test. Each is written with what is true of it, and with what its owner would answer.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from datetime import datetime, timedelta
from pathlib import Path

import numpy as np
import numpy.typing as npt

from .labs import numbers, workbook

Float1D = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Folder:
    """answers: (what the draft says, what its owner writes there instead), each once in the draft. tests: id -> its
    length [s]. channels: name -> quantity. peak: (channel, test, the true value that SQL must find [canonical])."""

    tests: dict[str, float]
    channels: dict[str, str]
    peak: tuple[str, str, float]
    answers: tuple[tuple[str, str], ...] = ()
    conditions: dict[str, dict[str, str]] = field(default_factory=dict)


def heating(n: int, low: float, rise: float, tau: float, seed: int, noise: float = 0.03) -> Float1D:
    """What creeps from `low` by `rise` with a time constant of `tau` rows. Shape (n,)."""
    scatter = np.random.default_rng(seed).normal(0, noise, n)
    return np.asarray(low + rise * (1 - np.exp(-np.arange(n) / tau)) + scatter)


def steps(n: int, levels: Sequence[float]) -> Float1D:
    """A spindle's programme: the levels, all of one length; at rest before and behind. Shape (n,)."""
    return np.asarray([0.0, *levels, 0.0])[np.minimum(np.arange(n) * (len(levels) + 2) // n, len(levels) + 1)]


def _write(
    path: Path, lines: Sequence[str], encoding: str = "utf-8", end: str = "\r\n", last: str | None = None
) -> None:
    """last: what stands behind the last line; by default the line end."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes((end.join(lines) + (end if last is None else last)).encode(encoding))


def without_time(folder: Path) -> Folder:
    """A spindle builder's bench, in English: comma, names and units in two rows, no time at all; speeds in the names as
    the operators say them, and the period only in a note that no program reads."""
    names = ["Brg NDE", "Brg DE", "Stator", "Housing left", "Ambient", "Growth Z"]
    units = ["degC", "degC", "degC", "degC", "degC", "µm"]
    programmes = {"1-8k": [1800.0], "2-12k": [12000.0], "3-1k+2krpm": [1000.0, 2000.0, 1000.0], "4-idle": []}
    n = 301
    for k, (test, levels) in enumerate(programmes.items()):
        heat = 14.0 if levels else 0.0
        columns = [heating(n, 21 + i, heat / (1 + i), 50 + 20 * i, 10 * k + i) for i in range(4)]
        columns += [heating(n, 20.5, 0.8, 200, 10 * k + 5), heating(n, 0, 3 * heat, 70, 10 * k + 6, 0.1)]
        texts = [numbers(c, 2) for c in columns]
        lines = [",".join(names), ",".join(units), *map(",".join, zip(*texts, strict=True))]
        _write(folder / "bench 3" / f"{test}.csv", lines)
    _write(folder / "bench 3" / "README.txt", ["Sampled every 60 s. Ask Dave about 1-8k."])
    return Folder(
        dict.fromkeys(programmes, 300 * 60.0),
        {
            **dict.fromkeys(("Brg_NDE", "Brg_DE", "Stator", "Housing_left", "Ambient"), "temperature"),
            "Growth_Z": "displacement",
        },
        ("Growth_Z", "1-8k", 42.0),
        (
            ("period: unknown", "period: 60 s"),
            ('id: "1-8k", kind: spindle,', 'id: "1-8k", kind: spindle, conditions: {speed: 1800 rpm},'),
            ('id: "2-12k", kind: spindle,', 'id: "2-12k", kind: spindle, conditions: {speed: 12000 rpm},'),
        ),
        {
            "1-8k": {"speed": "1800 rpm"},
            "2-12k": {"speed": "12000 rpm"},
            "3-1k+2krpm": {"schedule": "1000 rpm, 2000 rpm"},
        },
    )


def headerless(folder: Path) -> Folder:
    """A workshop's own logger, in Czech: a byte order mark, semicolons, decimal commas, no header; a folder a test,
    numbered as samples are, and the last row without a line end."""
    n = 720
    for k, (test, levels) in enumerate({"S001": [4000.0], "S002": [9000.0], "S010": [3000.0, 6000.0]}.items()):
        t = np.arange(n) * 10.0
        columns = [heating(n, 19.5 + 0.3 * i, 9.0 / (1 + i), 150 + 60 * i, 20 * k + i) for i in range(5)]
        growth = heating(n, 0, -31.0, 200, 20 * k + 9, 0.05)
        texts = [numbers(t, 0), *(numbers(c, 2, True) for c in columns), numbers(steps(n, levels), 0)]
        texts.append(numbers(growth, 3, True))
        _write(folder / test / "mereni.txt", list(map(";".join, zip(*texts, strict=True))), "utf-8-sig", last="")
    return Folder(
        dict.fromkeys(("S001", "S002", "S010"), 7190.0),
        {
            **{f"column_{i}": "temperature" for i in range(2, 7)},
            "column_7": "rotational_speed",
            "column_8": "displacement",
        },
        ("column_8", "S002", 31.0),
        (
            ("unit: unknown", "unit: s"),
            (
                '# column_7: {source: log, signal: "column 7", quantity: ?, unit: ?}',
                'column_7: {source: log, signal: "column 7", quantity: rotational_speed, unit: rpm, at: spindle}',
            ),
            (
                '# column_8: {source: log, signal: "column 8", quantity: ?, unit: ?}',
                'column_8: {source: log, signal: "column 8", quantity: displacement, unit: um, axis: Z, at: tcp}',
            ),
        ),
    )


def comments(folder: Path) -> Folder:
    """A climate chamber, in English with German units: comments above the header, stamps with a dash in a column called
    time that is not the first, millimetres; the course of the air stands in the names."""
    n = 480
    for k, (test, low, high, speed) in enumerate(
        [("wAC-from0-20Cto25C", 20.0, 25.0, 0.0), ("woAC-n6000", 23.0, 23.4, 6000.0)]
    ):
        start = datetime(2021, 6, 12 + k, 12, 54, 51)
        stamps = [f"{start + timedelta(seconds=15 * i):%Y/%m/%d-%H:%M:%S}" for i in range(n)]
        air = low + (high - low) * np.clip((np.arange(n) - 60) / 240, 0, 1)
        nose, motor = heating(n, low, 6.0 * (speed > 0), 90, k), heating(n, low + 1, 11.0 * (speed > 0), 60, k + 3)
        growth = heating(n, 0, 0.036 * (speed > 0) + 0.008 * (speed == 0), 110, k + 6, 0.0002)
        before = ["% ChamberLog 3.2 - export", "% machine: VMC 850;operator: JP", "% channels 6, sampling 15 s", "%"]
        header = "T nose [Grd C]\tT motor [Grd C]\ttime\tAir [Grd C]\tSpindle [U/min]\tgrowth Z [mm]"
        texts = [numbers(nose, 2), numbers(motor, 2), stamps, numbers(air, 1)]
        texts += [numbers(np.full(n, speed), 0), numbers(growth, 5)]
        _write(folder / "export" / f"{test}.txt", [*before, header, *map("\t".join, zip(*texts, strict=True))])
    return Folder(
        dict.fromkeys(("wAC-from0-20Cto25C", "woAC-n6000"), 479 * 15.0),
        {
            **dict.fromkeys(("T_nose", "T_motor", "Air"), "temperature"),
            "Spindle": "rotational_speed",
            "growth_Z": "displacement",
        },
        ("growth_Z", "woAC-n6000", 36.0),
        (('export/{test}.txt"', 'export/{test}.txt", timezone: Asia/Taipei'),),
        {"wAC-from0-20Cto25C": {"air": "20 degC to 25 degC"}, "woAC-n6000": {"speed": "6000 rpm"}},
    )


def minutes(folder: Path) -> Folder:
    """An institute, in German: cp1252, decimal commas, a time without a unit that counts minutes; the hours stand in
    the names."""
    n = 361
    header = ["Zeit", "Lager vorn [°C]", "Lager hinten [°C]", "Spindelstock [°C]", "Halle [°C]", "Drehzahl [1/min]"]
    header += ["Weg X [µm]", "Weg Z [µm]"]
    for k, (test, levels) in enumerate(
        {"Warmlauf_S4000_6h": [4000.0], "Stufen_1k+2krpm_6h": [1000.0, 2000.0], "Warmlauf_S8000_6h": [8000.0]}.items()
    ):
        columns = [heating(n, 20 + i, 12.0 / (1 + i), 60 + 30 * i, 30 * k + i) for i in range(3)]
        columns += [heating(n, 19.8, 0.6, 200, 30 * k + 5), steps(n, levels)]
        columns += [heating(n, 0, -6, 90, 30 * k + 6, 0.1), heating(n, 0, 48, 80, 30 * k + 7, 0.1)]
        texts = [numbers(np.arange(n) * 1.0, 0), *(numbers(c, 2, True) for c in columns)]
        _write(
            folder / "Messung" / f"{test}.csv", [";".join(header), *map(";".join, zip(*texts, strict=True))], "cp1252"
        )
    return Folder(
        dict.fromkeys(("Warmlauf_S4000_6h", "Stufen_1k+2krpm_6h", "Warmlauf_S8000_6h"), 360 * 60.0),
        {
            **dict.fromkeys(("Lager_vorn", "Lager_hinten", "Spindelstock", "Halle"), "temperature"),
            "Drehzahl": "rotational_speed",
            "Weg_X": "displacement",
            "Weg_Z": "displacement",
        },
        ("Weg_Z", "Warmlauf_S8000_6h", 48.0),
        (("unit: unknown", "unit: min"),),
        {"Warmlauf_S4000_6h": {"speed": "4000 rpm"}, "Stufen_1k+2krpm_6h": {"schedule": "1000 rpm, 2000 rpm"}},
    )


def sheets(folder: Path) -> Folder:
    """A job shop, in US units: one workbook, a sheet a test and one of notes; minutes in the header, Fahrenheit and
    thousandths of an inch."""
    n = 121
    book: dict[str, Sequence[Sequence[object]]] = {}
    header = ["Elapsed (min)", "Front brg (°F)", "Rear brg (°F)", "Shop air (°F)", "Spindle (rpm)", "Z drop (thou)"]
    for k, (test, levels) in enumerate(
        {"Idle": [], "6000 rpm": [6000.0], "Speed steps": [2000.0, 8000.0, 4000.0]}.items()
    ):
        rise = 18.0 if levels else 0.0
        columns = [np.arange(n) * 2.0, heating(n, 70, rise, 30, 40 * k), heating(n, 70, rise / 2, 40, 40 * k + 1)]
        columns += [heating(n, 69, 1, 80, 40 * k + 2), steps(n, levels)]
        columns.append(heating(n, 0, 1.5 if levels else 0.1, 35, 40 * k + 3, 0.005))
        rows = [[round(float(v), 4) for v in row] for row in zip(*columns, strict=True)]
        book[test] = [["Haas-type VMC, indicator on test bar"], header, *rows]
    book["Notes"] = [["Indicator zeroed cold."], ["Door closed."]]
    workbook(folder / "Spindle growth 2019.xlsx", book)
    return Folder(
        dict.fromkeys(("Idle", "6000 rpm", "Speed steps"), 240 * 60.0),
        {
            **dict.fromkeys(("Front_brg", "Rear_brg", "Shop_air"), "temperature"),
            "Spindle": "rotational_speed",
            "Z_drop": "displacement",
        },
        ("Z_drop", "6000 rpm", 38.1),
        (("id: Idle, kind: etve", "id: Idle, start: 2019-05-03 07:30, kind: etve"),),
        {"6000 rpm": {"speed": "6000 rpm"}},
    )


FOLDERS: dict[str, Callable[[Path], Folder]] = {
    "without_time": without_time,
    "headerless": headerless,
    "comments": comments,
    "minutes": minutes,
    "sheets": sheets,
}
