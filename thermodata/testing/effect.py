"""The kit for effects: one call checks a plugin's effect against the contract of `thermodata.plugin.Effect`.

    from thermodata.testing.effect import check_effect

    def test_my_effect() -> None:
        check_effect(MyEffect())

Each rule is a function whose name is the sentence; `faults` returns what does not hold, `check_effect` raises it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from itertools import product

import numpy as np

from thermodata.effect.guard import guarded_bases
from thermodata.effect.law import with_parameters
from thermodata.effect.law_run import evaluate
from thermodata.effect.places import can_bind, in_vocabulary, part_alone
from thermodata.errors import PluginError
from thermodata.plugin import Drivers, Effect, Float1D
from thermodata.schema.files.campaign import FEEDBACKS
from thermodata.schema.units.quantity import QUANTITIES
from thermodata.schema.words.places import nearest_place
from thermodata.testing.effect_drivers import FINER, STEP_S, on_finer_grid, shortened, start, variants
from thermodata.testing.effect_units import (
    its_gains_have_the_units_of_what_drives_them,
    its_units_are_those_of_the_library,
)

# of a column's rms: what switches is a ramp of one sample on either grid
GRID_TOLERANCE = 0.1
Rule = Callable[[Effect], Iterator[str]]


def check_effect(effect: Effect) -> None:
    """Raises PluginError with every rule that the effect breaks."""
    found = faults(effect)
    if found:
        raise PluginError(
            f"effect '{getattr(effect, 'name', effect)}' breaks its contract",
            got="; ".join(f"{rule}: {why}" for rule, why in found.items()),
        )


def faults(effect: Effect) -> dict[str, str]:
    """Broken rule -> what happened. A rule that can't be checked because the effect raises is broken."""
    found: dict[str, str] = {}
    for rule in RULES:
        try:
            why = next(rule(effect), None)
        except Exception as error:
            why = f"{type(error).__name__}: {error}"
        if why is not None:
            found[rule.__name__] = why
    return found


def it_has_all_that_the_contract_names(effect: Effect) -> Iterator[str]:
    if not isinstance(effect, Effect):
        yield "an attribute or method of thermodata.plugin.Effect is missing"
    for text in ("name", "family", "meaning", "source"):
        if not isinstance(getattr(effect, text, None), str) or not getattr(effect, text):
            yield f"'{text}' is no text"
    if not effect.name.isidentifier():
        yield f"the name '{effect.name}' is no identifier"
    if not effect.gains:
        yield "it has no gain, so it can contribute nothing"


def what_it_states_beyond_the_contract_is_text(effect: Effect) -> Iterator[str]:
    for name in ("equation", "telltale"):
        value = getattr(effect, name, None)
        if value is not None and not (isinstance(value, str) and value.strip()):
            yield f"'{name}' is {value!r}, and no text"
    refines = getattr(effect, "refines", ())
    if not isinstance(refines, tuple) or not all(isinstance(one, str) for one in refines):
        yield f"'refines' is {refines!r}, and no tuple of names"
    told_by = getattr(effect, "told_by", None)
    if told_by is not None and told_by not in [n.role for n in effect.needs]:
        yield f"'told_by' is {told_by!r}, and no role of its own"
    closed_by = getattr(effect, "closed_by", None)
    if closed_by is not None and closed_by not in FEEDBACKS:
        yield f"'closed_by' is {closed_by!r}, and no feedback of an axis: {', '.join(FEEDBACKS)}"


def its_names_are_unique(effect: Effect) -> Iterator[str]:
    names = [p.name for p in effect.params] + [g.name for g in effect.gains]
    if len(set(names)) < len(names):
        yield f"parameters and gains share a name: {names}"
    roles = [n.role for n in effect.needs]
    if len(set(roles)) < len(roles):
        yield f"roles repeat: {roles}"


def it_needs_quantities_that_exist(effect: Effect) -> Iterator[str]:
    for need in effect.needs:
        if need.quantity != "*" and need.quantity not in QUANTITIES:
            yield f"no quantity '{need.quantity}'"


def it_names_places_that_can_be(effect: Effect) -> Iterator[str]:
    for need in effect.needs:
        if not isinstance(need.places, tuple) or not all(isinstance(place, str) for place in need.places):
            yield f"{need.role}: places is {need.places!r}, and no tuple of texts"
            return
        for place in need.places:
            if not can_bind(place):
                yield f"{need.role}: no channel stands at {place!r}; a part is a word, '*' or '{{a}}': axis.{{a}}.nut"


