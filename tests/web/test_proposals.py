"""What a page proposes before anything is saved: the moves of a jump test, rules for a stretch, how sure a fall is."""

from __future__ import annotations

import html
import json
import re
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from thermodata.schema.strict.lines import read_document
from thermodata.store import Store
from thermodata.view.curves.predictions import predictions
from thermodata.view.curves.rule_for import Rule, rules_for
from thermodata.view.curves.window import channels_of
from thermodata.view.lists.models import model_rows
from thermodata.web.pages import test as test_page

from ..cli.conftest import write_campaign
from .client import Client
from .conftest import client_of, write_headers

STEPS = (100.0, 50.0, -200.0, -50.0, 100.0)


@pytest.fixture
def jump_lab(tmp_path: Path) -> Path:
    """A campaign file with a jump test of five steps whose moves nobody has said."""
    path = write_campaign(tmp_path / "lab")
    t = np.arange(0, 60, 0.1)
    volts = 5.0 + sum(size / 100 * (t > 10 * (i + 1) - 1) for i, size in enumerate(STEPS))
    volts += np.random.default_rng(0).normal(0, 0.002, len(t))
    rows = np.column_stack([t, volts])
    head = "time [s],Eddy Z [V]"
    np.savetxt(tmp_path / "lab/raw/jump_Z.csv", rows, fmt="%.4f", delimiter=",", header=head, comments="")
    file = 'source: log, file: raw/jump_Z.csv, signal: "Eddy Z"'
    line = f"  jump_Z: {{kind: jump, axis: Z, {file}, moves: unknown, dwell: 10 s}}"
    path.write_text(path.read_text().replace("calibrations:\n", f"calibrations:\n{line}  # ? moves\n"))
    return tmp_path / "lab"


def writing(folder: Path) -> Client:
    client, desk = client_of(folder, write=True)
    return Client(client.app, [*client.headers, *write_headers(desk)])


def test_a_jump_test_is_drawn_with_a_field_for_each_step(jump_lab: Path) -> None:
    client, path = writing(jump_lab), jump_lab / "campaign.yaml"
    start = client.get("/start").text
    at = re.search(r'hx-get="(/start/jump[^"]+)"', start)
    assert at is not None
    text = client.get(at[1].replace("&amp;", "&")).text
    fields = re.findall(r'name="(step\.[^"]+)"', text)
    assert len(fields) == 5
    sizes = [float(x.replace("−", "-")) for x in re.findall(r"· ([+−][\d.]+) V<", text)]
    assert sizes == pytest.approx([size / 100 for size in STEPS], abs=0.02)
    # in a hidden element: htmx takes scripts out of what it swaps in
    chart = json.loads(html.unescape(re.search(r'hidden id="jump-jump_Z">(.*?)</div>', text)[1]))  # type: ignore[index]
    assert [s["label"] for s in chart["spans"]] == ["1", "2", "3", "4", "5"]
    form = {"file": str(path), **{f: f"{size:g} um" for f, size in zip(fields, STEPS, strict=True)}}
    assert "-200 um" in client.post("/start/preview", form).text
    assert "-200 um" not in path.read_text()  # shown, not written
    client.post("/start/write", form)
    moves = read_document(path).data["calibrations"]["jump_Z"]["moves"]
    assert moves == ["100 um", "50 um", "-200 um", "-50 um", "100 um"]
    again = client.get(at[1].replace("&amp;", "&")).text
    assert re.findall(r'name="step[^>]+ value="([^"]+)"', again)[2] == "-200 um"


def test_the_lines_that_change_are_numbered_and_a_slip_of_a_place_is_told(jump_lab: Path) -> None:
    client, path = writing(jump_lab), jump_lab / "campaign.yaml"
    (name,) = [n for n, c in read_document(path).data["channels"].items() if c["quantity"] == "temperature"][:1]
    form = {"file": str(path), f"answer.channels.{name}.at": "headstok"}
    text = html.unescape(client.post("/start/preview", form).text)
    assert f"channel '{name}': no place 'headstok' is known; did you mean 'headstock'?" in text
    assert "@@" not in text
    assert re.search(r'<span class="at">line \d+</span>', text)
    below = re.search(r"any folder below (.*?)\. ", html.unescape(client.get("/start").text))
    assert below is not None
    assert below[1] == str(jump_lab.resolve())


