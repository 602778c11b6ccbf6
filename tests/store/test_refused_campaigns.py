"""Mistakes of a campaign file that show only beside its files or the installed plugins: told with their line."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from store_fakes import CAMPAIGN, times, write_campaign, write_log

from thermodata.errors import UsageError
from thermodata.store import Store
from thermodata.store.ingest.reading import campaign_files
from thermodata.store.ingest.run import checked, ingest
from thermodata.store.raw.streams import find_reader

DERIVED = '  dT: {derive: "T_a - T_b", quantity: temperature_difference}\n'
TWO = '  q: {derive: "r + T_a", quantity: temperature}\n  r: {derive: "q - 1 K", quantity: temperature}\n'
ITSELF = '  q: {derive: "q + T_a", quantity: temperature}\n'
JUMP = """  jump: {kind: jump, axis: Z, source: daq, file: raw/jump.npz, signal: Z, moves: [100 um, -100 um],
         dwell: 100 s, facing: -Z, increases_with: gap}
"""


def refused(store: Store, path: Path) -> UsageError:
    with pytest.raises(UsageError) as error:
        ingest(store, path)
    assert store.generation == 0
    return error.value


def with_channels(folder: Path, lines: str) -> Path:
    return write_campaign(folder, CAMPAIGN.replace("calibrations:\n", lines + "calibrations:\n"))


@pytest.mark.parametrize(
    ("lines", "what", "where", "hint"),
    [
        (DERIVED.replace("T_b", "T_bb"), "no channel 'T_bb'", "campaign.yaml:14 (channels.dT.derive)", "'T_b'"),
        (DERIVED.replace("T_b", ") T_b"), "a channel, a number or '('", "campaign.yaml:14 (channels.dT.derive)", ""),
        (TWO, "circle", "campaign.yaml:14 (channels.q.derive)", "derive 'r'"),
        (ITSELF, "q -> q", "campaign.yaml:14 (channels.q.derive)", "'q'"),
    ],
)
def test_a_derived_channel_that_no_test_could_have(
    store: Store, tmp_path: Path, lines: str, what: str, where: str, hint: str
) -> None:
    error = refused(store, with_channels(tmp_path / "lab", lines))
    assert what in str(error)
    assert (error.where or "").startswith(where)
    assert hint in (error.hint or "")


def test_a_derivation_of_one_test_alone(store: Store, tmp_path: Path) -> None:
    text = CAMPAIGN.replace("calibrations:\n", DERIVED + "calibrations:\n")
    text = text.replace("{id: two,", "{id: two, channels: {dT: {derive: T_a - T_x}},")
    error = refused(store, write_campaign(tmp_path / "lab", text))
    assert error.where == "campaign.yaml:19 (tests[1].channels.dT.derive)"


def test_an_operand_that_is_absent_in_a_test_takes_what_derives_from_it_along(store: Store, tmp_path: Path) -> None:
    text = CAMPAIGN.replace("calibrations:\n", DERIVED + "calibrations:\n")
    text = text.replace("{id: two,", "{id: two, channels: {T_b: {absent: true}},")
    assert ingest(store, write_campaign(tmp_path / "lab", text)).losses == []
    with store.reader() as con:
        found = con.execute("select distinct test from sample where channel = 'dT' and value is not null").fetchall()
    assert found == [("one",)]


def test_a_reader_that_is_not_installed(store: Store, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(campaign_files, "find_reader", find_reader)
    error = refused(
        store,
        write_campaign(
            tmp_path / "lab", CAMPAIGN.replace('reader: npz, files: "raw/{test}_', 'reader: mcapp, files: "raw/{test}_')
        ),
    )
    assert error.where == "campaign.yaml:6 (sources.daq.reader)"
    assert "mcap" in (error.hint or "")


def test_a_jump_test_that_contradicts_its_declaration(store: Store, tmp_path: Path) -> None:
    path = write_campaign(tmp_path / "lab", CAMPAIGN.replace("calibrations:\n", "calibrations:\n" + JUMP))
    volts = 5 + 0.1 * np.repeat([0.0, 1.0, 0.0], 200) + np.random.default_rng(0).normal(0, 1e-4, 600)
    write_log(path.parent / "raw/jump.npz", {"main": {"t_ns": times(600), "Z": volts}})
    error = refused(store, path)
    assert "contradicts the way the probe looks" in error.what
    assert error.where == "campaign.yaml:15 (calibrations.jump)"


def test_a_derivation_that_gives_no_number_is_told(store: Store, tmp_path: Path) -> None:
    lines = '  nil: {derive: "T_a / 0", quantity: temperature}\n' + DERIVED
    (loss,) = ingest(store, with_channels(tmp_path / "lab", lines)).losses
    assert "channel 'nil': its derivation 'T_a / 0' gives no number in any test" in loss["reason"]
    assert loss["where"] == "line 14"


def measuring(folder: Path, text: str) -> Path:
    """The campaign with a `measuring` in its first test."""
    return write_campaign(folder, CAMPAIGN.replace("{id: one,", f"{{id: one, measuring: {text},"))


@pytest.mark.parametrize(
    ("text", "what", "where", "hint"),
    [
        ('"speedd == 0"', "no channel 'speedd'", ".measuring)", "'speed'"),
        ('"speed = 0"', "unexpected '='", ".measuring), expression", "write '=='"),
        ('"max(speed) < 1"', "no function 'max'", ".measuring), expression", ""),
        ('"speed > 3 um"', "units that don't fit", ".measuring), expression", ""),
        ('{when: "speed == 0 and T_aa > 1"}', "no channel 'T_aa'", ".measuring.when)", "'T_a'"),
        ("{in_range: T_aa}", "no channel 'T_aa'", ".measuring.in_range)", "'T_a'"),
        ("{in_range: {T_aa: [1 degC, 2 degC]}}", "no channel 'T_aa'", ".measuring.in_range.T_aa)", "'T_a'"),
    ],
)
def test_a_measuring_that_no_test_could_have(
    store: Store, tmp_path: Path, text: str, what: str, where: str, hint: str
) -> None:
    error = refused(store, measuring(tmp_path / "lab", text))
    assert what in error.what
    line = next(i for i, x in enumerate(CAMPAIGN.splitlines(), 1) if "id: one" in x)
    assert (error.where or "").startswith(f"campaign.yaml:{line} (tests[0]{where}")
    assert error.expected
    assert hint in (error.hint or "")


@pytest.mark.parametrize("text", ["in_range", "speed == 0", '"not (speed > 10 rpm) or abs(T_a) >= 3"'])
def test_a_measuring_of_channels_that_are_there_is_taken(store: Store, tmp_path: Path, text: str) -> None:
    assert not any("measuring" in loss["reason"] for loss in ingest(store, measuring(tmp_path / "lab", text)).losses)


def test_a_measuring_that_tests_from_sets_is_told_at_its_line(tmp_path: Path) -> None:
    (tmp_path / "a.csv").touch()
    text = """schema: thermodata/campaign/1
id: c
sources: {daq: {reader: table}}
channels: {speed: {source: daq, signal: n, quantity: rotational_speed}}
tests_from:
  files: "{nr}.csv"
  set: {kind: mixed, measuring: "NAME == 0"}
"""
    path = tmp_path / "campaign.yaml"
    path.write_text(text.replace("NAME", "speedd"))
    with pytest.raises(UsageError) as caught:
        checked(path)
    assert (caught.value.where or "").startswith("campaign.yaml:7 (tests_from.set.measuring)")
    assert caught.value.hint == "did you mean 'speed'?"
    path.write_text(text.replace("NAME", "speed"))
    assert checked(path).tests[0].measuring == "speed == 0"
