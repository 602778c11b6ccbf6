"""The answer of confirm without an effect: what a model as it stands leaves on the locked tests."""

from __future__ import annotations

from thermodata.schema.answers.result import Result


class TestLocked(Result):
    """One locked test.

    campaign: id
    test: id
    rmse_um: free-run error from its first samples on, as tests are scored, in the response's unit
    shape_um: the same about its mean
    fit: FIT [%]; null where the response stands still
    ptp_um: of the response, max - min
    max_um: largest error
    n: samples that count
    """

    campaign: str
    test: str
    rmse_um: float
    shape_um: float
    fit: float | None
    ptp_um: float
    max_um: float
    n: int


class LockedError(Result):
    """One response of one model.

    model: id
    name: of the model
    response: name
    unit: of the response and of all its errors
    rmse_um: over all samples of all locked tests, as they are scored
    shape_um: the same about each test's mean
    tests: each locked test
    left_out: the others, and why
    looks: how often the locked tests have been opened so far, this look included; the most of any test
    """

    model: str
    name: str
    response: str
    unit: str
    rmse_um: float
    shape_um: float
    tests: list[TestLocked]
    left_out: list[str]
    looks: int
