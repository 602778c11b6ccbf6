"""Which flags of a test its picture draws as stretches."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from typing import Any

import numpy as np

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
