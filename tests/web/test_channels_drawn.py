"""Which of many channels a test is drawn with where nobody chose some."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from ..view.conftest import build as build
from .client import Client
from .conftest import client_of

T_S = np.arange(60) * 60.0


def reader_of(build: Callable[[], Any], temperatures: int, speeds: int) -> Client:
    """A test with a response and so many channels, and a model that reads the last two and, in an expression, T02."""
    b = build()
    b.test("c", "day", duration_s=float(T_S[-1]))
    names = {f"T{i:02}": "temperature" for i in range(temperatures)}
    names |= {f"n{i:02}": "rotational_speed" for i in range(speeds)} | {"dZ": "displacement"}
    for name, quantity in names.items():
        b.channel("c", "day", name, quantity)
    b.tidy("c", "day", T_S, {name: i + np.sin(T_S / 900) for i, name in enumerate(names)})
    drivers = [{"temperature": f"T{temperatures - 1:02}"}, {"speed": f"n{speeds - 1:02}"}, {"temperature": "T02 - T01"}]
    effects = [{"effect": "lag", "drivers": d} for d in drivers]
    b.model("m1", "base", spec=json.dumps({"effects": effects}))
    return client_of(b.store().path)[0]


def drawn(client: Client, more: str = "") -> list[str]:
    text = client.get(f"/test?campaign=c&test=day{more}").text
    found = re.search(r'id="chart">(.*?)</script>', text, re.S)
    assert found
    panels = json.loads(found[1])["panels"]
    return [s["name"] for p in panels for s in p.get("series", [p])]


def test_what_the_model_reads_is_drawn_before_what_stands_first(build: Callable[[], Any]) -> None:
    client = reader_of(build, 30, 14)
    names = drawn(client)
    assert {"dZ", "T29", "T01", "T02", "n13"} <= set(names)
    assert len(names) == 24 + 10
    assert names.index("T00") < names.index("T29"), "in their order"
    assert "34 of 45, with those of the model</option>" in client.get("/test?campaign=c&test=day").text
    without = drawn(client, "&model=none")
    assert not {"T29", "n13"} & set(without)
    assert "34 of 45</option>" in client.get("/test?campaign=c&test=day&model=none").text


@pytest.mark.parametrize("more", ["", "&model=none"])
def test_few_channels_are_all_drawn(build: Callable[[], Any], more: str) -> None:
    client = reader_of(build, 4, 2)
    assert len(drawn(client, more)) == 7
    assert "all 7</option>" in client.get(f"/test?campaign=c&test=day{more}").text
