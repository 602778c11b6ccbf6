"""TAR archives whose headers are damaged, or made to take all memory; and names that are unusual, and no more."""

from __future__ import annotations

import gzip
import lzma
import os
import tarfile
import tracemalloc
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from thermodata.archive.members import listed
from thermodata.archive.too_much import MOST_FILES
from thermodata.archive.unpacked import cut_off, forget_unpacked, held
from thermodata.errors import FormatError

LOG = b"time [s],T_bed [degC]\n" + b"".join(b"%d,%.1f\n" % (i, 20 + i / 10) for i in range(60))
END = bytes(1024)


@pytest.fixture(autouse=True)
def _nothing_left() -> Iterator[None]:
    yield
    forget_unpacked()


def entry(name: str, data: bytes = LOG, kind: bytes = tarfile.REGTYPE) -> bytes:
    """A file as a TAR archive has it."""
    member = tarfile.TarInfo(name)
    member.size, member.type = len(data), kind
    return member.tobuf(tarfile.GNU_FORMAT) + data + bytes(-len(data) % 512)


def summed(header: bytearray) -> bytes:
    """A header with its checksum."""
    header[148:156] = b" " * 8
    header[148:156] = b"%06o\0 " % sum(header[:512])
    return bytes(header)


def written(path: Path, *parts: bytes) -> Path:
    path.write_bytes(b"".join(parts))
    return path


def flipped(data: bytes, at: int) -> bytes:
    return data[:at] + bytes([data[at] ^ 1]) + data[at + 1 :]


THREE = b"".join(entry(f"heat{k}.csv") for k in range(3))
STEP = len(THREE) // 3
DAMAGED: dict[str, tuple[bytes, str]] = {
    "a bit of a header": (flipped(THREE, STEP + 160) + END, f"the header at byte {STEP} is damaged"),
    "cut within its first header": (THREE[:200], "before its end mark"),
    "cut behind its first header": (THREE[:512], "before its end mark"),
    "two archives": (entry("a.csv") + END + entry("b.csv") + END, "more stands behind its end mark"),
    "headers of headers": (
        entry("././@LongLink", b"a.csv\0", b"L") * 3000 + THREE + END,
        "one header stands before the other",
    ),
}


@pytest.mark.parametrize("kind", DAMAGED)
@pytest.mark.parametrize("pack", [bytes, lzma.compress])
def test_an_archive_that_would_lose_files_without_a_word_is_refused(
    tmp_path: Path, kind: str, pack: Callable[[bytes], bytes]
) -> None:
    data, why = DAMAGED[kind]
    with pytest.raises(FormatError, match="an archive that can't be read") as refused:
        listed(written(tmp_path / ("a.tar" if pack is bytes else "a.tar.xz"), pack(data)))
    assert why in (refused.value.got or "")


WHOLE = "the archive has no end mark behind 'heat0.csv': if more stood there, it is lost"
BEHIND = "the archive is cut off behind 'heat0.csv': what stood there is lost"
WITHIN = "the archive ends within 'heat1.csv': the rest of it, and what stood behind, is lost"
DATA = 512 + len(LOG)  # behind a header and what it is of
CUTS = {
    "before a header": (STEP, WHOLE),
    "within a header": (STEP + 200, BEHIND),
    "behind a header": (STEP + 512, BEHIND),
    "within the zeros behind a file": (DATA + 1, BEHIND),
    "within a file": (STEP + 700, WITHIN),
}


@pytest.mark.parametrize("where", CUTS)
@pytest.mark.parametrize("pack", [bytes, lzma.compress, gzip.compress])
def test_an_archive_that_is_cut_off_is_read_to_its_cut_and_says_what_is_lost(
    tmp_path: Path, where: str, pack: Callable[[bytes], bytes]
) -> None:
    at, lost = CUTS[where]
    cut = "heat1.csv" if lost == WITHIN else None
    archive = written(tmp_path / ("a.tar" if pack is bytes else "a.tar.xz"), pack(THREE[:at]))
    found = listed(archive)
    assert (found.cut, found.lost) == (cut, lost)
    assert found.names == (("heat0.csv", "heat1.csv") if cut else ("heat0.csv",))
    for name in found.names:
        with held(archive / name) as real:
            assert real.read_bytes() == (LOG[:188] if name == cut else LOG)
        assert cut_off(archive / name) == ("the archive ends within this file" if name == cut else None)


def test_what_ends_between_two_files_is_cut_where_its_packer_is(tmp_path: Path) -> None:
    packed = gzip.compress(THREE)
    assert listed(written(tmp_path / "whole.tar.gz", packed)).lost == WHOLE.replace("heat0", "heat2")
    assert listed(written(tmp_path / "a.tar.gz", packed[:-4])).lost == BEHIND.replace("heat0", "heat2")


