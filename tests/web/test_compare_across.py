"""Models of different campaigns side by side: the test that is shown, and the name by which a command finds it."""

from __future__ import annotations

import html
import re
import shlex
from pathlib import Path

import numpy as np
import pytest

from tests.stored_fits import fit_of, predicts_nothing, score_of
from thermodata.cli import main
from thermodata.schema.files.model import Model
from thermodata.store.catalogue.models.fits import save_fit

from ..view.conftest import Builder
from .client import Client
from .conftest import client_of

# model -> the tests that it predicts
FITTED = {
    "both": [("one", "day"), ("one", "extra"), ("two", "day")],
    "single": [("one", "day")],
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two campaigns that both have a test 'day'; `single` predicts one test only, and nothing predicts 'shut'."""
    t_s, b = np.arange(60) * 60.0, Builder(tmp_path_factory.mktemp("across") / "thermodata.store")
    for campaign, test in [*FITTED["both"], ("one", "shut")]:
        b.test(campaign, test, role="locked" if test == "shut" else "calibration")
        b.channel(campaign, test, "dZ")
    store = b.store()
    for model, keys in FITTED.items():
        campaigns = list(dict.fromkeys(c for c, _ in keys))
        spec = {
            "schema": "thermodata/model/1",
            "name": model,
            **({"campaigns": campaigns} if len(campaigns) > 1 else {"campaign": campaigns[0]}),
            "response": {"axis": "Z"},
            "effects": [{"effect": "drift"}],
        }
        result = fit_of(model, [score_of(t, model=model, campaign=c) for c, t in keys])
        y = np.sin(t_s / 900)
        predicted = predicts_nothing(t_s, y, drift=0.1 * y)
        save_fit(
            store,
            spec=Model.model_validate(spec),
            result=result,
            parent=None,
            predictions={(c, t, "dZ"): predicted for c, t in keys},
            data_version="v1",
        )
    return store.path.parent


@pytest.fixture
def reader(folder: Path) -> Client:
    return client_of(folder)[0]


def shown(text: str) -> str:
    found = re.search(r'<select name="test">.*?<option value="([^"]+)" selected>', text)
    assert found
    return found[1]


@pytest.mark.parametrize("named", ["two/day", "one/extra", "extra"])
def test_a_test_that_the_pinned_model_lacks_gives_way(reader: Client, named: str) -> None:
    both = "/compare?model=both&model=single&test=" + named
    assert shown(reader.get(f"{both}&pin=both").text).endswith(named)
    answer = reader.get(f"{both}&pin=single")
    assert answer.status == 200
    assert shown(answer.text) == "one/day"


@pytest.mark.parametrize("named", ["one/shut", "shut", "nothing", "day"])
def test_a_test_that_no_model_predicts_or_that_is_two_is_refused(reader: Client, named: str) -> None:
    assert reader.get(f"/compare?model=both&model=single&pin=both&test={named}").status == 400


@pytest.mark.parametrize("named", ["one/day", "two/day", "one/extra"])
def test_the_command_that_is_shown_runs(
    reader: Client, folder: Path, named: str, capsys: pytest.CaptureFixture[str]
) -> None:
    text = reader.get(f"/compare?model=both&model=single&pin=both&test={named}").text
    found = re.search(r"<code>(thermodata [^<]*--contributions[^<]*)</code>", text)
    assert found
    words = shlex.split(html.unescape(found[1]))[1:]
    store = [] if "--store" in words else ["--store", str(folder / "thermodata.store")]
    assert main([*store, *words, "--json"]) == 0
    campaign, test = named.split("/")
    out = capsys.readouterr().out
    assert f'"campaign": "{campaign}"' in out
    assert f'"test": "{test}"' in out
    assert words[-1] == named  # a list of tests of several campaigns names the campaign of each
    assert f">{words[-1]}</option>" in text
