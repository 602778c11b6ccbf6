"""Tests that a model file names, and what is offered in place of one that there is not."""

from __future__ import annotations

from dataclasses import replace

import pytest

from thermodata.errors import UsageError
from thermodata.modelling.inputs.roles import find_tests
from thermodata.view.grid.dataset import Dataset


@pytest.mark.parametrize(
    ("name", "hint", "offered"),
    [
        ("two/t9", "two/t0", ["two/only", "two/t0"]),  # never another campaign's
        ("t9", None, ["c/t0", "only", "two/t0"]),  # a bare name that would find two is none
        ("onyl", "only", ["c/t0", "only", "two/t0"]),
        ("three/t0", None, ["c/t0", "only", "two/t0"]),
    ],
)
def test_what_is_offered_finds_one_test_of_the_campaign_that_was_named(
    world: Dataset, name: str, hint: str | None, offered: list[str]
) -> None:
    first = world.tests[0]
    data = replace(world, tests=(first, replace(first, campaign="two"), replace(first, campaign="two", test="only")))
    with pytest.raises(UsageError) as refused:
        find_tests([name], data, "locked")
    assert str(refused.value.expected).split(", ") == offered
    for one in offered:
        assert len(find_tests([one], data, "locked")) == 1
    if hint is not None:
        assert hint in str(refused.value.hint)
