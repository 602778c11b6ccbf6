"""TAR archives whose headers are damaged, or made to take all memory; and names that are unusual, and no more."""

from __future__ import annotations

import lzma
import tarfile
import tracemalloc
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from thermodata.archive.members import listed
from thermodata.archive.too_much import MOST_FILES
from thermodata.archive.unpacked import forget_unpacked
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


def written(path: Path, *parts: bytes) -> Path:
    path.write_bytes(b"".join(parts))
    return path


def flipped(data: bytes, at: int) -> bytes:
    return data[:at] + bytes([data[at] ^ 1]) + data[at + 1 :]


THREE = b"".join(entry(f"heat{k}.csv") for k in range(3))
STEP = len(THREE) // 3
DAMAGED: dict[str, tuple[bytes, str]] = {
    "a bit of a header": (flipped(THREE, STEP + 160) + END, f"the header at byte {STEP} is damaged"),
    "cut within a header": (THREE[: STEP + 200], "before its end mark"),
    "cut before a header": (THREE[:STEP], "before its end mark"),
    "cut within a file": (THREE[: STEP + 700], "before its end mark"),
    "two archives": (entry("a.csv") + END + entry("b.csv") + END, "more stands behind its end mark"),
    "headers of headers": (entry("././@LongLink", b"a.csv\0", b"L") * 3000 + THREE + END, "recursion"),
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
