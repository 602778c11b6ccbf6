"""What is missing, told from the stored answer."""

from __future__ import annotations

import html
import re
from pathlib import Path

import pytest
from markupsafe import Markup

from thermodata.cli import main
from thermodata.report.text.clauses import clauses
from thermodata.report.verdict.verdict import causes, verdict_sentence
from thermodata.report.words.numbers import typeset
from thermodata.schema.answers.candidate import Rung
from thermodata.schema.answers.confirmed import Confirmed
from thermodata.schema.answers.diagnosis import Artefact, Diagnosis
from thermodata.schema.answers.missing_heat import HeatCourse, MissingHeat, Unknown
from thermodata.store import Store
from thermodata.store.catalogue.models.findings import keep_answer, load_diagnosis, save_diagnosis
from thermodata.store.catalogue.models.fits import find_model
from thermodata.store.catalogue.models.looks import count_locked_look
from thermodata.store.catalogue.models.stale import fitted_again
from thermodata.web.pages.missing import RUNG_TARGET, STUMBLES, _stumbles
from thermodata.web.pages.parts.drawn import among, pair
from thermodata.web.render import begun, link

from ..answers import candidate
from .client import Client
from .conftest import client_of


def diagnosed(lab: Path) -> tuple[Store, str, Diagnosis]:
    """The store of a lab, its first model, and what was found missing in it."""
    store = Store(lab / "thermodata.store")
    model = store.connect().execute("select model from model").fetchone()[0]
    return store, model, load_diagnosis(store, model)


def test_the_headline_is_the_sentence_of_the_terminal(reader: Client, made_lab: Path) -> None:
    _, _, found = diagnosed(made_lab)
    claim = next(c for c in found.candidates if c.claimed)
    text = reader.get("/missing").text
    headline = re.search(r"<h1[^>]*>(.*?)</h1>", text, re.S)[1]
    assert claim.effect in headline
    assert "probability" in headline
    rest = re.findall(r"<li>(.*?)</li>", re.search(r'<ul class="further">(.*?)</ul>', text, re.S)[1], re.S)
    assert [html.unescape(shown).strip() for shown in (headline, *rest)] == [
        typeset(part[:1].upper() + part[1:]) for part in clauses(verdict_sentence(found))
    ], "its first clause in bold, each of the rest below"


def test_every_rung_has_its_value_its_limit_and_its_evidence(reader: Client) -> None:
    text = reader.get("/missing").text
    assert text.count('aria-label="holds"') == 7  # a claim keeps every rule
    ids = set(re.findall(r'id="([a-z]+-\d+)"', text))
    for target in re.findall(r'<a href="#([a-z]+-\d+)">', text):
        assert target in ids
    assert set(RUNG_TARGET) == set(STUMBLES)
    assert ">how probable it is, all weighed</a>" in text


def test_an_answer_that_is_older_than_the_data_says_so(lab: Path) -> None:
    store = Store(lab / "thermodata.store")
    model = store.connect().execute("select model from model").fetchone()[0]
    client = client_of(lab, write=True)[0]
    said = "This answer is older than the data"
    assert said not in client.get("/missing").text
    found = load_diagnosis(store, model)
    save_diagnosis(store, model, found.model_copy(update={"data_version": "another"}))
    assert said in client.get("/missing").text
    assert f"diagnose {model}" in client.get("/missing").text
    # the same model, fitted to the data as they are now and diagnosed
    path = lab / "campaign.yaml"
    path.write_text(path.read_text().replace("role: verification", "role: calibration"))
    words = ("--store", str(lab / "thermodata.store"))
    for more in (["ingest", str(path)], ["fit", model]):
        assert main([*words, *more, "--json"]) == 0
    again = fitted_again(Store(lab / "thermodata.store"), find_model(store, model))
    assert again is not None
    client = client_of(lab, write=True)[0]
    page = f"/missing?model={model}"
    assert "the same model fitted to them" not in client.get(page).text, "nobody asked that fit"
    save_diagnosis(store, again, found.model_copy(update={"model": again, "data_version": None}))
    assert f'<a href="/missing?model={again}">' in client.get(page).text


