"""Probes whose log has no date, beside a logger that has one: when a test begins."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from thermodata.store import Store
from thermodata.store.ingest.run import ingest

DAQ = 'daq: {reader: table, files: "raw/{test}.csv", timezone: America/Chicago}'
HALL = 'hall: {reader: table, files: "raw/hall.csv"}'
CAMPAIGN = """\
schema: thermodata/campaign/1
id: shop
machine: {id: x}
sources:
  %s
  %s
channels:
  dZ: {source: daq, signal: dZ, quantity: displacement, unit: um, axis: Z, at: tcp}
  T_hall: {source: hall, signal: T, quantity: temperature, unit: degC, at: hall}
tests:
  - {id: one, kind: etve, role: calibration%s}
"""
BEGAN = np.datetime64("2026-06-01T13:00:00")  # 08:00 in Chicago


def ingested(
    folder: Path,
    start: str,
    hall_from_s: float,
    hours: float = 2.2,
    sources: tuple[str, str] = (DAQ, HALL),
    counts_from_s: int = 0,
) -> tuple[float, np.ndarray, list[str]]:
    """(start of the test [s after BEGAN], the hall's air at t_s = 0, what was lost) of 2 h of probes. The hall is
    warmer by 1 K an hour, from 20 degC when they began."""
    (folder / "raw").mkdir(parents=True)
    (folder / "campaign.yaml").write_text(CAMPAIGN % (*sources, f", start: {start}" if start else ""))
    t = np.arange(0, 7200, 10)
    (folder / "raw" / "one.csv").write_text(
        "\n".join(["t [s],dZ [um]", *(f"{x + counts_from_s},{x % 70 / 70}" for x in t), ""])
    )
    air = np.arange(hall_from_s, hall_from_s + 3600 * hours, 60)
    rows = [f"{BEGAN + np.timedelta64(round(x), 's')}Z,{20 + x / 3600:.3f}" for x in air]
    (folder / "raw" / "hall.csv").write_text("\n".join(["time,T", *rows, ""]))
    store = Store(folder / "store", create=True)
    losses = [loss["reason"] for loss in ingest(store, folder / "campaign.yaml").losses]
    with store.reader() as con:
        (start_ns,) = con.execute("select start_ns from test").fetchone() or (0,)
        grid = con.execute("select * from binned('shop', 'one', '60 s') where t_s >= 0 order by t_s").fetchnumpy()
    at_zero = np.ma.compressed(grid.get("T_hall", np.ma.array([])))[:1]
    return (start_ns - int(BEGAN.astype("datetime64[ns]").astype(int))) / 1e9, at_zero, losses


@pytest.mark.parametrize("hall_from_s", [-15.0, -300.0, 240.0, -86400.0])
@pytest.mark.parametrize("sources", [(DAQ, HALL), (HALL, DAQ)])
def test_a_declared_start_is_when_they_began(tmp_path: Path, hall_from_s: float, sources: tuple[str, str]) -> None:
    """Whatever else begins earlier or later, in the time zone of the probes, whichever source stands first."""
    hours = 30.0 if hall_from_s < -3600 else 2.2
    began, air, losses = ingested(tmp_path, "2026-06-01 08:00:00", hall_from_s, hours, sources)
    assert (began, losses) == (0.0, [])
    assert air[0] == pytest.approx(20 + max(hall_from_s, 0) / 3600, abs=0.02)


def test_a_start_at_which_nothing_else_was_recorded_is_said(tmp_path: Path) -> None:
    began, _, losses = ingested(tmp_path, "2026-06-02 08:00:00", -15.0)
    assert began == 86400.0
    assert any("nothing was recorded that has dates: hall is" in loss and "earlier" in loss for loss in losses), losses


@pytest.mark.parametrize(
    ("longer_s", "sure"),
    [(-170.0, False), (-110.0, True), (10.0, True), (70.0, True), (130.0, False), (79210.0, False)],
)
def test_without_a_start_they_begin_with_a_log_of_their_length_and_no_other_tells(
    tmp_path: Path, longer_s: float, sure: bool
) -> None:
    """Two minutes longer or shorter at most: else the two did not begin together, or did not end together."""
    lasts_s = 7190.0  # a row every 10 s; the hall's stands every minute, and its last is a minute before its end
    began, _, losses = ingested(tmp_path, "", -15.0, (lasts_s + longer_s + 60) / 3600)
    assert began == -15.0
    assert bool(losses) is not sure, losses
    assert all("nothing says when 'daq' began" in loss for loss in losses)


def test_that_they_began_together_can_be_said(tmp_path: Path) -> None:
    together = DAQ.replace("Chicago}", "Chicago, clock: {offset: 0 s}}")
    began, _, losses = ingested(tmp_path, "", -15.0, 2.5, (together, HALL))
    assert (began, losses) == (-15.0, [])


@pytest.mark.parametrize("counts_from_s", [600, 7200, 4_294_000])
def test_probes_that_count_from_elsewhere_are_not_taken_to_begin_so_much_later(
    tmp_path: Path, counts_from_s: int
) -> None:
    """As long as the hall's log, and placed behind its beginning, or wholly behind its end."""
    *_, losses = ingested(tmp_path, "", 0.0, 2.0, counts_from_s=counts_from_s)
    (loss,) = (x for x in losses if "nothing says when 'daq' began" in x)
    assert f"clock: {{offset: -{counts_from_s} s}}" in loss
    together = DAQ.replace("Chicago}", f"Chicago, clock: {{offset: -{counts_from_s} s}}}}")
    began, _, losses = ingested(tmp_path / "told", "", 0.0, 2.0, (together, HALL), counts_from_s)
    assert (began, losses) == (0.0, [])


def test_a_declared_offset_by_which_nothing_ran_beside_the_probes_is_said(tmp_path: Path) -> None:
    together = DAQ.replace("Chicago}", "Chicago, clock: {offset: 0 s}}")
    *_, losses = ingested(tmp_path, "", 0.0, 2.0, (together, HALL), 9000)
    (loss,) = (x for x in losses if "'daq' runs 31 min" in x and "later than all that has dates" in x)
    assert "clock: {offset: -9000 s} where they begin together" in loss


def test_a_first_row_behind_the_beginning_is_no_other_beginning(tmp_path: Path) -> None:
    """Of a log that ends with the others: its first mean is over the first ten minutes."""
    assert ingested(tmp_path, "", 0.0, 2.0 + 590 / 3600, counts_from_s=0)[2]
    began, _, losses = ingested(tmp_path / "short", "", 0.0, 2.0, counts_from_s=60)
    assert (began, losses) == (60.0, [])
