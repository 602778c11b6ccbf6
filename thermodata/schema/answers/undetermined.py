"""An effect of a model that its tests do not determine, as a diagnosis tells it."""

from __future__ import annotations

from thermodata.schema.answers.result import Parameter, Result


class Undetermined(Result):
    """An effect of the model whose gain the tests that were fitted do not determine: the interval of 95 % of each of
    its gains reaches down to a tenth of it, or beyond zero.

    effect: its id in the model
    drivers: channels or expressions
    gains: with their intervals
    does_um: RMS of what it does about its mean, in the fitted test in which it does most, in the response's unit
    elsewhere: the test that was not fitted in which it does most, where that is half as much again or more; the
        response of a locked one is not looked at; else null
    elsewhere_um: RMS of what it does there
    left_out_um: error of the model on open tests that are left out in turn, refitted as it is to the others; null where
        none can be left out
    left_out_without_um: the same of the model without it
    """

    effect: str
    drivers: list[str]
    gains: dict[str, Parameter]
    does_um: float
    elsewhere: str | None = None
    elsewhere_um: float | None = None
    left_out_um: float | None = None
    left_out_without_um: float | None = None
