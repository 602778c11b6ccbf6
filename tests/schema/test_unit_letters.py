"""Units that the wrong encoding spelled otherwise."""

from __future__ import annotations

import pytest

from thermodata.schema.units.letters import encoding_hint, encoding_of


@pytest.mark.parametrize("read_as", ["cp1250", "cp1252"])
@pytest.mark.parametrize(("unit", "written_in"), [("°C", "cp850"), ("µm", "cp850"), ("°C", "mac_roman")])
def test_the_encoding_that_makes_it_a_unit_is_found(unit: str, written_in: str, read_as: str) -> None:
    found = encoding_of(unit.encode(written_in).decode(read_as))
    assert found is not None
    assert found[1] == unit
    assert found[0] == written_in


@pytest.mark.parametrize("unit", ["°C", "µm", "Ω", "degC", "tenths", "řž", "℃", "度"])
def test_units_and_other_words_have_none(unit: str) -> None:
    assert encoding_of(unit) is None
    assert encoding_hint(unit) == ""
