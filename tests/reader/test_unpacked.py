"""What readers are given of packed logs: where it lies, for how long, and whose it is."""

from __future__ import annotations

import gzip
import io
import multiprocessing
import os
import signal
import tarfile
import tempfile
import threading
import zipfile
from collections.abc import Iterator
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

import pytest

from thermodata.archive import unpacked
from thermodata.archive.members import each_in
from thermodata.archive.unpacked import forget_unpacked, held
from thermodata.errors import FormatError
from thermodata.plugin import Source
from thermodata.reader.contract.guard import described
from thermodata.reader.finding.registry import reader
from thermodata.testing.reader.apart import together

LOG = "time [s],T_bed [degC]\n" + "".join(f"{i},{20 + i / 10:.1f}\n" for i in range(60))


@pytest.fixture(autouse=True)
def room(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """Where logs are unpacked to."""
    (tmp_path / "tmp").mkdir()
    forget_unpacked()
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "tmp"))
    yield tmp_path / "tmp"
    forget_unpacked()


def archive(path: Path, count: int) -> dict[str, bytes]:
    """The files of an archive."""
    files = {f"heat{k}.csv": LOG.replace("20.", f"{30 + k}.").encode() * 50 for k in range(count)}
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as zipped:
        for name, content in files.items():
            zipped.writestr(name, content)
    return files


def alone(folder: Path, count: int) -> list[Path]:
    """Logs of one size, each packed alone."""
    paths = [folder / f"heat{k}.csv.gz" for k in range(count)]
    for path in paths:
        path.write_bytes(gzip.compress(LOG.encode()))
    return paths


def unpacks_and_is_killed(path: Path, with_test: Connection) -> None:
    """Says where a log was unpacked to, and is killed once it is told so."""
    with held(path) as real:
        with_test.send(real)
        with_test.recv()
        os.kill(os.getpid(), signal.SIGKILL)


@pytest.mark.skipif("fork" not in multiprocessing.get_all_start_methods(), reason="no process can be forked here")
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_what_a_killed_process_left_is_deleted_by_the_next_and_what_a_living_one_reads_stays(
    tmp_path: Path, room: Path
) -> None:
    (path,) = alone(tmp_path, 1)
    context = multiprocessing.get_context("fork")
    both, places = [], []
    for _ in range(2):
        here, there = context.Pipe()
        both.append((context.Process(target=unpacks_and_is_killed, args=(path, there), daemon=True), here))
        both[-1][0].start()
        places.append(here.recv() if here.poll(60) else None)
    (killed, to_killed), (living, to_living) = both
    try:
        to_killed.send("now")
        killed.join(60)
        assert places[0].is_file()
        with held(path) as own:
            assert not places[0].exists()
            assert places[1].read_text() == own.read_text() == LOG
            assert len(list(room.iterdir())) == 2
        to_living.send("now")
        living.join(60)
        forget_unpacked()
        with held(path):
            assert not places[1].exists()
    finally:
        for process, _ in both:
            process.kill()
            process.join()
    forget_unpacked()
    assert not list(room.iterdir())


def used(room: Path) -> int:
    return sum(f.stat().st_size for f in room.rglob("*") if f.is_file())


