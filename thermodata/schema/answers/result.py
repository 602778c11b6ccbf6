"""What fit, add and compare answer, as JSON; the base of all answers. Keys that don't apply are null, never absent."""

from __future__ import annotations

import re

from pydantic import BaseModel, ConfigDict

SAMPLE = ".sample_s"  # behind the id of an effect whose coefficients are parameters
_COEFFICIENT = re.compile(r"\.([ab]\d+|sample_s)$")


class Result(BaseModel):
    """Base of what is answered as JSON. Keys that don't apply are null, never absent."""

    model_config = ConfigDict(extra="forbid")


class Parameter(Result):
    """A fitted parameter or gain, with its interval of 95 %.

    value: in `unit`
    unit: as the effect states it
    low: lower end; null at a bound, where held, or where these tests set none
    high: upper end; likewise
    """

    value: float
    unit: str
    low: float | None = None
    high: float | None = None


class Score(Result):
    """Errors of one model in one test, response and phase, by free-run simulation, in the response's canonical
    unit.

    model: id
    campaign: id
    test: id
    role: of the test in this model
    response: name
    phase: all is the whole test
    fit: FIT [%], not clipped: below 0 the mean would be better
    rmse_um: root mean square of the residual
    ptp_um: peak to peak of the response (max - min)
    ptp_residual_um: peak to peak of the residual
    max_um: largest absolute residual
    n: samples that count
    """

    model: str
    campaign: str
    test: str
    role: str
    response: str
    phase: str
    fit: float | None
    rmse_um: float | None
    ptp_um: float | None
    ptp_residual_um: float | None
    max_um: float | None
    n: int


class Check(Result):
    """One thing that a fit says of itself.

    name: what was checked, and of what; of several responses with whose it is: implausible:dZ/lag.gain
    value: found
    threshold: limit
    passed: whether it holds
    advice: what to do, or what it means
    """

    name: str
    value: float | None
    threshold: float | None
    passed: bool
    advice: str


class LostTest(Result):
    """A test that the version before predicts, and this one does not.

    campaign: id
    test: id
    response: name
    why: in words; null where it is not among the model's tests any more
    """

    campaign: str
    test: str
    response: str
    why: str | None = None


class FitResult(Result):
    """Answer of fit, add and compare.

    model: id
    name: of the model file
    parent: id of the version before
    campaigns: ids
    response: name or names
    parameters: effect.parameter -> value with its interval; of method arx the time constants, the gain at rest, and the
        coefficients a0 ... over b0 ... at sample_s
    scores: a row a test, response and phase
    checks: what the fit says of itself
    before: of add: the parent's scores
    added: of add: ids of the effects that the parent has not; a second lag of an effect is one of its own
    notes: in sentences: temperatures that are read in coarse steps and drawn through them; rows of a prediction file
        without a value; of add: which second lags were taken in and why, and what the version before leaves, fitted to
        the same tests
    locked_rmse_um_before: of add: the error on the locked tests without what the parent's diagnosis claims, where all
        of that is added; null where it is not, or none was asked
    locked_rmse_um_after: of this version itself, with the second lags that it was given; null where it can't be scored
        on the tests that the claims were asked of
    locked_rmse_um_fitted: the same of the parent as it is fitted, for the one before is refitted to all open tests;
        null where both leave as much to a tenth, and in an answer of an older version
    lost: of add and remove: what the parent predicts and this version does not; an error before and one after are
        comparable over the tests of both only
    """

    model: str
    name: str
    parent: str | None
    campaigns: list[str]
    response: str | list[str]
    parameters: dict[str, Parameter]
    scores: list[Score]
    checks: list[Check]
    before: list[Score] | None = None
    added: list[str] | None = None
    notes: list[str] = []
    lost: list[LostTest] | None = None
    locked_rmse_um_before: float | None = None
    locked_rmse_um_after: float | None = None
    locked_rmse_um_fitted: float | None = None

    @property
    def responses(self) -> list[str]:
        return [self.response] if isinstance(self.response, str) else self.response

    @property
    def readable(self) -> dict[str, Parameter]:
        """The parameters without the coefficients of functions, which say nothing in three digits."""
        functions = {name.removesuffix(SAMPLE) for name in self.parameters if name.endswith(SAMPLE)}
        return {
            name: parameter
            for name, parameter in self.parameters.items()
            if not (name.rpartition(".")[0] in functions and _COEFFICIENT.search(name))
        }
