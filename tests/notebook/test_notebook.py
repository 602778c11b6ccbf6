"""`thermodata.open(...)`: the commands' work as methods, and how each answer shows itself."""

from __future__ import annotations

import html
import json
import re
import shutil
import warnings
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import yaml

import thermodata
from thermodata.cli import main
from thermodata.errors import UsageError
from thermodata.notebook.fitted import Fit
from thermodata.notebook.opened import OpenStore
from thermodata.notebook.stale import StaleModelWarning
from thermodata.schema.files.model import Model
from thermodata.view.query.store_view import FlaggedValuesWarning

from ..cli.conftest import write_campaign


@pytest.fixture(scope="session")
def made(once: Callable[[str, Callable[[Path], object]], Path]) -> Path:
    def make(folder: Path) -> None:
        store = str(folder / "thermodata.store")
        assert main(["--store", store, "ingest", str(write_campaign(folder)), "--json"]) == 0
        thermodata.open(store).fit(folder / "baseline.yaml").diagnose().add(1)

    return once("notebook", make)


@pytest.fixture
def store(made: Path) -> OpenStore:
    """Read only."""
    return thermodata.open(made / "thermodata.store")


@pytest.fixture
def better(store: OpenStore) -> Fit:
    return store.model()


def test_the_newest_version_is_the_one_that_was_added(store: OpenStore, better: Fit) -> None:
    first = better.parent
    assert first is not None
    assert first.parent is None
    assert [m["model"] for m in store.models()] == [better.id, first.id]
    assert better.result.added == ["feed_screw"]
    assert store.model(first.id[:6]).id == first.id
    assert first.diagnose().sentence.startswith("missing: feed_screw")
    with pytest.raises(UsageError, match="did you mean 'baseline'"):
        store.model("basline")


def test_answers_are_those_of_the_commands(
    made: Path, store: OpenStore, better: Fit, capsys: pytest.CaptureFixture[str]
) -> None:
    def said(*words: str) -> str:
        capsys.readouterr()
        assert main(["--store", str(made / "thermodata.store"), *words]) == 0
        return capsys.readouterr().out

    assert json.loads(said("history", "--json")) == list(better.history())
    assert json.loads(said("compare", better.id, "--json"))["scores"] == list(store.compare().scores)
    assert store.compare(better).summary() in said("compare", better.id)
    first = better.parent
    assert first is not None
    assert first.diagnose().summary() == said("diagnose", first.id).rstrip("\n")


def test_a_row_of_the_scores_shows_its_phase(store: OpenStore, better: Fit) -> None:
    assert len({(s["test"], s["role"], s["response"]) for s in better.scores}) < len(better.scores)
    for scores in (better.scores, store.compare().scores):
        shown = scores.summary().splitlines()
        assert len(shown) == len(set(shown)), "rows that say the same of other figures"
        assert {"phase", "all", "heating"} <= {word for line in shown for word in line.split()}
        assert "<th>phase</th>" in scores.html()


