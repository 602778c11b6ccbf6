"""A Pt100 in ohm from its log to the store."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
from store_fakes import daq, write_log

from thermodata.store import Store
from thermodata.store.ingest.run import ingest


def test_a_pt100_in_ohm_is_stored_in_degrees(store: Store, campaign: Path) -> None:
    log = daq()
    t = log["main"]["T1"]
    log["main"]["R1"] = 100 * (1 + 3.9083e-3 * t - 5.775e-7 * t**2)
    for test in ("one", "two"):
        write_log(campaign.parent / f"raw/{test}_a.npz", log)
    in_ohm = "signal: R1, quantity: temperature, unit: ohm, calibration: pt,"
    text = campaign.read_text().replace("signal: T1, quantity: temperature,", in_ohm)
    campaign.write_text(text.replace("calibrations:\n", "calibrations:\n  pt: {kind: pt100}\n"))
    assert ingest(store, campaign).losses == []
    with store.reader() as con:
        found = con.execute("select value, flag from signal('shop', 'one', 'T_a') order by t_s").fetchnumpy()
        row = con.execute("select kind, gain_unit, detail from calibration where calibration = 'pt'").fetchall()[0]
    np.testing.assert_allclose(found["value"], t, atol=1e-6)
    assert (*row[:2], json.loads(row[2])["r0_ohm"]) == ("pt100", "degC/ohm", 100.0)
