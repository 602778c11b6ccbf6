"""Which flags of a test its picture draws as stretches."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from thermodata.view.lists import events

from ..view.conftest import build as build
from .client import Client
from .conftest import client_of

ONLY = "only while not measuring"
T_S = np.arange(600) * 60.0


def page(build: Callable[[], Any], *events: tuple[str, str, str | None]) -> tuple[str, dict[str, Any]]:
    """(the page, its chart) of a test of 10 h. events: (channel, flag, detail), each of 4 samples in 6 h."""
    b = build()
    b.test("c", "day", duration_s=float(T_S[-1]))
    for name in ("dX", "dZ"):
        b.channel("c", "day", name)
    b.tidy("c", "day", T_S, {"dX": np.sin(T_S), "dZ": np.cos(T_S)})
    for channel, flag, detail in events:
        b.add(
            "quality_event", campaign="c", test="day", source="daq", stream="daq", channel=channel, flag=flag,
            from_s=6210.0, to_s=26930.0, n=4, detail=detail,
        )  # fmt: skip
    reader: Client = client_of(b.store().path)[0]
    text = reader.get("/test?campaign=c&test=day").text
    found = re.search(r'id="chart">(.*?)</script>', text, re.S)
    assert found
    return text, json.loads(found[1])


def test_single_samples_between_the_measuring_phases_are_no_stretch(build: Callable[[], Any]) -> None:
    text, chart = page(build, ("dX", "spike", ONLY), ("dZ", "held", "1 value for 345 min"))
    assert [row["name"] for row in chart["rows"]] == ["dZ"]
    assert chart["rows_title"] == "flags: held"
    assert "2 flagged stretches" in text
    assert ONLY in text
    assert "Flags that a channel has only while the test does not measure" in text


def test_what_is_drawn_needs_no_word_of_what_is_not(build: Callable[[], Any]) -> None:
    text, chart = page(build, ("dX", "spike", "5 um beside both neighbours"))
    assert [row["name"] for row in chart["rows"]] == ["dX"]
    assert "only while the test does not measure" not in text


def test_stretches_that_are_alike_are_a_row_and_each_is_one_click_away(build: Callable[[], Any]) -> None:
    b = build()
    b.test("c", "day", duration_s=float(T_S[-1]))
    b.channel("c", "day", "dX")
    b.tidy("c", "day", T_S, {"dX": np.sin(T_S)})
    for i in range(300):
        b.add(
            "quality_event", campaign="c", test="day", source="daq", stream="daq", channel="dX", flag="saturated",
            from_s=1500.0 + 60 * i, to_s=1530.0 + 60 * i, n=6, detail="the end of its range",
        )  # fmt: skip
    text = client_of(b.store().path)[0].get("/test?campaign=c&test=day").text
    table = re.search(r'<table class="alike">(.*?)</table>', text, re.S)[1]
    row = re.search(r'<tr class="on">(.*?)</tr>', table, re.S)[1]
    cells = [re.sub(r"<[^>]+>", "", cell) for cell in re.findall(r"<td[^>]*>(.*?)</td>", row, re.S)]
    assert cells[:2] == ["dX", "saturated"]
    assert cells[2:] == ["300", "25 min", "5.4 h", "2.5 h", "1\u202f800", "the end of its range"]
    assert table.count("<li>") == 300, "none is left out"
    assert re.search(r'from=1200.0&amp;to=1830.0">0:25:00 to 0:25:30</a> <span class="muted">6 samples', table)


@pytest.mark.parametrize(("most", "later"), [(3, ""), (2, "neither drawn nor listed: 1 more behind these")])
def test_stretches_that_are_too_many_to_be_drawn_are_told(
    build: Callable[[], Any], monkeypatch: pytest.MonkeyPatch, most: int, later: str
) -> None:
    monkeypatch.setattr(events, "_MOST", most)
    text, _ = page(build, ("dX", "held", "a"), ("dX", "spike", "b"), ("dZ", "held", "c"))
    assert f"{most} flagged stretches" in text
    assert (later in text) if later else ("neither drawn nor listed" not in text)
