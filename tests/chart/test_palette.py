"""Lines are told apart, and from the page, in both looks and by every kind of cone vision."""

from __future__ import annotations

import re
from itertools import combinations

import numpy as np
import pytest

from thermodata.chart import asset, effect_styles
from thermodata.chart.colour import DASHES, EFFECTS, SOLID
from thermodata.schema.flag import Flag

# cone vision that lacks one kind wholly: Machado, Oliveira and Fernandes 2009, doi 10.1109/TVCG.2009.113
VISION = {
    "all cones": np.eye(3),
    "no long": [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
    "no medium": [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]],
    "no short": [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900]],
}


def blocks() -> list[dict[str, str]]:
    """The looks in palette.css: light, dark by choice, dark by the system."""
    found = re.findall(r"\{([^{}]*--c-ink[^{}]*)\}", asset("palette.css"))
    return [dict(re.findall(r"--c-([\w-]+):\s*(#[0-9a-f]{6})", text)) for text in found]


LOOKS = dict(zip(("light", "dark"), blocks()[:2], strict=True))


def linear(colour: str) -> np.ndarray:
    c = np.array([int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)])
    return np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)


def oklab(rgb: np.ndarray) -> np.ndarray:
    """Perceived place of linear RGB: bottosson.github.io/posts/oklab."""
    cones = np.array(
        [
            [0.41222147, 0.53633254, 0.05144599],
            [0.21190350, 0.68069955, 0.10739696],
            [0.08830246, 0.28171884, 0.62997870],
        ]
    )
    place = np.array(
        [
            [0.21045426, 0.79361779, -0.00407205],
            [1.97799850, -2.42859221, 0.45059371],
            [0.02590404, 0.78277177, -0.80867577],
        ]
    )
    return place @ np.cbrt(np.clip(cones @ rgb, 0, None))


def contrast(a: str, b: str) -> float:
    """Of WCAG 2."""
    high, low = sorted((float(linear(c) @ [0.2126, 0.7152, 0.0722]) for c in (a, b)), reverse=True)
    return (high + 0.05) / (low + 0.05)


def test_the_two_dark_looks_are_one() -> None:
    light, chosen, by_system = blocks()
    assert chosen == by_system
    assert set(light) == set(chosen)


@pytest.mark.parametrize("vision", VISION)
@pytest.mark.parametrize("look", LOOKS)
@pytest.mark.parametrize("of", [EFFECTS[:SOLID], EFFECTS[SOLID:]])
def test_no_two_effects_of_one_dash_lie_near_each_other(look: str, vision: str, of: tuple[str, ...]) -> None:
    nearest, apart = nearest_of([*of], look, vision)
    assert apart > 0.09, (nearest, apart)


@pytest.mark.parametrize("look", LOOKS)
def test_twelve_lines_have_colours_that_most_people_tell_apart(look: str) -> None:
    """None is nearly black either, as the line of what was measured is: a thin line shows no hue then."""
    nearest, apart = nearest_of([*EFFECTS], look, "all cones")
    assert apart > 0.13, (nearest, apart)
    nearest, apart = nearest_of([*EFFECTS, "measured"], look, "all cones")
    assert apart > 0.11, (nearest, apart)


def nearest_of(names: list[str], look: str, vision: str) -> tuple[tuple[str, str], float]:
    seen = {name: oklab(np.array(VISION[vision]) @ linear(LOOKS[look][name])) for name in names}
    apart = {(a, b): float(np.linalg.norm(seen[a] - seen[b])) for a, b in combinations(seen, 2)}
    nearest = min(apart, key=apart.__getitem__)
    return nearest, apart[nearest]


@pytest.mark.parametrize("look", LOOKS)
def test_each_line_stands_out_from_the_paper(look: str) -> None:
    colours = LOOKS[look]
    lines = [*EFFECTS, "measured", "model", "residual", "source", "lane"]
    assert {
        n: contrast(colours[n], colours["paper"]) for n in lines if contrast(colours[n], colours["paper"]) < 3
    } == {}


@pytest.mark.parametrize("look", LOOKS)
def test_text_can_be_read(look: str) -> None:
    colours = LOOKS[look]
    pairs = [(ink, ground) for ink in ("ink", "muted", "accent", "warn", "good", "bad") for ground in ("paper", "soft")]
    low = {p: contrast(colours[p[0]], colours[p[1]]) for p in pairs if contrast(colours[p[0]], colours[p[1]]) < 4.5}
    assert low == {}


def test_every_flag_has_a_colour() -> None:
    names = {f"flag-{f.word.replace('_', '-')}" for f in Flag if f}
    assert names <= set(LOOKS["light"])


@pytest.mark.parametrize("count", [7, 19, 48])
def test_many_lines_are_told_apart_and_keep_their_looks(count: int) -> None:
    styles = effect_styles([f"e{i}" for i in range(count)])
    assert len(set(styles.values())) == count
    first = [styles[f"e{i}"] for i in range(min(count, len(EFFECTS)))]
    assert len({colour for colour, _ in first}) == len(first), "a colour is no other's before all are used"
    assert effect_styles(["e0", "e1", "e0"]) == {k: styles[k] for k in ("e0", "e1")}


def test_every_dash_is_drawn_on_the_page_and_beside_the_name() -> None:
    listed = asset("paint.js").partition("T.dash = {")[2].partition("};")[0]
    drawn = dict(re.findall(r'"?([\w-]+)"?: \[([^\]]*)\]', listed))
    assert {n: tuple(int(v) for v in px.split(",") if v) for n, px in drawn.items()} == DASHES
    for name in DASHES:
        assert name == "solid" or f".tc-{name}" in asset("chart.css"), name
