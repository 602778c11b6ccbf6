"""The place of a displacement: the tool's, unless its name speaks of another body; then it is asked."""

from __future__ import annotations

import pytest

from thermodata.draft.signals.guess import guess


@pytest.mark.parametrize("name", ["dZ_stator", "dZ_statore", "dX_stator_dole", "Eddy stator Y", "dZ_tcp_stator"])
def test_the_stator_is_asked_and_not_the_tool(name: str) -> None:
    found = guess(name, "um")
    assert (found.quantity, found.at, found.sure) == ("displacement", "stator", False)
    assert found.questions == ("at: stator, the spindle's standing part, or tcp?",)


@pytest.mark.parametrize(
    ("name", "body"),
    [
        ("dZ_motor", "motor"),
        ("dY_ram", "ram"),
        ("Messtaster Tisch Z", "table"),
        ("dX_Werkstück", "workpiece"),
        ("Eddy bearing Z", "bearing"),
        ("dZ_headstock", "headstock"),
        ("Verlagerung Lager Z", "bearing"),
    ],
)
def test_another_body_is_asked(name: str, body: str) -> None:
    found = guess(name, "um")
    assert (found.quantity, found.at) == ("displacement", None)
    assert found.questions == (f"at: tcp, or the {body} itself?",)


@pytest.mark.parametrize("name", ["dZ", "dZ_tool", "dZ_spindle", "Eddy/Z", "Messtaster Z", "dZ_tcp", "Verlagerung Z"])
def test_the_tools_is_not(name: str) -> None:
    found = guess(name, "um")
    assert (found.quantity, found.at, found.questions) == ("displacement", "tcp", ())


def test_a_temperature_of_the_stator_is_of_a_motor() -> None:
    assert guess("T_stator_spindle", "degC").at == "spindle.motor"
    assert guess("T_stator", "degC").questions == ("at: which motor? e.g. spindle.motor, axis.x.motor",)
