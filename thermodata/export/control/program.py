"""A control program at one cycle, as plain values: what is read, what drives, what is remembered, what is given."""

from __future__ import annotations

from dataclasses import dataclass

from thermodata.effect import law

# what is made of a name: of an input's its readings, of a drive's its start, of a state's its parts
OF_INPUT = ("valid_{}", "held_{}", "bad_{}", "lost_{}", "seen_{}")
OF_START = ("ref_{}", "first_{}", "sum_{}", "bin1_{}", "bin2_{}", "moves_{}", "open_{}")
OF_STATE = (
    *("in_{}", "old_{}", "{}_lo", "{}_re", "{}_im", "{}_re_lo", "{}_im_lo", "{}_gap"),
    *("{}_ring", "{}_at", "{}_back", "{}_out"),
)


@dataclass(frozen=True)
class Input:
    """One channel that the control reads. low, high: outside of them, in `unit`, a reading is bad."""

    name: str
    channel: str
    quantity: str
    unit: str
    low: float
    high: float
    at: str | None = None


@dataclass(frozen=True)
class Drive:
    """What drives effects: a formula of inputs; relative: it counts from what it is at the start. band: as far from its
    mean as that a bin of it stands still."""

    name: str
    text: str
    tree: law.Node
    relative: bool
    unit: str
    band: float = 0.0


@dataclass(frozen=True)
class Rate:
    """forgotten and new of one cycle [1]; tau_s: of a lag, for what it forgets over any other time."""

    forgotten: complex
    new: complex
    tau_s: float | None = None


@dataclass(frozen=True)
class State:
    """What the program remembers. kind 'lag': one state, with `rates` by `condition` (a second one where it does not
    hold); 'pair': two states of a complex pole; 'delay': a ring of `length` samples, read `late` cycles back."""

    name: str
    kind: str
    of: law.Node
    about: str
    rates: tuple[Rate, ...] = ()
    condition: law.Node | None = None
    length: int = 0
    late: float = 0.0


@dataclass(frozen=True)
class Term:
    """One effect's contribution, in the response's unit. tree: of drives and states."""

    name: str
    effect: str
    equation: str
    about: tuple[str, ...]
    tree: law.Node


@dataclass(frozen=True)
class Limits:
    """correction: largest size; rate: largest change a minute (both in the response's unit); hold_s: how long a bad
    reading is held before the correction stands still [s]."""

    correction: float
    rate: float
    hold_s: float = 600.0


@dataclass(frozen=True)
class Start:
    """How temperatures find what they count from: means over `cycles`, of which at most `bins` are averaged."""

    cycles: int
    bins: int


@dataclass(frozen=True)
class Program:
    """The whole; blank, before anything is computed in it. about: (what, text) for the heading. start: None where the
    first reading is what counts."""

    name: str
    response: str
    unit: str
    cycle_s: float
    limits: Limits
    about: tuple[tuple[str, str], ...] = ()
    start: Start | None = None
    inputs: tuple[Input, ...] = ()
    drives: tuple[Drive, ...] = ()
    states: tuple[State, ...] = ()
    terms: tuple[Term, ...] = ()

    @property
    def hold_cycles(self) -> int:
        """Cycles that a bad reading is held."""
        return max(1, round(self.limits.hold_s / self.cycle_s))
