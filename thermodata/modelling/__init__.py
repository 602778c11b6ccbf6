"""Models: drivers, fitting, free-run prediction, scores. See `fit_model` and, with a store, `modelling.run`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from thermodata.lazy import on_demand

if TYPE_CHECKING:
    from thermodata.modelling.fit.model import fit_model
    from thermodata.modelling.terms.fitted import FittedModel
    from thermodata.modelling.terms.fitted_response import FittedResponse, FittedTerm

__all__ = ["FittedModel", "FittedResponse", "FittedTerm", "fit_model"]
__getattr__ = on_demand(
    __name__,
    {"fit.model": "fit_model", "terms.fitted": "FittedModel", "terms.fitted_response": "FittedResponse FittedTerm"},
)
