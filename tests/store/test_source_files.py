"""Source files as labs leave them: growing, replaced, pipes, folders, links, odd names."""

from __future__ import annotations

import hashlib
import os
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from store_fakes import daq, write_log

from thermodata.errors import FormatError, StoreError
from thermodata.plugin import Block, Head, Recording, Signal, Source
from thermodata.store import Store
from thermodata.store.ingest.reading.resolve import SourceFiles
from thermodata.store.ingest.run import ingest
from thermodata.store.ingest.summary import IngestSummary
from thermodata.store.raw.source_file import ChangedError, SourceFile, frozen, settled


class LineReader:
    """A number a line. While it reads, the file is changed by `meddle`."""

    name, version = "lines", "1"
    meddle: Any = None

    def sniff(self, head: Head) -> str | None:
        return None

    def describe(self, path: Path, source: Source) -> Recording:
        return Recording(
            (Signal("T1", "main", "degC"), Signal("T2", "main", "degC"), Signal("Z", "main", "V")), "absolute", 0
        )

    def blocks(self, path: Path, source: Source) -> Iterator[Block]:
        if type(self).meddle:
            type(self).meddle()
        text = path.read_text().split()
        v = np.array([float(x) for x in text])
        yield Block("main", np.arange(len(v)) * 10**9, {"T1": v, "T2": v, "Z": v})


