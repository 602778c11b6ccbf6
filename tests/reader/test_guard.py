"""The guard names the reader, the file, the block and the rule."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from thermodata.errors import FormatError, PluginError
from thermodata.plugin import Block, Head, Loss, Reader, Recording, Signal, Source
from thermodata.reader.contract.guard import described, guarded
from thermodata.reader.contract.locate import locate
from thermodata.reader.finding.preview import begin

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
        if isinstance(self.recording, BaseException):
            raise self.recording
        return self.recording  # type: ignore[return-value]

    def blocks(self, path: Path, source: Source) -> Iterator[Block | Loss]:
        for item in self.items:
            if isinstance(item, BaseException):
                raise item
            yield item  # type: ignore[misc]


def run(reader: Fake) -> list[Block | Loss]:
    return list(guarded(reader, Path("x.log"), Source()))


def test_good_blocks_and_losses_pass_and_empty_blocks_are_dropped() -> None:
    loss = Loss("byte 3", reason="cut")
    assert run(Fake(GOOD, EMPTY, loss)) == [GOOD, loss]


def test_a_broken_rule_names_file_block_row_and_rule() -> None:
    with pytest.raises(PluginError) as caught:
        run(Fake(GOOD, BAD))
    assert caught.value.where == "x.log block 1 row 4"
    assert "values have the length of the time" in caught.value.what


def test_rows_are_counted_in_each_stream() -> None:
    other = Block("u", np.arange(5, dtype=np.int64), {"b": np.zeros(5)})
    two = Recording((Signal("a", "s"), Signal("b", "u")), "relative")
    with pytest.raises(PluginError) as caught:
        run(Fake(GOOD, other, Block("s", GOOD.t_ns, {"a": np.zeros(2, np.int16)}), recording=two))
    assert caught.value.where == "x.log block 2 row 2"


def test_a_loss_that_breaks_a_rule_has_no_row() -> None:
    with pytest.raises(PluginError) as caught:
        run(Fake(GOOD, Loss("byte 3")))
    assert caught.value.where == "x.log block 1"


def test_a_foreign_exception_is_the_plugins_bug() -> None:
    with pytest.raises(PluginError, match="KeyError"):
        run(Fake(GOOD, KeyError("a")))
    with pytest.raises(PluginError, match="failed to describe"):
        described(Fake(recording=ZeroDivisionError()), Path("x"), Source())


class Scripted(Fake):
    """Its methods end the process, as a script's main function does."""

    def blocks(self, path: Path, source: Source) -> Iterator[Block | Loss]:
        sys.exit(3)

    def locate(self, path: Path, source: Source, stream: str, row: int) -> str:
        sys.exit(4)

    def beginning(self, path: Path, source: Source) -> Reader | None:
        sys.exit(5)


def test_a_reader_that_would_end_the_process_is_a_plugins_bug_and_ctrl_c_is_none(tmp_path: Path) -> None:
    with pytest.raises(PluginError, match=r"(?s)reader 'fake' failed\nwhere: x.log block 1\ngot: SystemExit: 3"):
        run(Fake(GOOD, SystemExit(3)))
    with pytest.raises(PluginError, match="SystemExit: 3"):
        run(Scripted())
    with pytest.raises(PluginError, match="SystemExit: 2"):
        described(Fake(recording=SystemExit(2)), Path("x"), Source())
    with pytest.raises(PluginError, match=r"(?s)failed to locate a row\nwhere: x stream 's' row 7\ngot: SystemExit: 4"):
        locate(Scripted(), Path("x"), Source(), "s", 7)
    with pytest.raises(PluginError, match=r"(?s)failed to begin a file.*SystemExit: 5"):
        begin(Scripted(), tmp_path, Source())
    with pytest.raises(KeyboardInterrupt):
        run(Fake(GOOD, KeyboardInterrupt()))
    with pytest.raises(KeyboardInterrupt):
        described(Fake(recording=KeyboardInterrupt()), Path("x"), Source())


def test_our_own_errors_pass_as_they_are() -> None:
    with pytest.raises(FormatError, match=r"^cut$"):
        run(Fake(FormatError("cut")))


def test_what_is_no_block_or_recording_is_refused() -> None:
    with pytest.raises(PluginError, match="yielded dict"):
        run(Fake({"a": 1}))
    with pytest.raises(PluginError, match="describes with str"):
        described(Fake(recording="x"), Path("x"), Source())
