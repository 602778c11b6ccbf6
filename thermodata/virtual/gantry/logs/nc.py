"""What the control exports: semicolons, decimal comma, cp1250, local time, a row of names and a row of units."""

from __future__ import annotations

from collections.abc import Mapping
from datetime import UTC, datetime, timedelta
from pathlib import Path
from zoneinfo import ZoneInfo

from thermodata.plugin import Float1D
from thermodata.virtual.gantry.logs.logbook import Logbook
from thermodata.virtual.gantry.plan import STEP_S
from thermodata.virtual.gantry.world import Run, World

ZONE = "Europe/Prague"
_UNITS = {"rpm": "1/min", "degC": "°C", "1": "-"}
_DECIMALS = {"temperature": 1, "rotational_speed": 1, "power": 2, "feed": 3, "position": 3, "state": 0}


def write_nc(path: Path, world: World, run: Run, book: Logbook) -> None:
    """One test; a row every 10 s, by the control's clock, which is off by some seconds."""
    columns = {}
    for s in (s for s in world.sensors if s.source == "nc"):
        decimals = 0 if s.resolution >= 1 else _DECIMALS[s.quantity]
        columns[book.names[s.name]] = (run.readings[s.name], s.unit, decimals)
    write_export(path, columns, round(run.start_unix_s) - book.nc_offset_s, STEP_S)


def write_export(path: Path, columns: Mapping[str, tuple[Float1D, str, int]], start_s: float, step_s: float) -> None:
    """columns: name -> (values, shape (n,), unit, decimals), a row a step_s from start_s [UTC s]."""
    zone = ZoneInfo(ZONE)
    start = datetime.fromtimestamp(start_s, UTC)
    texts = [[f"%.{decimals}f" % x for x in values.tolist()] for values, _, decimals in columns.values()]
    times = [(start + timedelta(seconds=step_s * k)).astimezone(zone) for k in range(len(texts[0]))]
    lines = [
        "Datum a čas;" + ";".join(columns),
        ";" + ";".join(_UNITS.get(unit, unit) for _, unit, _ in columns.values()),
    ]
    lines += [
        f"{t:%d.%m.%Y %H:%M:%S};" + ";".join(row).replace(".", ",")
        for t, row in zip(times, zip(*texts, strict=True), strict=True)
    ]
    path.write_bytes("\r\n".join([*lines, ""]).encode("cp1250"))
