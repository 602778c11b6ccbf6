"""Effects of the model whose gain its tests do not determine, and what it leaves without them: what they do elsewhere
is foretold by a number that may be any."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from thermodata.errors import ThermodataError
from thermodata.modelling.compare.left_out_error import LeftOut
from thermodata.modelling.model_file.resolve import term_ids
from thermodata.modelling.terms.fitted import FittedModel
from thermodata.modelling.terms.fitted_response import FittedResponse, FittedTerm
from thermodata.modelling.terms.identified import identified
from thermodata.modelling.terms.of_tests import OfTests
from thermodata.schema.answers.result import Parameter
from thermodata.schema.answers.undetermined import Undetermined
from thermodata.schema.files.model import Model
from thermodata.view.grid.dataset import Dataset, TestData

UNSURE = 0.1
"""An interval of 95 % that reaches down to this share of the gain determines no more than that there may be none."""
MOST = 3  # are asked what the model leaves without them: each costs a fit for every left-out test
ELSEWHERE = 1.5  # times what it does in a fitted test: there its gain counts for more than the fit could see


def undetermined(
    fitted: FittedModel, of: FittedResponse, data: Dataset, known: Mapping[str, Parameter], weighed: bool = True
) -> list[Undetermined]:
    """Of one response, the one that costs most on left-out tests first. known: parameters of the fit with intervals, by
    the names that `FittedModel.parameters` gives. weighed: whether it is asked what the model leaves without each,
    which takes some dozen fits."""
    prefix = f"{of.name}/" if len(fitted.responses) > 1 else ""
    terms = [(t, gains) for t in of.terms if is_unsure(gains := _gains(t, prefix, known)) and _is_driven(t)]
    # what a model of one effect leaves without it is the response
    asked = [t.id for t, _ in terms[:MOST]] if weighed and len(of.terms) > 1 else []
    errors = _left_out(fitted.spec, of, data, asked)
    found = [_told(t, gains, of, fitted.tests(data), data.tests, errors) for t, gains in terms]
    return sorted(found, key=lambda one: -_costs(one))


def is_unsure(gains: Mapping[str, Parameter]) -> bool:
    """Whether each of an effect's gains may as well be next to nothing; False where one has no interval, as of what is
    held."""
    return bool(gains) and all(_may_be_nothing(p) for p in gains.values())


def _may_be_nothing(p: Parameter) -> bool:
    if p.low is None and p.high is None:
        return False
    if p.value == 0:
        return True
    near = p.low if p.value > 0 else p.high
    return near is None or near / p.value <= UNSURE


def _gains(term: FittedTerm, prefix: str, known: Mapping[str, Parameter]) -> dict[str, Parameter]:
    """By the names that they have in a fit; '[group]' behind those of groups."""
    names = {f"{prefix}{term.id}.{gain.name}" for gain in term.effect.gains}
    return {name.removeprefix(prefix): p for name, p in known.items() if name.partition("[")[0] in names}


def _is_driven(term: FittedTerm) -> bool:
    """Whether a channel drives it, so that another test has more of it: a slip or a drift is of its own test. An
    identified function has coefficients in place of a gain."""
    return bool(term.effect.needs) and not isinstance(term.effect, OfTests) and identified(term.effect) is None


def _told(
    term: FittedTerm,
    gains: Mapping[str, Parameter],
    of: FittedResponse,
    opened: Sequence[TestData],
    tests: Sequence[TestData],
    errors: Mapping[str, tuple[float, float]],
) -> Undetermined:
    """What it does in locked tests is of their drivers alone: their response is not looked at."""
    sizes = {t.key: _size(term, of, t) for t in tests if term.can_predict(t) and term.bound.covers(t)}
    most = max((size for key, size in sizes.items() if key in of.fitted_on), default=0.0)
    there = max((key for key in sizes if key not in of.fitted_on), key=lambda key: sizes[key], default=None)
    more = there is not None and sizes[there] > ELSEWHERE * most
    several = len({t.campaign for t in opened}) > 1
    left, without = errors.get(term.id, (None, None))
    return Undetermined(
        effect=term.id,
        drivers=list(dict.fromkeys(term.binding.values())),
        gains=dict(gains),
        does_um=most,
        elsewhere=("/".join(there) if several else there[1]) if there is not None and more else None,
        elsewhere_um=sizes[there] if there is not None and more else None,
        left_out_um=left,
        left_out_without_um=without,
    )


def _size(term: FittedTerm, of: FittedResponse, test: TestData) -> float:
    """RMS of what it does about its mean, where samples count."""
    does = term.contribution(test)[of.mask(test)]
    does = does[np.isfinite(does)]
    return float(np.std(does)) if len(does) else 0.0


def _left_out(spec: Model, of: FittedResponse, data: Dataset, names: Sequence[str]) -> dict[str, tuple[float, float]]:
    """(error on left-out tests, the same without the effect), by the id of an effect; none where a test can't be left
    out. Locked tests take no part."""
    ids = term_ids(spec.effects)
    asked = [name for name in names if name in ids]
    if not asked:
        return {}
    found = dict[str, tuple[float, float]]()
    try:
        left_out = LeftOut(spec, data)
        now = left_out.errors(spec).rmse(of.name)
        for name in asked:
            rest = [e.model_copy(update={"id": i}) for i, e in zip(ids, spec.effects, strict=True) if i != name]
            without = left_out.errors(spec.model_copy(update={"effects": rest})).rmse(of.name)
            if np.isfinite(now) and np.isfinite(without):
                found[name] = now, without
    except ThermodataError:  # the model can't be fitted without one of its tests
        return found
    return found


def _costs(one: Undetermined) -> float:
    """By how much the error on left-out tests is larger with it."""
    if one.left_out_um is None or one.left_out_without_um is None:
        return 0.0
    return one.left_out_um - one.left_out_without_um
