"""The table of every known cause names effects that are installed and keys that files have."""

from __future__ import annotations

import re
from pathlib import Path

from thermodata.effect import all_effects, effects
from thermodata.schema.files.campaign import Campaign, Channel, SourceSpec, Test
from thermodata.schema.files.model import EffectSpec

PAGE = Path(__file__).parents[2] / "docs" / "model.md"
IN_FILES = {"prediction"}
ROW = re.compile(r"^\| (\d+) \| ([^|]+) \| ([^|]+) \|$", re.MULTILINE)


def _rows() -> list[tuple[int, str, str]]:
    text = PAGE.read_text(encoding="utf-8").partition("### Every cause")[2].partition("\n### ")[0]
    return [(int(number), cause, how.strip()) for number, cause, how in ROW.findall(text)]


def test_all_thirty_nine_causes_are_there() -> None:
    assert [number for number, _, _ in _rows()] == list(range(1, 40))


def test_what_expresses_them_exists() -> None:
    keys = {f for kind in (EffectSpec, Test, SourceSpec, Channel, Campaign) for f in kind.model_fields}
    for _, cause, how in _rows():
        for word in re.findall(r"`([^`]+)`", how):
            name = word.partition(":")[0]
            assert name in all_effects() or name in keys or name in IN_FILES, (cause, word)


def test_what_diagnosis_does_not_ask_for_is_marked() -> None:
    for _, cause, how in _rows():
        named = [word for word in re.findall(r"`(\w+)`", how) if word in all_effects()]
        assert ("°" in how) == any(name not in effects() for name in named), cause
