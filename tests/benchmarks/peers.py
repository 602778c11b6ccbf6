"""What a user would identify with instead of us: each fits one record and runs freely through another.

Imports stand inside: a ModuleNotFoundError says that the peer is not installed, and the benchmark then leaves it out.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from thermodata.plugin import Float1D

Run = Callable[[Any, Any], Float1D]


def _sippy(method: str, orders: tuple[int, int], ahead: int = 0) -> Run:
    """orders: numerator, denominator. Its functions begin one sample late, and have no delay below that: ahead: samples
    by which its input comes ahead, 1 where the function is to begin at once. Its OE is a problem with as many variables
    as samples, which is not put to it at 1 s."""

    def run(train: Any, unseen: Any) -> Float1D:
        from control import tfdata
        from scipy.signal import lfilter
        from sippy_unipi import system_identification

        if method == "OE" and len(train.y) > 5000:
            raise ValueError(f"not tried: its OE has a variable for each of {len(train.y)} samples")
        nb, na = orders
        mine = {"ARX_orders": [na, nb, 0]} if method == "ARX" else {"OE_orders": [nb, na, 0]}
        y, u = train.y[: len(train.y) - ahead], train.u[ahead:]
        found = system_identification(y, u, method, tsample=train.step_s, **mine)
        (((num,),), ((den,),)) = tfdata(found.G)
        later = np.concatenate([np.zeros(len(den) - len(num)), num])
        return np.asarray(lfilter(later[ahead:], den, unseen.u))

    return run


def _sysidentpy(lags: int) -> Run:
    """Linear terms chosen by forward regression (FROLS), and their free run."""

    def run(train: Any, unseen: Any) -> Float1D:
        from sysidentpy.basis_function import Polynomial
        from sysidentpy.model_structure_selection import FROLS
        from sysidentpy.parameter_estimation import LeastSquares

        model = FROLS(
            order_selection=True,
            n_info_values=2 * lags,
            ylag=lags,
            xlag=lags,
            estimator=LeastSquares(),
            basis_function=Polynomial(degree=1),
        )
        model.fit(X=train.u.reshape(-1, 1), y=train.y.reshape(-1, 1))
        # a free run: only the first samples of y are looked at
        return np.asarray(model.predict(X=unseen.u.reshape(-1, 1), y=unseen.y[: model.max_lag].reshape(-1, 1))).ravel()

    return run


def _statsmodels(lags: int) -> Run:
    """An ARDL model: y on its own past and the input's, by least squares of one step; run freely from rest."""

    def run(train: Any, unseen: Any) -> Float1D:
        from scipy.signal import lfilter
        from statsmodels.tsa.api import ARDL

        found = ARDL(train.y, lags, train.u.reshape(-1, 1), lags, trend="c").fit()
        by_name = dict(zip(found.model.exog_names, found.params, strict=True))
        past = [by_name[f"y.L{k}"] for k in range(1, lags + 1)]
        driven = [by_name[f"x0.L{k}"] for k in range(lags + 1)]
        return np.asarray(lfilter(driven, [1.0, *(-p for p in past)], unseen.u))

    return run


def _pastas(kind: str) -> Run:
    """A response function of the temperature, by pastas' own solver. Its clock counts days, of which a step is one."""

    def run(train: Any, unseen: Any) -> Float1D:
        import pandas as pd
        import pastas

        pastas.set_log_level("ERROR")

        def model(record: Any) -> Any:
            days = pd.date_range("2000-01-01", periods=len(record.y), freq="D")
            made = pastas.Model(pd.Series(record.y, index=days, name="dZ"))
            stress = pd.Series(record.u, index=days, name="T")
            pastas.StressModel(made, stress, getattr(pastas, kind)(), name="T", up=True)
            return made

        fitted = model(train)
        fitted.solve(report=False, warmup=0)
        best = fitted.parameters["optimal"].to_numpy()
        return np.asarray(model(unseen).simulate(p=best, warmup=0).to_numpy())

    return run


METHODS: list[tuple[str, str, Run]] = [
    ("SIPPY", "ARX(2,2), at once", _sippy("ARX", (2, 2), ahead=1)),
    ("SIPPY", "ARX(2,2), as it is", _sippy("ARX", (2, 2))),
    ("SIPPY", "ARX(4,4), at once", _sippy("ARX", (4, 4), ahead=1)),
    ("SIPPY", "ARX(4,4), as it is", _sippy("ARX", (4, 4))),
    ("SIPPY", "OE(2,2)", _sippy("OE", (2, 2))),
    ("SysIdentPy", "FROLS, 4 lags", _sysidentpy(4)),
    ("statsmodels", "ARDL(2,2)", _statsmodels(2)),
    ("statsmodels", "ARDL(4,4)", _statsmodels(4)),
    ("pastas", "Exponential", _pastas("Exponential")),
    ("pastas", "DoubleExponential", _pastas("DoubleExponential")),
]
