"""Transfer functions as effects: identified (oe, varpro), or given by their coefficients.

A free function is kept as time constants and gains, never as a polynomial of z: an OE(2,2) at 1 s needs nine
decimals, its time constants three. Its poles are real, between 0 and 1 (heat flow does not ring), hence stable.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping, Sequence
from itertools import pairwise

import numpy as np

from thermodata.effect.lag import lag, lags, step_of
from thermodata.effect.law import Law
from thermodata.errors import SpecError
from thermodata.modelling.model_file.transfer.digits import refuse_lost_digits
from thermodata.modelling.model_file.transfer.law import free_law, given_law
from thermodata.modelling.model_file.values.own_units import in_unit
from thermodata.plugin import Drivers, Float1D, Float2D, Gain, Need, Param

NAME = "transfer_function"
MOST = 4
DIRECT = "direct"  # the gain of what follows at once, without a lag
SOURCE = "[horejs2010], [ljung1999]: y(k) = [a0 u(k) + a1 u(k-1) + ... - b1 y(k-1) - ...] / b0"
_ANY = (Need("u", "*"),)
CONSTANTS = {"sample_s": "s", "time_s": "s"}
"""What `fixed` says of a given function beside its coefficients, and the unit of each."""
_COEFFICIENT = re.compile(r"^(a|b|num|den)(\d+)$")
_INF = float("inf")


class FreeFunction:
    """Identified from the data. oe: `orders[0]` numerator and `orders[1]` denominator coefficients; varpro: a sum of
    `orders[1]` lags, and beside them what follows at once where `orders[0]` is one more. basis: shape (n, gains)."""

    family = "generic"
    source = SOURCE

    def __init__(self, method: str, orders: tuple[int, int]) -> None:
        most = min(MOST, orders[1]) + 1 if method == "varpro" else MOST
        if not (1 <= orders[0] <= most and 1 <= orders[1] <= MOST):
            raise SpecError(
                "orders of a transfer function",
                expected=f"two whole numbers from 1 to {MOST}"
                + ("; the first is one more than the second for a direct term" if method == "varpro" else ""),
                got=str(list(orders)),
                hint="'thermodata orders MODEL' tries several, and says what the tests bear out",
            )
        self.method, self.orders = method, orders
        self.name, self.needs = NAME, _ANY
        self.meaning = f"{method} {orders[0]},{orders[1]}: real poles as time constants, gains linear"
        starts = np.geomspace(10.0, 300.0, orders[1]) if orders[1] > 1 else [60.0]
        names = [f"tau_{i + 1}" for i in range(orders[1])] if orders[1] > 1 else ["tau"]
        self.params = tuple(
            Param(n, "min", float(s), 0.5, 2880.0, "time constant of a pole")
            for n, s in zip(names, starts, strict=True)
        )
        if method == "varpro":
            gains = [f"gain_{i + 1}" for i in range(orders[1])] if orders[1] > 1 else ["gain"]
            self.interchangeable = dict(zip(names, gains, strict=True))  # like lags, each with the gain that is its own
            gains += [DIRECT] if orders[0] > orders[1] else []
        else:
            gains = ["gain"] + [f"lead_{j}" for j in range(1, orders[0])]
            self.interchangeable = dict.fromkeys(names, "")
        self.gains = tuple(
            Gain(n, "um/u", (0.0, _INF), "any", "gain at rest" if n == "gain" else "gain") for n in gains
        )

    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        u, step = drivers.values["u"], step_of(drivers)
        taus = [p[param.name] * 60.0 for param in self.params]
        if self.method == "varpro":
            direct = [u] if self.orders[0] > self.orders[1] else []
            return np.column_stack([*(lag(u, t, step) for t in taus), *direct])
        # numerator in powers of the difference operator (1 - 1/q), which spans the same functions as powers
        # of 1/q but leaves the columns apart; each is scaled to the size of the one before
        columns = np.empty((len(u), self.orders[0]), order="F")
        columns[:, 0] = lags(u, taus, step)
        for j in range(1, self.orders[0]):
            columns[0, j] = 0.0
            np.subtract(columns[1:, j - 1], columns[:-1, j - 1], out=columns[1:, j])
            columns[:, j] *= taus[min(j, len(taus)) - 1] / step
        return columns

    def law(self, roles: Collection[str], p: Mapping[str, float], step_s: float) -> tuple[Law, ...]:
        """One formula a gain; see `thermodata.effect.law`."""
        return free_law(self.method, self.orders, [p[param.name] * 60.0 for param in self.params], step_s)


class GivenFunction:
    """Coefficients as printed: a0.. over b0.. at `sample_s`, or num0.. over den0.. of s, num0 + num1 s + num2 s^2
    ([horejs2010] prints K1 + K2 s + K3 s^2; time in `time_s` seconds). One gain: 1 for the function as printed, free
    for `g` times the function."""

    name = NAME
    family = "generic"
    source = SOURCE
    needs = _ANY
    params: tuple[Param, ...] = ()
    gains = (Gain("gain", "1", (0.0, _INF), "any", "factor on the printed function"),)
    constants = CONSTANTS

    def __init__(
        self,
        num: Sequence[float],
        den: Sequence[float],
        sample_s: float | None,
        time_s: float = 1.0,
        where: str | None = None,
    ) -> None:
        self.num, self.den = np.asarray(num, float), np.asarray(den, float)
        self.sample_s, self.time_s = sample_s, time_s
        self.meaning = f"given function, {len(num)} over {len(den)} coefficients"
        lead = 0 if sample_s is not None else -1
        if not len(self.num) or not len(self.den) or self.den[lead] == 0:
            raise SpecError(
                "a transfer function without a leading denominator coefficient",
                where=where,
                hint="give what stands before the output of now (in z), or before the highest power of s",
            )
        if sample_s is None and len(self.num) > len(self.den):
            raise SpecError(
                "a transfer function with more numerator than denominator coefficients",
                where=where,
                hint="leave the highest of the numerator out: no machine answers a step faster than it is made",
            )
        if sample_s is not None and sample_s <= 0:
            raise SpecError(
                "the sample time of a transfer function is positive",
                where=where,
                got=f"{sample_s}",
                hint="fixed: {sample_s: 60, ...}, the step at which it was identified",
            )
        self._stable(where)

    @property
    def gain_at_rest(self) -> float:
        """um per unit of the driver."""
        if self.sample_s is None:
            rest, full = self.num[0], self.den[0]
        else:
            rest, full = self.num.sum(), self.den.sum()
        return float(rest / full) if full != 0 else float("inf")

    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        return self.simulate(drivers.t_s, drivers.values["u"]).reshape(-1, 1)

    def law(self, roles: Collection[str], p: Mapping[str, float], step_s: float) -> tuple[Law, ...]:
        """One formula a gain; see `thermodata.effect.law`."""
        return given_law(self.num, self.den, self.sample_s, self.time_s)

    def simulate(self, t_s: Float1D, u: Float1D) -> Float1D:
        """Free run from balance: shape (n,) on the grid t_s [s]."""
        from scipy.signal import cont2discrete, lfilter

        if self.sample_s is not None:
            fine = np.arange(t_s[0], t_s[-1] + self.sample_s / 2, self.sample_s)
            y = lfilter(self.num, self.den, np.interp(fine, t_s, u))
            return np.asarray(np.interp(t_s, fine, y), dtype=np.float64)
        step = (t_s[1] - t_s[0]) / self.time_s if len(t_s) > 1 else 1.0
        num, den, _ = cont2discrete((self.num[::-1], self.den[::-1]), step, method="foh")
        return np.asarray(lfilter(np.ravel(num), den, u), dtype=np.float64)

    def _stable(self, where: str | None) -> None:
        poles = np.roots(self.den if self.sample_s is not None else self.den[::-1])
        bad = poles[poles.real >= 0] if self.sample_s is None else poles[np.abs(poles) >= 1]
        if len(bad):
            raise SpecError(
                "the transfer function is not stable: its free run grows without end",
                where=where,
                expected="poles inside the unit circle" if self.sample_s else "poles left of zero",
                got=", ".join(f"{p:.9g}" for p in bad),
                hint="give its coefficients with more digits, or identify it from data",
            )


def given(fixed: Mapping[str, float], where: str | None = None) -> GivenFunction | None:
    """The function that `fixed` spells out (a0, a1, b0, b1, ... or num0, den0, ...), or None where it doesn't."""
    lists: dict[str, dict[int, float]] = {}
    fixed = {
        name: in_unit(name, v, CONSTANTS.get(name, "1"), where) for name, v in fixed.items() if is_coefficient(name)
    }
    for name, value in fixed.items():
        hit = _COEFFICIENT.match(name)
        if hit:
            lists.setdefault(hit[1], {})[int(hit[2])] = value
    if not lists:
        return None
    for name, numbers in lists.items():
        order = sorted(numbers)
        if order[0] not in (0, 1) or any(b - a != 1 for a, b in pairwise(order)):
            raise SpecError(
                f"coefficients {name}0, {name}1, ... with a hole",
                where=where,
                got=str(order),
                hint="write 0 for those that are none",
            )
    if "num" in lists or "den" in lists:
        return GivenFunction(
            _in_order(lists.get("num", {})), _in_order(lists.get("den", {})), None, fixed.get("time_s", 1.0), where
        )
    numerator, denominator = _in_order(lists.get("a", {})), _in_order({0: 1.0, **lists.get("b", {})})
    function = GivenFunction(numerator, denominator, fixed.get("sample_s", 1.0), where=where)
    refuse_lost_digits(numerator, denominator, fixed.get("sample_s", 1.0), where)
    return function


def is_coefficient(name: str) -> bool:
    """Whether a key of `fixed` belongs to a given function rather than to a parameter."""
    return name in CONSTANTS or _COEFFICIENT.match(name) is not None


def _in_order(numbers: Mapping[int, float]) -> list[float]:
    return [numbers[i] for i in sorted(numbers)]
