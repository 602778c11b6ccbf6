"""Which probes a jump test should leave at rest."""

from __future__ import annotations

from thermodata.schema.files.campaign import JumpCalibration
from thermodata.schema.files.load import parse_campaign
from thermodata.store.tidy.values.calibrations import probes_across

CAMPAIGN = """\
schema: thermodata/campaign/1
id: lab
machine: {id: m1}
sources:
  daq: {reader: crio, files: "{test}.tdms"}
  other: {reader: table, files: "{test}.csv"}
channels:
  dZ: {source: daq, signal: Z, quantity: displacement, axis: Z, at: tcp, calibration: jump}
  dZ_top: {source: daq, signal: Z top, quantity: displacement, axis: Z, at: tcp}
  dX: {source: daq, signal: X, quantity: displacement, axis: X, at: tcp}
  dQ: {source: daq, signal: Q, quantity: displacement, unit: V, at: tcp}
  dY: {source: other, signal: Y, quantity: displacement, unit: um, axis: "Y", at: tcp}
calibrations:
  jump: {kind: jump, axis: Z, source: daq, file: jump.tdms, signal: Z, moves: [100 um, -100 um], dwell: 10 s}
tests:
  - {id: day, kind: spindle, role: calibration}
"""


def test_a_second_probe_along_the_axis_that_moves_has_to_answer() -> None:
    campaign = parse_campaign(CAMPAIGN)
    spec = campaign.calibrations["jump"]
    assert isinstance(spec, JumpCalibration)
    assert [c.signal for c in probes_across(campaign, spec)] == ["Z", "X", "Q"]