def test_each_look_at_a_locked_test_is_told_with_what_it_was_for(lab: Path) -> None:
    store = Store(lab / "thermodata.store")
    model = store.connect().execute("select model from model").fetchone()[0]
    campaign, test = store.connect().execute("select campaign, test from test limit 1").fetchone()
    client = client_of(lab, write=True)[0]
    for k, number in enumerate(("once", "2 times")):
        count_locked_look(store, "0123456789ab" if k else model, [(campaign, test)], f"confirming lag:T_{k}, by choice")
        assert f"{test} was opened {number} (" in client.get("/missing").text
    assert (
        f"{model[:6]}: confirming lag:T_0, by choice; 012345: confirming lag:T_1, by choice"
        in client.get("/missing").text
    )
    count_locked_look(store, model, [(campaign, test)] * 6, "confirming lag:T_2, by choice")
    assert f"{test} was opened 8 times (2 before; {model[:6]}: confirming lag:T_2" in client.get("/missing").text


def test_a_refinement_is_added_by_its_own_name(lab: Path) -> None:
    store, model, found = diagnosed(lab)
    one = next(c for c in found.candidates if c.claimed)
    other = {"id": "gain_by:lag,conditions.tool", "effect": "lag", "claimed": False, "refinement": True}
    fresh = [one.model_copy(update=other), *(c for c in found.candidates if c is not one)]
    save_diagnosis(store, model, found.model_copy(update={"candidates": fresh}))
    assert ">Add gain_by:lag,conditions.tool …</a>" in client_of(lab, write=True)[0].get("/missing").text
    # what lets no error fall has no button of its own
    errors = {"rmse_um_before": 1.0, "rmse_um_after": 0.999, "acting_um_before": 0.5, "acting_um_after": 0.6}
    rungs = [r.model_copy(update={"value": -0.2, "holds": False}) if r.name == "fall" else r for r in one.rungs]
    fresh[0] = fresh[0].model_copy(update={**errors, "rungs": rungs})
    save_diagnosis(store, model, found.model_copy(update={"candidates": fresh}))
    text = client_of(lab, write=True)[0].get("/missing").text
    assert ">Add gain_by:lag,conditions.tool …</a>" not in text
    assert "Left-out tests are foretold hardly better (1.00" in text
    assert "so adding it is not advised.</p>" in text


def test_a_slip_that_was_told_is_taken_out_by_a_click(lab: Path) -> None:
    store = Store(lab / "thermodata.store")
    campaign, test = store.connect().execute("select campaign, test from test limit 1").fetchone()
    model = store.connect().execute("select model from model").fetchone()[0]
    found = load_diagnosis(store, model)
    slip = Artefact(kind="step", campaign=campaign, test=test, at_s=7200.0, size_um=9.0, why="the displacement jumps")
    save_diagnosis(store, model, found.model_copy(update={"artefacts": [slip]}))
    client, _ = client_of(lab, write=True)
    (address,) = re.findall(r'href="([^"]*)">Fit without it</a>', client.get("/missing").text)
    text = client.get(html.unescape(address)).text
    assert f"<h1>Add step:{test}</h1>" in text
    assert "is fitted to the same tests without this step of the probe" in text
    assert "The displacement jumps." in text
    assert "It was not claimed" not in text


def test_of_several_claims_one_click_or_one_command_adds_them_all(lab: Path) -> None:
    store, model, found = diagnosed(lab)
    one = next(c for c in found.candidates if c.claimed)
    other = one.model_copy(update={"id": "coolant:coolant_on", "effect": "coolant", "rank": 2})
    for claims, several in (([one], False), ([one, other], True)):
        save_diagnosis(store, model, found.model_copy(update={"candidates": claims}))
        said = re.findall(r"To have both: <code>(.*?)</code>", client_of(lab)[0].get("/missing").text)
        assert [line.split("add ")[1] for line in said] == [f"{model} {one.id} coolant:coolant_on"] * 2 * several
        text = client_of(lab, write=True)[0].get("/missing").text
        assert "To have both" not in text
        ways = {html.unescape(way) for way in re.findall(r'href="([^"]*)">Add both …</a>', text)}
        assert ways == ({link("/add", model=model, candidate=[one.id, "coolant:coolant_on"])} if several else set())


