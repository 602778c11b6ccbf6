"""What the control exports: semicolons, decimal comma, cp1250, local time, a row of names and a row of units."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from pathlib import Path
from zoneinfo import ZoneInfo

from thermodata.virtual.logbook import Logbook
from thermodata.virtual.plan import STEP_S
from thermodata.virtual.world import Run, World

ZONE = "Europe/Prague"
_UNITS = {"rpm": "1/min", "degC": "°C", "1": "-"}
_DECIMALS = {"temperature": 1, "rotational_speed": 1, "power": 2, "feed": 3, "position": 3, "state": 0}


def write_nc(path: Path, world: World, run: Run, book: Logbook) -> None:
    """One test; a row every 10 s, by the control's clock, which is off by some seconds."""
    sensors = [s for s in world.sensors if s.source == "nc"]
    zone = ZoneInfo(ZONE)
    start = datetime.fromtimestamp(round(run.start_unix_s) - book.nc_offset_s, UTC)
    times = [(start + timedelta(seconds=STEP_S * k)).astimezone(zone) for k in range(run.op.n)]
    columns = []
    for s in sensors:
        form = f"%.{0 if s.resolution >= 1 else _DECIMALS[s.quantity]}f"
        columns.append([form % x for x in run.readings[s.name].tolist()])
    lines = [
        "Datum a čas;" + ";".join(book.names[s.name] for s in sensors),
        ";" + ";".join(_UNITS.get(s.unit, s.unit) for s in sensors),
    ]
    lines += [
        f"{t:%d.%m.%Y %H:%M:%S};" + ";".join(row).replace(".", ",")
        for t, row in zip(times, zip(*columns, strict=True), strict=True)
    ]
    path.write_bytes("\r\n".join([*lines, ""]).encode("cp1250"))
