"""A logger's codes for "no value" in the unit that it logs in, which the store converts."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from thermodata.plugin import Float1D
from thermodata.store import Store
from thermodata.store.ingest.run import ingest

pytestmark = pytest.mark.usefixtures("installed_readers")
N = 3000
CAMPAIGN = """\
schema: thermodata/campaign/1
id: shop
machine: {id: x}
sources: {{log: {{reader: table, files: "{{test}}.csv"}}}}
channels:
  c: {{source: log, signal: "x [{unit}]", {channel}}}
calibrations:
  gauge: {{kind: scale, axis: Z, gain: 250 um/V, facing: -Z, increases_with: gap}}
tests:
  - {{id: t, kind: other, role: calibration}}
""".replace("machine: {id: x}", "machine: {{id: x}}")


def flagged(folder: Path, unit: str, channel: str, x: Float1D, digits: int) -> list[int]:
    """The rows of a log whose channel is out of range."""
    folder.mkdir(exist_ok=True)
    rows = "".join(f"{i},{v:.{digits}f}\n" for i, v in enumerate(x))
    (folder / "t.csv").write_text(f"t [s],x [{unit}]\n{rows}")
    (folder / "campaign.yaml").write_text(CAMPAIGN.format(unit=unit, channel=channel))
    store = Store(folder / "store", create=True)
    summary = ingest(store, folder / "campaign.yaml")
    assert not summary.losses, summary.losses
    with store.reader() as con:
        found = con.execute("select t_s from sample where flag & 16 > 0 order by t_s").fetchall()
    return [round(t) for (t,) in found]


def noise(middle: float, spread: float) -> Float1D:
    return middle + spread * np.random.default_rng(3).standard_normal(N)


PROBE = "quantity: displacement, axis: Z, at: tcp"
CODES = {
    "mm": ("mm", PROBE, noise(0.4, 0.01), -9999.0, 4),
    "mm, with one decimal": ("mm", PROBE, noise(0.4, 0.01), -999.9, 4),
    "inch": ("in", PROBE, noise(0.01, 0.001), 9999.0, 5),
    "volts": ("V", f"{PROBE}, calibration: gauge", noise(4, 0.01), -9999.0, 4),
    "watts": ("W", "quantity: power, at: spindle", np.abs(noise(900, 300)), 65535.0, 0),
    "milliampere": ("mA", "quantity: current, at: spindle", np.abs(noise(900, 300)), -9999.0, 1),
    "per second": ("1/s", "quantity: rotational_speed, at: spindle", np.abs(noise(90, 20)), 32767.0, 0),
    "counts": ("1", "quantity: displacement, axis: Z, at: tcp, unit: 0.1 um, scaled: false", noise(4000, 9), -32768, 0),
}


@pytest.mark.parametrize("name", CODES)
def test_a_code_is_known_in_the_unit_of_the_log(tmp_path: Path, name: str) -> None:
    unit, channel, x, code, digits = CODES[name]
    x = x.copy()
    x[1000:1003] = x[2000] = code
    assert flagged(tmp_path / "lab", unit, channel, x, digits) == [1000, 1001, 1002, 2000]


ON = (np.arange(N) // 500) % 2
WATTS = (ON * noise(65535, 3) + (1 - ON) * np.abs(noise(0, 900))).round()
DATA = {
    "a machine of so many watts": (
        "W",
        "quantity: power, at: spindle",
        (ON * noise(65535, 3) + (1 - ON) * np.abs(noise(0, 900))).round(),
    ),
    "a ramp to it": ("W", "quantity: power, at: spindle", np.minimum(np.linspace(0, 90000, N), 65535.0)),
    "a speed": ("rpm", "quantity: rotational_speed, at: spindle", np.linspace(0, 65535, N).round()),
    "a probe that is far": ("mm", PROBE, np.linspace(-1200, 300, N).round(1)),
}


@pytest.mark.parametrize("name", DATA)
def test_what_only_reads_so_is_data(tmp_path: Path, name: str) -> None:
    unit, channel, x = DATA[name]
    assert flagged(tmp_path / "lab", unit, channel, x, 1) == []
