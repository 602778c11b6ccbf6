"""Parts of machines as labs name them in their languages, and names that hold their letters by chance."""

from __future__ import annotations

import pytest

from thermodata.draft.signals.guess import guess

_PLACES = {
    "ram": "Stößel Stoessel Frässtößel Pinole Bohrpinole smykadlo pinoly coulisseau fourreau slittone cannotto quill",
    "tailstock": "Reitstock Reitstockpinole Pinole_Reitstock tailstock_quill koník contropunta contrepointe "
    "contre-poupée poupée_mobile contrapunto",
    "headstock": "Spindelkasten Spindelstock poupée poupée_fixe testa",
    "saddle": "Werkzeugsupport Kreuzsupport Werkzeugschlitten Planschlitten suport chariot carro",
    "table": "Planscheibe lícní_deska plateau",
    "crossbeam": "Traverse Querbalken příčník traversa",
    "column": "Ständer stojan montante montant",
    "bed": "Maschinenbett lože basamento bancale banc bâti",
    "spindle": "vřeteno mandrino broche",
}


@pytest.mark.parametrize(("at", "name"), [(at, name) for at, names in _PLACES.items() for name in names.split()])
def test_a_part_of_a_machine_is_its_place(at: str, name: str) -> None:
    assert guess(f"T_{name}", "°C").at == at


@pytest.mark.parametrize(
    ("name", "at"), [("Stoessel_vorn", "ram.front"), ("Stößel oben", "ram.top"), ("fourreau arrière", "ram.rear")]
)
def test_a_side_of_a_ram_is_told(name: str, at: str) -> None:
    assert guess(f"T {name}", "°C").at == at


@pytest.mark.parametrize(
    "name",
    ["Stoßelement", "Support", "support", "Sensorsupport", "supporto", "Lünette", "lunetta", "Ausleger", "contrepoids"],
)
def test_what_only_sounds_like_one_or_may_be_several_is_asked(name: str) -> None:
    """A support is the slide of a lathe to some, and what holds anything to others."""
    found = guess(f"T_{name}", "°C")
    assert found.at is None
    assert any("where on the machine" in question for question in found.questions)


@pytest.mark.parametrize(("name", "at"), [("Werkzeug", "tool"), ("probe support", "fixture"), ("tool holder", "tool")])
def test_a_tool_and_what_holds_a_probe_are_no_slide(name: str, at: str) -> None:
    assert guess(f"T {name}", "°C").at == at