def it_names_places_of_the_vocabulary(effect: Effect) -> Iterator[str]:
    for need in effect.needs:
        for place in need.places:
            if can_bind(place) and not in_vocabulary(place):
                close = nearest_place(part_alone(place))
                known = f"did you mean {close!r}?" if close else "thermodata.schema.words.places has those that are"
                yield f"{need.role}: {place!r} is no place of the vocabulary; {known}"


def its_bounds_hold_its_start(effect: Effect) -> Iterator[str]:
    for p in effect.params:
        if not (np.isfinite([p.lower, p.start, p.upper]).all() and p.lower <= p.start <= p.upper and p.lower < p.upper):
            yield f"{p.name}: {p.lower} <= {p.start} <= {p.upper} does not hold"
        if p.reach is not None and not p.reach[0] <= p.lower < p.upper <= p.reach[1]:
            yield f"{p.name}: {p.lower} to {p.upper} does not lie within its reach, {p.reach}"
    for g in effect.gains:
        if not 0 <= g.magnitude[0] <= g.magnitude[1] or g.sign not in ("+", "-", "any"):
            yield f"{g.name}: magnitude {g.magnitude}, sign {g.sign!r}"


def it_gives_one_column_a_gain(effect: Effect) -> Iterator[str]:
    for drivers in variants(effect):
        for n in (len(drivers.t_s), 2, 1):
            try:
                columns = effect.basis(shortened(drivers, n), start(effect))
            except Exception as error:
                samples = "1 sample, as a test may be" if n == 1 else f"{n} samples"
                yield f"asked with {samples}, it raises {type(error).__name__}: {error}"
                continue
            if not isinstance(columns, np.ndarray) or columns.shape != (n, len(effect.gains)):
                yield f"{n} samples gave shape {np.shape(columns)}, not {(n, len(effect.gains))}"
            elif columns.dtype != np.float64:
                yield f"dtype {columns.dtype}, not float64"


def it_is_finite_at_every_bound(effect: Effect) -> Iterator[str]:
    for drivers in variants(effect):
        for corner in product(*((p.lower, p.upper) for p in effect.params)):
            p = {q.name: value for q, value in zip(effect.params, corner, strict=True)}
            if not np.isfinite(effect.basis(drivers, p)).all():
                yield f"not finite at {p}"


def it_is_zero_at_rest(effect: Effect) -> Iterator[str]:
    if not effect.needs:
        return
    for drivers in variants(effect):
        rest = replace(drivers, values={r: np.zeros_like(v) for r, v in drivers.values.items()})
        if np.any(effect.basis(rest, start(effect)) != 0):
            yield "with all drivers at rest it still contributes"


def it_answers_to_its_drivers(effect: Effect) -> Iterator[str]:
    for drivers in variants(effect):
        columns = effect.basis(drivers, start(effect))
        for gain, column in zip(effect.gains, columns.T, strict=True):
            if not np.any(column):
                yield f"the column of '{gain.name}' is zero whatever drives it"


def it_does_not_look_ahead(effect: Effect) -> Iterator[str]:
    for drivers in variants(effect):
        cut = len(drivers.t_s) // 2
        late = {r: np.concatenate([v[:cut], v[cut:] * 0.3 + 1.0]) for r, v in drivers.values.items()}
        before = effect.basis(drivers, start(effect))[:cut]
        after = effect.basis(replace(drivers, values=late), start(effect))[:cut]
        if not np.allclose(before, after, rtol=1e-9, atol=1e-9):
            yield "what comes later changes what came before"


