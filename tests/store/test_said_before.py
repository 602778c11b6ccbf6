"""What a campaign file says otherwise than before is told: a copy of an older one puts roles back without a word
(store/ingest/told/declared/said_before.py)."""

from __future__ import annotations

import shutil
from pathlib import Path

from store_fakes import write_campaign

from thermodata.store import Store
from thermodata.store.ingest.run import ingest

SAID = "the campaign file says otherwise than the one before: "


def _said(store: Store, path: Path) -> list[str]:
    return [n.removeprefix(SAID) for n in ingest(store, path).notes if n.startswith(SAID)]


def test_what_changed_is_named_with_what_it_was(store: Store, tmp_path: Path) -> None:
    path = write_campaign(tmp_path / "lab")
    assert _said(store, path) == []
    first = path.read_text(encoding="utf-8")
    assert "role: calibration" in first
    path.write_text(first.replace("role: calibration", "role: none", 1), encoding="utf-8")
    (said,) = _said(store, path)
    assert said == "tests one: role none, it was calibration"
    assert _said(store, path) == [], "of the same file again"


def test_a_copy_of_an_older_file_says_where_the_other_one_stood(store: Store, tmp_path: Path) -> None:
    path = write_campaign(tmp_path / "lab")
    ingest(store, path)
    shutil.copytree(path.parent, tmp_path / "older")
    path.write_text(path.read_text(encoding="utf-8").replace("role: calibration", "role: none", 1), encoding="utf-8")
    ingest(store, path)
    (said,) = _said(store, tmp_path / "older" / path.name)
    assert said == f"tests one: role calibration, it was none; that one stood at {path}"


def test_channels_that_come_and_go_are_named(store: Store, tmp_path: Path) -> None:
    path = write_campaign(tmp_path / "lab")
    ingest(store, path)
    before = path.read_text(encoding="utf-8")
    (line,) = [text for text in before.splitlines() if text.strip().startswith("T_b:")]
    path.write_text(before.replace(line + "\n", ""), encoding="utf-8")
    assert _said(store, path) == ["channels T_b is gone"]
    path.write_text(before, encoding="utf-8")
    assert _said(store, path) == ["channels T_b is new"]


def test_words_that_were_not_there_are_named_as_new(store: Store, tmp_path: Path) -> None:
    path = write_campaign(tmp_path / "lab")
    placed = path.read_text(encoding="utf-8")
    assert placed.count(", at: bed}") == 1
    path.write_text(placed.replace(", at: bed}", "}"), encoding="utf-8")
    ingest(store, path)
    path.write_text(placed.replace(", at: bed}", ", unit: degC, at: bed}"), encoding="utf-8")
    assert _said(store, path) == ["channels T_b: new: unit degC, at bed"]
