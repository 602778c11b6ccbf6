"""Another program's model is imported, scored and corrected like any other."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from thermodata.errors import SpecError
from thermodata.modelling import fit_model
from thermodata.modelling.model_file.prediction import read_prediction
from thermodata.modelling.predictions.score import scores
from thermodata.modelling.versions.result import model_id
from thermodata.view.dataset import Dataset

from .conftest import EFFECTS, Spec


@pytest.fixture
def theirs(world: Dataset, spec: Spec, tmp_path: Path) -> Path:
    """A good model's prediction, every third sample, with an offset of its own; test t6 is not in it."""
    response = fit_model(spec(*EFFECTS), world).responses[0]
    lines = ["test,t_s,predicted"]
    for test in world.tests[:6]:
        y = response.predict(test) + 1000.0
        lines += [f"{test.test},{t},{v:.6f}" for t, v in zip(test.t_s[::3], y[::3], strict=True)]
    path = tmp_path / "theirs.csv"
    path.write_text("\n".join(lines))
    return path


def test_a_prediction_is_scored(world: Dataset, spec: Spec, theirs: Path) -> None:
    model = spec({"effect": "prediction", "file": "theirs.csv", "fixed": {"gain": 1.0}})
    rows = [s for s in scores(fit_model(model, world, base=theirs.parent), world, "m") if s.phase == "all"]
    assert [s.test for s in rows] == [f"t{k}" for k in range(6)]
    assert all(s.fit is not None and s.fit > 90 for s in rows)


def test_an_effect_can_be_added_to_it(world: Dataset, spec: Spec, theirs: Path) -> None:
    model = spec({"effect": "prediction", "file": "theirs.csv", "fixed": {"gain": 0.5}}, *EFFECTS)
    fitted = fit_model(model, world, base=theirs.parent)
    # half the truth is theirs, the effects bring the other half
    assert fitted.parameters()["coolant.gain"].value == pytest.approx(3.0, rel=0.1)
    assert fitted.responses[0].noise == pytest.approx(0.3, abs=0.1)


def test_beyond_its_end_a_prediction_says_nothing(world: Dataset, tmp_path: Path, spec: Spec) -> None:
    path = tmp_path / "short.csv"
    path.write_text("\n".join(["test,t,predicted", *(f"t{k},{t},{t / 100}" for k in range(5) for t in (0, 9000))]))
    fitted = fit_model(spec({"effect": "prediction", "file": str(path)}), world).responses[0]
    mask = fitted.mask(world.tests[0])
    assert mask.sum() == (world.tests[0].t_s <= 9000).sum()


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("test,time,predicted\na,0,1\n", "no column 't_s'"),
        ("test,t_s,predicted\na,0,x\n", ":2"),
        ("", "no column 'test'"),
        ("test,time [s],predicted [um]\na,0,1\n", "no column 't_s'"),
        ("test,response,t_s,predicted\na,dX,0,1\na,dZ,0,1\n", "of one response"),
    ],
)
def test_a_file_that_is_none_is_refused(tmp_path: Path, text: str, says: str) -> None:
    path = tmp_path / "bad.csv"
    path.write_text(text)
    with pytest.raises(SpecError, match=says):
        read_prediction(path)


def test_a_missing_file_is_an_error_with_its_name(tmp_path: Path) -> None:
    with pytest.raises(SpecError, match=r"gone\.csv"):
        read_prediction(tmp_path / "gone.csv")


def test_the_id_follows_the_content_of_the_file(spec: Spec, theirs: Path) -> None:
    model = spec({"effect": "prediction", "file": "theirs.csv"})
    before = model_id(model, "v", theirs.parent)
    theirs.write_text(theirs.read_text() + "\nt6,0,1")
    assert model_id(model, "v", theirs.parent) != before
    assert np.char.isalnum(before)


def test_another_programs_prediction_keeps_its_scale_unless_its_gain_is_freed() -> None:
    from thermodata.modelling.model_file.resolve import as_it_was_made
    from thermodata.schema.model import EffectSpec

    assert as_it_was_made(EffectSpec(effect="prediction", file="a.csv")).fixed == {"gain": 1.0}
    assert as_it_was_made(EffectSpec(effect="prediction", file="a.csv", bounds={"gain": (0, 3)})).fixed == {}
    assert as_it_was_made(EffectSpec(effect="lag")).fixed == {}


def test_what_predict_writes_is_read(tmp_path: Path) -> None:
    """Units stand in brackets behind its names, and each test's campaign in a column."""
    path = tmp_path / "out.csv"
    path.write_text(
        '"campaign","test","response","t_s [s]","predicted [um]","measured [um]","known"\n'
        '"c","a","dZ",30,1.5,,true\n"c","a","dZ",0,0.5,,true\n'
    )
    t, y = read_prediction(path).tables["c/a"]
    assert t.tolist() == [0.0, 30.0]
    assert y.tolist() == [0.5, 1.5]


def test_a_prediction_file_that_is_not_there_is_told_with_what_it_should_be(tmp_path: Path) -> None:
    with pytest.raises(SpecError, match="no such prediction file") as caught:
        read_prediction(tmp_path / "theirs.csv")
    assert caught.value.got == "theirs.csv"
    assert "test, t_s, predicted" in (caught.value.expected or "")
