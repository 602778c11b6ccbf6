"""The guard: what an effect's basis gives, held against the contract before anything else sees it.

Every call is checked: beside the filters that a basis runs it is too quick to be measured.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import TypeVar

import numpy as np
import numpy.typing as npt

from thermodata.effect.registry import origin
from thermodata.errors import FAILED, EffectError
from thermodata.plugin import Drivers, Effect, Float2D

_T = TypeVar("_T", bound=np.generic)


def guarded_basis(effect: Effect, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
    """The effect's basis, shape (n, gains). EffectError where it raises what it may, gives columns of another shape or
    dtype, or numbers that are none; drivers are finite, so that a column can be. Ctrl-C and a full memory pass."""
    try:
        found = effect.basis(drivers, p)
    except (EffectError, MemoryError):
        raise
    except FAILED as error:
        raise _fault(effect, drivers, f"effect '{effect.name}' failed", _raised(error)) from error
    right = _has_shape(found, len(drivers.t_s), len(effect.gains))
    if right and _is_finite(found):
        return found
    rule = "a basis gives one finite float64 column a gain, with a row a sample"
    raise _fault(
        effect, drivers, f"effect '{effect.name}' broke the rule: {rule}", _what_was_given(effect, found, right, p)
    )


def guarded_bases(effect: Effect, several: Sequence[Drivers], points: Sequence[Mapping[str, float]]) -> list[Float2D]:
    """The same at several points in each of several tests, point by point side by side: shape (n, points * gains) each.
    Of an effect that has `bases` all at once; where these are not what they must be, one basis after the other, which
    tells what is wrong. EffectError: see `guarded_basis`."""
    width = len(points) * len(effect.gains)
    at_once = getattr(effect, "bases", None)
    if at_once is not None:
        try:
            found = list(at_once(several, points))
        except MemoryError:
            raise
        except (EffectError, *FAILED):
            found = []
        shapes = [_has_shape(f, len(d.t_s), width) and _is_finite(f) for f, d in zip(found, several, strict=False)]
        if len(found) == len(several) and all(shapes):
            return found
    return [np.concatenate([guarded_basis(effect, d, p) for p in points], axis=1) for d in several]


def _has_shape(found: object, rows: int, columns: int) -> bool:
    return isinstance(found, np.ndarray) and found.dtype == np.float64 and found.shape == (rows, columns)


def _is_finite(found: Float2D) -> bool:
    """By the quickest look at all of it; squares of finite numbers may be too large, which the second look forgives."""
    return math.isfinite(np.vdot(found, found)) or bool(np.isfinite(found).all())


def read_only(drivers: Drivers) -> Drivers:
    """The same drivers, which no effect can change: they are kept, and shared by the effects of a model."""
    return Drivers(
        _view(drivers.t_s),
        MappingProxyType({role: _view(values) for role, values in drivers.values.items()}),
        MappingProxyType({role: _view(valid) for role, valid in drivers.valid.items()}),
        MappingProxyType(dict(drivers.conditions)),
    )


def _view(values: npt.NDArray[_T]) -> npt.NDArray[_T]:
    view = values.view()
    view.flags.writeable = False
    return view


def _fault(effect: Effect, drivers: Drivers, what: str, got: str) -> EffectError:
    return EffectError(
        what,
        effect=effect.name,
        origin=origin(effect),
        expected=f"shape {(len(drivers.t_s), len(effect.gains))}, float64, finite; drivers are read-only",
        got=got,
        hint="a fault of this plugin: take its effect out of the model, or mend it "
        "(thermodata.testing.effect.check_effect tells what it breaks)",
    )


def _raised(error: BaseException) -> str:
    """'KeyError: 'zz' (line 12 of effect.py)': the line that raised it."""
    last = error.__traceback__
    while last is not None and last.tb_next is not None:
        last = last.tb_next
    line = "" if last is None else f" (line {last.tb_lineno} of {last.tb_frame.f_code.co_filename.rsplit('/', 1)[-1]})"
    return f"{type(error).__name__}: {error}{line}"


def _what_was_given(effect: Effect, found: object, right: bool, p: Mapping[str, float]) -> str:
    if not isinstance(found, np.ndarray):
        return f"{type(found).__name__}, and no array"
    if not right:
        return f"shape {found.shape}, {found.dtype}"
    row, column = (int(place[0]) for place in np.nonzero(~np.isfinite(found)))
    params = ", ".join(f"{name} = {value:g}" for name, value in p.items())
    name = effect.gains[column].name
    return f"{found[row, column]} in the column of '{name}' at row {row}" + (f", with {params}" if params else "")
