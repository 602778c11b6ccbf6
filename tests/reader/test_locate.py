"""A reader's own words for where a row stands: by `locate`, by the older name `place`, or not at all."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from thermodata.errors import FormatError
from thermodata.plugin import Block, Head, Loss, Recording, Source
from thermodata.reader.contract.locate import locate


class Plain:
    name = "plain"

    def sniff(self, head: Head) -> str | None:
        return None

    def describe(self, path: Path, source: Source) -> Recording:
        return Recording((), "relative")

    def blocks(self, path: Path, source: Source) -> Iterator[Block | Loss]:
        return iter(())


class Places(Plain):
    def place(self, path: Path, source: Source, stream: str, row: int) -> str:
        return f"{path.name} {source.name} {stream} line {row + 1}"


class Locates(Places):
    def locate(self, path: Path, source: Source, stream: str, row: int) -> str:
        return f"{path.name} {source.name} {stream} row {row + 1}"


class Refuses(Plain):
    def locate(self, path: Path, source: Source, stream: str, row: int) -> str:
        raise FormatError("cut", where=path.name)


@pytest.mark.parametrize(
    ("reader", "expected"), [(Plain(), None), (Places(), "a.log daq main line 8"), (Locates(), "a.log daq main row 8")]
)
def test_locate_is_asked_first_then_place(reader: Plain, expected: str | None) -> None:
    assert locate(reader, Path("a.log"), Source(name="daq"), "main", 7) == expected


def test_a_refusal_is_passed_on() -> None:
    with pytest.raises(FormatError, match="cut"):
        locate(Refuses(), Path("a.log"), Source(), "main", 0)
