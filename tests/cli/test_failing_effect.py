"""An installed effect whose plugin fails: a model that has it is refused with its name; a diagnosis goes on without."""

from __future__ import annotations

import importlib
import json
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest

from thermodata.diagnosis.candidates.failing import without_failing
from thermodata.diagnosis.run import question
from thermodata.effect import registry
from thermodata.errors import EffectError
from thermodata.plugin import Drivers, Effect, Float2D, Gain, Need
from thermodata.store import Store

from ..commands import Say
from .conftest import MODEL


class Failing:
    """Needs what the logs have; raises where the hall is a driver, and works by any other temperature."""

    name, family, meaning, source = "zz", "zz", "a plugin's", "none"
    needs = (Need("temperature", "temperature", ("hall", "axis.{a}.nut")),)
    params = ()
    gains = (Gain("gain", "um/K", (0.0, 10.0), "any", "growth"),)
    mended = False

    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        column = drivers.values["temperature"].reshape(-1, 1)
        if self.mended or float(np.abs(column).max()) > 2.0:
            return np.array(column)
        raise KeyError("zz")


@pytest.fixture
def plugin(monkeypatch: pytest.MonkeyPatch) -> Failing:
    found, failed = registry._load()
    made = Failing()
    monkeypatch.setattr(registry, "_load", lambda: ({**found, "zz": made}, failed))
    return made


@pytest.fixture
def store(campaign: Path) -> Path:
    return campaign / "thermodata.store"


def test_a_model_that_has_it_is_refused_with_effect_plugin_and_test(
    say: Say, campaign: Path, store: Path, plugin: Failing
) -> None:
    file = campaign / "with.yaml"
    file.write_text(MODEL.replace("baseline", "with") + "  - {effect: zz, id: mine, drivers: {temperature: T_hall}}\n")
    said = say("--store", store, "fit", file)
    assert said.code == 1
    assert said.err.startswith("error: effect 'zz' failed\nwhere: with.yaml:9 (effects[1]), effect 'mine' of ")
    assert "test_failing_effect:Failing, test 'small/heat1'" in said.err
    assert "got: KeyError: 'zz' (line " in said.err
    assert "defect" not in said.err
    plugin.mended = True
    assert say("--store", store, "fit", file).code == 0


def test_a_diagnosis_leaves_it_out_and_says_why(say: Say, store: Path, plugin: Failing) -> None:
    said = say("--store", store, "diagnose", "baseline", "--json")
    assert said.code == 0, said.err
    found = json.loads(said.out)
    [left_out] = found.pop("not_asked")
    assert left_out["effect"] == "zz"
    assert left_out["why"].startswith("effect 'zz' failed: KeyError: 'zz' (line ")
    assert "test_failing_effect:Failing" in left_out["why"]
    assert "feed_screw" in {c["effect"] for c in found["candidates"]}
    # not by the nut either, where it works: what fails somewhere is no evidence elsewhere
    assert "zz" not in {c["effect"] for c in found["candidates"]}

    again = say("--store", store, "diagnose", "baseline")
    assert again.code == 0
    assert "left out, for their plugins fail\n  ! zz: effect 'zz' failed" in again.out
    assert say("--store", store, "confirm", "baseline", "feed_screw:T_nut_Z").code == 0

    plugin.mended = True
    mended = json.loads(say("--store", store, "diagnose", "baseline", "--json").out)
    assert mended["not_asked"] == []
    assert "from the store" in say("--store", store, "diagnose", "baseline").err


def test_what_fails_without_the_library_too_is_an_error(plugin: Failing) -> None:
    def ask(library: Mapping[str, Effect]) -> list[str]:
        if len(library) > least:
            raise EffectError("effect failed", effect=max(library), origin="here")
        return sorted(library)

    library: dict[str, Effect] = {"a": plugin, "b": plugin, "c": plugin}
    least = 1
    found, failed = without_failing(library, ask)
    assert (found, [one.effect for one in failed], len(library)) == (["a"], ["c", "b"], 3)

    def always(library: Mapping[str, Effect]) -> None:
        raise EffectError("effect failed", effect="a", origin="here")

    with pytest.raises(EffectError):
        without_failing(library, always)


def test_an_answer_is_given_anew_where_the_code_of_an_effect_has_changed(
    say: Say, store: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    package = tmp_path / "plug"
    package.mkdir()
    (package / "__init__.py").touch()
    (package / "own.py").write_text("class Own:\n    pass\n")
    (package / "helper.py").write_text("GAIN = 1.0\n")
    monkeypatch.syspath_prepend(tmp_path)
    own = importlib.import_module("plug.own").Own
    found = registry.all_effects()
    monkeypatch.setattr(registry, "all_effects", lambda: {**found, "own": own()})
    registry.code.cache_clear()
    try:
        assert say("--store", store, "diagnose", "baseline").code == 0
        assert question(Store(store), "baseline").kept() is not None
        (package / "helper.py").write_text("GAIN = 2.0\n")
        registry.code.cache_clear()
        assert question(Store(store), "baseline").kept() is None
    finally:
        registry.code.cache_clear()
