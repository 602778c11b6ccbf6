"""Errors of a model of a displacement and a temperature: each in its own unit."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import pytest

import thermodata
from thermodata.cli import main
from thermodata.notebook.fitted import Fit
from thermodata.notebook.own_units import in_own_units

from ..cli.conftest import write_campaign

BOTH = """
schema: thermodata/model/1
name: both
campaign: small
response: [{channel: dZ}, {channel: T_bearing}]
step: 60 s
effects:
  - {effect: lag, drivers: {u: spindle_speed}}
"""


@pytest.fixture(scope="module")
def both(once: Callable[[str, Callable[[Path], object]], Path]) -> Fit:
    def make(folder: Path) -> None:
        store = str(folder / "thermodata.store")
        assert main(["--store", store, "ingest", str(write_campaign(folder)), "--json"]) == 0
        (folder / "both.yaml").write_text(BOTH, encoding="utf-8")
        assert main(["--store", store, "fit", str(folder / "both.yaml"), "--json"]) == 0

    return thermodata.open(once("own-units", make) / "thermodata.store").model()


def test_errors_of_two_units_stand_each_with_its_response(both: Fit) -> None:
    beside = both.compare(both)
    for page in (both.html(), both.scores.html(), beside.html(), beside.scores.html()):
        assert set(re.findall(r"<td[^>]*>((?:dZ|T_bearing)[^</]*)</td>", page)) == {"dZ [µm]", "T_bearing [K]"}
        assert not any("[µm]" in head for head in re.findall(r"<th>(.*?)</th>", page))
    assert "[*] in the unit of the row's response: dZ [um], T_bearing [K]" in beside.summary()
    # rows are data, and stay as the command has them
    assert {row["response"] for row in both.scores} == {"dZ", "T_bearing"}


def test_a_residual_is_on_a_scale_of_its_own_unit(both: Fit) -> None:
    maps = both.compare(both).plot().charts
    assert sorted(chart.as_json()["unit"] for chart in maps.values()) == ["K", "um"]
    assert both.plot(response="T_bearing").charts.popitem()[1].as_json()["panels"][1]["unit"] == "K"
    table = both.contributions(response="T_bearing").to_arrow_table()
    assert table.schema.field("residual").metadata == {b"unit": b"K"}


@pytest.mark.parametrize(
    ("units", "response", "heading"),
    [({"a": "K", "b": "K"}, "a", "RMSE [K]"), ({"a": "um", "b": "K"}, "a [um]", "RMSE"), ({}, "a", "RMSE [um]")],
)
def test_one_unit_stands_in_the_heading(units: dict[str, str], response: str, heading: str) -> None:
    rows, columns = in_own_units([{"response": "a"}, {"response": "b"}], [("rmse_um", "RMSE [um]")], units)
    assert (rows[0]["response"], columns[0][1]) == (response, heading)
