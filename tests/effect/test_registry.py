"""Effects come from entry points; what fails to load is told, not thrown."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from importlib.metadata import EntryPoint
from pathlib import Path

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
    "cutting_load": "{s}cutting",
    "rotary_friction": "rotary_{a}",
    "table_bearing": "table",
    "turret_heat": "turret",
    "bed_bending": "bed",
    "tool_elongation": "tool",
    "cutting_power": "{s}cutting",
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
    registry.code.cache_clear()
    yield
    registry._load.cache_clear()
    registry.code.cache_clear()


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


@pytest.mark.parametrize("changed", ["base_of_effects.py", "own_effects/__init__.py", "own_effects/laws.py"])
def test_the_code_is_of_the_plugin_and_of_the_class_that_it_imports(
    fresh: None, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, changed: str
) -> None:
    (tmp_path / "own_effects").mkdir()
    (tmp_path / "base_of_effects.py").write_text(
        "from thermodata_effects_machine_tool.generic import Lag\n\n\n"
        "class Base(Lag):\n    def __init__(self, law):\n        self.law, self.name = law, 'doubled'\n"
    )
    (tmp_path / "own_effects/laws.py").write_text("def law(x):\n    return 2 * x\n")
    (tmp_path / "own_effects/__init__.py").write_text(
        "from base_of_effects import Base\nfrom own_effects.laws import law\n\neffect = Base(law)\n"
    )
    monkeypatch.syspath_prepend(tmp_path)
    for module in ("base_of_effects", "own_effects", "own_effects.laws"):
        monkeypatch.delitem(sys.modules, module, raising=False)
    _entries(monkeypatch, EntryPoint("doubled", "own_effects:effect", registry.GROUP))
    before = registry.code()
    assert failed_effects() == {}
    (tmp_path / changed).write_text((tmp_path / changed).read_text() + "# another law\n")
    registry.code.cache_clear()
    assert registry.code() != before


@pytest.mark.parametrize(
    ("word", "meant"),
    [
        ("spindle_bering", "spindle_bearing"),
        ("feedscrew", "feed_screw"),
        ("Coolant_heat", "coolant_heat"),
        ("bearing", "spindle_bearing"),
        ("ownheat", None),  # of a plugin that is not installed, and no slip of coolant_heat
    ],
)
def test_an_effect_that_is_not_there_is_a_slip_only_where_it_is_spelt_nearly_so(word: str, meant: str | None) -> None:
    with pytest.raises(UsageError) as refused:
        effect(word)
    hint = str(refused.value.hint)
    assert ("did you mean" in hint) is (meant is not None)
    assert meant is None or f"did you mean '{meant}'?" in hint
    assert "if a plugin has it that is not installed here" in hint