def test_a_long_name_whose_file_is_gone_is_no_end_between_two_files(tmp_path: Path) -> None:
    name = entry("././@LongLink", b"b" * 150 + b"\0", b"L")
    assert listed(written(tmp_path / "a.tar", entry("heat0.csv"), name)).lost == BEHIND


@pytest.mark.parametrize("suffix", ["gz", "xz"])
def test_what_a_cut_packer_gave_of_an_archive_is_read(tmp_path: Path, suffix: str) -> None:
    pack = gzip.compress if suffix == "gz" else lzma.compress
    rows = b"".join(b"%d,%d\n" % (i, i * 7919 % 10007) for i in range(40_000))
    data = pack(entry("heat0.csv") + entry("heat1.csv", rows) + END)
    archive = written(tmp_path / f"a.tar.{suffix}", data[: len(data) * 2 // 3])
    found = listed(archive)
    assert found.names == ("heat0.csv", "heat1.csv")
    assert found.cut == "heat1.csv"
    with held(archive / "heat1.csv") as real:
        got = real.read_bytes()
    assert len(got) == found.sizes["heat1.csv"] > 10_000
    assert rows.startswith(got)


@pytest.mark.parametrize("end", [512, 1024, 10240])
def test_an_archive_is_whole_whatever_zeros_fill_it_up(tmp_path: Path, end: int) -> None:
    assert listed(written(tmp_path / "a.tar", THREE, bytes(end))).names == ("heat0.csv", "heat1.csv", "heat2.csv")


def test_a_name_takes_no_memory_and_folders_no_time(tmp_path: Path) -> None:
    name = entry("././@LongLink", b"a" * (60 << 20), b"L") + entry("heat1.csv")
    long = written(tmp_path / "long.tar.xz", lzma.compress(name + END, preset=0))
    del name
    folders = entry("day", b"", tarfile.DIRTYPE) * (MOST_FILES + 1) + entry("heat1.csv")
    many = written(tmp_path / "many.tar.xz", lzma.compress(folders + END, preset=0))
    tracemalloc.start()
    with pytest.raises(FormatError, match="an archive that can't be read"):
        listed(long)
    assert tracemalloc.get_traced_memory()[1] < 20 << 20
    tracemalloc.stop()
    with pytest.raises(FormatError, match="an archive that unpacks to more than logs do"):
        listed(many)


def test_a_later_version_is_read_as_unpacking_would(tmp_path: Path) -> None:
    archive = written(
        tmp_path / "a.tar", entry("heat1.csv"), entry("heat2.csv"), entry("heat1.csv", LOG + b"60,26\n"), END
    )
    found = listed(archive)
    assert found.names == ("heat2.csv", "heat1.csv")
    assert found.refused == {"heat1.csv (earlier)": "another of its name stands behind it: that one is read"}
    with held(archive / "heat1.csv") as real:
        assert real.read_bytes() == LOG + b"60,26\n"


@pytest.mark.skipif(os.name == "nt", reason="no file is called so here")
def test_a_name_with_a_time_of_day_is_one(tmp_path: Path) -> None:
    archive = written(tmp_path / "a.tar", entry("2026-03-02T07:00:00.csv"), END)
    assert listed(archive).names == ("2026-03-02T07:00:00.csv",)
    with held(archive / "2026-03-02T07:00:00.csv") as real:
        assert real.read_bytes() == LOG


@pytest.mark.parametrize(
    ("name", "why"),
    [
        ("../heat1.csv", "its name leads elsewhere"),
        ("C:/heat1.csv", "its name leads elsewhere"),
        ("day//heat1.csv", "its name holds '//' or '/./'"),
        ("heat\udcfc1.csv", "its name holds what can't be shown"),
        ("h" * 201, "its name is too long"),
    ],
)
def test_why_a_name_is_not_read_is_true_of_it(tmp_path: Path, name: str, why: str) -> None:
    assert list(listed(written(tmp_path / "a.tar", entry(name), END)).refused.values()) == [why]


def test_a_file_without_its_gaps_is_no_link_and_takes_no_room(tmp_path: Path) -> None:
    """900 GB, of which 512 bytes at its beginning are packed."""
    header = bytearray(entry("log.csv", bytes(512), tarfile.GNUTYPE_SPARSE))
    header[386:410] = b"%011o\0%011o\0" % (0, 512)
    header[483:495] = b"\x80" + (900 << 30).to_bytes(11, "big")
    archive = written(tmp_path / "a.tar", summed(header), entry("heat1.csv"), END)
    found = listed(archive)
    assert found.names == ("heat1.csv",)
    assert found.refused == {"log.csv": "it is packed without its gaps, as 'tar --sparse' does"}


def test_a_size_below_nothing_is_damage(tmp_path: Path) -> None:
    header = bytearray(entry("heat1.csv"))
    header[124:136] = b"\xff" * 12
    with pytest.raises(FormatError, match="a file of -1 bytes"):
        listed(written(tmp_path / "a.tar", summed(header), END))
