"""A filter as a discrete linear system: coefficients, poles, zeros, state space, step response, Bode.

    y(k) = [a0 u(k) + a1 u(k-1) + ... - b1 y(k-1) - b2 y(k-2) - ...] / b0      [horejs2010]
    x(k+1) = A x(k) + B u(k),  y(k) = C x(k) + D u(k)

All for inputs that run straight between samples (first-order hold), as the model's free run takes them.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from thermodata.effect.linear import Filter
from thermodata.plugin import Float1D, Float2D

Complex1D = npt.NDArray[np.complex128]


@dataclass(frozen=True)
class System:
    """a, b: coefficients of rising powers of 1/z, b[0] = 1. poles, zeros: of z. taus_s: time constants [s], of
    swinging poles those of their envelope. A, B, C, D: modes in their own states, then delays. step_s [s]."""

    step_s: float
    a: Float1D
    b: Float1D
    poles: Complex1D
    zeros: Complex1D
    taus_s: tuple[float, ...]
    at_rest: float
    A: Float2D
    B: Float2D
    C: Float2D
    D: Float2D

    def step_response(self, n: int) -> Float1D:
        """y of u = 1 from the first sample on, shape (n,)."""
        return self.respond(np.ones(n))

    def respond(self, u: Float1D) -> Float1D:
        """y of u from rest, shape (n,) as u."""
        from scipy.signal import lfilter

        x_of = np.asarray(self.D[0, 0] * u, dtype=np.float64)
        # state by state where they are apart: a polynomial of z would lose half of the digits
        state, out = np.zeros(len(self.A)), np.zeros(len(u))
        if np.count_nonzero(self.A - np.diag(np.diagonal(self.A))) == 0:
            for p, b, c in zip(np.diagonal(self.A), self.B[:, 0], self.C[0], strict=True):
                out += c * np.asarray(lfilter([0.0, b], [1.0, -p], u))
            return out + x_of
        for k, value in enumerate(u):
            out[k] = float(self.C[0] @ state)
            state = self.A @ state + self.B[:, 0] * value
        return out + x_of

    def frequency_response(self, omega: Float1D) -> Complex1D:
        """H(e^(j omega step)), omega [rad/s], shape (n,)."""
        z = np.exp(1j * np.asarray(omega) * self.step_s)
        eye = np.eye(len(self.A))
        return np.array(
            [(self.C @ np.linalg.solve(one * eye - self.A, self.B))[0, 0] + self.D[0, 0] for one in z], dtype=complex
        )


def system_of(by: Filter, step_s: float) -> System:
    """The filter at a step [s]. UsageError where a pole is known at other samples only."""
    poles, shares = list[complex](), list[tuple[complex, complex, complex]]()
    blocks: list[Float2D] = []
    inputs, outputs, direct = list[float](), list[float](), by.direct
    for mode in by.modes:
        p, forgotten, new = mode.stepped(step_s)
        old = forgotten - new
        weight, b = complex(mode.weight), p * new + old
        if mode.is_real:
            poles.append(complex(p.real))
            shares.append((weight.real, new.real, old.real))
            blocks.append(np.array([[p.real]]))
            inputs.append(b.real)
            outputs.append(weight.real)
            direct += weight.real * new.real
        else:
            for q, w, n, o in (
                (p, weight, new, old),
                (p.conjugate(), weight.conjugate(), new.conjugate(), old.conjugate()),
            ):
                poles.append(q)
                shares.append((w, n, o))
            blocks.append(np.array([[p.real, -p.imag], [p.imag, p.real]]))
            inputs += [b.real, b.imag]
            outputs += [2 * weight.real, -2 * weight.imag]
            direct += 2 * (weight * new).real
    fir = _delay_factors(by, step_s)
    a, b_all = _polynomials(by.direct, fir, poles, shares)
    order = len(fir) - 1
    if order > 0:  # a shift register: its states are u one, two, ... samples ago
        blocks.append(np.eye(order, k=-1))
        inputs += [1.0] + [0.0] * (order - 1)
        outputs += list(fir[1:])
    size = sum(len(block) for block in blocks)
    A = np.zeros((size, size))
    at = 0
    for block in blocks:
        A[at : at + len(block), at : at + len(block)] = block
        at += len(block)
    zeros = np.roots(np.trim_zeros(a, "f")) if np.any(a) else np.zeros(0)
    return System(
        step_s,
        a,
        b_all,
        np.array(poles + [0j] * order, dtype=complex),
        np.asarray(zeros, dtype=complex),
        tuple(m.tau_s for m in by.modes if m.tau_s is not None),
        by.at_rest,
        A,
        np.array(inputs).reshape(-1, 1),
        np.array(outputs).reshape(1, -1),
        np.array([[direct + fir[0]]]),
    )


def _delay_factors(by: Filter, step_s: float) -> Float1D:
    """Delays as factors of u(k), u(k-1), ...: straight between two samples."""
    most = max((int(-(-t // step_s)) for t, _ in by.late), default=0)
    fir = np.zeros(most + 1)
    for t, g in by.late:
        whole = int(t // step_s)
        share = t / step_s - whole
        fir[whole] += g * (1 - share)
        if share:
            fir[whole + 1] += g * share
    return fir


def _polynomials(
    direct: float, fir: Float1D, poles: list[complex], shares: list[tuple[complex, complex, complex]]
) -> tuple[Float1D, Float1D]:
    den = np.ones(1, complex)
    for p in poles:
        den = np.convolve(den, [1.0, -p])
    ahead = np.asarray(fir, complex).copy()
    ahead[0] += direct
    num = np.convolve(ahead, den)
    for i, (weight, new, old) in enumerate(shares):
        rest = np.ones(1, complex)
        for j, p in enumerate(poles):
            if j != i:
                rest = np.convolve(rest, [1.0, -p])
        part = weight * np.convolve(rest, [new, old])
        num = np.pad(num, (0, max(0, len(part) - len(num))))
        num[: len(part)] += part
    return np.asarray(num.real), np.asarray(den.real)
