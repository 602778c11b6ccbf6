"""What the pages say, asked without a browser."""

from __future__ import annotations

import html
import json
import re
from pathlib import Path
from typing import Any

import pytest

from thermodata.store import Store
from thermodata.store.ingest.run import ingest
from thermodata.web.pages.parts.strip import strip_svg
from thermodata.web.render import ends, environment

from .client import Client
from .conftest import client_of

PAGES = [
    "/",
    "/quality",
    "/test?campaign=small&test=heat1",
    "/test?campaign=small&test=day2",
    "/trace?campaign=small&test=heat1",
]


@pytest.mark.parametrize("url", PAGES)
def test_nothing_is_inline_and_every_page_shows_its_command(reader: Client, url: str) -> None:
    answer = reader.get(url)
    assert answer.status == 200
    assert not re.search(r"<style|\sstyle=|\son[a-z]+=|javascript:", answer.text)
    for script in re.findall(r"<script([^>]*)>", answer.text):
        assert "src=" in script or 'type="application/json"' in script
    assert re.search(r"<code>thermodata .*</code>", answer.text)
    assert not re.search(r'(?:href|src|action)="(?:https?:)?//', answer.text)


@pytest.mark.parametrize("url", PAGES)
def test_looking_computes_nothing_and_opens_nothing(made_lab: Path, url: str) -> None:
    store = Store(made_lab / "thermodata.store")
    before = {p: (p.stat().st_mtime_ns, p.stat().st_size) for p in made_lab.rglob("*") if p.is_file()}
    looks = store.connect().execute("select count(*) from locked_look").fetchone()
    assert client_of(made_lab)[0].get(url).status == 200
    assert {p: (p.stat().st_mtime_ns, p.stat().st_size) for p in made_lab.rglob("*") if p.is_file()} == before
    assert store.connect().execute("select count(*) from locked_look").fetchone() == looks


def test_the_map_lists_the_tests_with_what_the_model_leaves(reader: Client) -> None:
    text = reader.get("/").text
    assert "4 tests" in text
    for name in ("heat1", "heat2", "day1", "day2"):
        assert f">{name}</a>" in text
    assert text.count('<svg class="strip"') == 3  # the locked one has none
    assert "locked: opened only to confirm a claim" in text


def test_a_search_that_finds_nothing_says_what_to_do(reader: Client) -> None:
    text = reader.get("/?find=no+such+thing").text
    assert "No test is like that" in text
    assert 'href="/"' in text


@pytest.mark.parametrize("url", ["/", "/quality", "/compare", "/missing", "/sql", "/report", "/test?campaign=a&test=b"])
def test_a_folder_without_a_store_says_what_to_do(tmp_path: Path, url: str) -> None:
    text = client_of(tmp_path)[0].get(url).text
    assert "There is no store yet" in text
    assert 'href="/start"' in text
    assert "<code>thermodata init FOLDER</code>" in text, "a campaign file comes first"


def test_names_from_data_are_escaped(reader: Client) -> None:
    text = reader.get('/?find="><script>alert(1)</script>').text
    assert "<script>alert" not in text
    answer = reader.get("/test?campaign=small&test=<img src=x>")
    assert answer.status == 400
    assert "<img src=x" not in answer.text


def test_a_wrong_name_is_answered_with_the_right_one(reader: Client) -> None:
    answer = reader.get("/test?campaign=small&test=heat")
    assert answer.status == 400
    assert "heat1" in answer.text
    assert reader.get("/?page=x").status == 400
    assert reader.get("/test?campaign=small&test=heat1&from=nan&to=3").status == 400
    assert reader.get("/nothing").status == 404


def test_a_test_draws_its_channels_and_its_model(reader: Client) -> None:
    text = reader.get("/test?campaign=small&test=heat1").text
    spec = json.loads(re.search(r'<script type="application/json" id="chart">(.*?)</script>', text, re.S)[1])
    titles = [p["title"] for p in spec["panels"]]
    assert "dZ, model" in titles
    assert "dZ, residual" in titles
    assert "temperature, elsewhere" in titles
    assert "spindle_speed" in titles


def chart_of(text: str) -> dict[str, Any]:
    found = re.search(r'<script type="application/json" id="chart">(.*?)</script>', text, re.S)
    assert found is not None
    return dict(json.loads(found[1]))


def test_a_test_says_the_error_of_its_model_as_the_list_does(reader: Client) -> None:
    listed = re.search(r'heat1</a>.*?data-unit="µm">([\d.]+)<', reader.get("/").text, re.S)
    assert listed is not None
    assert f"error of baseline 1 <b>{listed[1]} µm</b>" in reader.get("/test?campaign=small&test=heat1").text
    assert "error of" not in reader.get("/test?campaign=small&test=day2").text, "of a locked test none is shown"


