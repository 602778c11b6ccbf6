"""Logs that came after the campaign file was written are told, with the line that makes a test of them
(store/ingest/told/declared/not_listed.py)."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from store_fakes import write_campaign

from thermodata.schema.files.load import load_campaign
from thermodata.store import Store
from thermodata.store.ingest.run import ingest
from thermodata.store.ingest.told.declared.not_listed import not_listed
from thermodata.store.keep.forget import forget


def _new(store: Store, path: Path) -> list[str]:
    return [n for n in ingest(store, path).notes if "in no test" in n]


def test_new_logs_are_told_until_a_test_has_them(store: Store, tmp_path: Path) -> None:
    path = write_campaign(tmp_path / "lab")
    raw = path.parent / "raw"
    assert _new(store, path) == []
    shutil.copy(raw / "one_a.npz", raw / "three_a.npz")
    shutil.copy(raw / "one.nc.npz", raw / "three.nc.npz")
    for _ in range(2):
        (said,) = _new(store, path)
        assert "raw/three_a.npz" in said
        assert "raw/three.nc.npz" in said
        assert "- {id: three, role: none}" in said
    before = path.read_text(encoding="utf-8")
    path.write_text(before + "# - {id: three, role: none}\n", encoding="utf-8")
    assert _new(store, path) == [], "left out on purpose"
    path.write_text(before, encoding="utf-8")
    (raw / "three_a.npz").unlink()
    (raw / "three.nc.npz").unlink()
    assert _new(store, path) == []


def test_what_was_taken_out_on_purpose_is_not_told_and_what_came_since_is(store: Store, tmp_path: Path) -> None:
    path = write_campaign(tmp_path / "lab")
    raw = path.parent / "raw"
    assert _new(store, path) == []
    before = path.read_text(encoding="utf-8")
    path.write_text("\n".join(line for line in before.splitlines() if "id: two" not in line), encoding="utf-8")
    for _ in range(2):
        assert _new(store, path) == []
    path.write_text(path.read_text(encoding="utf-8") + "\nnotes: 'two fell off'\n", encoding="utf-8")
    assert _new(store, path) == [], "another commit"
    shutil.copy(raw / "two_a.npz", raw / "two_b.npz")
    (said,) = _new(store, path)
    assert "raw/two_b.npz" in said
    assert "raw/two_a.npz" not in said
    (raw / "two_b.npz").unlink()
    path.write_text(before, encoding="utf-8")
    for _ in range(2):
        assert _new(store, path) == []
    forget(store, "shop")
    path.write_text("\n".join(line for line in before.splitlines() if "id: two" not in line), encoding="utf-8")
    (said,) = _new(store, path)
    assert "raw/two_a.npz" in said, "no store knows that it was in one"


TEXT = """schema: thermodata/campaign/1
id: c
sources:
  daq: {reader: table, files: "{test}.csv"}
  nc: {reader: table, files: "{test}_NC.csv"}
channels: {T_1: {source: daq, signal: T, quantity: temperature, unit: "°C", at: bed}}
tests:
  - {id: a, role: calibration, conditions: {tool: D10, speed: 100 rpm}}
  - {id: b, role: calibration, conditions: {tool: D20}}
"""


@pytest.mark.parametrize(
    ("files", "lines"),
    [
        (["a.csv", "a_NC.csv", "campaign.yaml"], None),
        (["cc.csv", "cc_NC.csv"], "- {id: cc, role: none}"),
        (["cc_NC.csv"], "- {id: cc, role: none}"),
        (["12.csv"], '- {id: "12", role: none}'),
        (["B.csv"], None),
    ],
)
def test_a_file_is_of_the_test_that_the_pattern_which_says_most_names(
    tmp_path: Path, files: list[str], lines: str | None
) -> None:
    path = tmp_path / "campaign.yaml"
    path.write_text(TEXT, encoding="utf-8")
    for name in files:
        (tmp_path / name).touch()
    said = not_listed(tmp_path, path, load_campaign(path), {"a.csv", "a_NC.csv"})
    rest = ", with its role and the conditions that all others have (tool)"
    assert [s.rpartition("under tests: ")[2] for s in said] == ([] if lines is None else [lines + rest])


@pytest.mark.parametrize(
    ("comment", "told"),
    [
        ("# run1.csv: the probe fell off", False),
        ("# left out: run1.csv, run2.csv", False),
        ("# see run1.csv.", False),
        ("# xrun1.csv", True),
        ("# run1.csvx", True),
        ("# old/run1.csv", True),
        ("# xrun1.csv, and run1.csv too", False),
        ("# - {id: run1, role: none}", False),
        ("# - {id: 'run1'}", False),
        ("# - {id: run10, role: none}", True),
        ("# - {id: xrun1, role: none}", True),
    ],
)
def test_a_comment_leaves_out_what_it_names_as_a_word_of_its_own(tmp_path: Path, comment: str, told: bool) -> None:
    path = tmp_path / "campaign.yaml"
    path.write_text(TEXT + comment + "\n", encoding="utf-8")
    (tmp_path / "run1.csv").touch()
    assert bool(not_listed(tmp_path, path, load_campaign(path), {})) is told
