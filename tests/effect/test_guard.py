"""The guard of effects: what a basis gives is held against the contract, and who breaks it is named."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from thermodata.effect import effect
from thermodata.effect.guard import guarded_bases, guarded_basis, read_only
from thermodata.errors import EffectError, UsageError
from thermodata.modelling.model_file.shaped import DEAD_TIME, Shaped
from thermodata.plugin import Drivers, Float2D, Gain, Need, Param

N = 5
T_S = 60.0 * np.arange(N)
DRIVERS = read_only(Drivers(T_S, {"u": np.arange(N, dtype=np.float64)}, {"u": np.ones(N, bool)}, {"tool": "T1"}))


class Gives:
    """Gives what it was made with, or raises it."""

    name, family, meaning, source = "gives", "artefact", "what it was made with", "none"
    needs = (Need("u", "temperature"),)
    params = (Param("tau", "min", 1.0, 0.1, 10.0, "unused"),)
    gains = (Gain("gain", "um/K", (0.0, 1.0), "any", "unused"),)

    def __init__(self, what: Any) -> None:
        self.what = what

    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        if isinstance(self.what, BaseException):
            raise self.what
        found: Float2D = self.what(drivers) if callable(self.what) else self.what
        return found


def basis(what: Any) -> Float2D:
    return guarded_basis(Gives(what), DRIVERS, {"tau": 2.0})


def column(value: float = 1.0) -> Float2D:
    return np.full((N, 1), value)


@pytest.mark.parametrize(
    "right",
    [column(), column(0.0), column(1e200), np.ones((1, N)).T, np.asfortranarray(np.ones((N, 2)))[:, :1]],
    ids=["ones", "zeros", "squares overflow", "transposed", "a view"],
)
def test_a_finite_float64_column_a_gain_passes_as_it_is(right: Float2D) -> None:
    assert basis(right) is right


@pytest.mark.parametrize(
    ("wrong", "got"),
    [
        (np.ones((N, 2)), "shape (5, 2), float64"),
        (np.ones(N), "shape (5,), float64"),
        (np.ones((N - 1, 1)), "shape (4, 1), float64"),
        (np.ones((N, 1), np.complex128), "shape (5, 1), complex128"),
        (np.ones((N, 1), np.float32), "shape (5, 1), float32"),
        (np.ones((N, 1), np.int64), "shape (5, 1), int64"),
        (None, "NoneType, and no array"),
        ([[1.0]] * N, "list, and no array"),
        (np.float64(1.0), "float64, and no array"),
        (column(np.nan), "nan in the column of 'gain' at row 0, with tau = 2"),
        (np.array([[0.0], [1.0], [2.0], [-np.inf], [4.0]]), "-inf in the column of 'gain' at row 3, with tau = 2"),
    ],
)
def test_any_other_answer_names_effect_plugin_rule_and_what_was_got(wrong: object, got: str) -> None:
    with pytest.raises(EffectError) as caught:
        basis(wrong)
    error = caught.value
    assert error.what == (
        "effect 'gives' broke the rule: a basis gives one finite float64 column a gain, with a row a sample"
    )
    assert (error.effect, error.got, error.exit_code) == ("gives", got, 1)
    assert error.where == error.origin == f"{Gives.__module__}:Gives"
    assert error.expected is not None
    assert error.expected.startswith("shape (5, 1), float64, finite")
    assert "check_effect" in (error.hint or "")


@pytest.mark.parametrize("raised", [KeyError("zz"), SystemExit(3), OSError(2, "gone"), UsageError("no")])
def test_what_it_raises_is_a_fault_of_its_plugin(raised: BaseException) -> None:
    with pytest.raises(EffectError, match=r"^effect 'gives' failed\n") as caught:
        basis(raised)
    assert caught.value.got is not None
    assert caught.value.got.startswith(f"{type(raised).__name__}: {raised} (line ")
    assert caught.value.got.endswith("of test_guard.py)")


@pytest.mark.parametrize("raised", [KeyboardInterrupt, MemoryError])
def test_ctrl_c_and_a_full_memory_are_no_plugins_fault(raised: type[BaseException]) -> None:
    with pytest.raises(raised):
        basis(raised())


def overwrites(drivers: Drivers) -> Float2D:
    drivers.values["u"][:] -= 1.0
    return drivers.values["u"].reshape(-1, 1)


def rebinds(drivers: Drivers) -> Float2D:
    drivers.values["u"] = drivers.values["u"] * 2.0  # type: ignore[index]
    return drivers.values["u"].reshape(-1, 1)


@pytest.mark.parametrize("changes", [overwrites, rebinds])
def test_drivers_can_t_be_changed_and_who_tries_is_named(changes: object) -> None:
    with pytest.raises(EffectError, match="drivers are read-only"):
        basis(changes)
    assert DRIVERS.values["u"].tolist() == [0.0, 1.0, 2.0, 3.0, 4.0]


def test_a_copy_of_the_drivers_may_be_changed_and_who_made_them_may_go_on_writing() -> None:
    def copies(drivers: Drivers) -> Float2D:
        own = drivers.values["u"].copy()
        own[:] -= 1.0
        return own.reshape(-1, 1)

    assert basis(copies)[0, 0] == -1.0
    values = np.zeros(N)
    made = read_only(Drivers(T_S, {"u": values}, {}, {}))
    values[0] = 7.0
    assert (made.values["u"][0], made.t_s.flags.writeable, T_S.flags.writeable) == (7.0, False, True)


def test_the_effect_is_named_also_where_its_drivers_come_late() -> None:
    shaped = Shaped(Gives(overwrites), [DEAD_TIME.name], "test")
    with pytest.raises(EffectError, match="read-only") as caught:
        guarded_basis(shaped, DRIVERS, {"tau": 1.0, DEAD_TIME.name: 60.0})
    assert caught.value.origin == f"{Gives.__module__}:Gives"


def test_an_effect_of_an_entry_point_is_named_with_its_distribution() -> None:
    lag = effect("lag")
    drivers = replace(DRIVERS, values={})
    with pytest.raises(EffectError) as caught:
        guarded_basis(lag, drivers, {})
    assert caught.value.origin.startswith("thermodata-effects-machine-tool ")
    assert caught.value.origin.endswith("(thermodata_effects_machine_tool.generic:Lag)")


class GivesAll(Gives):
    """And all at once."""

    def __init__(self, what: Any, at_once: Any) -> None:
        super().__init__(what)
        self.at_once = at_once

    def bases(self, several: Sequence[Drivers], points: Sequence[Mapping[str, float]]) -> list[Float2D]:
        if isinstance(self.at_once, BaseException):
            raise self.at_once
        found: list[Float2D] = self.at_once
        return found


POINTS = [{"tau": 1.0}, {"tau": 2.0}, {"tau": 3.0}]


def test_bases_are_taken_as_they_are() -> None:
    right = [np.full((N, 3), 7.0)] * 2
    found = guarded_bases(GivesAll(column(), right), [DRIVERS] * 2, POINTS)
    assert [f is r for f, r in zip(found, right, strict=True)] == [True, True]


@pytest.mark.parametrize(
    "wrong",
    [
        [],
        [np.ones((N, 3))],
        [np.ones((N, 3)), np.ones((N, 2))],
        [np.full((N, 3), np.nan)] * 2,
        ValueError("no"),
        [None] * 2,
    ],
    ids=["none", "too few", "narrow", "not finite", "raises", "no arrays"],
)
def test_where_bases_are_wrong_each_basis_is_asked_for(wrong: Any) -> None:
    found = guarded_bases(GivesAll(column(2.0), wrong), [DRIVERS] * 2, POINTS)
    assert [f.tolist() for f in found] == [np.full((N, 3), 2.0).tolist()] * 2
    with pytest.raises(EffectError, match="'gives' failed"):
        guarded_bases(GivesAll(KeyError("zz"), wrong), [DRIVERS] * 2, POINTS)


def test_without_bases_each_basis_is_asked_for() -> None:
    assert guarded_bases(Gives(column(3.0)), [DRIVERS], POINTS)[0].tolist() == np.full((N, 3), 3.0).tolist()