def test_a_campaign_that_a_folder_is_called_like_is_predicted_by_its_own_name(
    better: Fit, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    alone = better.predict("small")
    (tmp_path / "small").mkdir()
    monkeypatch.chdir(tmp_path)
    with pytest.raises(UsageError, match="a campaign of the store and a path") as error:
        better.predict("small")
    assert str(error.value.hint) == "./small is the path alone, campaign:small the campaign"
    assert better.predict("campaign:small").summary() == alone.summary()
    with pytest.raises(UsageError, match="did you mean 'small'"):
        better.predict("campaign:smal")


def test_contributions_add_up_and_carry_units(store: OpenStore, better: Fit) -> None:
    found = better.contributions("day1")
    table = found.to_arrow_table()
    total = sum(found[effect] for effect in found)
    offset = table["predicted"].to_numpy() - total
    assert np.ptp(offset) < 1e-9
    assert {f.name: f.metadata[b"unit"].decode() for f in table.schema if f.metadata} == {
        "t_s": "s",
        **dict.fromkeys(["measured", "predicted", "residual", "spindle_bearing", "feed_screw"], "um"),
    }
    assert store.contributions("small/day1").test == "day1"
    with pytest.raises(UsageError, match="did you mean 'day1'"):
        better.contributions("day")


def test_a_locked_test_stays_closed(store: OpenStore, better: Fit) -> None:
    looks = "select count(*) from locked_look"
    before = store.sql(looks).fetchall()
    with pytest.raises(UsageError, match="no test in the predictions"):
        better.contributions("day2")
    with pytest.raises(UsageError):
        better.plot("day2")
    better.plot(), better.compare(), better.residual_tests(), better.diagnose(), better.history()
    assert "day2" not in better.plot().page()
    # what a diagnosis opened for its claim is all
    assert store.sql(looks).fetchall() == before


def test_predictions_of_a_campaign(better: Fit) -> None:
    made = better.predict("small")
    assert [p.test for p in made] == ["heat1", "heat2", "day1", "day2"]
    assert made[3].measured is None  # locked
    assert made.to_arrow_table().schema.field("predicted").metadata == {b"unit": b"um"}
    assert "RMSE" in made.summary()
    with pytest.raises(UsageError, match="no folder, campaign file or campaign"):
        better.predict("nothing")


def test_conditions_of_logs_are_said_in_python_too(better: Fit, made: Path, tmp_path: Path) -> None:
    store = thermodata.open(shutil.copytree(made / "thermodata.store", tmp_path / "store"))
    spec = yaml.safe_load((made / "baseline.yaml").read_text())
    spec["effects"][0]["gain_by"] = "conditions.speed"
    fitted = store.fit(Model.model_validate(spec))
    logs = tmp_path / "logs"
    logs.mkdir()
    shutil.copy(made / "raw" / "heat1.csv", logs / "run_1.csv")
    plain = fitted.predict(logs)
    assert len(plain) == 0
    assert "conditions={'speed': '9000'} in Python" in plain.left_out[0]
    for given in ({"speed": 9000}, {"speed": "9000"}, {"conditions.speed": 9000.0}):
        assert len(store.predict(logs, conditions=given)) == 1


def test_what_can_not_be_predicted_is_left_out_with_a_word(better: Fit, made: Path, tmp_path: Path) -> None:
    folder = tmp_path / "march"
    folder.mkdir()
    rows = [line.split(",") for line in (made / "raw" / "heat1.csv").read_text().splitlines()]
    at = rows[0].index("T_bearing [degC]")
    (folder / "run_1.csv").write_text("".join(",".join(r[:at] + r[at + 1 :]) + "\n" for r in rows))
    none = better.predict(folder)
    assert (len(none), none.to_arrow_table().num_rows, len(none.df())) == (0, 0, 0)
    assert any(why.startswith("march/run_1: ") for why in none.left_out)
    assert none.summary() == "\nleft out: ".join(["no test can be predicted", *none.left_out])
    assert all(why in html.unescape(none.html()) for why in none.left_out)
    assert none.plot().charts == {}


def test_flagged_values_are_told_in_python_too(store: OpenStore) -> None:
    mean = "select avg(value) from temperature"
    with pytest.warns(FlaggedValuesWarning, match="'where valid\\(flag\\)' leaves out what does not count") as told:
        store.sql(mean)
    assert [w.filename for w in told] == [__file__]  # where the query stands
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        store.sql(f"{mean} where valid(flag)"), store.signal("small", "day1", "T_hall").df()


def test_residual_tests(better: Fit) -> None:
    found = better.residual_tests()
    assert found.autocorrelation[0] == 1.0
    assert [b.lags for b in found.ljung_box] == [10, 20, 50]
    assert {s.state.partition(":")[0] for s in found.states} == {"spindle_bearing", "feed_screw"}
    assert "Ljung-Box" in found.summary()


def test_each_answer_shows_itself_and_escapes_names(store: OpenStore, better: Fit) -> None:
    first = better.parent
    assert first is not None
    verdict = first.diagnose()
    shown = [store, better, first, verdict, better.scores, better.history(), store.compare(first, better)]
    shown += [
        better.contributions(),
        better.predict("small"),
        better.residual_tests(),
        store.models(),
        verdict.candidates,
    ]
    for one in shown:
        page = one._repr_html_()
        assert "<table>" in page
        assert "NaN" not in page
        assert "Traceback" not in repr(one)
    assert "before" in better._repr_html_()
    assert "before" not in first._repr_html_()
    rows = thermodata.notebook.shown.Listed([{"a": "<script>"}], [("a", "a")])  # type: ignore[attr-defined]
    assert "<script>" not in rows._repr_html_()


def test_a_plot_is_a_frame_that_reaches_nothing(better: Fit, tmp_path: Path) -> None:
    plot = better.plot("day1")
    frame = plot._repr_html_()
    assert 'sandbox="allow-scripts"' in frame
    page = html.unescape(re.search(r'srcdoc="(.*?)" sandbox', frame, re.DOTALL)[1])  # type: ignore[index]
    assert page == plot.page() == plot.save(tmp_path / "p.html").read_text("utf-8")
    assert "default-src 'none'" in page
    assert not re.search(r"(src|href)=", page.split("<script>")[0])
    limits = [json.loads(text)["limit"] for text in re.findall(r'json" id="c[01]">(.*?)</script>', page)]
    assert limits[0] == limits[1]  # the fall is seen on one scale
    assert len(frame) < 400_000


def test_a_model_object_and_a_file_fit_alike(made: Path, tmp_path: Path) -> None:
    from thermodata.schema.files.load import load_model

    shutil.copytree(made, tmp_path / "lab")
    store = thermodata.open(tmp_path / "lab" / "thermodata.store")
    a, b = store.fit(tmp_path / "lab" / "baseline.yaml"), store.fit(load_model(tmp_path / "lab" / "baseline.yaml"))
    assert a.id == b.id
    version = store.add("feed_screw:T_nut_Z", a.id, plain=True)
    assert version.remove("feed_screw").parameters.keys() == a.parameters.keys()


def test_a_response_in_place_of_a_model_is_told_where_it_goes(store: OpenStore) -> None:
    with pytest.raises(UsageError, match="is a response") as told:
        store.diagnose("dZ")
    assert told.value.hint == "diagnose(response='dZ')"
    with pytest.raises(UsageError, match="no model"):
        store.diagnose("nobody")


def test_of_a_model_whose_data_changed_every_answer_says_so(made: Path, tmp_path: Path) -> None:
    shutil.copytree(made, tmp_path / "lab")
    store = thermodata.open(tmp_path / "lab" / "thermodata.store")
    first = store.model().parent
    assert first is not None
    with warnings.catch_warnings():
        warnings.simplefilter("error", StaleModelWarning)
        assert first.stale is None
        first.predict("small"), store.compare(first), first.scores, first.history()
    path = tmp_path / "lab" / "campaign.yaml"
    path.write_text(path.read_text().replace("kind: mixed", "kind: spectrum"))
    assert main(["--store", str(store.path), "ingest", str(path), "--json"]) == 0
    assert str(first.stale).startswith(f"stale: the data of baseline {first.id} changed")
    for asked in (
        first.diagnose,
        first.residual_tests,
        first.history,
        first.contributions,
        lambda: first.scores,
        lambda: first.predict("small"),
        lambda: store.predict("small", first.id),
        lambda: store.compare(first),
        lambda: store.history(first.id),
    ):
        with pytest.warns(StaleModelWarning) as told:
            asked()
        assert [str(w.message) for w in told if w.category is StaleModelWarning] == [first.stale]
        assert {w.filename for w in told if w.category is StaleModelWarning} == {__file__}
    with warnings.catch_warnings():
        warnings.simplefilter("error", StaleModelWarning)
        assert store.fit(first.id).stale is None
