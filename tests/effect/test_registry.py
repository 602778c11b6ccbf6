"""Effects come from entry points; what fails to load is told, not thrown."""

from __future__ import annotations

from collections.abc import Iterator
from importlib.metadata import EntryPoint

import pytest

from thermodata.effect import effect, effects, failed_effects, registry
from thermodata.errors import PluginError, UsageError

LIBRARY = {
    "spindle_bearing": "{s}spindle",
    "spindle_bearing_2": "{s}spindle",
    "spindle_motor": "{s}spindle",
    "spindle_friction": "{s}spindle",
    "centrifugal_shift": "{s}centrifugal",
    "ambient_frame": "ambient",
    "ambient_skin": "ambient",
    "vertical_gradient": "ambient",
    "floor": "ambient",
    "feed_screw": "feed_{a}",
    "feed_motor": "feed_{a}",
    "guideway": "guide_{a}",
    "spindle_gearbox": "{s}gearbox",
    "chiller_temperature": "chiller",
    "cutting_load": "cutting",
    "rotary_friction": "rotary_{a}",
    "table_bearing": "table",
    "turret_heat": "turret",
    "bed_bending": "bed",
    "tool_elongation": "tool",
    "cutting_power": "cutting",
    "coolant": "coolant",
    "coolant_heat": "coolant",
    "coolant_temperature": "coolant",
    "hydraulics": "hydraulics",
    "column_bending": "column",
    "probe_temperature": "probe",
    "lag": "generic",
    "step": "artefact",
    "drift": "artefact",
    "warm_start": "start",
}


@pytest.fixture
def fresh() -> Iterator[None]:
    registry._load.cache_clear()
    yield
    registry._load.cache_clear()


def test_the_library_is_installed() -> None:
    assert failed_effects() == {}
    assert {name: found.family for name, found in effects().items() if name in LIBRARY} == LIBRARY


def test_an_unknown_name_lists_the_choices_and_the_nearest() -> None:
    with pytest.raises(UsageError, match="spindle_bearing'") as caught:
        effect("spindel_bearing")
    assert "ambient_frame" in str(caught.value)


def _entries(monkeypatch: pytest.MonkeyPatch, *entries: EntryPoint) -> None:
    monkeypatch.setattr(registry, "entry_points", lambda group: list(entries))


def test_a_broken_plugin_is_a_warning_and_the_rest_works(fresh: None, monkeypatch: pytest.MonkeyPatch) -> None:
    good = EntryPoint("lag", "thermodata_effects_machine_tool.generic:Lag", registry.GROUP)
    gone = EntryPoint("gone", "no_such_module:Gone", registry.GROUP)
    no_effect = EntryPoint("odd", "collections:OrderedDict", registry.GROUP)
    _entries(monkeypatch, good, gone, no_effect)
    with pytest.warns(UserWarning, match="does not load"):
        assert list(effects()) == ["lag"]
    assert set(failed_effects()) == {"gone", "odd"}
    with pytest.raises(PluginError, match="no_such_module"):
        effect("gone")


def test_without_plugins_the_error_says_what_installs_them(fresh: None, monkeypatch: pytest.MonkeyPatch) -> None:
    _entries(monkeypatch)
    with pytest.raises(UsageError, match="pip install"):
        effect("lag")
