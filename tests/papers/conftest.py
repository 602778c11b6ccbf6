"""Commands fit again what they tell of; here each fit is searched once."""

from __future__ import annotations

import hashlib
import pickle
from collections.abc import Iterator, Mapping
from dataclasses import fields
from typing import Any

import pytest

from thermodata.modelling import run
from thermodata.modelling.terms.fitted import FittedModel
from thermodata.schema.files.model import Model
from thermodata.view.grid.dataset import Dataset


def _content(value: Any) -> Any:
    return dict(value) if isinstance(value, Mapping) else value


def _asked(spec: Model, data: Dataset, uncertainty: bool) -> bytes:
    """All that a fit comes from."""
    tests = [[_content(getattr(t, f.name)) for f in fields(t) if f.name != "kept"] for t in data.tests]
    whole = [_content(getattr(data, f.name)) for f in fields(data) if f.name != "tests"]
    return hashlib.sha256(pickle.dumps((spec.model_dump_json(by_alias=True), uncertainty, whole, tests))).digest()


@pytest.fixture(scope="module", autouse=True)
def fits_once() -> Iterator[None]:
    """A model that is fitted to the same data again is the one that was found. That the search finds it again is held
    in tests/modelling."""
    search, found = run.fit_model, dict[bytes, FittedModel]()

    def once(spec: Model, data: Dataset, *, uncertainty: bool = True) -> FittedModel:
        asked = _asked(spec, data, uncertainty)
        if asked not in found:
            found[asked] = search(spec, data, uncertainty=uncertainty)
        return found[asked]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(run, "fit_model", once)
        yield