def test_copies_that_nobody_reads_make_room_and_those_that_somebody_does_stay(
    tmp_path: Path, room: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    first, *others = alone(tmp_path, 6)
    monkeypatch.setattr(unpacked, "no_room", lambda path: used(room) > 1.5 * len(LOG))
    with held(first) as read:
        for other in others:
            with held(other) as real:
                assert real.read_text() == read.read_text() == LOG
        with held(others[0]), pytest.raises(FormatError, match="no room to unpack it"), held(others[1]):
            pass
        assert read.read_text() == LOG
    with held(others[1]) as real:
        assert real.read_text() == LOG


def test_the_copies_kept_are_dropped_before_another_takes_their_room(
    tmp_path: Path, room: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(unpacked, "_KEPT", 2)
    for path in alone(tmp_path, 5):
        with held(path) as real:
            assert real.read_text() == LOG
        assert used(room) <= 2 * len(LOG)


def test_the_directory_of_an_archive_is_read_as_often_whatever_it_holds(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    opened = []

    class Counted(zipfile.ZipFile):
        def __init__(self, file: Any, *args: Any, **options: Any) -> None:
            opened.append(file)
            super().__init__(file, *args, **options)

    files = archive(tmp_path / "day.zip", 9)
    monkeypatch.setattr(zipfile, "ZipFile", Counted)
    for path in each_in(tmp_path / "day.zip"):
        with held(path) as real:
            assert real.read_bytes() == files[path.name]
    assert len(opened) <= 2  # to list it, and to read it


def test_a_packed_archive_that_outgrows_what_is_kept_is_unpacked_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    files = {f"heat{k}.csv": LOG.replace("20.", f"{30 + k}.").encode() for k in range(6)}
    with tarfile.open(tmp_path / "day.tar.gz", "w:gz") as archive:
        for name, content in files.items():
            member = tarfile.TarInfo(name)
            member.size = len(content)
            archive.addfile(member, io.BytesIO(content))
    made, names = unpacked._unpack, []

    def counted(archive: Path, name: str, status: os.stat_result) -> Any:
        names.append(name)
        return made(archive, name, status)

    monkeypatch.setattr(unpacked, "_unpack", counted)
    monkeypatch.setattr(unpacked, "_KEPT_BYTES", len(LOG))
    for path in each_in(tmp_path / "day.tar.gz"):
        with held(path) as real:
            assert real.read_bytes() == files[path.name]
    assert sorted(names) == ["", *files]


def test_an_archive_that_was_written_anew_is_read_anew(tmp_path: Path) -> None:
    path = tmp_path / "day.zip"
    archive(path, 2)
    with held(path / "heat1.csv") as real:
        before = real.read_bytes()
    with zipfile.ZipFile(path, "w") as zipped:
        zipped.writestr("heat0.csv", "time [s]\n0\n")
        zipped.writestr("heat1.csv", before + b"60,26.0\n")
    with held(path / "heat1.csv") as real:
        assert real.read_bytes() == before + b"60,26.0\n"


def test_a_file_that_an_archive_calls_by_the_folder_it_is_in_is_read(tmp_path: Path) -> None:
    with zipfile.ZipFile(tmp_path / "day.zip", "w") as zipped:
        zipped.writestr("./t4.csv", LOG)
        zipped.writestr("./day/t5.csv", LOG)
        zipped.writestr("./.hidden.csv", LOG)
    paths = each_in(tmp_path / "day.zip")
    assert paths == [tmp_path / "day.zip/t4.csv", tmp_path / "day.zip/day/t5.csv"]
    for path in paths:
        assert [s.name for s in described(reader("table"), path, Source()).signals] == ["T_bed [degC]"]


def test_two_that_read_one_archive_at_once_get_what_is_in_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(unpacked, "_KEPT", 1)  # so that each drops what the other has read
    files = archive(tmp_path / "day.zip", 8)
    gate, wrong = threading.Barrier(2), []

    def read(names: list[str]) -> None:
        gate.wait(30)
        for name in names * 5:
            try:
                with held(tmp_path / "day.zip" / name) as real:
                    if real.read_bytes() != files[name]:
                        wrong.append(name)
            except (FormatError, OSError) as error:
                wrong.append(f"{name}: {error}")

    readers = [threading.Thread(target=read, args=(names,)) for names in (list(files), list(files)[::-1])]
    for one in readers:
        one.start()
    for one in readers:
        one.join(60)
    assert not wrong


@pytest.mark.parametrize("kept", [64, 1])
def test_a_child_deletes_nothing_that_its_parent_reads(
    tmp_path: Path, room: Path, monkeypatch: pytest.MonkeyPatch, kept: int
) -> None:
    monkeypatch.setattr(unpacked, "_KEPT", kept)
    files = archive(tmp_path / "day.zip", 4)
    paths = [tmp_path / "day.zip" / name for name in files]
    with held(paths[0]):
        pass

    def read_and_end() -> str | None:
        wrong = []
        for path in paths[::-1]:
            with held(path) as real:
                if real.read_bytes() != files[path.name]:
                    wrong.append(path.name)
        forget_unpacked()
        return ", ".join(wrong) or None

    assert together(read_and_end, count=2) == [None, None]
    for path in paths:
        with held(path) as real:
            assert real.read_bytes() == files[path.name]
    assert len(list(room.iterdir())) == 1