def test_several_claims_have_a_line_each_below_a_short_head_and_all_but_the_first_are_folded(lab: Path) -> None:
    store, model, found = diagnosed(lab)
    one = next(c for c in found.candidates if c.claimed)
    other = one.model_copy(update={"id": "coolant:coolant_on", "effect": "coolant", "rank": 2})
    both = found.model_copy(update={"candidates": [one, other]})
    save_diagnosis(store, model, both)
    text = html.unescape(client_of(lab)[0].get("/missing").text)
    assert '<h1 class="verdict effect">Missing: 2 effects</h1>' in text
    rest = re.findall(r"<li>(.*?)</li>", re.search(r'<ul class="further">(.*?)</ul>', text, re.S)[1], re.S)
    assert rest[:2] == [typeset(causes([c])) for c in (one, other)]
    assert len(rest) == 1 + len(clauses(verdict_sentence(both))), "and every further clause"
    assert text.count("<summary>Where it acts, and why it is claimed</summary>") == 1
    cards = re.findall(r'<section class="card candidate.*?</section>', text, re.S)
    assert [card.count("<details") == card.count("</details>") for card in cards] == [True, True]
    assert ["Where it acts, and why" in card for card in cards] == [False, True]


def test_noise_is_told_by_what_it_does_and_one_alone_beside_what_all_take_away(lab: Path) -> None:
    store, model, found = diagnosed(lab)
    one = next(c for c in found.candidates if c.claimed)
    other = one.model_copy(update={"id": "coolant:coolant_on", "effect": "coolant", "rank": 2})
    more = {"noise_um": 0.05, "noise_over_s": 60.0, "rmse_um": 8.0, "named_rmse_um": 4.0}
    alone = {"explainable": 0.7, "explainable_by": "lag:T_hall"}
    save_diagnosis(store, model, found.model_copy(update={"candidates": [one, other], **more, **alone}))
    text = html.unescape(client_of(lab)[0].get("/missing").text)
    assert "Noise 0.0500\N{NO-BREAK SPACE}µm: how far a mean of 60 s scatters about its course by chance" in text
    assert "both together take away 75\N{NO-BREAK SPACE}% of the squared residual, the best candidate alone" in text
    assert "lag:T_hall, 70\N{NO-BREAK SPACE}%, which by itself names no cause" in text


def test_what_is_added_together_is_told_one_by_one(lab: Path) -> None:
    store = Store(lab / "thermodata.store")
    model = store.connect().execute("select model from model").fetchone()[0]
    one = next(c for c in load_diagnosis(store, model).candidates if c.claimed)
    client = client_of(lab, write=True)[0]
    text = html.unescape(client.get(link("/add", model=model, candidate=[one.id, "lag:T_hall"])).text)
    assert f"<h1>Add {one.id} and lag:T_hall</h1>" in text
    assert re.search(rf'<h2>{one.id} <span class="badge good">claimed</span></h2>', text)
    assert re.search(r"<h2>lag:T_hall <span", text)
    assert f'name="candidate" value="{one.id}\nlag:T_hall"' in text
    assert re.search(rf"<code>thermodata .*add {model} {one.id} lag:T_hall</code>", text)
    assert 'hx-confirm="lag:T_hall was not claimed.' in text
    assert ">Add both</button>" in text
    assert client.get(link("/add", model=model, candidate=[one.id, "lag:T_nowhere"])).status == 400


