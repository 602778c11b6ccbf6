"""A changed file is a new version beside the old; renamed, vanished and unreadable files lose nothing."""

from __future__ import annotations

import hashlib
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from store_fakes import NpzReader, daq, write_log

from thermodata.errors import FormatError, UsageError
from thermodata.store import Store
from thermodata.store.ingest.run import ingest
from thermodata.store.keep.forget import forget
from thermodata.store.keep.gc import gc
from thermodata.store.trace.lineage import trace


def sha(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


def values(store: Store, test: str = "one") -> Any:
    with store.reader() as con:
        return con.execute("select value from signal('shop', ?, 'T_a') order by t_s", [test]).fetchnumpy()["value"]


def pin(campaign: Path, path: str, version: str) -> None:
    text = campaign.read_text()
    campaign.write_text(text.replace("\ntests:", f'\nversions: {{{path}: "{version}"}}\ntests:', 1))


@pytest.fixture
def changed(filled: Store, campaign: Path) -> tuple[Store, Path, str, str]:
    """The store after a file changed: store, the file, the hash before, the hash now."""
    log = campaign.parent / "raw/one_a.npz"
    old = sha(log)
    write_log(log, daq(700, seed=9))
    ingest(filled, campaign)
    return filled, log, old, sha(log)


def test_a_changed_file_is_a_version_beside_the_old(changed: tuple[Store, Path, str, str]) -> None:
    store, _, old, new = changed
    np.testing.assert_array_equal(values(store), daq(700, seed=9)["main"]["T1"])
    (file,) = (f for f in trace(store, "shop", "one", "T_a")["files"])
    assert file["sha256"] == new
    assert [v["sha256"] for v in file["earlier"]] == [old]
    assert file["earlier"][0]["superseded_at"] > file["earlier"][0]["added_at"][:10]
    gc(store, grace_s=0)
    assert (store.path / file["earlier"][0]["raw"]).exists()


def test_the_campaign_file_goes_back_to_a_version(changed: tuple[Store, Path, str, str], campaign: Path) -> None:
    store, _, old, new = changed
    gc(store, grace_s=0)
    NpzReader.reads = 0
    pin(campaign, "raw/one_a.npz", old[:10])
    summary = ingest(store, campaign)
    assert (summary.losses, NpzReader.reads) == ([], 0)
    assert any(old[:12] in note for note in summary.notes)
    np.testing.assert_array_equal(values(store), daq(seed=0)["main"]["T1"])
    assert [v["sha256"] for v in trace(store, "shop", "one", "T_a")["files"][0]["earlier"]] == [new]
    assert ingest(store, campaign).changed is False


def test_a_version_that_is_not_there_is_refused_with_those_that_are(
    changed: tuple[Store, Path, str, str], campaign: Path
) -> None:
    store, _, old, _ = changed
    pin(campaign, "raw/one_a.npz", "0123456789")
    with pytest.raises(UsageError, match=old[:12]):
        ingest(store, campaign)


def test_going_back_on_disk_needs_no_reading(changed: tuple[Store, Path, str, str], campaign: Path) -> None:
    store, log, _, new = changed
    write_log(log, daq(seed=0))
    NpzReader.reads = 0
    ingest(store, campaign)
    assert NpzReader.reads == 0
    assert [v["sha256"] for v in trace(store, "shop", "one", "T_a")["files"][0]["earlier"]] == [new]


def test_earlier_versions_can_be_forgotten_alone(changed: tuple[Store, Path, str, str]) -> None:
    store, _, _, _ = changed
    kept = trace(store, "shop", "one", "T_a")["files"][0]
    assert forget(store, "shop", earlier=True)["versions"] == 1
    assert trace(store, "shop", "one", "T_a")["files"][0]["earlier"] == []
    # two files go: the earlier raw file, and what had been made of it
    assert gc(store, grace_s=0)["removed"] == 2
    assert not (store.path / kept["earlier"][0]["raw"]).exists()
    assert len(values(store)) == 700


def test_the_moment_of_storing_stays(filled: Store, campaign: Path) -> None:
    before = trace(filled, "shop", "one", "T_a")["files"][0]["added_at"]
    campaign.write_text(campaign.read_text().replace("gain: 10 um/V", "gain: 20 um/V"))
    assert ingest(filled, campaign).changed
    assert trace(filled, "shop", "one", "T_a")["files"][0]["added_at"] == before


def test_a_renamed_file_is_not_read_twice_nor_joined_to_itself(filled: Store, campaign: Path) -> None:
    (campaign.parent / "raw/one_a.npz").rename(campaign.parent / "raw/one_b.npz")
    NpzReader.reads = 0
    summary = ingest(filled, campaign)
    assert (NpzReader.reads, summary.losses, len(values(filled))) == (0, [], 1200)
    assert any("raw/one_b.npz" in note and "same content" in note for note in summary.notes)
    assert [f["source_path"] for f in trace(filled, "shop", "one", "T_a")["files"]] == ["raw/one_b.npz"]


def test_a_copy_beside_the_file_counts_once(store: Store, campaign: Path) -> None:
    shutil.copy(campaign.parent / "raw/one_a.npz", campaign.parent / "raw/one_a (1).npz")
    summary = ingest(store, campaign)
    assert (summary.losses, len(values(store))) == ([], 1200)
    # 'one_a (1)' comes first by its name, and is the copy
    assert "raw/one_a (1).npz: left out, its content is that of raw/one_a.npz" in summary.notes


def test_a_file_that_cannot_be_read_any_more_keeps_what_was_read(
    filled: Store, campaign: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from thermodata.store.ingest.reading import campaign_files

    right = campaign_files.settled

    def denied(path: Path) -> Any:
        if path.name == "one_a.npz":
            raise PermissionError(13, "Permission denied", str(path))
        return right(path)

    monkeypatch.setattr(campaign_files, "settled", denied)
    summary = ingest(filled, campaign)
    assert [(x["file"], "denied" in x["reason"]) for x in summary.losses] == [("raw/one_a.npz", True)]
    assert (summary.changed, len(values(filled))) == (False, 1200)


def test_a_file_that_was_spoilt_keeps_what_was_read(filled: Store, campaign: Path) -> None:
    (campaign.parent / "raw/one_a.npz").write_bytes(b"PK spoilt")
    summary = ingest(filled, campaign)
    assert [x["file"] for x in summary.losses] == ["raw/one_a.npz"]
    assert any("read before" in note for note in summary.notes)
    np.testing.assert_array_equal(values(filled), daq(seed=0)["main"]["T1"])


def test_a_reader_that_refuses_the_same_bytes_now_is_believed(
    filled: Store, campaign: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(self: Any, path: Path, source: Any) -> Any:
        raise FormatError("an unknown scale", where=path.name)

    monkeypatch.setattr(NpzReader, "version", "2")
    monkeypatch.setattr(NpzReader, "describe", refuse)
    assert len(ingest(filled, campaign).losses) >= 4
    assert len(values(filled)) == 0


def test_a_vanished_file_that_would_be_read_otherwise_now_is_a_loss(filled: Store, campaign: Path) -> None:
    (campaign.parent / "raw/one_a.npz").unlink()
    text = campaign.read_text()
    campaign.write_text(text.replace('_*.npz"}', '_*.npz", timezone: Europe/Prague}'))
    reasons = [x["reason"] for x in ingest(filled, campaign).losses if x["file"] == "raw/one_a.npz"]
    assert len(reasons) == 1
    assert "other settings" in reasons[0]
    assert len(values(filled)) == 1200


def test_a_newer_reader_is_told_and_the_logs_are_not_blamed(
    filled: Store, campaign: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(NpzReader, "version", "2")
    summary = ingest(filled, campaign)
    assert summary.read == 3  # one of them is that of both tests
    (said,) = [note for note in summary.notes if "reader npz 1" in note]
    assert "reader npz 1 -> 2: 3 logs were read anew by it, and are unchanged" in said
    assert not any("reader npz" in note for note in ingest(filled, campaign).notes)


def test_an_older_reader_is_refused_before_anything_is_written(
    store: Store, campaign: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(NpzReader, "version", "0.3.10")
    ingest(store, campaign)
    files = sorted(store.path.rglob("*.parquet"))
    monkeypatch.setattr(NpzReader, "version", "0.3.9")
    with pytest.raises(UsageError) as refused:
        ingest(store, campaign)
    told = str(refused.value)
    assert "npz 0.3.10 or newer" in told
    assert "npz 0.3.9" in told
    assert "campaign.yaml:6" in told
    assert sorted(store.path.rglob("*.parquet")) == files
    monkeypatch.setattr(NpzReader, "version", "built here")  # nobody knows which came first
    assert ingest(store, campaign).changed
