"""The locked tests asked on a page: before the click it says what that opens and counts, after it what they said."""

from __future__ import annotations

import html
import re
from pathlib import Path

from thermodata.store import Store
from thermodata.store.catalogue.models.findings import load_diagnosis, save_diagnosis
from thermodata.store.catalogue.models.looks import count_locked_look, looks_of
from thermodata.view.lists.models import model_rows
from thermodata.web.render import link

from .client import Client
from .conftest import client_of
from .test_compare_and_add import finished

CHOICE = "lag:T_hall"


def looks(lab: Path) -> int:
    return max(map(len, looks_of(Store(lab / "thermodata.store"), ["small"]).values()), default=0)


def confirm_page(client: Client, model: str, candidate: str = CHOICE) -> str:
    return html.unescape(client.get(link("/confirm", model=model, candidate=candidate)).text)


def test_the_button_says_what_it_opens_and_which_look_it_is_before_it_does_it(writer: Client, lab: Path) -> None:
    store = Store(lab / "thermodata.store")
    model, before = model_rows(store)[0].model, looks(lab)
    assert before, "its claim opened the lock"
    text = confirm_page(writer, model)
    assert f"<h1>Ask the locked tests of {CHOICE}</h1>" in text
    assert re.search(rf">Open \d locked tests?: look {before + 1}</button>", text)
    assert f"every look is counted</b>: this would be look {before + 1}." in text
    row = re.search(r'<td class="name">day2</td><td class="whole">(.*?)</td>', text)
    assert row[1] == ("once" if before == 1 else f"{before} times")
    assert looks(lab) == before, "looking at the page opens nothing"


def test_what_they_said_stands_there_test_by_test_and_is_counted_once(writer: Client, lab: Path) -> None:
    store = Store(lab / "thermodata.store")
    model, before = model_rows(store)[0].model, looks(lab)
    _, onward = finished(writer, writer.post("/task/confirm", {"model": model, "candidate": CHOICE}).text)
    assert onward == link("/confirm", model=model, candidate=CHOICE)
    text = html.unescape(writer.get(onward).text)
    assert re.search(rf"<p>{CHOICE} (holds|does not hold|hardly acts)", text)
    assert re.search(r'<td class="name">day2</td>.*?<td class="n">[\d.]+ → [\d.]+</td>', text)
    assert ">Ask again</button>" in text
    assert looks(lab) == before + 1
    finished(writer, writer.post("/task/confirm", {"model": model, "candidate": CHOICE}).text)
    assert looks(lab) == before + 1, "the same question comes from the store"


def test_the_page_of_what_is_missing_leads_there_and_says_so_of_a_choice(writer: Client, lab: Path) -> None:
    store = Store(lab / "thermodata.store")
    model = model_rows(store)[0].model
    found = load_diagnosis(store, model)
    one = found.candidates[0]
    rules = [r.model_copy(update={"holds": r.name != "probability"}) for r in one.rungs]
    unlocked = {"locked_tests_asked": None, "locked_rmse_um_before": None, "locked_rmse_um_after": None}
    likely = one.model_copy(update={"claimed": False, "probability": 0.4, "rungs": rules, **unlocked})
    rival = likely.model_copy(update={"id": CHOICE, "rank": 2, "probability": 0.1})
    save_diagnosis(store, model, found.model_copy(update={"verdict": "unknown", "candidates": [likely, rival]}))
    count = looks(lab)
    text = html.unescape(writer.get("/missing").text)
    head = text.partition("</h1>")[2].partition("<section")[0]
    asks = re.escape(link("/confirm", model=model, candidate=likely.id))
    assert re.search(rf'href="{asks}">Ask the locked tests of {likely.id} …</a>', head)
    assert f"opens 1, and counts: look {count + 1}" in head
    assert "asks the locked tests of it" not in head, "the button says it"
    row = re.search(r'<table class="rivals">.*?</table>', text, re.S)[0]
    assert re.search(rf'href="{re.escape(link("/confirm", model=model, candidate=CHOICE))}"[^>]*>ask …</a>', row)
    reading = html.unescape(client_of(lab)[0].get("/missing").text)
    assert "/confirm?" not in reading
    assert "asks the locked tests of it" in reading


def test_without_a_locked_test_it_says_how_to_have_one(lab: Path) -> None:
    store = Store(lab / "thermodata.store")
    model = model_rows(store)[0].model
    with store.write() as con:
        con.execute("update test set role = 'none' where role = 'locked'")
    client = client_of(lab, write=True)[0]
    text = confirm_page(client, model)
    assert "No test is locked" in text
    assert "/task/confirm" not in text
    assert "Ask the locked tests" not in client.get("/missing").text


def test_a_workbench_that_only_reads_has_the_command(lab: Path, reader: Client) -> None:
    model = model_rows(Store(lab / "thermodata.store"))[0].model
    text = confirm_page(reader, model)
    assert "/task/confirm" not in text
    assert re.search(
        rf"This workbench only reads\. In a terminal: <code>thermodata .*confirm {model} {CHOICE}</code>", text
    )


def test_a_look_for_another_model_counts_too(writer: Client, lab: Path) -> None:
    store = Store(lab / "thermodata.store")
    model, before = model_rows(store)[0].model, looks(lab)
    count_locked_look(store, "0123456789ab", [("small", "day2")], "confirming lag:T_nut, by choice")
    assert f": look {before + 2}</button>" in confirm_page(writer, model)
    assert writer.get(f"/confirm?model={model}").status == 400
