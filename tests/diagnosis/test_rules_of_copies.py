"""A locked test that is a copy of an open one (locked/copies.py)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from thermodata.diagnosis.locked.copies import as_artefacts, copies
from thermodata.view.dataset import TestData

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