def test_several_channels_are_ticked_and_drawn(reader: Client) -> None:
    url = "/test?campaign=small&test=heat1&model=none"
    names = [p["title"] for p in chart_of(reader.get(url).text)["panels"]]
    text = reader.get(f"{url}&show=&show=dZ&show=spindle_speed").text
    assert len(names) > 2
    assert [p["title"] for p in chart_of(text)["panels"]] == ["dZ", "spindle_speed"]
    assert re.findall(r'name="show" value="(\w+)" checked', text) == ["dZ", "spindle_speed"]
    assert "the 2 ticked below" in text
    assert len(chart_of(reader.get(f"{url}&show=all&show=dZ").text)["panels"]) >= len(names), "all are asked for"


def test_the_rows_of_flags_say_which_flags_they_are_of(reader: Client) -> None:
    titles = {
        chart_of(reader.get(f"/test?campaign=small&test={t}").text)["rows_title"] for t in ("heat1", "day1", "day2")
    }
    assert any(title.startswith("flags: ") for title in titles), titles
    assert not any("_" in title for title in titles)


def test_the_model_of_a_locked_test_is_not_shown(reader: Client) -> None:
    text = reader.get("/test?campaign=small&test=day2").text
    assert "Locked: no model was fitted to it" in text
    assert "dZ, residual" not in text
    assert "dZ" in text  # what was measured is


def test_a_window_is_finer_than_the_whole(reader: Client) -> None:
    url = "/test/data?campaign=small&test=heat1&show=dZ&model=none"
    part = json.loads(reader.get(url + "&from=3600&to=7200").text)
    assert part["panels"][0]["series"][0]["x"] == {"start": 1.0, "step": pytest.approx(1 / 60), "n": 61}
    assert part["axis"]["range"][0] == 0


def test_a_stretch_says_its_samples_and_its_error(reader: Client) -> None:
    text = reader.get("/test/range?campaign=small&test=heat1&from=3600&to=7200").text
    assert "of 360 samples that count" in text
    assert "window: [3600 s, 7200 s]" in text
    assert reader.get("/test/range?campaign=small&test=heat1&from=3600&to=3600").status == 400


def test_a_point_leads_back_to_the_row_of_its_file(reader: Client) -> None:
    text = reader.get("/trace?campaign=small&test=heat1&channel=dZ&at=3600").text
    assert "raw/heat1.csv" in text
    assert "<dt>row</dt><dd>61</dd>" in text
    assert "3600 s (60 min) from the start ·" in text
    assert environment().filters["moment"]("2026-03-11T07:00:00.000000000Z") == "2026-03-11 07:00:00 UTC"
    assert re.search(r"<dt>value there</dt><dd>-?[\d.]+ um</dd>", text), "as the file has it"
    assert "<dt>unit</dt><dd>µm</dd>" in text
    late = html.unescape(reader.get("/trace?campaign=small&test=heat1&channel=dZ&at=3600.1234567").text)
    assert "--at '3600.1234567 s'" in late, "the same sample in the terminal"
    (around,) = re.findall(r'href="(/test[^"]*show=dZ[^"]*)"', text)
    assert "from=1800" in around
    assert reader.get(html.unescape(around)).status == 200


def test_a_point_of_a_probe_leads_back_to_the_rows_of_its_jump_test(tmp_path: Path) -> None:
    """As `trace` does; also where the channel is derived from the probe."""
    volts = [5.0] * 50 + [6.0] * 50 + [5.5] * 50
    rows = (f"{0.2 * i:.1f},{level + i % 3 / 1000}" for i, level in enumerate(volts))
    (tmp_path / "jump.csv").write_text("t [s],dZ\n" + "\n".join(rows) + "\n")
    (tmp_path / "day.csv").write_text("t [s],dZ\n" + "".join(f"{i},{5 + i / 1000}\n" for i in range(60)))
    (tmp_path / "campaign.yaml").write_text(
        """schema: thermodata/campaign/1
id: lab
machine: {id: m1}
sources: {log: {reader: table, files: "{test}.csv"}}
channels:
  dZ: {source: log, signal: dZ, quantity: displacement, unit: V, axis: Z, at: tcp, calibration: jump_z}
  lift: {derive: "dZ + 0 um", quantity: displacement, axis: Z, at: tcp}
calibrations:
  jump_z: {kind: jump, axis: Z, source: log, file: jump.csv, signal: dZ, moves: [100 um, -50 um], dwell: 10 s}
tests: [{id: day, kind: etve, role: calibration}]
"""
    )
    ingest(Store(tmp_path / "thermodata.store", create=True), tmp_path / "campaign.yaml")
    client, _ = client_of(tmp_path)
    for channel in ("dZ", "lift"):
        text = client.get(f"/trace?campaign=lab&test=day&channel={channel}&at=30").text
        assert "<h3>jump_z: the rows of its jump test</h3>" in text
        levels = re.findall(r'<td class="n">(\d+) µm</td><td class="n">([\d.]+) V</td>', text)
        assert [int(at) for at, _ in levels] == [0, 100, 50]
        assert [float(mean) for _, mean in levels] == pytest.approx([5.001, 6.001, 5.501], abs=1e-3)
        assert text.count("<td>jump.csv, ") == 3
    text = client.get("/trace?campaign=lab&test=day&channel=dZ&at=30").text
    found = re.search(r"<dt>sum</dt><dd>(\S+) × (\S+) ([+−])(\S+) = (\S+)\sµm</dd>", text)
    assert found
    gain, raw, sign, offset, value = (part.replace("−", "-") for part in found.groups())
    assert float(raw) == pytest.approx(5.03)
    assert float(gain) * float(raw) + float(sign + offset) == pytest.approx(float(value))
    told = re.search(r"<dt>gain</dt><dd>\S+ µm/V</dd><dt>offset</dt><dd>(\S+?)\s*µm</dd>", text)
    assert told
    assert float(told[1].replace("−", "-")) == pytest.approx(float(sign + offset), rel=1e-5)
    assert "jump_z: the rows" not in client.get("/trace?campaign=lab&test=day&channel=dZ").text, "of no sample"


