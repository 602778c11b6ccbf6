"""The table that papers print: which tests stand in it, and what its mean is of."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from thermodata.errors import UsageError
from thermodata.modelling import fit_model
from thermodata.modelling.compare.beside import MEAN, models_on_tests
from thermodata.schema.files.model import Model
from thermodata.view.grid.dataset import Dataset

Spec = Callable[..., Model]


def _models(world: Dataset, spec: Spec) -> list[Any]:
    named = (("whole", ("spindle_bearing", "ambient_frame")), ("part", ("spindle_bearing",)))
    return [(name, fit_model(spec(*effects), world, uncertainty=False), world) for name, effects in named]


def test_only_the_named_tests_stand_in_the_table_and_its_mean(world: Dataset, spec: Spec) -> None:
    models = _models(world, spec)
    every = models_on_tests(models, "part")
    opened = list(dict.fromkeys(row.test for row in every if row.test != MEAN))
    assert len(opened) > 2
    some = models_on_tests(models, "part", opened[1:3])
    assert [row for row in some if row.test != MEAN] == [row for row in every if row.test in opened[1:3]]
    for name in ("whole", "part"):
        (mean,) = [row for row in some if (row.test, row.model) == (MEAN, name)]
        own = [row.residual for row in some if row.test != MEAN and row.model == name]
        assert mean.residual == pytest.approx(np.mean([r for r in own if r is not None]))
        assert mean != next(row for row in every if (row.test, row.model) == (MEAN, name))


def test_a_test_that_is_unknown_or_closed_is_refused(world: Dataset, spec: Spec) -> None:
    models = _models(world, spec)
    with pytest.raises(UsageError, match="no test 'nowhere'"):
        models_on_tests(models, "part", ["nowhere"])
    (locked, *_) = [test for test in world.tests if test.role == "locked"]
    with pytest.raises(UsageError, match="neither fit nor verify") as refusal:
        models_on_tests(models, "part", [locked.test])
    assert locked.test in str(refusal.value.got)
