"""The models to tick on the page Compare, how twins are told apart, and models that predict different tests."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from tests.stored_fits import fit_of, predicts_nothing, score_of
from thermodata.cli import main
from thermodata.modelling.named import newest_model
from thermodata.schema.files.model import Model
from thermodata.store import Store
from thermodata.store.catalogue.models.findings import save_diagnosis
from thermodata.store.catalogue.models.fits import find_model, save_fit
from thermodata.view.lists.models import model_rows

from ..answers import diagnosis
from ..view.conftest import Builder
from .client import Client
from .conftest import client_of

MODELS = 15


def identity(number: int) -> str:
    return f"{number:x}".ljust(12, "0")


@pytest.fixture(scope="module")
def client(tmp_path_factory: pytest.TempPathFactory) -> Client:
    """15 fits of one edited file on a temperature; the last predicts one of the two tests only."""

    folder = tmp_path_factory.mktemp("models") / "store"
    t_s, b = np.arange(60) * 60.0, Builder(folder)
    for test in ("a", "b"):
        b.test("c", test, role="calibration", kind="spindle")
        b.channel("c", test, "T_nut", quantity="temperature", unit="degC")
        b.tidy("c", test, t_s, {"T_nut": 20 + np.sin(t_s / 900)})
    store = b.store()
    for i in range(MODELS):
        name = identity(i)
        spec = Model.model_validate(
            {
                "schema": "thermodata/model/1",
                "name": "rev",
                "campaign": "c",
                "response": {"channel": "T_nut"},
                "effects": [{"effect": "drift"}],
            }
        )
        left = np.sin(t_s / 900)
        table = predicts_nothing(t_s, left)
        tests = ("a",) if i == MODELS - 1 else ("a", "b")
        scores = [score_of(t, model=name, response="T_nut", rmse_um=9.0 if t == "b" else 3.0) for t in tests]
        result = fit_of(name, scores, name="rev")
        save_fit(
            store, spec=spec, result=result, parent=None, data_version="v1",
            predictions={("c", t, "T_nut"): table for t in tests},
        )  # fmt: skip
    newest = model_rows(store)[0].model
    save_diagnosis(
        store,
        newest,
        diagnosis(model=newest, response="T_nut", verdict="none", rmse_um=0.5, explainable=0.0),
    )  # fmt: skip
    return client_of(store.path)[0]


def test_every_model_can_be_ticked_and_twins_are_told_apart(client: Client) -> None:
    page = client.get("/compare").text
    ticks = re.findall(r'name="model" value="(\w+)"[^>]*> ([^<]+) <span class="muted">([^<]+)<', page)
    assert len({model for model, _, _ in ticks}) == MODELS
    assert len({label for _, label, _ in ticks}) == MODELS
    assert all(model[:6] in label for model, label, _ in ticks)
    assert all(re.fullmatch(r"1 effect, \d{4}-\d\d-\d\d \d\d:\d\d", about) for _, _, about in ticks)
    assert f"<summary>{MODELS - 12} older models</summary>" in page


def test_the_ticked_models_stand_first(client: Client) -> None:
    page = client.get(f"/compare?model={identity(0)}&model={identity(5)}&pin={identity(5)}").text
    ticks = re.findall(r'name="model" value="(\w+)"( checked)?', page)
    assert ticks[:2] == [(identity(5), " checked"), (identity(0), " checked")]
    assert len(ticks) == MODELS


def test_pages_take_the_model_that_commands_take_where_none_is_named(lab: Path) -> None:
    at = ["--store", str(lab / "thermodata.store"), "fit"]
    other = lab / "other.yaml"
    other.write_text((lab / "baseline.yaml").read_text().replace("name: baseline", "name: other"))
    store, client = Store(lab / "thermodata.store"), client_of(lab)[0]
    for path in (other, lab / "baseline.yaml"):  # the second one was fitted before
        assert main([*at, str(path), "--json"]) == 0
        last = newest_model(store)
        assert find_model(store, last).name == path.stem
        for page in ("/", "/missing", "/report", "/test?campaign=small&test=day1"):
            assert (
                re.findall(r'<option value="(\w+)" selected>', client.get(page).text.split('name="model"')[1])[0]
                == last
            ), page
        assert f'value="{last}" checked' in client.get("/compare").text


def test_a_ticked_model_is_never_folded_up(client: Client) -> None:
    page = client.get(f"/compare?model={identity(0)}&model={identity(1)}").text
    assert page.index(f'value="{identity(0)}" checked') < page.index("<summary>1 older model</summary>")


def test_models_are_compared_over_what_all_of_them_predict(client: Client) -> None:
    page = client.get(f"/compare?model={identity(0)}&model={identity(MODELS - 1)}").text
    assert "calibration 3.00 → 3.00 K" in re.sub(r"\s+", " ", page)
    # a label is a name, and keeps its small letter
    assert re.search(
        r">rev 1 \(\w+\) predicts 1 of 2 tests not: c/b; errors are over the 1 that all of them predict.", page
    )
    assert "hatched is not measured, or not predicted." in page


def test_pages_of_a_temperature_are_in_kelvin(client: Client) -> None:
    words = re.sub(r"<(script|style).*?</\1>|<[^>]+>", " ", client.get("/missing").text, flags=re.DOTALL)
    assert "0.500 K are left on left-out tests" in words
    assert not re.search(r"\d\s(um|µm)", words)
    assert client.get("/test?campaign=c&test=a").text.count("µm") == 0