@pytest.mark.parametrize(
    ("after", "said", "never"),
    [(5.17, "the error rises", "hardly falls"), (4.67, "the error hardly falls", "the error rises")],
)
def test_an_error_that_rises_is_not_said_to_fall(lab: Path, after: float, said: str, never: str) -> None:
    store, model, found = diagnosed(lab)
    one = next(c for c in found.candidates if c.claimed)
    rungs = [r.model_copy(update={"holds": False}) if r.name == "fall" else r for r in one.rungs]
    errors = {"rmse_um_before": 4.68, "rmse_um_after": after}
    rival = one.model_copy(update={"id": "lag:T_x", "claimed": False, "rank": 2, "rungs": rungs, **errors})
    save_diagnosis(store, model, found.model_copy(update={"candidates": [one, rival]}))
    text = client_of(lab)[0].get("/missing").text
    assert said in text
    assert never not in text


def test_errors_that_others_share_are_said_to_be_theirs_too(lab: Path) -> None:
    """Where a candidate is judged beside one that nobody adds, its error is none that adding it gives."""
    store = Store(lab / "thermodata.store")
    model = store.connect().execute("select model from model").fetchone()[0]
    found = load_diagnosis(store, model)
    one = next(c for c in found.candidates if c.claimed)
    parts = [
        p.model_copy(update={"test": one.left_out[0].test, "from_s": 60.0 * i}) for i, p in enumerate(one.left_out)
    ]
    claim = one.model_copy(
        update={"beside": ["lag:T_x"], "left_out": parts, "rmse_um_before": 2.48, "rmse_um_after": 1.34}
    )
    rival = claim.model_copy(update={"id": "lag:T_y", "claimed": False, "rank": 2, "rungs": [], "rmse_um_after": 2.0})
    own = {"rmse_um": 2.41, "named_rmse_um": 2.33}
    save_diagnosis(store, model, found.model_copy(update={"candidates": [claim, rival], **own}))
    client = client_of(lab, write=True)[0]
    text = client.get("/missing").text
    assert "Error on left-out parts of 1 test <b>2.48 → 1.34 µm</b> (both with lag:T_x, which adding this alone" in text
    assert re.search(r'lag:T_y</td>.*<td class="muted">lag:T_x</td>', text.replace("<wbr>", ""))
    offer = client.get(link("/add", model=model, candidate=one.id)).text
    assert "(both with lag:T_x, which adding this alone does not bring)" in offer
    assert "With it added, on left-out parts of 1 test: <b>2.41 → 2.33 µm</b>" in offer


@pytest.mark.parametrize(
    ("value", "why", "said"),
    [
        (0.08, "alone it falls; it is judged beside others: where it acts", "the error hardly falls beside others"),
        (-0.1, "alone it falls; it is judged beside others: where it acts", "the error rises beside others"),
        (0.08, "where it acts", "the error hardly falls where it acts"),
    ],
)
def test_a_rule_that_looks_at_other_errors_than_those_of_its_row_says_so(value: float, why: str, said: str) -> None:
    rung = Rung(name="fall", asks="fall", value=value, unit="1", at="least", limit=0.15, holds=False)
    row = candidate("lag:T", rmse_um_before=2.41, rmse_um_after=1.85, why=why, rungs=[rung])
    assert _stumbles(row, rung) == said
    unlikely = rung.model_copy(update={"name": "probability", "value": 0.36, "limit": 0.65})
    assert _stumbles(row, unlikely) == "not likely enough (36 %)"


