"""A locked test that is a copy of an open one (locked/copies.py), open ones that share samples (question/once.py)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from thermodata.diagnosis.locked.copies import as_artefacts, copies
from thermodata.diagnosis.question.once import RepeatedSamples, each_once
from thermodata.diagnosis.question.once import as_artefacts as as_told
from thermodata.view.grid.dataset import Dataset, TestData
from thermodata.view.grid.recorded import Recorded

from .hand_made import a_test


def read(name: str, values: np.ndarray) -> TestData:
    return replace(a_test(name, len(values)), values={"dZ": values})


NOISE = np.random.default_rng(0).normal(size=30)


@pytest.mark.parametrize(
    ("values", "same"),
    [
        (NOISE, True),
        (np.where(np.arange(30) == 7, NOISE + 1e-9, NOISE), False),
        (np.where(np.arange(30) == 7, np.nan, NOISE), False),
        (NOISE[:29], False),
    ],
)
def test_a_copy_has_every_value_of_the_other(values: np.ndarray, same: bool) -> None:
    found = copies([read("locked", values)], [read("a", NOISE[::-1]), read("b", NOISE)], "dZ")
    assert [(one.test, other.test) for one, other in found] == ([("locked", "b")] if same else [])


@pytest.mark.parametrize(("known", "same"), [(30, True), (29, False)])
def test_of_few_samples_and_of_one_value_nothing_is_said(known: int, same: bool) -> None:
    some = np.where(np.arange(40) < known, np.arange(40.0), np.nan)
    assert bool(copies([read("locked", some)], [read("b", some)], "dZ")) is same
    still = np.zeros(40)
    assert copies([read("locked", still)], [read("b", still)], "dZ") == []
    assert copies([read("locked", some)], [replace(read("b", some), values={})], "dZ") == []


def test_what_is_said_names_both() -> None:
    [said] = as_artefacts(copies([read("locked", NOISE)], [read("b", NOISE)], "dZ"), "dZ")
    assert (said.kind, said.test) == ("copy", "locked")
    assert "the open test 'b'" in said.why


def cut(name: str, from_row: int, to_row: int, file: str = "day", signal: str = "p") -> TestData:
    """Rows of one recording, whose values are those of its rows."""
    values = np.random.default_rng(0).normal(size=500)[from_row:to_row]
    at_ns = {file: (from_row * 60 * 10**9, (to_row - 1) * 60 * 10**9)}
    where = Recorded(from_row * 60 * 10**9, 60 * 10**9, at_ns, signal)
    return replace(a_test(name, len(values), values={"dZ": values}), recorded={"dZ": where})


def once(*tests: TestData) -> tuple[dict[str, list[int]], list[RepeatedSamples]]:
    """(test -> its rows that still count, what was found)."""
    data, kept, found = each_once(Dataset(60.0, tests, {}), tests, lambda test: "dZ")
    assert {t.key for t in kept} <= {t.key for t in data.tests}
    return {t.test: np.flatnonzero(t.valid.get("dZ", np.ones(len(t.t_s), bool))).tolist() for t in kept}, found


def test_what_two_open_tests_share_counts_in_the_first_one_only() -> None:
    counted, [found] = once(cut("a", 0, 100), cut("b", 60, 200), cut("c", 300, 400))
    assert counted == {"a": list(range(100)), "b": list(range(40, 140)), "c": list(range(100))}
    assert (found.test.test, found.other.test, found.whole) == ("b", "a", False)


@pytest.mark.parametrize(
    "second", [cut("b", 100, 200), cut("b", 60, 200, "another day"), cut("b", 60, 200, signal="q")]
)
def test_windows_that_meet_and_other_recordings_count_in_full(second: TestData) -> None:
    counted, found = once(cut("a", 0, 100), second)
    assert found == []
    assert counted["b"] == list(range(len(second.t_s)))


def test_what_was_not_measured_in_a_shared_span_is_not_told() -> None:
    late = cut("b", 60, 200)
    values = np.where(np.arange(140) < 60, np.nan, late.values["dZ"])
    assert once(cut("a", 0, 100), replace(late, values={"dZ": values}))[1] == []


def test_a_test_of_which_no_sample_is_its_own_takes_no_part() -> None:
    counted, [found] = once(cut("a", 0, 100), cut("b", 20, 80))
    assert (list(counted), found.whole) == (["a"], True)
    two = [replace(read(name, NOISE), valid={"dZ": np.ones(30, bool)}) for name in ("a", "b")]
    counted, [found] = once(*two)
    assert (list(counted), found.whole) == (["a"], True)


def test_what_counts_once_is_told_with_its_hours() -> None:
    _, found = once(cut("a", 0, 121), cut("b", 60, 200), cut("c", 0, 60))
    told = as_told(found)
    assert [(a.kind, a.test) for a in told] == [("copy", "b"), ("copy", "c")]
    assert told[0].why.startswith("0 to 1 h of it are the recording of 'a'")
    assert told[1].why.startswith("all of it is the recording of 'a'")
