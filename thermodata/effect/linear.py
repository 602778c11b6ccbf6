"""A linear filter as a direct term, delays, and modes: the form in which it can be run at any cycle.

    H = direct + sum of late_j q^-tau_j + sum of weight_i F_i

Each mode F_i has a gain at rest of 1 and one pole: s < 0 in continuous time (a lag of time constant -1/s), or z in
discrete time where no continuous pole says the same (negative or complex poles of a printed function). A polynomial of
z loses what its digits lose; time constants and weights do not.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from thermodata.errors import UsageError
from thermodata.plugin import Float1D

Complex1D = npt.NDArray[np.complex128]
_WHOLE = 1e-9  # of a ratio that counts as a whole number


@dataclass(frozen=True, slots=True)
class Mode:
    """weight: contribution at rest a unit of the input. s: pole [1/s], or None where `z`, a pole at sample_s [s], is
    given. A complex mode stands for itself and its conjugate: it contributes 2 Re(weight x)."""

    weight: complex
    s: complex | None = None
    z: complex | None = None
    sample_s: float = 1.0

    @property
    def is_real(self) -> bool:
        """Whether one real state holds it."""
        pole = self.s if self.s is not None else self.z
        return pole is not None and complex(pole).imag == 0

    @property
    def tau_s(self) -> float | None:
        """Its time constant [s]: of its envelope where it swings; None for an alternating pole at or below 0."""
        if self.s is not None:
            return -1.0 / complex(self.s).real
        size = abs(complex(self.z or 0.0))
        return None if size <= 0 or size >= 1 else -self.sample_s / float(np.log(size))

    @property
    def at_rest(self) -> float:
        """Its share of the gain at rest."""
        return float(complex(self.weight).real) if self.is_real else 2.0 * float(complex(self.weight).real)

    def stepped(self, cycle_s: float) -> tuple[complex, complex, complex]:
        """(pole, forgotten, new) at a cycle [s], for inputs that run straight between its samples:
        x += forgotten (u_old - x) + new (u - u_old). UsageError where its own samples do not fit the cycle."""
        if self.s is not None:
            r = -complex(self.s) * cycle_s
            forgotten = -_expm1(-r)
            return cmath.exp(-r), forgotten, _share_of_new(r, forgotten)
        ratio = cycle_s / self.sample_s
        count = round(ratio)
        if count < 1 or abs(ratio - count) > _WHOLE * max(1.0, ratio):
            raise UsageError(
                f"the function has a pole at z = {_text(complex(self.z or 0))}, which only its own samples know",
                expected=f"a cycle that is a whole number of {self.sample_s:g} s",
                got=f"{cycle_s:g} s",
                hint=f"--cycle {self.sample_s:g}s, or identify the effect as lags from the data",
            )
        z = complex(self.z or 0.0)
        powers = z ** np.arange(count - 1, -1, -1)
        ramp = np.arange(1, count + 1) / count
        return z**count, 1 - z**count, complex((1 - z) * (powers @ ramp))


@dataclass(frozen=True, slots=True)
class Filter:
    """direct: of the input, at once. late: (delay [s], factor). modes: see Mode."""

    direct: float = 0.0
    late: tuple[tuple[float, float], ...] = ()
    modes: tuple[Mode, ...] = ()

    @property
    def at_rest(self) -> float:
        """The gain at rest."""
        return self.direct + sum(g for _, g in self.late) + sum(m.at_rest for m in self.modes)

    def scaled(self, factor: float) -> Filter:
        """factor times the filter."""
        return Filter(
            self.direct * factor,
            tuple((t, g * factor) for t, g in self.late),
            tuple(Mode(m.weight * factor, m.s, m.z, m.sample_s) for m in self.modes),
        )

    def __add__(self, other: Filter) -> Filter:
        late = dict(self.late)
        for t, g in other.late:
            late[t] = late.get(t, 0.0) + g
        modes = {(m.s, m.z, m.sample_s): m.weight for m in self.modes}
        for m in other.modes:
            key = (m.s, m.z, m.sample_s)
            modes[key] = modes.get(key, 0.0) + m.weight
        return Filter(
            self.direct + other.direct,
            tuple(sorted(late.items())),
            tuple(Mode(w, *key) for key, w in modes.items()),
        )


def lag_filter(tau_s: float) -> Filter:
    """F_tau; tau_s <= 0 is no lag at all."""
    return Filter(direct=1.0) if tau_s <= 0 else Filter(modes=(Mode(1.0, s=-1.0 / tau_s),))


def partial_fractions(
    numerator: Float1D, denominator: Float1D, sample_s: float, poles: Complex1D | None = None
) -> Filter:
    """num(w) / den(w), w = 1/z, coefficients in rising powers of w, as a filter. poles: where they are known better
    than the denominator tells them. UsageError where poles coincide: their parts can't be told apart."""
    num, den = np.asarray(numerator, float) / denominator[0], np.asarray(denominator, float) / denominator[0]
    num, den = np.trim_zeros(num, "b"), np.trim_zeros(den, "b")
    found = np.asarray(np.roots(den) if poles is None else poles, complex)
    quotient = np.zeros(1)
    if len(num) >= len(den):
        quotient = np.polydiv(num[::-1], den[::-1])[0][::-1]
    direct, late, modes = float(quotient[0]), list[tuple[float, float]](), list[Mode]()
    late = [(j * sample_s, float(g)) for j, g in enumerate(quotient) if j and g]
    residues = np.zeros(len(found), complex)
    for i, p in enumerate(found):
        others = np.delete(found, i)
        # the factor (1 - p w) at w = 1/p is taken out of the denominator
        residues[i] = np.polyval(num[::-1], 1 / p) / np.prod(1 - others / p)
        if p.imag < 0:
            continue
        if p.imag == 0 and p.real > 0:
            tau = -sample_s / math.log(p.real)
            held = -math.expm1(-sample_s / tau) / (sample_s / tau)
            new, old = 1 - held, held - p.real
            share = old / p.real / (new + old / p.real)
            direct += float(residues[i].real * share)
            modes.append(Mode(float(residues[i].real / (new + old / p.real)), s=-1.0 / tau))
        else:
            weight = residues[i] / (1 - p)
            modes.append(
                Mode(
                    float(weight.real) if p.imag == 0 else complex(weight),
                    z=float(p.real) if p.imag == 0 else complex(p),
                    sample_s=sample_s,
                )
            )
    w = np.exp(-1j * np.linspace(0.01, np.pi, 24))
    told = np.polyval(num[::-1], w) / np.polyval(den[::-1], w)
    made = np.polyval(quotient[::-1], w) + sum(r / (1 - p * w) for r, p in zip(residues, found, strict=True))
    if not np.all(np.isfinite(residues)) or np.abs(made - told).max() > 1e-7 * max(1e-12, np.abs(told).max()):
        raise UsageError(
            "two poles of a transfer function coincide: its parts can't be told apart",
            got=", ".join(_text(p) for p in found),
            hint="identify it with one time constant fewer",
        )
    return Filter(direct, tuple(late), tuple(modes))