def test_what_was_confirmed_by_choice_is_told_and_not_proposed_again(lab: Path) -> None:
    store = Store(lab / "thermodata.store")
    model = store.connect().execute("select model from model").fetchone()[0]
    found = load_diagnosis(store, model)
    rules = [r.model_copy(update={"holds": r.name != "probability"}) for r in found.candidates[0].rungs]
    likely = found.candidates[0].model_copy(
        update={"claimed": False, "probability": 0.4, "rungs": rules, "locked_tests_asked": None}
    )
    save_diagnosis(store, model, found.model_copy(update={"verdict": "unknown", "candidates": [likely]}))
    asks = f"confirm {model[:8]} {likely.id}"
    text = html.unescape(client_of(lab)[0].get("/missing").text)
    assert f"<li>thermodata {asks} asks the locked tests of it" in text, "a command is typed as it stands"
    assert re.search(rf'data-copy="thermodata .*confirm {model} {likely.id}"', text)
    answer = Confirmed(
        model=model, response="dZ", candidate=likely.id, holds=True, locked_rmse_um_before=11.7,
        locked_rmse_um_after=7.04, parameters={}, tests=[], looks=1,
    )  # fmt: skip
    keep_answer(store, model, f"confirm {likely.id}", "k", answer.model_dump_json())
    text = html.unescape(client_of(lab)[0].get("/missing").text)
    assert f"Asked by choice: {likely.id} holds on the locked tests: 11.7 → 7.04\N{NO-BREAK SPACE}µm." in text
    assert f"thermodata {asks}" not in text


def test_what_cant_be_told_from_the_claim_does_not_stumble_over_it(lab: Path) -> None:
    store, model, found = diagnosed(lab)
    one = next(c for c in found.candidates if c.claimed)
    rival = one.model_copy(update={"id": "lag:T_nut", "claimed": False, "rank": 2, "why": "", "locked_tests_asked": 0})
    claim = one.model_copy(update={"equivalent": ["lag:T_nut"]})
    save_diagnosis(store, model, found.model_copy(update={"candidates": [claim, rival]}))
    text = client_of(lab)[0].get("/missing").text
    assert "these tests can’t tell it from what is claimed" in text
    assert "the claim explains it, or more" not in text


def test_a_twin_of_the_claim_is_told_as_one_though_a_rule_fails_beside_it(lab: Path) -> None:
    store, model, found = diagnosed(lab)
    one = next(c for c in found.candidates if c.claimed)
    rungs = [r.model_copy(update={"holds": False}) if r.name == "worth" else r for r in one.rungs]
    less = {"claimed": False, "rungs": rungs, "locked_tests_asked": 0}
    twin = one.model_copy(update={"id": "lag:T_nut", "rank": 2, **less})
    other = one.model_copy(update={"id": "lag:T_far", "rank": 3, **less})
    claim = one.model_copy(update={"equivalent": ["lag:T_nut"]})
    save_diagnosis(store, model, found.model_copy(update={"candidates": [claim, twin, other]}))
    text = client_of(lab)[0].get("/missing").text
    rows = dict(re.findall(r'<td class="name">(lag:T_\w+)</td><td>(.*?)</td>', text.replace("<wbr>", "")))
    assert "these tests can’t tell it" in rows["lag:T_nut"]
    assert "too small" not in rows["lag:T_nut"]
    assert "too small" in rows["lag:T_far"]


def test_pictures_come_before_the_rules_behind_them(reader: Client) -> None:
    text = reader.get("/missing").text
    card = re.search(r'<section class="card candidate claimed".*?</section>', text, re.S)[0]  # type: ignore[index]
    assert card.index("Error on left-out tests") < card.index("The residual with its contribution")
    assert card.index("foretold by the others") < card.index('class="ladder"')
    assert re.search(r'<details class="why" open><summary>Why it is claimed', card)


def test_what_a_claim_is_not_told_from_stands_once_in_the_headline(lab: Path) -> None:
    store, model, found = diagnosed(lab)
    twins = ["feed_motor:T_bearing", "lag:T_nut_Z"]
    fresh = [c.model_copy(update={"equivalent": twins}) if c.claimed else c for c in found.candidates]
    save_diagnosis(store, model, found.model_copy(update={"candidates": fresh}))
    text = client_of(lab)[0].get("/missing").text
    headline = re.search(r"<h1[^>]*>(.*?)</h1>", text)[1]  # type: ignore[index]
    assert headline.count("not told from feed_motor (T_bearing)") == 1
    assert "lag" not in headline, "which is no cause of its own; it stands with all twins below"
    assert "can&#39;t tell it from</b> feed_motor:T_bearing, lag:T_nut_Z" in text.replace("'", "&#39;")


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
    for page in ("/missing", "/compare", "/report"):
        assert 'href="/start#model">Fit a first model' in client_of(lab)[0].get(page).text


