"""A store of several campaigns: each test is shown beside a model of its own campaign, and lines say of which they
are."""

from __future__ import annotations

import html
import re
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

T_S = np.arange(60) * 60.0
# model -> (name, campaign, amplitude of its residual [um]), in the order of their fits
FITTED = {
    "a1": ("base", "summer", 8.0),
    "b1": ("base", "winter", 3.0),
    "a2": ("base", "summer", 2.0),
    "a3": ("bearing", "summer", 1.0),
}
MACHINES = {"summer": "VMC-3", "winter": "SB-42", "bare": "SB-42"}


def fit(store: Store, model: str) -> None:
    name, campaign, size = FITTED[model]
    spec = {
        "schema": "thermodata/model/1",
        "name": name,
        "campaign": campaign,
        "response": {"axis": "Z"},
        "effects": [] if model == "a1" else [{"effect": "drift"}],
    }
    y = size * np.sin(T_S / 900)
    score = score_of("day", model=model, campaign=campaign, rmse_um=size / 2)
    result = fit_of(model, [score], name=name, parent="a1" if model == "a2" else None)
    save_fit(
        store,
        spec=Model.model_validate(spec),
        result=result,
        parent=result.parent,
        predictions={(campaign, "day", "dZ"): predicts_nothing(T_S, y, drift=0.1 * y)},
        data_version="v1",
    )


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Three campaigns on two machines, each with a test 'day'; of 'bare' there is no model."""
    b = Builder(tmp_path_factory.mktemp("several") / "thermodata.store")
    for campaign in ("winter", "summer", "bare"):
        b.test(campaign, "day")
        b.channel(campaign, "day", "dZ")
        b.add("machine", campaign=campaign, test="day", machine=MACHINES[campaign], attributes="{}")
    store = b.store()
    for model in FITTED:
        fit(store, model)
    return store.path.parent


@pytest.fixture
def reader(folder: Path) -> Client:
    return client_of(folder)[0]


def rows_of(text: str) -> dict[str, str]:
    """campaign -> its row of the list."""
    rows = re.findall(r"<tr>\s*<td data-th=\"campaign\".*?</tr>", text, re.S)
    return {found[1]: row for row in rows if (found := re.search(r'class="whole">(\w+)', row))}


def errors_of(text: str) -> dict[str, str | None]:
    """campaign -> the error of its test."""
    found = {name: re.search(r'data-unit="µm">([\d.]+)<', row) for name, row in rows_of(text).items()}
    return {name: one[1] if one else None for name, one in found.items()}


def options_of(text: str, select: str) -> list[tuple[str, bool]]:
    """(text, whether it is chosen) of each option of a select."""
    found = re.search(rf'<select[^>]* name="{select}">(.*?)</select>', text, re.S)
    assert found
    options = re.findall(r"<option([^>]*)>(.*?)</option>", found[1])
    return [(html.unescape(told), "selected" in more) for more, told in options]


@pytest.mark.parametrize(
    ("asked", "errors"),
    [
        ("", {"winter": "1.50", "summer": "0.500", "bare": None}),
        ("campaign=winter", {"winter": "1.50"}),
        ("campaign=summer", {"summer": "0.500"}),
        ("campaign=bare", {"bare": None}),
        ("campaign=summer&model=a1", {"summer": "4.00"}),
        ("model=a1", {"winter": None, "summer": "4.00", "bare": None}),
        ("campaign=winter&model=a1", {"winter": "1.50"}),  # a model of another campaign predicts none of it
    ],
)
def test_a_test_stands_beside_a_model_of_its_own_campaign(
    reader: Client, asked: str, errors: dict[str, str | None]
) -> None:
    assert errors_of(reader.get(f"/?{asked}").text) == errors


def test_where_each_campaign_has_its_own_model_the_rows_name_it(reader: Client) -> None:
    text = reader.get("/").text
    rows = rows_of(text)
    assert "model of each campaign that was <b>fitted last</b>" in text
    assert "bearing 1" in rows["summer"]
    assert "base 1" in rows["winter"]
    assert "no model of bare" in rows["bare"]
    assert [o for o in options_of(text, "model") if o[1]] == []  # the first one: of each the last
    assert options_of(text, "model")[0][0] == "fitted last of each campaign"


def test_one_campaign_is_shown_with_its_scale_its_models_and_its_command(reader: Client) -> None:
    text = reader.get("/?campaign=winter").text
    assert re.search(r"Residual of <b>.*base 1.*</b> over each test, one scale", text)
    assert re.search(r"−3\.0 to \+3\.0 µm", text)
    assert re.search(r"compare b1</code>", text)
    assert len(options_of(text, "model")) == 2
    assert 'href="/missing?model=b1"' in text  # the other pages go on with it


def test_no_scale_is_made_up_where_nothing_is_predicted(reader: Client) -> None:
    text = reader.get("/?campaign=bare").text
    assert "one scale" not in text
    assert "No model of bare was fitted yet" in text


def test_lists_of_models_say_of_which_campaign_each_is(reader: Client) -> None:
    """Two campaigns have a model 'base', and 'bearing' is the name of one model only."""
    wanted = ["bearing 1 of summer", "summer/base 2", "winter/base 1", "summer/base 1"]
    pinned = [told for told, _ in options_of(reader.get("/compare").text, "pin")]
    assert pinned == wanted
    for path in ("/missing", "/report"):
        listed = [told for told, _ in options_of(reader.get(path).text, "model")]
        assert [told.split(", ")[0] for told in listed] == ["bearing 1", *wanted[1:]]
        assert listed[0].startswith("bearing 1, of summer, 1 effect")
    assert [o for o, _ in options_of(reader.get("/").text, "model")][1:] == wanted


def test_models_of_two_campaigns_side_by_side_name_the_campaign_of_each_test(reader: Client) -> None:
    text = reader.get("/compare?model=a2&model=b1&pin=a2").text
    rows = re.findall(r'<td class="name"><a href="/test[^"]*">(.*?)</a>', text)
    assert rows == ["summer/day", "winter/day"]
    assert options_of(text, "test") == [("summer/day", True)]
    assert "What each effect gives in summer/day</h2>" in text


def test_a_campaign_of_its_own_needs_no_name(reader: Client) -> None:
    text = reader.get("/compare?model=a2&model=a3&pin=a2").text
    assert options_of(text, "test") == [("day", True)]
    assert re.findall(r'<td class="name"><a href="/test[^"]*">(.*?)</a>', text) == ["day"]


def test_tests_are_found_by_their_machine_which_stands_beside_their_campaign(reader: Client) -> None:
    text = reader.get("/").text
    assert "<th>campaign, machine</th>" in text
    cells = re.findall(r'class="whole">(\w+)<br><small class="muted">([^<]+)</small></td>', text)
    assert dict(cells) == MACHINES
    assert [told for told, _ in options_of(text, "machine")] == ["all", "SB-42 (2)", "VMC-3 (1)"]
    assert [told for told, _ in options_of(text, "campaign")] == ["all", "bare (1)", "summer (1)", "winter (1)"]
    filtered = reader.get("/?machine=SB-42").text
    assert list(rows_of(filtered)) == ["bare", "winter"]
    assert "2 of 3 tests" in filtered
    assert "tests --machine SB-42" in filtered
    assert list(rows_of(reader.get("/?find=sb-42+win").text)) == ["winter"]
    assert reader.get("/?machine=SB-43").status == 400
    assert "summer on VMC-3" in reader.get("/test?campaign=summer&test=day").text


def test_the_campaigns_of_a_store_are_listed_with_their_machines(reader: Client) -> None:
    assert "bare (SB-42), summer (VMC-3), winter (SB-42)" in reader.get("/start").text