def test_moves_of_some_steps_only_are_refused(jump_lab: Path) -> None:
    client = writing(jump_lab)
    form = {"file": str(jump_lab / "campaign.yaml"), "step.calibrations.jump_Z.moves.0": "100 um"}
    form["step.calibrations.jump_Z.moves.1"] = ""
    answer = client.post("/start/preview", form)
    assert answer.status == 400
    assert "none at step 2" in answer.text


def test_a_jump_test_that_cannot_be_drawn_says_why(jump_lab: Path) -> None:
    client, path = writing(jump_lab), jump_lab / "campaign.yaml"
    (jump_lab / "raw/jump_Z.csv").unlink()
    text = client.get(f"/start/jump?file={path}&calibration=jump_Z").text
    assert "is not there" in text
    assert 'name="answer.calibrations.jump_Z.moves"' in text
    path.write_text(path.read_text().replace("raw/jump_Z.csv", "../../../etc/passwd"))
    assert "outside of the chosen folders" in client.get(f"/start/jump?file={path}&calibration=jump_Z").text
    assert client.get(f"/start/jump?file={path}&calibration=other").status == 400
    assert client.get("/start/jump?file=/etc/hosts&calibration=jump_Z").status == 400


def test_a_stretch_is_told_with_rules_and_what_they_do(
    reader: Client, made_lab: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    store = Store(made_lab / "thermodata.store")
    found = predictions(store, model_rows(store)[0].model, "small", "day1")[0]
    channels = channels_of(store, "small", "day1")
    speed = np.loadtxt(made_lab / "raw/day1.csv", delimiter=",", skiprows=1)[:, 5]
    edges = [0, *(np.flatnonzero(np.diff(speed)) + 1), len(speed)]
    for first, stop in pairwise(edges):
        rules = rules_for(store, found, channels, first * 60, (stop - 1) * 60)
        asked = f"/test/range?campaign=small&test=day1&from={first * 60}&to={(stop - 1) * 60}"
        text = html.unescape(reader.get(asked).text)
        assert "window: [" in text
        assert [r.text for r in rules] == re.findall(r'<code>measuring: "?(.+?)"?</code>', text)
        assert rules or "no <code>measuring</code> rule" in text
    monkeypatch.setattr(test_page, "rules_for", lambda *asked: [Rule("abs(pos_Z) < 5", 300, 40, 0, 1.25)])
    text = html.unescape(reader.get("/test/range?campaign=small&test=day1&from=600&to=3000").text)
    assert 'data-copy="measuring: "abs(pos_Z) < 5""' in text
    assert "takes 40 samples of this stretch and no other; 300 are left" in text


def test_differences_and_bands_are_shown_with_what_they_mean(lab: Path) -> None:
    from thermodata.cli import main

    assert main(["--store", str(lab / "thermodata.store"), "add", "baseline", "1", "--json"]) == 0
    client, _ = client_of(lab)
    page = client.get("/compare").text
    assert "Difference to baseline 1 with its 95 %" in page
    interval = r'<span class="good">−[\d.]+</span> <span class="muted">\(−[\d.]+ … −[\d.]+\)</span>'
    cells = re.findall(rf'<td class="n" data-th="difference[^"]*">{interval}', page)
    assert len(cells) >= 2  # the fall is sure
    test = client.get("/test?campaign=small&test=day1").text
    assert "95 % by the parameters" in test
    assert "it says nothing of effects that the model lacks" in test
    none = client.get("/test?campaign=small&test=day1&model=none").text
    assert "95 % by the parameters" not in none
