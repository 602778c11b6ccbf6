"""Effects and responses that stand on channels: what a model file means on the data at hand."""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from thermodata.errors import EffectError, unknown_name
from thermodata.modelling.inputs.drivers import has_drivers, names_of
from thermodata.modelling.inputs.lead import columns, columns_of_each, led_drivers
from thermodata.modelling.inputs.roles import Key
from thermodata.modelling.terms.acting import acting, moved_while
from thermodata.modelling.terms.of_tests import OfTests
from thermodata.plugin import Bool1D, Drivers, Effect, Float2D
from thermodata.schema.files.model import EffectSpec
from thermodata.view.grid.at_work import activity_channels
from thermodata.view.grid.dataset import TestData

OF_TESTS = ("test", "machine", "campaign")  # what a gain can differ by, beside conditions,
OF_RESPONSES = ("tool", "place")  # and by what has a name of its own
KEPT_TESTS = 1024  # drivers a term keeps; changed copies of tests count too
PLACE = "response's place"  # a condition of tests that were copied for each of several responses


@dataclass(frozen=True)
class BoundTerm:
    """An effect on its channels. bindings: campaign -> role -> channel or expression (names may differ)."""

    id: str
    effect: Effect
    spec: EffectSpec
    bindings: Mapping[str, Mapping[str, str]]
    family: str
    only: frozenset[Key] | None = None  # the tests it exists in; None: all
    calibrate: frozenset[Key] | None = None  # identified on these first
    seen_at: Mapping[str, str] | None = None  # campaign -> the response that it is identified on first, then held
    apart: bool = False  # parameters of its own at each place, where several responses are fitted together
    _drivers: dict[int, tuple[TestData, Drivers, tuple[Drivers, int]]] = field(
        default_factory=dict, repr=False, compare=False
    )

    @property
    def reading(self) -> Hashable:
        """Which channels it reads in which campaign."""
        return tuple((campaign, *binding.items()) for campaign, binding in self.bindings.items())

    @property
    def binding(self) -> Mapping[str, str]:
        return next(iter(self.bindings.values()), {})

    def covers(self, test: TestData) -> bool:
        return self.only is None or test.key in self.only

    def has(self, test: TestData) -> bool:
        """Whether the test has what the term reads (a term that does not cover a test needs nothing there)."""
        if not self.covers(test):
            return True
        if self.spec.phases is not None and acting(test, self.spec.phases) is None:
            return False
        if isinstance(self.effect, OfTests):
            return self.effect.has(test)
        return has_drivers(test, self.binding_of(test))

    def lacks(self, test: TestData) -> str:
        """Why it has not, where that is told by what its output comes from; else ''."""
        return self.effect.lacks(test) if isinstance(self.effect, OfTests) and not self.effect.has(test) else ""

    def drivers(self, test: TestData) -> Drivers:
        """What the effect sees of the test."""
        return self._drivers_kept(test)[1]

    def _drivers_kept(self, test: TestData) -> tuple[TestData, Drivers, tuple[Drivers, int]]:
        """Made once a test; a changed copy of a test is another test."""
        kept = self._drivers.get(id(test))
        if kept is None or kept[0] is not test:
            if len(self._drivers) >= KEPT_TESTS:
                self._drivers.clear()
            made = led_drivers(test, self.effect, self.binding_of(test), self.id)
            kept = self._drivers[id(test)] = (test, *made)
        return kept

    def columns(self, test: TestData, params: Mapping[str, float]) -> Float2D:
        """shape (n, gains); zeros where the term does not cover the test. EffectError: see `guarded_basis`."""
        if not self.covers(test):
            return np.zeros((len(test.t_s), len(self.effect.gains)))
        if isinstance(self.effect, OfTests):
            found = self.effect.column(test)
        else:
            try:
                found = columns(self.effect, self._drivers_kept(test)[2], params)
            except EffectError as error:
                raise error.at(f"effect '{self.id}' of {error.origin}, test '{test.campaign}/{test.test}'") from error
        return self.while_acting(test, found)

    def columns_of_each(self, tests: Sequence[TestData], params: Mapping[str, float]) -> list[Float2D]:
        """The same of several tests."""
        try:
            if isinstance(self.effect, OfTests) or not all(self.covers(t) for t in tests):
                return [self.columns(t, params) for t in tests]
            found = columns_of_each(self.effect, [self._drivers_kept(t)[2] for t in tests], [params])
        except EffectError:  # one after the other, it is told in which test
            return [self.columns(t, params) for t in tests]
        return [self.while_acting(t, own) for t, own in zip(tests, found, strict=True)]

    def while_acting(self, test: TestData, found: Float2D) -> Float2D:
        """Columns of the whole test, shape (n, k), as far as the term's phases last."""
        where = None if self.spec.phases is None else acting(test, self.spec.phases)
        return found if where is None else moved_while(found, where)

    def reads(self, test: TestData) -> tuple[str, ...]:
        """Every channel that its columns depend on in a test: its drivers, and what tells its phases."""
        if isinstance(self.effect, OfTests):
            return self.effect.reads(test)
        own = [n for text in self.binding_of(test).values() for n in names_of(text)]
        phased = activity_channels(test) if self.spec.phases is not None else []
        return tuple(dict.fromkeys([*own, *phased]))

    def known(self, test: TestData) -> Bool1D | None:
        """Where all drivers were measured, or nearly; None: everywhere."""
        if not self.covers(test):
            return None
        if isinstance(self.effect, OfTests):
            return np.isfinite(self.effect.column(test)[:, 0])
        if not self.effect.needs:
            return None
        masks = list(self.drivers(test).valid.values())
        out = masks[0].copy()
        for mask in masks[1:]:
            out &= mask
        return out

    def group(self, test: TestData) -> str:
        """The value that its gain belongs to ('' where one gain serves all)."""
        values = [self._value(name, test) for name in self.spec.gains_by]
        return ", ".join(self.spec.groups.get(v, v) for v in values if v)

    def _value(self, by: str, test: TestData) -> str:
        value = group_of(test, by)
        if value is None:
            raise unknown_name(
                "condition",
                by,
                conditions_of(test),
                where=f"gain_by of effect '{self.id}', test {test.campaign}/{test.test}",
            )
        return value

    def binding_of(self, test: TestData) -> Mapping[str, str]:
        """role -> channel or expression, as the test's campaign names them."""
        found = self.bindings.get(test.campaign)
        return self.binding if found is None else found


