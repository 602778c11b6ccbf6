"""The page Compare of a model with responses in two units."""

from __future__ import annotations

import json
import re

import numpy as np
import pytest

from tests.stored_fits import fit_of, predicts_nothing, score_of
from thermodata.schema.files.model import Model
from thermodata.store.catalogue.models.fits import save_fit

from ..view.conftest import Builder
from .client import Client
from .conftest import client_of

MODEL = "a" * 12
RESPONSES = ("dZ", "T_nut")


@pytest.fixture(scope="module")
def client(tmp_path_factory: pytest.TempPathFactory) -> Client:
    """One model of a displacement, which it misses by 30 um, and of a temperature, which it misses by 0.2 K."""

    folder = tmp_path_factory.mktemp("models") / "store"
    t_s, b = np.arange(60) * 60.0, Builder(folder)
    course = np.sin(t_s / 900)
    b.test("c", "a", role="calibration", kind="spindle")
    b.channel("c", "a", "dZ", quantity="displacement", unit="um")
    b.channel("c", "a", "T_nut", quantity="temperature", unit="degC")
    b.tidy("c", "a", t_s, {"dZ": 30 * course, "T_nut": 20 + course})
    store = b.store()
    spec = Model.model_validate(
        {
            "schema": "thermodata/model/1",
            "name": "both",
            "campaign": "c",
            "response": [{"channel": name} for name in RESPONSES],
            "effects": [{"effect": "drift"}],
        }
    )
    left = {"dZ": 30 * course, "T_nut": 0.2 * course}
    tables = {("c", "a", name): predicts_nothing(t_s, y) for name, y in left.items()}
    scores = [
        score_of("a", model=MODEL, response=name, fit=0.0, rmse_um=rmse)
        for name, rmse in (("dZ", 30.0), ("T_nut", 0.2))
    ]
    result = fit_of(MODEL, scores, name="both")
    save_fit(store, spec=spec, result=result, parent=None, data_version="v1", predictions=tables)
    return client_of(store.path)[0]


def test_each_row_of_errors_is_in_the_unit_of_its_response(client: Client) -> None:
    page = client.get("/compare").text
    table = page[page.index("Test by test") :]
    heads = re.findall(r"<th[^>]*>([^<]*)</th>", table[: table.index("</thead>")])
    assert not any("µm" in head for head in heads)
    assert "<td>dZ [µm]</td>" in table
    assert "<td>T_nut [K]</td>" in table


@pytest.mark.parametrize(("response", "unit"), [("dZ", "um"), ("T_nut", "K")])
def test_charts_of_a_residual_are_in_the_unit_of_its_response(client: Client, response: str, unit: str) -> None:
    page = client.get(f"/compare?response={response}&over=T_nut").text
    chart = re.search(r'<script type="application/json" id="against">(.*?)</script>', page, flags=re.DOTALL)
    assert chart is not None
    assert json.loads(chart[1])["panels"][0]["unit"] == unit


def test_what_is_not_of_all_responses_says_of_which_it_is(client: Client) -> None:
    words = re.sub(r"<[^>]+>", " ", client.get("/compare?response=T_nut").text)
    assert "Of dZ: calibration 30.0" in words
    assert "Of T_nut. One scale for all" in words
    assert "Of T_nut in both 1, all open tests together" in words
    assert re.search(r"<option selected>T_nut</option>", client.get("/compare?response=T_nut").text)


def test_each_contribution_is_in_the_unit_of_its_response(client: Client) -> None:
    page = client.get("/compare").text
    parts = page[page.index('id="contributions"') : page.index("Test by test")].split("<h3>")[1:]
    # in the order of the model
    assert [(part.partition("<")[0], set(re.findall(r"at most \[([^]]+)\]", part))) for part in parts] == [
        ("dZ", {"µm"}),
        ("T_nut", {"K"}),
    ]


def test_the_page_missing_says_which_response_its_errors_are_of(client: Client) -> None:
    assert "error of dZ 30.0 µm in calibration" in re.sub(r"\s+", " ", client.get("/missing").text)