def test_abstaining_is_told_as_clearly_as_claiming(lab: Path) -> None:
    store = str(lab / "thermodata.store")
    assert main(["--store", store, "add", "baseline", "1", "--json"]) == 0
    assert main(["--store", store, "diagnose", "baseline", "--json"]) == 0
    text = client_of(lab)[0].get("/missing").text
    headline = re.search(r'<h1 class="verdict (\w+)">(.*?)</h1>', text, re.S)
    assert headline[1] == "none"
    assert "show no missing effect" in headline[2]
    assert "not claimed" in text


def test_what_nothing_logged_explains_is_drawn_and_the_next_test_is_said_beside_a_candidate(lab: Path) -> None:
    store, model, found = diagnosed(lab)
    course = HeatCourse(
        campaign="small",
        test="day1",
        from_s=0.0,
        step_s=600.0,
        source_um=[0.0, 8.0, 8.0, 0.0],
        contribution_um=[-2.0, 0.0, 2.0, 0.5],
        residual_um=[None, 0.1, 2.1, 0.4],
    )
    heat = MissingHeat(
        time_constant_h=0.67,
        time_constant_low_h=None,
        time_constant_high_h=1.5,
        direction="+",
        agreed=0.93,
        explained=0.99,
        left_out=0.91,
        hours_of_day=[],
        strong_tests=["day1"],
        weak_tests=["day2"],
        goes_with=[],
        goes_not_with=[],
        where="a body near <coolant>",
        courses=[course, course.model_copy(update={"test": "day2"})],
    )
    unclaimed = [c.model_copy(update={"claimed": False}) for c in found.candidates]
    unknown = Unknown(time_constants_h=[0.7], hours_of_day=[], states=[], heat=heat)
    changed = {"verdict": "unknown", "candidates": unclaimed, "unknown": unknown, "next_test": "run <axis> Z alone"}
    save_diagnosis(store, model, found.model_copy(update=changed))
    text = client_of(lab)[0].get("/missing").text
    card = re.search(r'<section class="card" id="heat">(.*?)</section>', text, re.S)[1]
    assert "a body near &lt;coolant&gt;" in card
    assert re.findall(r'<script type="application/json" id="(heat\d)">', card) == ["heat0", "heat1"]
    assert re.search(r'day1 <span class="badge bad">strong.*day2 <span class="badge">absent', card, re.S)
    assert "Run &lt;axis&gt; Z alone" in re.search(r'id="next">(.*?)</section>', text, re.S)[1]


def test_pictures_without_a_script() -> None:
    assert 'width="50.00"' in pair(4.0, 2.0, 8.0)
    assert isinstance(among([0.0, 1.0], 5.0), Markup)
    assert "NaN" not in among([-3.0, -1.0], -2.0)


def test_counts_shares_and_limits_have_no_zeros_that_say_nothing(reader: Client) -> None:
    cells = re.findall(r'<td class="n(?: muted)?">(.*?)</td>', reader.get("/missing").text)
    told = [n for cell in cells if "µm" not in cell and "→" not in cell for n in re.findall(r"\d+\.\d+", cell)]
    assert told
    assert not [n for n in told if n.endswith("0")]
    assert "it may be larger than the residual" in reader.get("/missing").text


@pytest.mark.parametrize(
    ("sentence", "shown"),
    [
        ("hold the spindle at 3 speeds", "Hold the spindle at 3 speeds"),
        ("table_bearing:Pt11 and lag:Pt12 need a test", "table_bearing:Pt11 and lag:Pt12 need a test"),
        ("lag:Pt11 needs a test", "lag:Pt11 needs a test"),
    ],
)
def test_an_identifier_begins_a_sentence_as_it_is_written(sentence: str, shown: str) -> None:
    assert begun(sentence) == shown
