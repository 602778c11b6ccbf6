"""A search of many parameters says how far it is, and before that it takes long; one of few says nothing."""

from __future__ import annotations

import warnings

import pytest

from thermodata.modelling.fit.model import fit_model
from thermodata.modelling.least_squares import search
from thermodata.modelling.terms.fitted import FittedModel
from thermodata.schema.files.model import Model
from thermodata.store.base.counting import watched
from thermodata.view.grid.dataset import Dataset

from .conftest import Spec

Told = list[tuple[str, int, int]]


@pytest.fixture
def of_two(spec: Spec) -> Model:
    """Two time constants."""
    return spec("spindle_bearing", "feed_screw")


def fitted(model: Model, data: Dataset) -> tuple[FittedModel, Told]:
    told: Told = []
    with watched(lambda what, done, total: told.append((what, done, total))):
        found = fit_model(model, data, uncertainty=False)
    return found, [one for one in told if one[0] != "responses"]


def test_a_search_of_few_says_nothing(world: Dataset, of_two: Model) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert fitted(of_two, world)[1] == []


@pytest.mark.parametrize(("least", "tells"), [(2, True), (3, False)])
def test_from_so_many_parameters_on_it_says_how_far_it_is_and_finds_the_same(
    world: Dataset, of_two: Model, monkeypatch: pytest.MonkeyPatch, least: int, tells: bool
) -> None:
    before, _ = fitted(of_two, world)
    monkeypatch.setattr(search, "TOLD", least)
    after, told = fitted(of_two, world)
    assert bool(told) == tells
    assert [t.params for t in after.responses[0].terms] == [t.params for t in before.responses[0].terms]
    if tells:
        assert all(0 <= done <= total for _, done, total in told)
        assert {what for what, _, _ in told} == {
            "parameters, over their range",
            "parameters, nearby",
            "parameters, along their range",
            "looks, at most",
        }


@pytest.mark.parametrize(("least", "warns"), [(2, True), (3, False)])
def test_from_so_many_parameters_on_it_says_before_that_it_takes_long(
    world: Dataset, of_two: Model, monkeypatch: pytest.MonkeyPatch, least: int, warns: bool
) -> None:
    monkeypatch.setattr(search, "LONG", least)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("default")
        fit_model(of_two, world, uncertainty=False)
    said = [str(w.message) for w in caught if "searched together" in str(w.message)]
    assert [text.startswith("2 parameters of 'dZ' are searched together") for text in said] == [True] * warns
