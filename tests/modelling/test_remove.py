"""What `remove` says where the version before an effect is not what is left without it."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

from thermodata.modelling.remove import stays
from thermodata.schema.files.model import EffectSpec


def version(model: str, *effects: str) -> Any:
    specs = [EffectSpec(id=e, effect=e.removesuffix("_lag2"), drivers={"u": "T"}) for e in effects]
    return SimpleNamespace(model=model, spec=SimpleNamespace(effects=specs))


BASE = version("aaa", "spindle_bearing")
BOTH = version("bbb", "spindle_bearing", "coolant", "spindle_bearing_lag2")


def test_a_second_lag_that_came_with_an_effect_and_stays_is_said_with_the_version_before() -> None:
    said = stays([BASE, BOTH], "coolant", ["spindle_bearing", "spindle_bearing_lag2"])
    assert len(said) == 1
    assert said[0].startswith("spindle_bearing_lag2 came with coolant and stays")
    assert "aaa is the version before both" in said[0]


def test_nothing_is_said_where_an_effect_came_alone_or_was_there_from_the_start() -> None:
    alone = version("bbb", "spindle_bearing", "coolant")
    later = version("ccc", "spindle_bearing", "coolant", "sun")
    assert stays([BASE, alone, later], "coolant", ["spindle_bearing", "sun"]) == [], "what came later is no part of it"
    assert stays([BASE, BOTH], "spindle_bearing", ["coolant"]) == []
