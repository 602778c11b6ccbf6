"""Each rule of a reader, with a deliberately broken twin that only this rule catches."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from thermodata.plugin import Block, Loss, Recording, Signal
from thermodata.reader.contract import rules

T = np.arange(3, dtype=np.int64)
GOOD = Recording((Signal("a", "s"), Signal("n", "s", dtype="int16"), Signal("w", "s", dtype="str")), "relative")
BLOCK = Block(
    "s",
    T,
    {"a": np.zeros(3), "n": np.zeros(3, np.int16), "w": np.array(["x", None, ""], object)},
    {"a": np.zeros(3, np.uint16)},
)
LOSS = Loss("byte 7", 1, 2, 0.5, "cut")


def with_values(**changed: np.ndarray) -> Block:
    return replace(BLOCK, values={**BLOCK.values, **changed})


BROKEN_RECORDINGS = {
    rules.signal_names_are_unique_within_a_stream: replace(GOOD, signals=(*GOOD.signals, Signal("a", "s"))),
    rules.every_signal_has_a_name_a_stream_and_a_dtype: replace(GOOD, signals=(Signal("a", "s", dtype="volts"),)),
    rules.the_clock_is_absolute_or_relative: replace(GOOD, clock="absolute"),
}
BROKEN_BLOCKS = {
    rules.the_stream_was_declared: replace(BLOCK, stream="other"),
    rules.time_is_int64_nanoseconds_in_one_dimension: replace(BLOCK, t_ns=T.astype(float)),
    rules.every_declared_signal_is_delivered_and_no_other: replace(BLOCK, values={"a": np.zeros(3)}),
    rules.values_have_the_length_of_the_time: with_values(a=np.zeros(2)),
    rules.values_have_the_declared_dtype: with_values(n=np.zeros(3)),
    rules.flags_are_uint16_of_delivered_signals: replace(BLOCK, flags={"a": np.zeros(3, int)}),
    rules.where_rows_stand_is_int64_of_the_time_s_length: replace(BLOCK, at=np.arange(2)),
}
BROKEN_LOSSES = {
    rules.a_loss_says_where_and_why: replace(LOSS, reason=""),
    rules.the_fraction_lost_is_between_0_and_1: replace(LOSS, fraction=37.0),
    rules.a_loss_does_not_end_before_it_starts: replace(LOSS, to_ns=0),
}


def test_good_data_break_no_rule() -> None:
    assert [rule(GOOD) for rule in rules.RECORDING_RULES] == [None] * len(rules.RECORDING_RULES)
    assert rules.broken_rule(GOOD, BLOCK) is None
    assert rules.broken_rule(GOOD, LOSS) is None


@pytest.mark.parametrize("rule", rules.RECORDING_RULES, ids=rules.sentence)
def test_recording_rule_catches_its_broken_twin(rule: rules.RecordingRule) -> None:
    assert rule(BROKEN_RECORDINGS[rule])


@pytest.mark.parametrize("rule", [*rules.BLOCK_RULES, *rules.LOSS_RULES], ids=rules.sentence)
def test_item_rule_is_the_one_that_catches_its_broken_twin(rule: rules.BlockRule | rules.LossRule) -> None:
    twin = {**BROKEN_BLOCKS, **BROKEN_LOSSES}[rule]
    found = rules.broken_rule(GOOD, twin)
    assert found is not None
    assert found.rule == rules.sentence(rule)


@pytest.mark.parametrize("dtype", ["text", "object", "<U5", "a[", "datetime64[ns]"])
def test_a_dtype_that_is_none_is_answered_with_what_to_declare(dtype: str) -> None:
    said = rules.every_signal_has_a_name_a_stream_and_a_dtype(replace(GOOD, signals=(Signal("w", "s", dtype=dtype),)))
    assert said is not None
    assert said.startswith(f"signal 'w' declares dtype {dtype!r}; expected 'str' for text, else numpy's name")


@pytest.mark.parametrize("t_ns", [np.iinfo(np.int64).min, np.iinfo(np.int64).max])
def test_a_time_that_is_none_is_no_time(t_ns: int) -> None:
    block = replace(BLOCK, t_ns=np.array([0, t_ns, 1], np.int64))
    assert rules.time_is_int64_nanoseconds_in_one_dimension(GOOD, block) == rules.Wrong(f"t_ns is {t_ns}, no time", 1)


def test_text_with_a_number_in_it_is_named_by_row() -> None:
    wrong = rules.values_have_the_declared_dtype(GOOD, with_values(w=np.array(["x", 3, ""], object)))
    assert wrong == rules.Wrong("'w' is int, declared str", 1)


@pytest.mark.parametrize(("values", "row"), [(2, 2), (4, 3)])
def test_values_of_another_length_are_named_by_the_first_row_without_its_like(values: int, row: int) -> None:
    wrong = rules.values_have_the_length_of_the_time(GOOD, with_values(a=np.zeros(values)))
    assert wrong == rules.Wrong(f"'a' has shape ({values},), time (3,)", row)


@pytest.mark.parametrize("values", [np.zeros((3, 2)), 0.0, None])
def test_values_that_are_no_column_are_wrong_from_the_first_row_on(values: object) -> None:
    wrong = rules.values_have_the_length_of_the_time(GOOD, with_values(a=values))  # type: ignore[arg-type]
    assert wrong is not None
    assert wrong.row == 0


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ({"W": T}, "'W', which describe() does not declare"),
        ({"W": T, "V": T}, "'V', 'W', which describe() does not declare"),
        ({"a": None}, "no 'a', which describe() declares"),
        ({"a": None, "W": T}, "'W', which describe() does not declare, and no 'a', which describe() declares"),
    ],
)
def test_signals_that_are_too_many_or_too_few_are_said_in_words(values: dict[str, object], said: str) -> None:
    held = {name: v for name, v in {**BLOCK.values, **values}.items() if v is not None}
    wrong = rules.every_declared_signal_is_delivered_and_no_other(GOOD, replace(BLOCK, values=held))
    assert wrong == rules.Wrong(f"the block of stream 's' holds {said}")


def test_blocks_of_several_files_in_turn_are_each_held_against_their_own_file() -> None:
    files = [Recording((Signal("a", f"s{i}", "K"),), "absolute", 0) for i in range(5)]
    for _ in range(2):
        for i, said in enumerate(files):
            block = Block(f"s{i}", np.array([1], np.int64), {"a": np.array([1.0])})
            assert rules.broken_rule(said, block) is None
            assert rules.broken_rule(files[i - 1], block) == rules.Broken(
                "the stream was declared", f"stream 's{i}' was not declared"
            )
