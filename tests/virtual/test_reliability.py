"""Stated probabilities against what came true."""

from __future__ import annotations

from xml.etree import ElementTree

import numpy as np
import pytest

from thermodata.virtual.blind.diagram import diagram
from thermodata.virtual.blind.reliability import reliability
from thermodata.virtual.blind.tally import wilson


def trials(pairs: list[tuple[float | None, bool]], of: str = "first") -> list[dict[str, object]]:
    return [{"stated": [{"of": of, "id": "x", "probability": p, "right": r}]} for p, r in pairs]


def test_figures_are_the_textbooks() -> None:
    found = reliability(trials([(0.9, True), (0.9, True), (0.92, False), (0.1, False), (0.15, True), (None, True)]))
    assert [r.of for r in found] == ["first"]
    one = found[0]
    assert one.statements == 5
    assert one.brier == pytest.approx((0.01 + 0.01 + 0.92**2 + 0.01 + 0.85**2) / 5)
    assert one.base_brier == pytest.approx(0.6 * 0.4)
    assert [(b.of, b.true) for b in one.bins] == [(2, 0.5), (3, pytest.approx(2 / 3))]
    assert one.bins[0].stated == pytest.approx(0.125)
    assert (one.bins[1].low, one.bins[1].high) == wilson(2, 3)
    assert one.calibration_error == pytest.approx((2 * 0.375 + 3 * (0.9066667 - 0.6666667)) / 5)


def test_statements_that_come_true_as_often_as_stated_have_no_error() -> None:
    rng = np.random.default_rng(1)
    p = rng.uniform(0, 1, 20_000)
    told = list(zip(p.tolist(), (rng.random(len(p)) < p).tolist(), strict=True))
    fair = reliability(trials(told))[0]
    assert fair.calibration_error < 0.02
    assert fair.brier == pytest.approx(1 / 6, abs=0.01)
    bold = reliability(trials([(min(1.0, x + 0.2), r) for x, r in told]))[0]
    assert bold.calibration_error > 0.15


def test_certainty_falls_into_the_last_tenth_and_claims_are_apart() -> None:
    found = reliability([*trials([(1.0, True), (0.0, False)]), *trials([(0.95, True)], of="claim")])
    assert [(r.of, r.statements) for r in found] == [("first", 2), ("claim", 1)]
    assert [b.stated for b in found[0].bins] == [0.0, 1.0]
    assert reliability(trials([(None, True)])) == []


def test_the_diagram_is_whole_and_its_points_stand_where_they_should() -> None:
    found = reliability([*trials([(0.75, True), (0.75, False)]), *trials([(0.95, True)], of="claim")])
    picture = ElementTree.fromstring(diagram(found, "9 machines & <more>"))
    spot = "{http://www.w3.org/2000/svg}"
    points = picture.findall(f"{spot}circle")
    assert [p.findtext(f"{spot}title") for p in points] == [
        "50% of 2 (9%-91%), stated 75%",
        "100% of 1 (21%-100%), stated 95%",
    ]
    assert float(points[0].attrib["cy"]) > float(points[1].attrib["cy"])
    assert float(points[0].attrib["cx"]) < float(points[1].attrib["cx"])
    assert "9 machines & <more>" in [t.text for t in picture.iter(f"{spot}text")]


def test_a_long_title_stays_in_the_picture() -> None:
    title = "3000 machines, sealed seeds 200631 to 200680, 200683 to 200782"
    picture = ElementTree.fromstring(diagram(reliability(trials([(0.75, True)])), title))
    lines = [t for t in picture.iter("{http://www.w3.org/2000/svg}text") if t.attrib["font-size"] == "13"]
    assert " ".join(t.text or "" for t in lines) == title
    assert len({t.attrib["y"] for t in lines}) == 2
    assert all(float(t.attrib["x"]) + 7.5 * len(t.text or "") < float(picture.attrib["width"]) for t in lines)