def it_says_the_same_twice(effect: Effect) -> Iterator[str]:
    for drivers in variants(effect):
        kept = {r: v.copy() for r, v in drivers.values.items()}
        first = np.array(effect.basis(drivers, start(effect)))
        effect.basis(shortened(drivers, len(drivers.t_s) // 2), start(effect))
        if not np.array_equal(first, effect.basis(drivers, start(effect))):
            yield "a second call with the same drivers gives something else"
        if any(not np.array_equal(kept[r], v) for r, v in drivers.values.items()):
            yield "it changes its drivers"


def every_parameter_changes_something(effect: Effect) -> Iterator[str]:
    silent = {p.name for p in effect.params}
    for drivers in variants(effect):
        for p in effect.params:
            low, high = (effect.basis(drivers, {**start(effect), p.name: end}) for end in (p.lower, p.upper))
            if not np.allclose(low, high):
                silent.discard(p.name)
    if silent:
        yield f"no driver makes {sorted(silent)} matter"


def its_law_is_its_basis(effect: Effect) -> Iterator[str]:
    law = getattr(effect, "law", None)
    if law is None:
        return
    units = {q.name: q.unit for q in effect.params}
    for drivers in variants(effect):
        for ends in ("start", "lower", "upper"):
            p = {q.name: float(getattr(q, ends)) for q in effect.params}
            columns = effect.basis(drivers, p)
            formulas = law(set(drivers.values), p, STEP_S)
            if len(formulas) != len(effect.gains):
                yield f"{len(formulas)} formulas for {len(effect.gains)} gains"
                return
            for gain, formula, column in zip(effect.gains, formulas, columns.T, strict=True):
                told = evaluate(with_parameters(formula, p, units), drivers.values, STEP_S)
                if not np.allclose(told, column, rtol=1e-9, atol=1e-9 * max(1.0, float(np.abs(column).max()))):
                    yield f"the law of '{gain.name}' gives something else than the basis, by {_peak(told - column):.3g}"


def its_bases_are_its_basis(effect: Effect) -> Iterator[str]:
    several = [*variants(effect), *(shortened(d, len(d.t_s) // 2) for d in variants(effect))]
    points = [{q.name: float(getattr(q, end)) for q in effect.params} for end in ("start", "lower", "upper")]
    many = getattr(effect, "bases", lambda *asked: guarded_bases(effect, *asked))
    for found, drivers in zip(many(several, points), several, strict=True):
        if not np.array_equal(found, np.concatenate([effect.basis(drivers, p) for p in points], axis=1)):
            yield "what it gives of many at once is not what it gives of each, to the last digit"


def it_says_the_same_on_any_grid(effect: Effect) -> Iterator[str]:
    for coarse in variants(effect):
        fine = on_finer_grid(coarse)
        for gain, slow, fast in zip(effect.gains, *_columns_at_start(effect, coarse, fine), strict=True):
            there = fast[::FINER]
            size = float(np.sqrt(np.mean(slow**2)))
            if size > 0 and float(np.sqrt(np.mean((slow - there) ** 2))) > GRID_TOLERANCE * size:
                yield f"the column of '{gain.name}' is another one at {STEP_S / FINER:g} s than at {STEP_S:g} s"


def _columns_at_start(effect: Effect, *many: Drivers) -> list[Iterator[Float1D]]:
    return [iter(effect.basis(drivers, start(effect)).T) for drivers in many]


def a_gap_that_was_filled_right_changes_nothing(effect: Effect) -> Iterator[str]:
    for drivers in variants(effect):
        n = len(drivers.t_s)
        seen = np.ones(n, bool)
        seen[n // 3 : n // 2] = False
        whole = effect.basis(drivers, start(effect))
        holed = effect.basis(replace(drivers, valid=dict.fromkeys(drivers.values, seen)), start(effect))
        if not np.allclose(whole, holed, rtol=1e-9, atol=1e-12):
            yield "it looks at which samples are valid: filling them is done before, and what is filled does not count"


def _peak(values: Float1D) -> float:
    return float(np.abs(values).max())


RULES: tuple[Rule, ...] = (
    it_has_all_that_the_contract_names,
    what_it_states_beyond_the_contract_is_text,
    its_names_are_unique,
    it_needs_quantities_that_exist,
    it_names_places_that_can_be,
    it_names_places_of_the_vocabulary,
    its_bounds_hold_its_start,
    it_gives_one_column_a_gain,
    it_is_finite_at_every_bound,
    it_is_zero_at_rest,
    it_answers_to_its_drivers,
    it_does_not_look_ahead,
    it_says_the_same_twice,
    every_parameter_changes_something,
    its_law_is_its_basis,
    its_bases_are_its_basis,
    it_says_the_same_on_any_grid,
    a_gap_that_was_filled_right_changes_nothing,
    its_units_are_those_of_the_library,
    its_gains_have_the_units_of_what_drives_them,
)
