"""Lines of a file in chunks: of any size, encoding and line end, they are the lines that an editor shows."""

from __future__ import annotations

import tempfile
from pathlib import Path

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from thermodata.reader.text.file.lines import Chunk, chunks, last_line_is_whole, sample

LINES = st.lists(st.text(alphabet='ab;1,5 žé°µ\t"', max_size=12), max_size=10)
ENCODINGS = ["utf-8", "utf-8-sig", "cp1250", "utf-16", "utf-16-le", "utf-16-be"]


def joined(parts: list[Chunk]) -> str:
    return b"".join(part.data for part in parts).decode()


@settings(deadline=None, max_examples=300)
@given(LINES, st.sampled_from(["\n", "\r\n", "\r"]), st.booleans(), st.integers(1, 40), st.sampled_from(ENCODINGS))
@example(["ž" * 30] * 3, "\n", False, 2, "utf-16")
@example(["a", "", "b"], "\r\n", True, 2, "utf-8")
def test_chunks_of_any_size_hold_the_same_lines(
    lines: list[str], end: str, ended: bool, size: int, encoding: str
) -> None:
    lines = [line.replace("µ", "u") for line in lines] if encoding == "cp1250" else lines
    text = end.join(lines) + (end if ended else "")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "a.txt"
        path.write_bytes(text.encode(encoding))
        parts = list(chunks(path, encoding, size))
    wanted = text.replace("\r", "\n") if end == "\r" else text
    assert joined(parts) == wanted
    assert [part.last for part in parts] == [False] * (len(parts) - 1) + [True]
    assert all(part.data.endswith(b"\n") for part in parts[:-1])
    assert [part.line for part in parts] == [
        sum(part.data.count(b"\n") for part in parts[:k]) for k in range(len(parts))
    ]
    assert [part.odd for part in parts] == [()] * len(parts)


@pytest.mark.parametrize("size", [4, 16, 1 << 20])
def test_lines_of_another_encoding_are_read_as_they_look_and_named(tmp_path: Path, size: int) -> None:
    path = tmp_path / "a.txt"
    path.write_bytes("Teplota\nžluťoučký\n".encode() + "Tür\n".encode("cp1252") + "kůň\n".encode() + b"\x81\n")
    parts = list(chunks(path, "utf-8", size))
    assert joined(parts) == "Teplota\nžluťoučký\nTür\nkůň\n\ufffd\n"
    assert [line for part in parts for line in part.odd] == [2, 4]


def test_a_byte_order_mark_is_no_part_of_the_first_line(tmp_path: Path) -> None:
    """Also where a few lines are not UTF-8, so that the file is read as UTF-8 without a word on its mark."""
    path = tmp_path / "a.txt"
    path.write_bytes("\ufeffTeplota vřetene, žluťoučký kůň\n".encode() + b"T\xfcr\n")
    found = sample(path, None)
    assert found.encoding == "utf-8"
    (part,) = chunks(path, found.encoding)
    assert part.data.decode() == "Teplota vřetene, žluťoučký kůň\nTür\n"
    assert part.odd == (1,)


def test_a_file_without_any_line_end_comes_in_pieces(tmp_path: Path) -> None:
    """Zeros, where a file was allocated in advance, must not fill the memory."""
    path = tmp_path / "a.txt"
    path.write_bytes(b"1\n" + b"\0" * 3_000_000)
    parts = list(chunks(path, "utf-8", 1024))
    assert max(len(part.data) for part in parts) < 1_100_000
    assert sum(len(part.data) for part in parts) == 3_000_002
    assert {part.line for part in parts[1:]} == {1}


def test_a_sample_of_a_large_file_has_its_first_and_last_lines(tmp_path: Path) -> None:
    path = tmp_path / "a.txt"
    lines = [f"line {k:06d}" for k in range(100_000)]
    path.write_text("\n".join([*lines, ""]), "utf-8")
    found = sample(path, None)
    assert not found.whole
    assert found.ends_with_newline
    assert list(found.head) == lines[: len(found.head)]
    assert found.rest[-1] == lines[-1]
    assert set(found.rest) <= set(lines)
    small = sample(path, None, whole_up_to=2_000_000)
    assert small.whole
    assert list(small.head) == lines


@pytest.mark.parametrize(
    ("line", "before", "whole"),
    [
        ("1;on", "0;on", True),
        ("1;o", "0;on", False),
        ("1;12.50", "0;12.25", True),
        ("1;12.5", "0;12.25", False),
        ("1;100", "0;1000", False),
        ("1;1000", "0;1001", False),
        ("1;", "0;", False),
        ("1", "0;on", False),
        ("1;12.500", "0;12", False),
    ],
)
def test_a_last_line_proves_itself_whole(line: str, before: str, whole: bool) -> None:
    assert last_line_is_whole(line, before, ";") is whole


@pytest.mark.parametrize("odd", [0, 1])
@pytest.mark.parametrize("encoding", ["utf-8", "utf-16"])
def test_a_long_file_ends_where_it_ends_whether_its_size_is_odd_or_not(tmp_path: Path, odd: int, encoding: str) -> None:
    path = tmp_path / "a.csv"
    path.write_bytes(("a;b\n" + "1;2\n" * 200_000 + ("10;2\n" if odd else "")).encode(encoding))
    if encoding == "utf-8":
        assert path.stat().st_size % 2 == odd
    assert sample(path, None).ends_with_newline
    path.write_bytes(path.read_bytes()[:-2] if encoding == "utf-16" else path.read_bytes()[:-1])
    assert not sample(path, None).ends_with_newline
