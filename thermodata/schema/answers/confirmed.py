"""The answer of confirm."""

from __future__ import annotations

from thermodata.schema.answers.diagnosis import PutRight
from thermodata.schema.answers.result import Parameter, Result


class TestConfirmed(Result):
    """One locked test of a confirmation.

    campaign: id
    test: id
    rmse_um_before: free-run error without the effect, in the response's unit
    rmse_um_after: with it
    acts: whether the effect does there at least a fifth of what it does in the open test in which it does most
    n: samples that count; null in an answer of an older version
    does_um: how much the effect does there, about its mean, in the response's unit; null in one of an older version
    rmse_um_fitted: free-run error of the model as it is fitted, for the one before is refitted to all open tests; null
        where that leaves as much on all locked tests together, or in an answer of an older version
    """

    campaign: str
    test: str
    rmse_um_before: float
    rmse_um_after: float
    acts: bool = True
    n: int | None = None
    does_um: float | None = None
    rmse_um_fitted: float | None = None


class Confirmed(Result):
    """Answer of confirm: the locked tests, opened for a choice of the user's own.

    model: id of the model that the effect was tried on
    response: name
    candidate: effect:channels
    holds: whether it holds by its shape, and the error as scored does not rise (by more than 2 %), both in the locked
        tests in which the effect acts; null where it rests in all of them, and nothing can be said
    holds_by_shape: whether there the error about each test's mean falls by what a cause would take away; beside `holds`
        false, the course fits and where it starts does not; null as `holds`
    why: the reason, in a sentence
    locked_rmse_um_fitted: error over all locked tests of the model as it is fitted, which is the one that the user has;
        null where the one before, refitted to all open tests, leaves as much, or in an answer of an older version
    locked_rmse_um_before: the same of the model refitted to all open tests without the effect, in the response's unit
    locked_rmse_um_after: with it
    locked_shape_um_before: the same over those in which it acts, a free offset for each, which is what `holds_by_shape`
        goes by
    locked_shape_um_after: with it
    parameters: of the effect, fitted to all open tests
    tests: each locked test
    most_um: how much it does in the open test in which it does most; null in an answer of an older version
    looks: how often the locked tests have been opened so far, this look included; the most of any test
    probability: that the stored diagnosis claims it with; null where it does not
    despite: why that diagnosis claims what does not hold here, in a sentence; null where it claims it not, or it holds
    put_right: what of the logs was put right before, as a diagnosis does; null where nothing was
    note: why it is no cause whatever the tests say; null where nothing forbids it
    """

    model: str
    response: str
    candidate: str
    holds: bool | None
    holds_by_shape: bool | None = None
    why: str | None = None
    locked_rmse_um_fitted: float | None = None
    locked_rmse_um_before: float | None
    locked_rmse_um_after: float | None
    locked_shape_um_before: float | None = None
    locked_shape_um_after: float | None = None
    parameters: dict[str, Parameter]
    tests: list[TestConfirmed]
    most_um: float | None = None
    looks: int
    probability: float | None = None
    despite: str | None = None
    put_right: PutRight | None = None
    note: str | None = None
