"""What is missing, told from the stored answer."""

from __future__ import annotations

import re
from pathlib import Path

from markupsafe import Markup

from thermodata.cli import main
from thermodata.store import Store
from thermodata.store.catalogue.models import load_diagnosis
from thermodata.web.pages.drawn import among, pair
from thermodata.web.pages.missing import RUNG_TARGET, STUMBLES

from .client import Client
from .conftest import client_of


def test_the_claim_stands_in_the_headline_with_what_else_it_could_be(reader: Client, made_lab: Path) -> None:
    found = load_diagnosis(
        Store(made_lab / "thermodata.store"),
        Store(made_lab / "thermodata.store").connect().execute("select model from model").fetchone()[0],
    )
    claim = next(c for c in found.candidates if c.claimed)
    text = reader.get("/missing").text
    headline = re.search(r"<h1[^>]*>(.*?)</h1>", text, re.S)[1]
    assert claim.effect in headline
    assert "probability" in headline
    for other in claim.equivalent:
        assert other in headline
    assert ("these tests can" in headline) is bool(claim.equivalent)


def test_every_rung_has_its_value_its_limit_and_its_evidence(reader: Client) -> None:
    text = reader.get("/missing").text
    assert text.count('aria-label="holds"') == 7  # a claim keeps every rule
    ids = set(re.findall(r'id="([a-z]+-\d+)"', text))
    for target in re.findall(r'<a href="#([a-z]+-\d+)">', text):
        assert target in ids
    assert set(RUNG_TARGET) == set(STUMBLES)


def test_it_says_what_was_not_asked_and_why(reader: Client) -> None:
    text = reader.get("/missing").text
    assert "effects that were not asked" in text
    assert re.search(r"no \w[\w ]* at coolant", text)


def test_a_workbench_that_only_reads_shows_the_command_instead_of_a_button(reader: Client, writer: Client) -> None:
    assert 'href="/add?' not in reader.get("/missing").text
    assert "thermodata" in re.search(r"To add it: <code>(.*?)</code>", reader.get("/missing").text)[1]
    assert 'href="/add?' in writer.get("/missing").text


def test_without_a_diagnosis_the_page_says_how_to_get_one(lab: Path) -> None:
    store = Store(lab / "thermodata.store")
    with store.write(views=False) as con:
        con.execute("delete from finding")
    text = client_of(lab)[0].get("/missing").text
    assert "was not diagnosed yet" in text
    assert "thermodata" in text
    assert 'hx-post="/task/diagnose"' in client_of(lab, write=True)[0].get("/missing").text


def test_without_a_model_the_page_says_how_to_get_one(lab: Path) -> None:
    store = Store(lab / "thermodata.store")
    with store.write() as con:
        for table in ("model", "finding", "prediction", "score_row", "fit"):
            con.execute(f"delete from {table}")
    assert "No model was fitted yet" in client_of(lab)[0].get("/missing").text


def test_abstaining_is_told_as_clearly_as_claiming(lab: Path) -> None:
    store = str(lab / "thermodata.store")
    assert main(["--store", store, "add", "baseline", "1", "--json"]) == 0
    assert main(["--store", store, "diagnose", "baseline", "--json"]) == 0
    text = client_of(lab)[0].get("/missing").text
    headline = re.search(r'<h1 class="verdict (\w+)">(.*?)</h1>', text, re.S)
    assert headline[1] == "none"
    assert "o effect is missing" in headline[2]
    assert "not claimed" in text


def test_pictures_without_a_script() -> None:
    assert 'width="50.00"' in pair(4.0, 2.0, 8.0)
    assert isinstance(among([0.0, 1.0], 5.0), Markup)
    assert "NaN" not in among([-3.0, -1.0], -2.0)