def group_of(test: TestData, by: str) -> str | None:
    """The value of one name of `gain_by` in a test; None where the test has no such condition."""
    if by == "place":
        return str(test.conditions.get(PLACE, ""))
    if by in OF_TESTS:
        return str(getattr(test, by))
    name = by.removeprefix("conditions.")
    if name == "tool" and name not in test.conditions:
        name = "tool.id"
    value = test.conditions.get(name)
    return f"{value:g}" if isinstance(value, float | int) else None if value is None else str(value)


def conditions_of(test: TestData) -> list[str]:
    """All that a gain can differ by in a test."""
    return [n for n in (*test.conditions, *OF_TESTS, *OF_RESPONSES) if group_of(test, n) is not None]


def each_group_its_own(term: BoundTerm) -> BoundTerm:
    """The same term with gains of each group by themselves, where the factor between groups is known."""
    if not term.spec.one_gain:
        return term
    return replace(term, spec=term.spec.model_copy(update={"one_gain": False}))


@dataclass(frozen=True)
class BoundResponse:
    """name: its channel (in the first campaign); channels: campaign -> channel."""

    name: str
    unit: str
    channels: Mapping[str, str]
    terms: tuple[BoundTerm, ...]
    units: Mapping[str, str] = field(default_factory=dict)  # of every channel, by name
    weights: Mapping[str, float] = field(default_factory=dict)  # test or phase -> weight of its samples; 1 else

    def channel_of(self, test: TestData) -> str:
        return self.channels.get(test.campaign, self.name)
