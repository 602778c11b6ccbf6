"""All that a report shows, as plain values: collected from a store, or made by hand in tests."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from thermodata.modelling.seen.as_system import SeenResponse
from thermodata.plugin import Float1D
from thermodata.schema.answers.confirmed import Confirmed
from thermodata.schema.answers.diagnosis import Diagnosis, WeakSpot
from thermodata.schema.answers.result import Check, Parameter, Score
from thermodata.view.lists.response_units import told_together


@dataclass(frozen=True, slots=True)
class Curve:
    """One channel of a test on a uniform grid. values: shape (n,), NaN where nothing was measured. sd: its standard
    deviation, None where it has none."""

    name: str
    unit: str
    values: Float1D
    sd: Float1D | None = None


@dataclass(frozen=True, slots=True)
class TestPart:
    """One response in one test, on a uniform grid of step_s from start_s [s]; all arrays have shape (n,). unit: in
    which it is measured (None: in that of its errors, which is K of a temperature).

    lanes: operating state (speed, feed, flags); drivers: what the effects were given. phases: name -> (from, to) [s].
    """

    __test__ = False
    campaign: str
    test: str
    kind: str
    role: str
    response: str
    start_s: float
    step_s: float
    measured: Float1D
    predicted: Float1D
    residual: Float1D
    contributions: tuple[Curve, ...] = ()
    drivers: tuple[Curve, ...] = ()
    lanes: tuple[Curve, ...] = ()
    conditions: dict[str, Any] = field(default_factory=dict)
    phases: dict[str, tuple[float, float]] = field(default_factory=dict)
    predicted_sd: Float1D | None = None  # by the uncertainty of the parameters
    unit: str | None = None


@dataclass(frozen=True, slots=True)
class Errors:
    """RMSE over the open tests and by role."""

    all_um: float | None = None
    calibration_um: float | None = None
    verification_um: float | None = None


@dataclass(frozen=True, slots=True)
class ResponseError:
    """One response's errors in a version, in `unit`. own: over all tests that the version predicts; common: over those
    that all versions predict."""

    response: str
    unit: str
    own: Errors
    common: Errors


@dataclass(frozen=True, slots=True)
class Version:
    """One version of the model. added: the effect that it has more than its parent. *_um: RMSE over the responses in
    the unit of the first, which is `unit`, and over the tests that all versions predict; own: over all that this one
    does. removed: the effect that its parent has more. in_sample: whether its verification tests were fitted too.
    responses: the errors of each. lost: tests, as campaign/test, that the version before predicts for a response of
    both, and this one does not. tests: how many it predicts; compared: how many all versions do. refitted: what is told
    of the version before where it was not fitted to verification tests that this one is fitted to; else ''."""

    model: str
    name: str
    added: str | None
    all_um: float | None
    calibration_um: float | None
    verification_um: float | None
    stale: bool = False
    removed: str | None = None
    in_sample: bool = False
    unit: str = "um"
    responses: tuple[ResponseError, ...] = ()
    own: Errors = Errors()
    lost: tuple[str, ...] = ()
    tests: int = 0
    compared: int = 0
    refitted: str = ""

    @property
    def change(self) -> str:
        """What it has more and less than its parent, in signs; '' where it has the same effects."""
        return " ".join(f"{sign} {what}" for sign, what in (("+", self.added), ("−", self.removed)) if what)


@dataclass(frozen=True, slots=True)
class ReportData:
    """A model, its scores and curves, and what was diagnosed.

    diagnosis: of this model; reason: of its last ancestor that has one, which says why effects were added since.
    reason_of_fit: whether its claims were confirmed in this very fit: on these data and tests, with no other effect.
    reason_but_for: second lags that came along with its claims, where this fit is theirs but for these. left_on_locked:
    what this version itself leaves on the locked tests that were opened for its claims; None where nobody scored it.
    by_choice: what locked tests said of what the last version added, asked of the version before by somebody's choice.
    offered: whether all that was added since are refinements that it offered.
    units: response -> that of its errors; unit: of the first. versions: oldest first. looks: how often each locked
    test was opened, for whichever model. calibrations: rows of the catalogue's table.
    weak: weak spots by response. first: the tests as the first version foretells them, for the scale of residuals;
    empty where this is it. All but diagnosis and reason is of one fit to the data as they are now; older: sentences on
    what of the page is of other data than that. as_stored: of each earlier version that can't be run, why, and what is
    told of it.
    """

    model: str
    name: str
    campaigns: tuple[str, ...]
    machine: str
    responses: tuple[str, ...]
    unit: str
    effects: tuple[str, ...]
    created: str
    parameters: dict[str, Parameter]
    scores: list[Score]
    checks: list[Check]
    before: list[Score]
    tests: tuple[TestPart, ...]
    versions: tuple[Version, ...]
    diagnosis: Diagnosis | None = None
    reason: Diagnosis | None = None
    calibrations: tuple[dict[str, Any], ...] = ()
    looks: dict[str, int] = field(default_factory=dict)
    weak: dict[str, list[WeakSpot]] = field(default_factory=dict)
    first: tuple[TestPart, ...] = ()
    older: tuple[str, ...] = ()
    systems: tuple[SeenResponse, ...] = ()
    as_stored: tuple[str, ...] = ()
    units: Mapping[str, str] = field(default_factory=dict)
    driven: Mapping[str, str] = field(default_factory=dict)
    reason_of_fit: bool = True
    reason_but_for: tuple[str, ...] = ()
    left_on_locked: float | None = None
    offered: bool = False
    by_choice: tuple[Confirmed, ...] = ()

    def unit_of(self, found: Diagnosis | str | None) -> str:
        """Of a response, or of the one that was diagnosed."""
        return self.units.get(found.response if isinstance(found, Diagnosis) else found or "", self.unit)

    @property
    def told_together(self) -> list[str]:
        """The responses that errors of the whole page are of: those in `unit`."""
        return told_together(self.responses, self.units)

    @property
    def added(self) -> str | None:
        return self.versions[-1].added if self.versions else None
