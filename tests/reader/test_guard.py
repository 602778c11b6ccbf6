"""The guard names the reader, the file, the block and the rule."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from thermodata.errors import FormatError, PluginError
from thermodata.plugin import Block, Head, Loss, Recording, Signal, Source
from thermodata.reader.guard import described, guarded

GOOD = Block("s", np.arange(2, dtype=np.int64), {"a": np.zeros(2)})
BAD = Block("s", np.arange(2, dtype=np.int64), {"a": np.zeros(3)})
EMPTY = Block("s", np.arange(0, dtype=np.int64), {"a": np.zeros(0)})


class Fake:
    """Yields what it was given; an exception among it is raised."""

    name = "fake"

    def __init__(self, *items: object, recording: object = None) -> None:
        self.items = items
        self.recording = recording or Recording((Signal("a", "s"),), "relative")

    def sniff(self, head: Head) -> str | None:
        return None

    def describe(self, path: Path, source: Source) -> Recording:
        if isinstance(self.recording, Exception):
            raise self.recording
        return self.recording  # type: ignore[return-value]

    def blocks(self, path: Path, source: Source) -> Iterator[Block | Loss]:
        for item in self.items:
            if isinstance(item, Exception):
                raise item
            yield item  # type: ignore[misc]


def run(reader: Fake) -> list[Block | Loss]:
    return list(guarded(reader, Path("x.log"), Source()))


def test_good_blocks_and_losses_pass_and_empty_blocks_are_dropped() -> None:
    loss = Loss("byte 3", reason="cut")
    assert run(Fake(GOOD, EMPTY, loss)) == [GOOD, loss]


def test_a_broken_rule_names_file_block_and_rule() -> None:
    with pytest.raises(PluginError) as caught:
        run(Fake(GOOD, BAD))
    assert caught.value.where == "x.log block 1"
    assert "values have the length of the time" in caught.value.what


def test_a_foreign_exception_is_the_plugins_bug() -> None:
    with pytest.raises(PluginError, match="KeyError"):
        run(Fake(GOOD, KeyError("a")))
    with pytest.raises(PluginError, match="failed to describe"):
        described(Fake(recording=ZeroDivisionError()), Path("x"), Source())


def test_our_own_errors_pass_as_they_are() -> None:
    with pytest.raises(FormatError, match=r"^cut$"):
        run(Fake(FormatError("cut")))


def test_what_is_no_block_or_recording_is_refused() -> None:
    with pytest.raises(PluginError, match="yielded dict"):
        run(Fake({"a": 1}))
    with pytest.raises(PluginError, match="describes with str"):
        described(Fake(recording="x"), Path("x"), Source())
