"""A damaged or read-only store: what is said, and what `ingest` makes good again."""

from __future__ import annotations

import errno
import os
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from store_fakes import CAMPAIGN, NpzReader, daq, times, write_campaign, write_log

from thermodata.cli.app import run
from thermodata.errors import StoreError
from thermodata.store import Store
from thermodata.store.ingest.run import ingest
from thermodata.store.keep.check import check_store


def samples(store: Store) -> int:
    with store.reader() as con:
        return int(con.execute("select count(*) from sample").fetchall()[0][0])


def files(store: Store, layer: str, test: str = "one") -> list[Path]:
    with store.reader() as con:
        return [
            store.path / r[0]
            for r in con.execute(
                "select path from file where layer = ? and test = ? order by 1", [layer, test]
            ).fetchall()
        ]


def spoil(path: Path, harm: str) -> None:
    data = path.read_bytes()
    if harm == "gone":
        path.unlink()
    elif harm == "cut":
        path.write_bytes(data[: len(data) // 2])
    elif harm == "empty":
        path.write_bytes(b"")
    else:
        middle = len(data) // 3
        path.write_bytes(data[:middle] + bytes(b ^ 0x5A for b in data[middle : middle + 8]) + data[middle + 8 :])


@pytest.mark.parametrize("layer", ["raw", "tidy"])
@pytest.mark.parametrize("harm", ["gone", "cut", "empty"])
def test_what_can_be_made_again_is_made_by_ingest(filled: Store, campaign: Path, layer: str, harm: str) -> None:
    before = samples(filled)
    for path in files(filled, layer):
        spoil(path, harm)
    found = check_store(filled)
    assert {d.path for d in found.damaged} == {p.relative_to(filled.path).as_posix() for p in files(filled, layer)}
    NpzReader.reads = 0
    assert ingest(filled, campaign).losses == []
    assert NpzReader.reads == (2 if layer == "raw" else 0)
    assert check_store(filled).damaged == []
    assert samples(filled) == before


@pytest.mark.parametrize("layer", ["raw", "tidy"])
def test_an_altered_file_is_found_by_the_check_and_made_again(filled: Store, campaign: Path, layer: str) -> None:
    before = samples(filled)
    path = files(filled, layer)[0]
    whole = path.read_bytes()
    spoil(path, "altered")
    (damaged,) = check_store(filled).damaged
    assert damaged.path == path.relative_to(filled.path).as_posix()
    assert damaged.campaign == "shop"
    check_store(filled, repair=True)
    assert not path.exists()
    assert ingest(filled, campaign).losses == []
    assert path.read_bytes() == whole
    assert samples(filled) == before


# what is altered within a page shows where all pages are opened: in the check that repairs
@pytest.mark.parametrize(
    ("harm", "repair"), [("gone", False), ("gone", True), ("cut", False), ("cut", True), ("altered", True)]
)
def test_one_damaged_stream_of_several_is_read_again(store: Store, tmp_path: Path, harm: str, repair: bool) -> None:
    campaign = write_campaign(
        tmp_path / "lab",
        CAMPAIGN.replace(
            "  T_b:", "  T_c: {source: daq, signal: T3, unit: degC, quantity: temperature, at: hall.top}\n  T_b:"
        ),
    )
    for i, test in enumerate(("one", "two")):
        own = daq(seed=i)
        slow = {"t_ns": times(120, 10.0), "T3": 20 + np.arange(120) / 100}
        write_log(campaign.parent / f"raw/{test}_a.npz", {**own, "slow": slow})
    assert ingest(store, campaign).losses == []
    before = samples(store)
    (path,) = (p for p in files(store, "raw") if p.name.endswith("-main.parquet"))
    whole = path.read_bytes()
    spoil(path, harm)
    if repair:
        check_store(store, repair=True)
    NpzReader.reads = 0
    assert ingest(store, campaign).losses == []
    assert NpzReader.reads == 1
    assert path.read_bytes() == whole
    assert samples(store) == before
    assert check_store(store).damaged == []


@pytest.mark.parametrize("harm", ["gone", "cut"])
def test_a_query_over_a_damaged_file_says_which_and_what_to_do(
    filled: Store, harm: str, capsys: pytest.CaptureFixture[str]
) -> None:
    path = files(filled, "tidy")[0]
    spoil(path, harm)
    assert run(["--store", str(filled.path), "sql", "select sum(value) from sample"]) == 4
    said = capsys.readouterr().err
    assert path.name in said
    assert "ingest" in said


@pytest.mark.parametrize("harm", ["gone", "cut"])
def test_a_damaged_campaign_does_not_block_another(
    filled: Store, campaign: Path, tmp_path: Path, harm: str, capsys: pytest.CaptureFixture[str]
) -> None:
    other = write_campaign(tmp_path / "other", CAMPAIGN.replace("id: shop", "id: other").replace("10 um/V", "7 um/V"))
    for path in {*files(filled, "tidy"), *files(filled, "tidy", "two")}:
        spoil(path, harm)
    assert ingest(filled, other).losses == []
    with filled.reader() as con:
        assert con.execute("select count(*) from wide_other_daq").fetchall() == [(2400,)]
    assert run(["--store", str(filled.path), "sql", "select count(*) from sample"]) == 4
    said = capsys.readouterr().err
    assert "damaged" in said
    assert "campaign file of 'shop' again" in said
    assert ingest(filled, campaign).losses == []
    assert samples(filled) == 2 * 7460


def test_raw_and_source_both_gone_is_refused_with_what_to_do(filled: Store, campaign: Path) -> None:
    (campaign.parent / "raw/one_a.npz").unlink()
    for path in files(filled, "raw"):
        spoil(path, "cut")
    before = filled.generation
    with pytest.raises(StoreError, match="put the source file back"):
        ingest(filled, campaign)
    assert filled.generation == before


def test_a_lost_catalogue_says_how_to_begin_again(filled: Store, campaign: Path) -> None:
    (filled.path / "catalog.duckdb").write_bytes(b"\0" * 4096)
    with pytest.raises(StoreError, match="move the damaged one away"):
        ingest(Store(filled.path), campaign)
    (filled.path / "catalog.duckdb").rename(filled.path / "catalog.broken")
    again = Store(filled.path, create=True)
    assert ingest(again, campaign).losses == []
    assert samples(again) == 7460


def read_only(monkeypatch: pytest.MonkeyPatch, folder: Path) -> None:
    right = os.open

    def refuse(path: Any, flags: int, *more: Any, **named: Any) -> int:
        if str(path).startswith(str(folder)) and flags & (os.O_RDWR | os.O_WRONLY | os.O_CREAT):
            raise OSError(errno.EROFS, "Read-only file system", str(path))
        return right(path, flags, *more, **named)

    monkeypatch.setattr(os, "open", refuse)


@pytest.mark.parametrize("locks", [True, False])
def test_a_store_on_a_read_only_disk_can_be_read(filled: Store, monkeypatch: pytest.MonkeyPatch, locks: bool) -> None:
    if not locks:
        for path in filled.path.glob("*.lock"):
            path.unlink()
    read_only(monkeypatch, filled.path)
    assert samples(Store(filled.path)) == 7460
    with pytest.raises(StoreError, match="only be read") as error:
        Store(filled.path).write().__enter__()
    assert error.value.exit_code == 4


def test_a_store_stands_anywhere(filled: Store, campaign: Path, tmp_path: Path) -> None:
    place = tmp_path / 'Měření 23 °C 测试/o\'clock "quoted" %20;x'
    place.parent.mkdir()
    shutil.move(filled.path, place)
    store = Store(place)
    assert ingest(store, campaign).changed is False
    campaign.write_text(campaign.read_text().replace("10 um/V", "20 um/V"))
    assert ingest(store, campaign).losses == []
    assert samples(store) == 7460
    assert check_store(store).damaged == []