def partial_fractions_of_s(numerator: Float1D, denominator: Float1D, time_s: float) -> Filter:
    """num(s) / den(s), coefficients in rising powers of s, time in time_s [s], as a filter."""
    num, den = np.trim_zeros(np.asarray(numerator, float), "b"), np.trim_zeros(np.asarray(denominator, float), "b")
    poles = np.roots(den[::-1]).astype(complex)
    direct = float(num[-1] / den[-1]) if len(num) == len(den) else 0.0
    modes = []
    for i, p in enumerate(poles):
        rest = den[-1] * np.prod(p - np.delete(poles, i))
        residue = np.polyval(num[::-1], p) / rest if rest else np.inf
        if not np.isfinite(residue):
            raise UsageError(
                "two poles of a transfer function coincide",
                got=_text(complex(p)),
                hint="choose a lower order",
            )
        if p.imag >= 0:
            weight, s = -residue / p, p / time_s
            modes.append(
                Mode(float(weight.real), s=float(s.real)) if p.imag == 0 else Mode(complex(weight), complex(s))
            )
    return Filter(direct, (), tuple(modes))


def _expm1(x: complex) -> complex:
    return complex(np.expm1(np.complex128(x)))


def _share_of_new(r: complex, forgotten: complex) -> complex:
    """1 - (1 - e^-r) / r, also where r is small: the difference would lose half of its digits."""
    if abs(r) < 0.02:
        total, part = 0j, r / 2
        for k in range(3, 12):
            total += part
            part *= -r / k
        return total
    return 1 - forgotten / r


def _text(p: complex) -> str:
    return f"{p.real:.9g}" if p.imag == 0 else f"{p.real:.6g}{p.imag:+.6g}j"
