"""Values that nothing can have are refused at their line, with what would be right."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from thermodata.errors import SpecError
from thermodata.modelling import fit_model
from thermodata.schema.files.load import load_model
from thermodata.schema.files.locate import located
from thermodata.view.grid.dataset import Dataset

from .conftest import Spec

HEAD = """schema: thermodata/model/1
name: base
campaign: c
step: 60 s
response: {axis: Z, at: tcp}
effects:
  - effect: spindle_bearing
"""
AT = 8  # the line of what follows


def _refusal(text: str, data: Dataset, folder: Path) -> SpecError:
    path = folder / "model.yaml"
    path.write_text(HEAD + text)
    with pytest.raises(SpecError) as caught:
        fit_model(load_model(path), data, uncertainty=False)
    found = located(caught.value, path)
    assert isinstance(found, SpecError)
    return found


@pytest.mark.parametrize(
    ("text", "what", "expected", "got"),
    [
        ("fixed: {tau: -10 min}", "below zero", "0 min or more", "-10 min"),
        ("bounds: {tau: [-5 min, 5 min]}", "below zero", "0 min or more", "[-5 min, 5 min]"),
        ("also: [dead_time]; start: {dead_time: -3 s}", "below zero", "0 s or more", "-3 s"),
        ("start: {tau: 5000 h}", "outside of its bounds", "within [1, 360] min", "5000 h"),
        ("start: {tau: 1 min}; bounds: {tau: [20, 30]}", "outside of its bounds", "within [20, 30]", "1 min"),
        ("fixed: {tau: 10 min}; bounds: {tau: [20, 30]}", "outside of its bounds", "within [20, 30]", "10 min"),
        ("fixed: {gain: 9}; bounds: {gain: [1, 3 um/K]}", "outside of its bounds", "within [1, 3 um/K]", "9"),
        ("bounds: {tau: [10 min, 5 min]}", "wrong way round", "[5 min, 10 min]", "[10 min, 5 min]"),
        ("bounds: {gain: [3 um/K, 1 um/K]}", "wrong way round", "[1 um/K, 3 um/K]", "[3 um/K, 1 um/K]"),
        ("bounds: {tau: [1 h, 5 min]}", "wrong way round", "[5 min, 1 h]", "[1 h, 5 min]"),
        ("bounds: {tau: [5 min, 300 s]}", "leave one value", "fixed: {tau: 5 min}", "[5 min, 300 s]"),
        ("bounds: {tau: [10, .inf]}", "no finite number", "a number", "[10, inf]"),
    ],
)
def test_an_impossible_value_is_refused_at_its_line(
    world: Dataset, tmp_path: Path, text: str, what: str, expected: str, got: str
) -> None:
    lines = "".join(f"    {part}\n" for part in text.split("; "))
    error = _refusal(lines, world, tmp_path)
    assert what in error.what
    assert expected in (error.expected or "")
    assert error.got == got
    line = AT + int(text.startswith("also"))
    assert (error.where or "").startswith(f"model.yaml:{line} (effects[0].")
    assert error.exit_code == 2


@pytest.mark.parametrize(
    ("text", "name", "low", "high"),
    [
        ("fixed: {tau: 5000}", "tau", 5000.0, 5000.0),
        ("fixed: {tau: 0}", "tau", 0.0, 0.0),
        ("bounds: {tau: [0.5, 900]}", "tau", 0.5, 900.0),
        ("bounds: {gain: [0, .inf]}", "gain", 0.0, float("inf")),
    ],
)
def test_what_lies_beyond_the_library_is_taken(
    world: Dataset, tmp_path: Path, text: str, name: str, low: float, high: float
) -> None:
    path = tmp_path / "model.yaml"
    path.write_text(HEAD + f"    {text}\n")
    fitted = fit_model(load_model(path), world, uncertainty=False)
    assert low <= fitted.parameters()[f"spindle_bearing.{name}"].value <= high


@pytest.mark.parametrize(("value", "hint"), [("b", "did you mean 'B'?"), ("long", "leave it out of the groups")])
def test_a_group_of_a_value_that_no_test_has_is_refused(world: Dataset, tmp_path: Path, value: str, hint: str) -> None:
    tests = tuple(replace(t, conditions={"tool.id": "AB"[k % 2]}) for k, t in enumerate(world.tests))
    text = f"    gain_by: tool\n    groups:\n      A: one\n      [B, {value}]: other\n"
    error = _refusal(text, replace(world, tests=tests), tmp_path)
    assert (error.where or "").startswith(f"model.yaml:{AT + 3} ")
    assert (error.expected, error.got, error.hint) == ("A, B", value, hint)


def test_a_model_in_a_model_is_named_where_its_file_is_wrong(world: Dataset, spec: Spec) -> None:
    inside = spec({"effect": "spindle_bearing", "fixed": {"tau": "-1 min"}}, name="frame")
    held = {"effect": "model", "name": "frame", "inside": inside.model_dump(mode="json", by_alias=True)}
    with pytest.raises(SpecError) as caught:
        fit_model(spec("coolant", held), world)
    assert caught.value.where == "model 'frame', effects[0].fixed.tau"


@pytest.mark.parametrize("gain", ["2 um", "1,2", '"2"', "K 1", ".nan"])
def test_the_free_gain_of_a_model_is_called_by_a_word(world: Dataset, tmp_path: Path, gain: str) -> None:
    text = f"  - effect: model\n    name: frame\n    gain: {gain}\n"
    error = _refusal(text, world, tmp_path)
    assert (error.where or "").startswith(f"model.yaml:{AT + 2} (effects[1].gain)")
    assert (error.got or "") in gain.strip('"').replace(".nan", "nan")
