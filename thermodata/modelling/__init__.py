"""Models: drivers, fitting, free-run prediction, scores. See `fit_model` and, with a store, `modelling.run`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from thermodata.modelling.fit.model import fit_model
    from thermodata.modelling.terms.fitted import FittedModel
    from thermodata.modelling.terms.fitted_response import FittedResponse, FittedTerm

__all__ = ["FittedModel", "FittedResponse", "FittedTerm", "fit_model"]


def __getattr__(name: str) -> Any:
    if name == "fit_model":
        from thermodata.modelling.fit.model import fit_model

        return fit_model
    if name == "FittedModel":
        from thermodata.modelling.terms.fitted import FittedModel

        return FittedModel
    if name in __all__:
        from thermodata.modelling.terms import fitted_response

        return getattr(fitted_response, name)
    raise AttributeError(name)
