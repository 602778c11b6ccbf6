"""The kit's checks of rows that are doubled, swapped or spoiled, against readers that lose them without a word."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from unittest import SkipTest

import numpy as np
import pytest

from tests.conformance import broken_texts as texts
from tests.conformance.test_reader_kit import MAGIC, PAIR, Good, Whole
from thermodata.plugin import Block, Source
from thermodata.testing import reader as kit


@pytest.fixture
def file(tmp_path: Path) -> tuple[Path, Source]:
    return texts.written(tmp_path / "a.lines"), Source()


@pytest.mark.parametrize("good", [texts.Good, texts.KeepsTheWord, texts.SaysThatItSorts], ids=lambda c: c.__name__)
def test_a_good_reader_of_a_text_passes_everything(good: type, file: tuple[Path, Source]) -> None:
    kit.check_reader(good, [file], block_rows="block_rows")


@pytest.mark.parametrize("broken", texts.BROKEN, ids=lambda c: c.__name__)
def test_one_that_loses_rows_is_caught_by_the_check_for_it(
    broken: type, file: tuple[Path, Source], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("thermodata.testing.reader.memory.LAST", 2**21)
    with pytest.raises(AssertionError, match=r"(?s)a\.lines .*\nexpected: .*\ngot: .*\ntry: "):
        texts.BROKEN[broken](kit.Case(broken, (file,), (), "block_rows"), *file)


def test_what_is_wrong_is_said_with_its_line_and_value(file: tuple[Path, Source]) -> None:
    with pytest.raises(AssertionError) as caught:
        kit.a_cell_without_a_value_gives_no_number(kit.Case(texts.ZeroForNothing, (file,)), *file)
    assert str(caught.value).startswith(
        "a.lines where 'T' of line 7 is empty\n"
        "expected: no number in row 5 of stream 'log', all else as it was\n"
        "got: 0.0 there, unflagged\ntry: give NaN where the file has no value"
    )


class SortsPairs(Whole):
    def read(self, path: Path) -> tuple[list[tuple[int, float]], int]:
        pairs, count = super().read(path)
        return sorted(pairs), count


class ZeroForNaNOfPairs(Good):
    def blocks(self, path: Path, source: Source) -> object:
        for item in super().blocks(path, source):
            yield replace(item, values={"T": np.nan_to_num(item.values["T"])}) if isinstance(item, Block) else item


@pytest.mark.parametrize(
    ("broken", "check"),
    [
        (SortsPairs, kit.rows_arrive_in_the_order_of_the_file),
        (ZeroForNaNOfPairs, kit.a_cell_without_a_value_gives_no_number),
    ],
)
def test_records_of_a_binary_file_are_found_by_their_numbers(
    broken: type, check: Callable[..., None], tmp_path: Path
) -> None:
    path = tmp_path / "a.pairs"
    pairs = [PAIR.pack(i * 1_000_000_000, 20 + i / 3) for i in range(12)]
    path.write_bytes(MAGIC + len(pairs).to_bytes(4, "little") + b"".join(pairs))
    check(kit.Case(Good, ((path, Source()),)), path, Source())
    with pytest.raises(AssertionError, match=r"a\.pairs .*bytes 1\d\d to 1\d\d"):
        check(kit.Case(broken, ((path, Source()),)), path, Source())


def test_a_file_whose_rows_nobody_can_find_is_skipped_with_the_reason(tmp_path: Path) -> None:
    path = tmp_path / "a.pairs"
    path.write_bytes(MAGIC + (1).to_bytes(4, "little") + PAIR.pack(0, 20.0))
    with pytest.raises(SkipTest, match="no line or record of it can be taken away"):
        kit.rows_arrive_in_the_order_of_the_file(kit.Case(Good, ((path, Source()),)), path, Source())
    kit.check_reader(Good, [(path, Source())])
