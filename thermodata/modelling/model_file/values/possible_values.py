"""Values of a model file that nothing can have: a time below zero, bounds the wrong way round, a start or a fixed value
outside of the file's own bounds, a gain whose name is no word.

How fast or slow a body may be is no business of this: a candidate's time constant may lie beyond the library's bounds.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from math import isfinite

from thermodata.errors import SpecError, nearest
from thermodata.modelling.terms.bound import group_of
from thermodata.plugin import Effect, Param
from thermodata.schema.files.model import EffectSpec
from thermodata.schema.strict.printed import Printed
from thermodata.schema.units.conversion import converts
from thermodata.view.grid.dataset import Dataset, TestData

_NAME = re.compile(r"[^\W\d]\w*")
_NEAR = 1e-9  # of the bounds: what a fit left at one of them lies within


def refuse_impossible(given: EffectSpec, spec: EffectSpec, effect: Effect, where: str) -> None:
    """SpecError for what is fixed, started or bounded so. given: as the file says it; spec: in the effect's own units;
    where: the effect's place in the file, such as `effects[0]`."""
    params = {p.name: p for p in effect.params}
    for name, (low, high) in spec.bounds.items():
        _bounds(f"{where}.bounds.{name}", name, given.bounds[name], (low, high), params.get(name))
    for key, values, written in (("fixed", spec.fixed, given.fixed), ("start", spec.start, given.start)):
        for name, value in values.items():
            _value(f"{where}.{key}.{name}", name, written.get(name, value), value, params.get(name))
            if name in spec.bounds:
                ends, said = spec.bounds[name], _range(given.bounds[name])
            elif key == "start" and name in params:
                ends = (params[name].lower, params[name].upper)
                said = f"{_range(ends)} {_unit(params[name])}"
            else:
                continue
            near = _NEAR * sum(abs(end) for end in ends if isfinite(end))
            if not ends[0] - near <= value <= ends[1] + near:
                raise SpecError(
                    f"'{name}': the {key} value lies outside of its bounds",
                    where=f"{where}.{key}.{name}",
                    expected=f"within {said}",
                    got=_text(written.get(name, value)),
                    hint=f"other bounds for the search: bounds: {{{name}: [..., ...]}}"
                    if name not in spec.bounds
                    else "a fixed value needs no bounds"
                    if key == "fixed"
                    else "the search goes on within the bounds alone",
                )


def refuse_no_name(spec: EffectSpec, where: str) -> None:
    """SpecError where the free gain of a model in a model has a name that is no word: '2 um' and '1,2' are values."""
    if isinstance(spec.gain, str) and not _NAME.fullmatch(spec.gain):
        raise SpecError(
            "'gain': neither a number nor a name",
            where=f"{where}.gain",
            expected="a number, which holds the factor on its output: 1.2; or a name, which leaves it free: K",
            got=spec.gain,
            hint="a name begins with a letter and has letters, digits and _ only",
        )
    if isinstance(spec.gain, float) and not isfinite(spec.gain):
        raise SpecError(
            "'gain' is no finite number",
            where=f"{where}.gain",
            expected="a number",
            got=str(spec.gain),
            hint="leave 'gain' out, which leaves it free",
        )


def refuse_unknown_groups(spec: EffectSpec, data: Dataset, where: str) -> None:
    """SpecError for a value in `groups` that no test has: misspelt, it would leave the right one a gain of its own."""
    if not spec.groups:
        return
    known = dict.fromkeys(v for by in spec.gains_by for test in data.tests for v in _values(test, by))
    for value in spec.groups:
        if value not in known and known:
            close = nearest(value, list(known))
            raise SpecError(
                f"no test has the value '{value}' of {', '.join(spec.gains_by)}",
                where=f"{where}.groups",
                expected=", ".join(known),
                got=value,
                hint=f"did you mean '{close}'?" if close else "leave it out of the groups",
            )


def _values(test: TestData, by: str) -> Sequence[str]:
    if by == "place":  # of a response, which may be any channel
        return tuple(test.values)
    value = group_of(test, by)
    return () if value is None else (value,)


def _bounds(where: str, name: str, given: tuple[float, float], ends: tuple[float, float], param: Param | None) -> None:
    for one, value in zip(given, ends, strict=True):
        if param is not None or value != value:  # a gain may have no end
            _value(where, name, one, value, param, _range(given))
    low, high = ends
    if low > high:
        raise SpecError(
            f"the bounds of '{name}' stand the wrong way round",
            where=where,
            expected=_range((given[1], given[0])),
            got=_range(given),
            hint="put the lower one first",
        )
    if low == high:
        raise SpecError(
            f"the bounds of '{name}' leave one value",
            where=where,
            expected=f"fixed: {{{name}: {_text(given[0])}}}, or a lower and a higher one",
            got=_range(given),
            hint="'fixed' holds a parameter; 'bounds' is where it is searched for",
        )


def _value(where: str, name: str, given: float, value: float, param: Param | None, got: str | None = None) -> None:
    if not isfinite(value):
        raise SpecError(
            f"'{name}' is no finite number",
            where=where,
            expected="a number",
            got=got or _text(given),
            hint="leave it out, which lets the fit search for it",
        )
    if param is not None and value < 0 <= param.lower and converts(param.unit, "s"):
        raise SpecError(
            f"'{name}' is a time, and none is below zero",
            where=where,
            expected=f"0 {param.unit} or more",
            got=got or _text(given),
            hint="a log whose clock is late: clock: {offset: ...} of its source" if name == "dead_time" else None,
        )


def _unit(param: Param) -> str:
    return "" if param.unit == "1" else param.unit


def _range(ends: tuple[float, float]) -> str:
    return f"[{_text(ends[0])}, {_text(ends[1])}]"


def _text(value: float) -> str:
    return value.text if isinstance(value, Printed) else f"{value:g}"
