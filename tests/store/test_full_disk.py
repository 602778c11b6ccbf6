"""A full disk is an error that says what to do, wherever it strikes, and the store stays as it was."""

from __future__ import annotations

import errno
import os
import resource
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pyarrow.parquet as pq
import pytest
from store_fakes import daq, write_log

from thermodata.errors import StoreError
from thermodata.store import Store
from thermodata.store.ingest.run import ingest
from thermodata.store.keep.snapshot import snapshot

sys.path.insert(0, str(Path(__file__).parents[1] / "hardening"))
import whole

HARDENING = Path(__file__).parents[1] / "hardening"


class Full:
    """Replaces a function by one that finds the disk full at its n-th call."""

    def __init__(self, right: Callable[..., Any], at: int) -> None:
        self.right, self.at, self.calls = right, at, 0

    def __call__(self, *args: Any, **more: Any) -> Any:
        self.calls += 1
        if self.calls == self.at:
            raise OSError(errno.ENOSPC, "No space left on device")
        return self.right(*args, **more)


POINTS = {
    "fsync": (os, "fsync"),
    "rename": (os, "replace"),
    "row group": (pq.ParquetWriter, "write_table"),
    "footer": (pq.ParquetWriter, "close"),
    "new file": (pq, "ParquetWriter"),
}


@pytest.mark.parametrize("point", POINTS)
def test_a_full_disk_at_every_point_of_an_ingest_leaves_the_store_as_it_was(
    store: Store, campaign: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, point: str
) -> None:
    owner, name = POINTS[point]
    right = getattr(owner, name)

    def method(full: Full) -> Any:
        return full if owner is os or name == "ParquetWriter" else lambda self, *a, **k: full(self, *a, **k)

    counting = Full(right, 0)
    monkeypatch.setattr(owner, name, method(counting))
    shutil.copytree(store.path, tmp_path / "count")
    ingest(Store(tmp_path / "count"), campaign)
    assert counting.calls > 4
    right_content = whole.content(tmp_path / "count")
    for at in {1, counting.calls // 2, counting.calls - 1, counting.calls}:
        place = tmp_path / f"{point}{at}"
        shutil.copytree(store.path, place)
        monkeypatch.setattr(owner, name, method(Full(right, at)))
        with pytest.raises(StoreError, match="disk is full") as error:
            ingest(Store(place), campaign)
        assert (error.value.exit_code, "free space" in str(error.value)) == (4, True)
        assert "MB" in str(error.value)
        monkeypatch.setattr(owner, name, right)
        assert whole.check(place)["sample"] == 0
        assert whole.left_over(place) == []
        ingest(Store(place), campaign)
        assert whole.content(place) == right_content


def limited(op: str, store: Path, argument: object, most_bytes: int) -> subprocess.CompletedProcess[str]:
    """An operation in a process that may write no file longer than that, by whatever library."""
    return subprocess.run(
        [
            sys.executable,
            str(HARDENING / "victim.py"),
            op,
            str(store),
            str(argument),
            "--fakes",
            str(Path(__file__).parent),
        ],
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
        env={**os.environ, "PYTHONDONTWRITEBYTECODE": "1"},  # Python would cut that of an import, and keep it
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (most_bytes, most_bytes)),
    )


def test_a_catalogue_that_cannot_grow_is_said(store: Store, campaign: Path) -> None:
    size = (store.path / "catalog.duckdb").stat().st_size
    # the catalogue's log outgrows the limit before any of these small Parquet files does
    long = "{speed: 9000 rpm, note: " + "x" * size + "}"
    campaign.write_text(campaign.read_text().replace("{speed: 9000 rpm}", long))
    done = limited("ingest", store.path, campaign, size // 2)
    assert done.returncode != 0
    assert "NoRoomError" in done.stderr
    assert "longer than it may be" in done.stderr
    assert whole.check(store.path)["sample"] == 0
    assert ingest(Store(store.path), campaign).changed


def test_a_snapshot_on_a_full_disk_is_no_file(filled: Store, tmp_path: Path) -> None:
    out = tmp_path / "all.duckdb"
    done = limited("snapshot", filled.path, out, 100_000)
    assert "NoRoomError" in done.stderr
    assert "longer than it may be" in done.stderr
    assert not out.exists()
    assert not list(tmp_path.glob(".all*"))
    assert snapshot(filled, out) == out


def test_a_file_that_is_too_big_for_the_disk_says_how_much_it_needs(
    store: Store, campaign: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_log(campaign.parent / "raw/one_a.npz", daq(100_000))
    monkeypatch.setattr(pq, "ParquetWriter", Full(pq.ParquetWriter, 1))
    with pytest.raises(StoreError, match=r"about 5 MB for raw/one_a\.npz"):
        ingest(store, campaign)
