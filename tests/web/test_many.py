"""A campaign of 1,000 tests: the list is paged and searched, and no page reads them all where one is asked for."""

from __future__ import annotations

import re
import time
from pathlib import Path

import numpy as np
import pytest

from tests.stored_fits import fit_of, predicts_nothing, score_of
from thermodata.schema.files.model import Model
from thermodata.store import Store
from thermodata.store.catalogue.models.fits import save_fit

from ..view.conftest import Builder
from .client import Client
from .conftest import client_of

TESTS = 1000


@pytest.fixture(scope="module")
def many(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """1,000 tests of an hour, and two versions of a model over all of them."""

    t_s, b = np.arange(60) * 60.0, Builder(tmp_path_factory.mktemp("many") / "store")
    names = [f"t{i:04}" for i in range(TESTS)]
    for i, test in enumerate(names):
        b.test("many", test, role="locked" if i % 10 == 9 else "calibration", kind="spindle")
        b.channel("many", test, "dZ")
        if i == 0:
            b.tidy("many", test, t_s, {"dZ": np.sin(t_s / 900)})
    store: Store = b.store()
    for version, size in (("first", 2.0), ("second", 1.0)):
        spec = Model.model_validate(
            {
                "schema": "thermodata/model/1",
                "name": "base",
                "campaign": "many",
                "response": {"axis": "Z"},
                "effects": [] if version == "first" else [{"effect": "drift"}],
            }
        )
        open_ones = [t for i, t in enumerate(names) if i % 10 != 9]
        residual = size * np.sin(t_s / 900)
        table = predicts_nothing(t_s, residual)
        scores = [score_of(t, model=version, campaign="many", rmse_um=size) for t in open_ones]
        result = fit_of(version, scores, name="base", parent=None if version == "first" else "first")
        save_fit(
            store,
            spec=spec,
            result=result,
            parent=result.parent,
            predictions={("many", t, "dZ"): table for t in open_ones},
            data_version="v1",
        )
    return store.path


@pytest.fixture
def reader(many: Path) -> Client:
    return client_of(many)[0]


def test_the_list_is_paged_and_searched(reader: Client) -> None:
    text = reader.get("/").text
    assert "1 000 tests" in text.replace("\u202f", " ")
    rows = re.findall(r'<td class="name"><a href="/test[^"]+">(t\d+)</a>', text)
    assert 20 <= len(rows) <= 200
    assert len(text) < 600_000
    assert re.findall(r'<td class="name"><a href="/test[^"]+">(t\d+)</a>', reader.get("/?find=t0123").text) == ["t0123"]
    assert re.findall(r'name"><a href="/test[^"]+">(t\d+)</a>', reader.get("/?page=2").text)[0] == f"t{len(rows):04}"


def test_compare_tells_all_of_them_in_one_page(reader: Client) -> None:
    began = time.process_time()
    text = reader.get("/compare").text
    assert time.process_time() - began < 20
    assert len(re.findall(r'<td class="name"><a href="/test', text)) == 900
    fall = -float(np.sqrt(np.mean(np.sin(np.arange(60) * 60.0 / 900) ** 2)))
    assert f'Over the calibration tests: <span class="good">−{-fall:.3g}</span>' in text  # alike in all of them
    assert text.count(" … ") >= 900  # each has its interval
    assert "t0009" not in text  # locked


@pytest.mark.parametrize("path", ["/test?campaign=many&test=t0000", "/missing", "/sql?q=select+count(*)+from+test"])
def test_other_pages_answer(reader: Client, path: str) -> None:
    began = time.process_time()
    assert reader.get(path).status == 200
    assert time.process_time() - began < 10