@pytest.fixture
def lines(campaign: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A campaign of one text file, test 'one'."""
    from thermodata.store.ingest.reading import campaign_files

    monkeypatch.setattr(campaign_files, "find_reader", lambda name: LineReader())
    monkeypatch.setattr(LineReader, "meddle", None)
    text = campaign.read_text().replace("raw/{test}_*.npz", "raw/{test}.txt")
    campaign.write_text(
        "\n".join(x for x in text.splitlines() if "nc," not in x and "nc:" not in x and "id: two" not in x)
    )
    (campaign.parent / "raw/one.txt").write_text("".join(f"{20 + i % 7}\n" for i in range(50)))
    return campaign


def stored(store: Store) -> list[float]:
    with store.reader() as con:
        return [r[0] for r in con.execute("select value from signal('shop', 'one', 'T_a') order by t_s").fetchall()]


def hashes(store: Store) -> list[str]:
    with store.reader() as con:
        return [r[0] for r in con.execute("select sha256 from file where layer = 'raw'").fetchall()]


def test_hash_and_rows_agree_where_a_logger_is_still_writing(
    store: Store, lines: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    log = lines.parent / "raw/one.txt"

    def grow() -> None:
        with log.open("a") as file:
            file.write("30\n31\n")

    monkeypatch.setattr(LineReader, "meddle", grow)
    summary = ingest(store, lines)
    assert any("changed while it was read" in note for note in summary.notes)
    data = "".join(f"{v:g}\n" for v in stored(store)).encode()
    assert hashes(store) == [hashlib.sha256(data).hexdigest()]
    assert log.read_bytes().startswith(data)
    assert not [p for p in store.path.rglob("*") if ".tmp" in p.name]
    monkeypatch.setattr(LineReader, "meddle", None)
    ingest(store, lines)
    assert hashes(store) == [hashlib.sha256(log.read_bytes()).hexdigest()]
    assert len(stored(store)) == len(log.read_text().split())


def test_a_file_replaced_during_the_ingest_is_not_taken_for_the_hashed_one(
    store: Store, lines: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    log = lines.parent / "raw/one.txt"
    status = log.stat()

    def swap() -> None:
        other = log.with_name("other")
        other.write_text("".join(f"{40 + i % 7}\n" for i in range(50)))  # as long, and as old
        os.utime(other, ns=(status.st_atime_ns, status.st_mtime_ns))
        other.replace(log)

    monkeypatch.setattr(LineReader, "meddle", swap)
    ingest(store, lines)
    assert stored(store)[0] == 40
    assert hashes(store) == [hashlib.sha256(log.read_bytes()).hexdigest()]


def test_a_change_is_noticed_by_length_time_and_identity(tmp_path: Path) -> None:
    path = tmp_path / "x"
    path.write_bytes(b"1234")
    settled(path).check()
    for change in (lambda: path.write_bytes(b"12345"), lambda: path.write_bytes(b"54321"), path.unlink):
        file = settled(path)
        change()
        with pytest.raises(ChangedError):
            file.check()


def test_a_frozen_copy_is_the_bytes_of_its_hash_and_goes_away(tmp_path: Path) -> None:
    path = tmp_path / "day.tdms"
    path.write_bytes(os.urandom(3_000_000))
    with frozen(path, tmp_path / "store") as copy:
        path.write_bytes(b"other")
        assert copy.path.name == "day.tdms"
        assert hashlib.sha256(copy.path.read_bytes()).hexdigest() == copy.sha256
        assert copy.bytes == 3_000_000
    assert list((tmp_path / "store").iterdir()) == []


def test_no_room_for_the_copy_is_a_store_error(tmp_path: Path) -> None:
    (tmp_path / "x").write_bytes(b"1")
    (tmp_path / "file").write_bytes(b"")
    with pytest.raises(StoreError, match="free space"), frozen(tmp_path / "x", tmp_path / "file"):
        pass


@pytest.mark.parametrize("pattern", ["raw/{test}_*.npz", "raw/one_pipe.npz"])
def test_a_pipe_is_refused_and_never_waited_for(store: Store, campaign: Path, pattern: str) -> None:
    os.mkfifo(campaign.parent / "raw/one_pipe.npz")
    campaign.write_text(campaign.read_text().replace("raw/{test}_*.npz", pattern))
    losses = [x["reason"] for x in ingest(store, campaign).losses if x["file"] == "raw/one_pipe.npz"]
    assert losses
    assert all("pipe" in reason for reason in losses)


def test_what_becomes_a_pipe_after_it_was_found_is_refused_too(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "x")
    with pytest.raises(FormatError, match="pipe"):
        settled(tmp_path / "x")


def other_losses(summary: IngestSummary) -> list[tuple[str | None, str]]:
    return [(x["file"], x["reason"]) for x in summary.losses]


def test_links_that_lead_nowhere_or_in_circles_are_told(store: Store, campaign: Path) -> None:
    raw = campaign.parent / "raw"
    (raw / "one_gone.npz").symlink_to("nothing.npz")
    (raw / "one_round.npz").symlink_to("one_round.npz")
    (raw / "one_ok.npz").symlink_to("one_a.npz")
    summary = ingest(store, campaign)
    told = dict(other_losses(summary))
    assert "link to nothing" in told["raw/one_gone.npz"]
    assert "raw/one_round.npz" in told
    assert set(told) == {"raw/one_gone.npz", "raw/one_round.npz"}
    assert summary.samples == 2 * (3 * 1200 + 2 * 130)


def test_a_device_behind_a_link_is_refused(store: Store, campaign: Path) -> None:
    (campaign.parent / "raw/one_z.npz").symlink_to("/dev/zero")
    assert [f for f, _ in other_losses(ingest(store, campaign))] == ["raw/one_z.npz"]


def test_a_folder_that_a_pattern_fits_is_passed_over_and_a_named_one_refused(store: Store, campaign: Path) -> None:
    (campaign.parent / "raw/one_folder.npz").mkdir()
    assert ingest(store, campaign).losses == []
    campaign.write_text(campaign.read_text().replace("- {id: one,", "- {id: one, files: {daq: raw/one_folder.npz},"))
    assert any("folder" in reason for _, reason in other_losses(ingest(store, campaign)))


def test_an_empty_file_is_a_loss_and_the_others_stay(store: Store, campaign: Path) -> None:
    (campaign.parent / "raw/one_b.npz").write_bytes(b"")
    summary = ingest(store, campaign)
    assert [f for f, _ in other_losses(summary)] == ["raw/one_b.npz"]
    assert summary.samples == 2 * (3 * 1200 + 2 * 130)


@pytest.mark.parametrize(
    "name",
    [
        "one_měření 23 °C 日本 'x' \"y\"; drop table file; --.npz",
        "one_" + "n" * 240 + ".npz",
        "one_\n\t.npz",
        os.fsdecode(b"one_\xff\xfe.npz"),
        "one_a,b{c}[d]%e.npz",
    ],
)
def test_any_file_name_that_a_disk_takes_is_read(store: Store, campaign: Path, name: str) -> None:
    raw = campaign.parent / "raw"
    (raw / "one_a.npz").unlink()
    made = write_log(raw / "one_x.npz", daq(seed=0))
    made.rename(raw / name)
    summary = ingest(store, campaign)
    assert summary.losses == []
    assert summary.samples == 2 * (3 * 1200 + 2 * 130)
    assert ingest(store, campaign).changed is False
    with store.reader() as con:
        (path,) = con.execute(
            "select source_path from file where layer = 'raw' and test = 'one' and source = 'daq'"
        ).fetchone() or ("",)
    assert path.encode("utf-8", "replace")[:8] == b"raw/one_"


class Choosy(LineReader):
    """It describes no file that begins with a blank."""

    described = 0

    def describe(self, path: Path, source: Source) -> Recording:
        type(self).described += 1
        if self.meddle:
            type(self).meddle()
        with path.open("rb") as file:
            if file.read(1) == b" ":
                raise FormatError("it begins with a blank", where=path.name)
        return super().describe(path, source)

    def blocks(self, path: Path, source: Source) -> Iterator[Block]:
        type(self).meddle = None
        return super().blocks(path, source)


@pytest.fixture
def choosy(lines: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The same, read by a reader that refuses some files, and where any file is a huge one."""
    from thermodata.store.ingest.reading import campaign_files

    monkeypatch.setattr(campaign_files, "find_reader", lambda name: Choosy())
    monkeypatch.setattr(campaign_files, "_HUGE", 1)
    monkeypatch.setattr(Choosy, "meddle", None)
    monkeypatch.setattr(Choosy, "described", 0)
    return lines


@pytest.fixture
def hashed(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The names of the files that are hashed."""
    from thermodata.store.ingest.reading import campaign_files

    found: list[str] = []

    def told(path: Path) -> SourceFile:
        found.append(path.name)
        return settled(path)

    monkeypatch.setattr(campaign_files, "settled", told)
    return found


def test_a_huge_file_that_its_reader_refuses_is_not_hashed(store: Store, choosy: Path, hashed: list[str]) -> None:
    log = choosy.parent / "raw/one.txt"
    good = log.read_text()
    log.write_text(" " + good)
    summary = ingest(store, choosy)
    assert any("it begins with a blank" in loss["reason"] for loss in summary.losses)
    assert (hashed, Choosy.described) == ([], 1)
    log.write_text(good)
    assert not ingest(store, choosy).losses
    assert (hashed, len(hashes(store))) == (["one.txt"], 1)
    log.write_text(" " + good)  # what was read before stands, and whether that are these bytes is asked
    summary = ingest(store, choosy)
    assert any("the version that was read before is used" in note for note in summary.notes)
    assert hashed == ["one.txt", "one.txt"]


def test_a_smaller_file_is_hashed_and_looked_at_once(
    store: Store, choosy: Path, hashed: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    from thermodata.store.ingest.reading import campaign_files

    monkeypatch.setattr(campaign_files, "_HUGE", 1 << 30)
    assert not ingest(store, choosy).losses
    assert (hashed, Choosy.described) == (["one.txt"], 1)


def test_a_huge_file_that_changes_while_it_is_looked_at_is_not_refused_for_that(
    store: Store, choosy: Path, hashed: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    log = choosy.parent / "raw/one.txt"
    good = log.read_text()
    log.write_text(" " + good)

    def end() -> None:
        Choosy.meddle = None
        log.write_text(good)
        raise FormatError("half of a file", where=log.name)

    monkeypatch.setattr(Choosy, "meddle", end)
    assert not ingest(store, choosy).losses
    assert hashes(store) == [hashlib.sha256(good.encode()).hexdigest()]


def test_files_come_as_they_are_listed_however_they_are_written_and_however_many(tmp_path: Path) -> None:
    listed = tuple(f"./b/{k:04d}.csv" for k in reversed(range(3000)))
    paths = tuple(name.removeprefix("./") for name in listed)
    files = SourceFiles((*listed, "log*"), (*paths, "log.2", "log.1", "log"), (), False, True)
    began = time.process_time()
    assert files.in_order(set(files.paths)) == list(files.paths)
    gone = SourceFiles(files.patterns, files.paths[5:], (), False, True)
    assert all(map(gone.claims, files.paths))
    assert not gone.claims("b/9.csv")
    assert gone.in_order(set(files.paths))[:3000] == list(paths)
    assert time.process_time() - began < 10  # a pattern compiled for each of each took minutes
