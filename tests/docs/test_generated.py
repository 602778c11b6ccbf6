"""The generated pages say all that the code does. Whether they are up to date, tests/cli/test_schema.py asks."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import combinations
from pathlib import Path
from random import Random

import pytest

from thermodata.draft.words.place import place_of
from thermodata.draft.words.vocabulary import PLACE_WORDS
from thermodata.effect import all_effects
from thermodata.effect.describe import describe
from thermodata.effect.publish import linked
from thermodata.plugin import Drivers, Float2D, Gain, Need, Param
from thermodata.schema.units.conversion import linear_conversion
from thermodata.schema.units.quantity import QUANTITIES, QUANTITY_MEANING
from thermodata.schema.units.spelling import UNIT_SPELLING, spellings
from thermodata.schema.words.places import PLACES, is_known

ROOT = Path(__file__).parents[2]


@pytest.mark.parametrize("name", sorted(all_effects()))
def test_an_effect_states_its_equation_units_and_source_in_its_docstring(name: str) -> None:
    effect = all_effects()[name]
    said = describe(effect)
    text = " ".join((type(effect).__doc__ or "").split())
    assert said.equation
    assert said.equation in text
    assert f"Source: {said.source}" in text
    assert said.telltale
    units = {g.unit for g in said.gains} | {p.unit for p in said.parameters}
    for unit in units - {"um/u"}:
        assert f"[{unit}" in text, unit
    page = (ROOT / "docs" / "effects.md").read_text("utf-8")
    assert f"## {name}\n" in page


class Foreign:
    """An effect of somebody else.

    y = k u, with k [um/K]
    """

    name = "foreign"
    family = "theirs"
    meaning = "goes with u"
    source = "their own tests"
    needs = (Need("u", "temperature", ("bed",)),)
    params: tuple[Param, ...] = ()
    gains = (Gain("k", "um/K", (0.0, float("inf")), "any", "gain"),)

    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        return drivers.values["u"].reshape(-1, 1)


def test_an_effect_without_the_optional_attributes_is_described_by_its_docstring() -> None:
    said = describe(Foreign())
    assert said.equation == "y = k u, with k [um/K]"
    assert (said.telltale, said.refines) == (None, ())
    assert (said.gains[0].largest, said.roles[0].unit) == (None, "degC")


def test_an_effect_may_state_them_and_may_have_no_docstring() -> None:
    class Stated(Foreign):
        __doc__ = None
        equation = "d = k u"
        telltale = "a line"

    assert (describe(Stated()).equation, describe(Stated()).telltale) == ("d = k u", "a line")

    class Silent(Stated):
        __doc__ = None
        equation = " "

    Silent.__doc__ = ""
    assert describe(Silent()).equation is None


def test_sources_become_links() -> None:
    assert linked("[golub1973]; docs/model.md#the-model") == (
        "[golub1973](literature.md#ref-golub1973); [model: the model](model.md#the-model)"
    )


def test_effects_need_places_that_the_vocabulary_holds() -> None:
    for effect in all_effects().values():
        for need in effect.needs:
            for place in need.places:
                letter = "b" if place.startswith("rotary") else "x"
                plain = place.replace("{a}", letter).replace("{s}", "counter_").removesuffix(".*").removesuffix("?")
                assert is_known(plain), place


def test_a_draft_writes_places_that_the_vocabulary_holds() -> None:
    words = [w for w in PLACE_WORDS if w != "not spindle"]
    threes = sorted(" ".join(c) for c in combinations(words, 3))
    texts = [" ".join(c) for n in (1, 2) for c in combinations(words, n)] + Random(1).sample(threes, 2000)
    drafted = {
        at
        for quantity in QUANTITIES
        for text in [*texts, *(f"{t} {axis}" for t in texts[:60] for axis in ("x", "axis b"))]
        if (at := place_of(text, quantity).at)
    }
    assert len(drafted) > 40
    assert {at for at in drafted if not is_known(at)} == set()


@pytest.mark.parametrize(
    ("place", "known"),
    [
        ("tcp", True),
        ("axis.Z.nut", True),
        ("axis.z", True),
        ("rotary.c.motor", True),
        ("table.d3000", True),
        ("axis.*", False),
        ("axis.w.nut", False),
        ("axis.z.knob", False),
        ("rotary.x", False),
        ("table.dwide", False),
        ("kitchen", False),
    ],
)
def test_a_place_is_known_or_not(place: str, known: bool) -> None:
    assert is_known(place) is known


def test_every_quantity_has_its_meaning_and_every_spelling_is_a_unit() -> None:
    assert set(QUANTITY_MEANING) == set(QUANTITIES)
    assert sum(map(len, spellings().values())) >= len(UNIT_SPELLING)
    for unit, written in spellings().items():
        assert all(linear_conversion(w, unit) == (1.0, 0.0) for w in written if w != "nm"), unit
    page = (ROOT / "docs" / "places.md").read_text("utf-8")
    assert all(f"| `{place}` |" in page for place in PLACES)
