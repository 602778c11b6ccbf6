"""The page of what was flagged: a row a cause, each stretch a link, and what counts apart from what does not."""

from __future__ import annotations

import html
import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from thermodata.view.lists.overview import TestList, TestRow
from thermodata.web.pages.quality import _headline

from ..view.conftest import build as build
from .client import Client
from .conftest import client_of

T_S = np.arange(600) * 60.0


def page(build: Callable[[], Any], *events: tuple[str, str, str, str | None], url: str = "/quality") -> str:
    """Two tests of 10 h with two channels. events: (test, channel, flag, detail), each of 4 samples from 6,210 s on."""
    b = build()
    for test in ("day1", "day2"):
        b.test("c", test, duration_s=float(T_S[-1]))
        for name in ("dX", "dZ"):
            b.channel("c", test, name)
        b.tidy("c", test, T_S, {"dX": np.sin(T_S), "dZ": np.cos(T_S)})
    for test, channel, flag, detail in events:
        b.add(
            "quality_event", campaign="c", test=test, source="daq", stream="daq", channel=channel, flag=flag,
            from_s=6210.0, to_s=6930.0, n=4, detail=detail,
        )  # fmt: skip
    reader: Client = client_of(b.store().path)[0]
    answer = reader.get(url)
    assert answer.status == 200
    return html.unescape(answer.text)


def section(text: str, title: str) -> str:
    found = re.search(rf"<h2>{title}</h2>(.*?)</section>", text, re.S)
    return found[1] if found else ""


def test_one_cause_over_tests_is_one_row_whose_stretches_are_links(build: Callable[[], Any]) -> None:
    text = page(build, ("day1", "dX", "saturated", "3 s at 9.98 V"), ("day2", "dX", "saturated", "7 s at 9.99 V"))
    rows = section(text, "What does not count")
    assert rows.count("3 s at 9.98 V") == 1, "figures differ, the cause does not"
    assert '<td class="n" data-th="samples">8</td>' in rows
    for test in ("day1", "day2"):
        assert f"/test?campaign=c&test={test}&show=dX&flagged=1&from=5910.0&to=7230.0" in rows
    assert "1:43:30 to 1:55:30" in rows


def test_what_counts_and_what_was_not_measured_stand_apart(build: Callable[[], Any]) -> None:
    text = page(
        build,
        ("day1", "dX", "spike", "5 K beside both neighbours"),
        ("day1", "dZ", "gap", "600 s without a sample"),
        ("day1", "dZ", "spike", "only while not measuring"),
        ("day2", "dZ", "stuck", "overruled: a stop holds it (was: 1 value for 2 h)"),
    )
    assert "5 K beside" in section(text, "What does not count")
    assert "only while not measuring" in section(text, "What was not measured")
    told = section(text, "What counts all the same")
    assert "600 s without a sample" in told
    assert "a stop holds it" in told


def test_the_worst_tests_of_a_cause_stand_first_and_no_page_grows_without_end(build: Callable[[], Any]) -> None:
    b = build()
    for i in range(60):
        b.test("c", f"t{i:02}", duration_s=float(T_S[-1]))
        for k in range(30):
            b.add(
                "quality_event", campaign="c", test=f"t{i:02}", source="daq", stream="daq", channel="dX", flag="spike",
                from_s=600.0 * k, to_s=600.0 * k + 60, n=i + 1, detail="5 K beside both neighbours",
            )  # fmt: skip
    rows = section(html.unescape(client_of(b.store().path)[0].get("/quality").text), "What does not count")
    assert "in the 50 of 60 tests that have most" in rows
    told = re.findall(r'<p class="sub">(t\d\d)</p>', rows)
    assert told == [f"t{i:02}" for i in range(59, 9, -1)]
    assert rows.count("flagged=1&from=") == 50 * 20
    assert rows.count("and 10 more") == 50


@pytest.mark.parametrize(
    ("valid", "idle", "said"),
    [
        (1.0, 0, "All of 1 k samples count"),
        (0.9, 0, "10 % of 1 k samples do not count"),
        (0.42, 575, "A defect in 0.5 % of 1 k samples; 58 % were not measured"),
        (0.42, 580, "A defect in none; 58 % of 1 k samples were not measured"),
    ],
)
def test_the_head_tells_defects_from_what_was_not_measured(valid: float, idle: int, said: str) -> None:
    row = TestRow("c", "t", "day", "calibration", None, 60.0, {}, None, 1000, 1, valid, None, None, None, None, None)
    assert _headline(TestList((row,), 1, 1, 1, 1), idle).replace("\u00a0", " ") == said


def test_a_store_without_flags_says_so(build: Callable[[], Any]) -> None:
    text = page(build)
    assert "Nothing was flagged, and nothing lost" in text
    assert "In 2 tests." in text


def test_a_campaign_that_there_is_not_is_refused(build: Callable[[], Any]) -> None:
    b = build()
    b.test("c", "day1")
    answer = client_of(b.store().path)[0].get("/quality?campaign=other")
    assert answer.status == 400
    assert "other" in answer.text


def test_names_from_data_are_escaped_on_it(build: Callable[[], Any]) -> None:
    b = build()
    b.test("c", "day1", duration_s=60.0)
    b.add(
        "quality_event", campaign="c", test="day1", source="daq", stream="daq", channel="<img src=x>", flag="spike",
        from_s=0.0, to_s=1.0, n=1, detail="<script>alert(1)</script>",
    )  # fmt: skip
    text = client_of(b.store().path)[0].get("/quality").text
    assert "<img src=x" not in text
    assert "<script>alert" not in text
