"""A feed whose axis the name does not say, as of a hexapod's struts: asked where it is, and a test in which it runs is
none in which nothing moves."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tests.commands import Say
from tests.draft.labs import numbers, text
from thermodata.draft.signals.guess import guess
from thermodata.reader.text import split_unit
from thermodata.schema.files.load import load_campaign


@pytest.mark.parametrize(
    "header", ["struts.feed_a_m_min", "/struts.feed_b_m_min", "Feed leg 3 [m/min]", "Vorschub Lader [m/min]"]
)
def test_a_feed_of_a_part_is_asked_for_its_axis(header: str) -> None:
    found = guess(*split_unit(header))
    assert (found.quantity, found.at) == ("feed", None)
    assert found.questions == ("at: which axis? e.g. axis.x; a feed along a path: no 'at'",)


@pytest.mark.parametrize(
    ("header", "place"),
    [
        ("Feedrate [mm/min]", None),
        ("actFeedRate [mm/min]", None),
        ("Path feed act [mm/min]", None),
        ("Bahnvorschub [mm/min]", None),
        ("/Channel/State/actFeedRateIpo [mm/min]", None),
        ("Velocidade de avanço [mm/min]", None),
        ("Velocità di avanzamento [mm/min]", None),
        ("Posuw roboczy [mm/min]", None),
        ("İlerleme hızı [mm/min]", None),
        ("Feed X [m/min]", "axis.x"),
    ],
)
def test_a_feed_along_the_path_or_of_an_axis_is_not(header: str, place: str | None) -> None:
    found = guess(*split_unit(header))
    assert (found.quantity, found.at, found.questions) == ("feed", place, ())


@pytest.mark.parametrize(
    ("name", "feed", "kind", "said"),
    [
        ("struts_b", 20.0, "linear_axis", "? kind: linear_axis? a feed runs, whose axis is not told"),
        ("struts_b", 0.0, "etve", "kind guess: data only, nothing moves"),
        ("feed_b", 20.0, "linear_axis", "kind sure: name and data"),
        (
            "idle_b",
            20.0,
            "etve",
            "? kind: the name says etve, the data linear_axis (a feed runs, whose axis is not told)",
        ),
    ],
)
def test_a_test_in_which_it_runs_moves(tmp_path: Path, say: Say, name: str, feed: float, kind: str, said: str) -> None:
    t = np.arange(300) * 30.0
    runs = np.where(t > 600, feed, 0.0)
    columns = [numbers(t, 0), numbers(0 * t, 0), numbers(runs, 1), numbers(20 + t / 9000, 2), numbers(t / 300, 2)]
    header = ["t [s]", "Spindle speed [rpm]", "Struts feed b [m/min]", "Hall air [degC]", "Displ. Z [um]"]
    text(tmp_path / f"{name}.csv", header, columns, mark=",")
    say("init", tmp_path)
    (test,) = load_campaign(tmp_path / "campaign.yaml").tests
    (line,) = [x for x in (tmp_path / "campaign.yaml").read_text("utf-8").splitlines() if f"id: {name}" in x]
    assert test.kind == kind
    assert said in line