def test_a_strip_tints_by_size_and_sign() -> None:
    text = str(strip_svg([0.0, 1.0, -0.5, float("nan")], 1.0))  # type: ignore[arg-type]
    assert re.findall(r'class="(hot s6|cold s3|none)"', text) == ["hot s6", "cold s3", "none"]


def test_a_zoom_draws_the_strips_of_the_whole_test(reader: Client) -> None:
    """A speed that stands still in the window stays: another number of panels would be another chart."""
    text = reader.get("/test?campaign=small&test=heat1").text
    whole = [p["title"] for p in json.loads(re.search(r'id="chart">(.*?)</script>', text)[1])["panels"]]
    assert "spindle_speed" in whole
    source = html.unescape(re.search(r'data-source="([^"]+)"', text)[1])
    still = json.loads(reader.get(f"{source}&from=0&to=600").text)  # the spindle rests in the first 20 min
    assert [p["title"] for p in still["panels"]] == whole


@pytest.mark.parametrize("show", ["", "&show=all"])
def test_a_page_that_is_loaded_with_a_window_keeps_the_strips_of_the_whole_test(reader: Client, show: str) -> None:
    url = f"/test?campaign=small&test=heat1{show}"

    def titles(text: str) -> list[str]:
        return [p["title"] for p in json.loads(text)["panels"]]

    def loaded(text: str) -> tuple[list[str], str]:
        chart, source = re.search(r'id="chart">(.*?)</script>', text), re.search(r'data-source="([^"]+)"', text)
        assert chart
        assert source
        return titles(chart[1]), html.unescape(source[1])

    whole, source = loaded(reader.get(url).text)
    assert "spindle_speed" in whole
    # the spindle rests in the first 20 min: reloaded there, and zoomed out again
    assert loaded(reader.get(f"{url}&from=0&to=600").text) == (whole, source)
    assert titles(reader.get(f"{source}&from=0&to=20000").text) == whole


@pytest.mark.parametrize("page", ["/", "/compare"])
def test_a_table_of_errors_says_from_where_they_count(reader: Client, page: str) -> None:
    told = "Level: the error of a calibration test is about a level fitted to it"
    assert reader.get(page).text.count(told) == 1


@pytest.mark.parametrize(
    ("low", "high", "told"),
    [
        (-0.6931, 0.0235, "(−0.69 … +0.02)"),
        (-27.44, -19.21, "(−27.4 … −19.2)"),
        (-163.4, -49.2, "(−163 … −49)"),
        (0.00123, 0.00187, "(+0.00123 … +0.00187)"),
        (1.5, 1.5, "(+1.50 … +1.50)"),
        (-8.3, -0.04, "(−8.3 … 0.0)"),
    ],
)
def test_an_interval_has_as_many_decimals_as_its_width(low: float, high: float, told: str) -> None:
    assert ends(low, high) == told


def test_the_calibrations_stand_below_the_tests_with_what_fails(lab: Path) -> None:
    store, checks = Store(lab / "thermodata.store"), [{"name": "linear", "passed": False, "advice": "move it again"}]
    with store.write() as con:
        con.execute("delete from calibration")
        con.execute(
            "insert into calibration by name select 'small' as campaign, 'jump_Z' as calibration, 'jump' as kind, "
            "'Z' as axis, 33.27 as gain, 'um/V' as gain_unit, -361.8 as offset_value, 0.22 as uncertainty_pct, "
            f"0.19 as noise_um, '{json.dumps(checks)}' as checks"
        )
    text = html.unescape(client_of(lab)[0].get("/").text)
    card = re.search(r'<details class="card" id="calibrations">(.*?)</details>', text, re.S)[1]
    assert "<summary>1 calibration: 1 with a check that does not hold</summary>" in card
    assert '<td class="name">jump_Z</td><td class="n">33.27 µm/V</td><td class="n">0.22</td>' in card
    assert "linear: move it again" in card
