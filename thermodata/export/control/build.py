"""From the laws of a fitted response to a control program: all states are taken out of the formulas.

States are run in delta form, x += forgotten (u_old - x) + new (u - u_old). In the difference form of the papers the
coefficients differ from 1 by a millionth, and what 32 bits leave of them is wrong by micrometres after a day.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from thermodata.effect import law
from thermodata.effect.law_text import written
from thermodata.effect.linear import Filter, Mode
from thermodata.errors import UsageError
from thermodata.export.control.names import Names, identifier
from thermodata.export.control.program import OF_INPUT, OF_START, OF_STATE, Drive, Input, Program, Rate, State, Term
from thermodata.modelling.seen.laws import TermLaw

LONGEST_S, SHORTEST_S = 3600.0, 1e-3  # of a cycle
MOST_DELAYED = 50_000  # samples in one delay


def build(blank: Program, terms: Sequence[TermLaw], inputs: Mapping[str, Input], bands: Mapping[str, float]) -> Program:
    """A blank program with some laws in it. inputs: channel -> how it is read; bands: text of a drive -> its `band` (0
    where it has none). UsageError for a cycle that the laws don't fit."""
    cycle_s = blank.cycle_s
    if not SHORTEST_S <= cycle_s <= LONGEST_S:
        raise UsageError(
            "a cycle of a control",
            expected=f"{SHORTEST_S:g} s to {LONGEST_S:g} s",
            got=f"{cycle_s:g} s",
            hint="give one with --cycle: the time between two calls of the program",
        )
    taken = Names()
    named = {channel: taken.take(one.name, OF_INPUT) for channel, one in inputs.items()}
    maker = _Maker(cycle_s, taken, {c: law.Symbol(f"held_{n}") for c, n in named.items()})
    made = tuple(maker.term(t) for t in terms)
    used = {name for drive in maker.drives.values() for name in law.symbols(drive.tree)}
    return replace(
        blank,
        name=identifier(blank.name),
        inputs=tuple(replace(one, name=named[c], channel=c) for c, one in inputs.items() if f"held_{named[c]}" in used),
        drives=tuple(replace(d, band=bands.get(d.text, 0.0)) for d in maker.drives.values()),
        states=tuple(maker.states.values()),
        terms=made,
    )


class _Maker:
    """Takes the states out of formulas; equal ones are one."""

    def __init__(self, cycle_s: float, taken: Names, held: Mapping[str, law.Node]) -> None:
        self.cycle_s, self.taken, self.held = cycle_s, taken, held
        self.drives: dict[tuple[law.Node, bool], Drive] = {}
        self.states: dict[State, State] = {}

    def term(self, term: TermLaw) -> Term:
        roles: dict[str, law.Node] = {}
        for role, drive in term.drives.items():
            key = (law.put(drive.tree, self.held), drive.relative)
            if key not in self.drives:
                plain = drive.text if drive.text.isidentifier() else f"u{len(self.drives) + 1}"
                name = self.taken.take(f"d_{plain}", OF_START)
                self.drives[key] = Drive(name, drive.text, key[0], drive.relative, drive.unit)
            roles[role] = law.Symbol(self.drives[key].name)
        tree: law.Node = law.ZERO
        for gain in term.gains:
            column = self.flat(law.put(gain.tree, roles), term.id)
            tree = law.fold(law.Binary("+", tree, law.Binary("*", law.Number(gain.value), column)))
        about = [f"{n} = {v:.9g} {u}" for n, (v, u) in term.parameters.items()]
        about += [f"{g.name} = {g.value:.9g} {g.unit}" for g in term.gains]
        return Term(self.taken.take(f"y_{term.id}"), term.effect, term.equation, tuple(about), tree)

    def flat(self, node: law.Node, where: str) -> law.Node:
        """The node with every state below it in its place."""
        match node:
            case law.Lag(of, tau):
                return self._lag(self.flat(of, where), tau, where)
            case law.Delay(of, law.Number(dead)):
                return self._delay(self.flat(of, where), dead)
            case law.Filtered(of, by):
                return self._filter(self.flat(of, where), by, where)
            case law.Binary(operator, left, right):
                return law.fold(law.Binary(operator, self.flat(left, where), self.flat(right, where)))
            case law.Absolute(of):
                return law.Absolute(self.flat(of, where))
            case law.Compare(operator, left, right):
                return law.Compare(operator, self.flat(left, where), self.flat(right, where))
            case law.Logic(operator, parts):
                return law.Logic(operator, tuple(self.flat(p, where) for p in parts))
            case law.Where(condition, then, other):
                return law.Where(self.flat(condition, where), self.flat(then, where), self.flat(other, where))
            case law.Delay():
                raise UsageError(
                    "a dead time that changes can't run in a control",
                    where=where,
                    hint="leave the effect out with --without",
                )
        return node

    def _lag(self, of: law.Node, tau: law.Node, where: str) -> law.Node:
        match tau:
            case law.Number(value) if value <= 0:
                return of
            case law.Number(value):
                return self._named_state(State("", "lag", of, f"tau = {value / 60:.9g} min", (self._rate(value),)))
            case law.Where(condition, law.Number(then), law.Number(other)) if then > 0 and other > 0:
                condition = self.flat(condition, where)
                rates = (self._rate(then), self._rate(other))
                about = f"tau = {then / 60:.9g} min while {written(condition)}, else {other / 60:.9g} min"
                return self._named_state(State("", "lag", of, about, rates, condition))
        raise UsageError(
            "a time constant that changes steadily can't run in a control",
            where=where,
            expected="a number, or a choice between two",
            got=written(tau),
            hint="leave the effect out with --without",
        )

    def _rate(self, tau_s: float) -> Rate:
        _, forgotten, new = Mode(1.0, s=-1.0 / tau_s).stepped(self.cycle_s)
        return Rate(forgotten.real, new.real, tau_s)

    def _delay(self, of: law.Node, dead_s: float) -> law.Node:
        late = dead_s / self.cycle_s
        if late <= 0:
            return of
        if late > MOST_DELAYED:
            raise UsageError(
                f"a dead time of {dead_s / 60:g} min needs {late:.0f} samples at this cycle",
                expected=f"at most {MOST_DELAYED}",
                hint="--cycle with a longer one",
            )
        late = round(late) if abs(late - round(late)) < 1e-9 * late else late
        length = int(-(-late // 1)) + 1
        about = f"{dead_s / 60:.6g} min late"
        return self._named_state(State("", "delay", of, about, length=length, late=float(late)))

    def _filter(self, of: law.Node, by: Filter, where: str) -> law.Node:
        total: law.Node = law.Binary("*", law.Number(by.direct), of) if by.direct else law.ZERO
        parts: list[tuple[complex, law.Node]] = [(g, self._delay(of, t)) for t, g in by.late if g]
        for mode in by.modes:
            try:
                _, forgotten, new = mode.stepped(self.cycle_s)
            except UsageError as error:
                raise UsageError(
                    error.what, where=where, expected=error.expected, got=error.got, hint=error.hint
                ) from None
            if mode.is_real:
                tau = mode.tau_s if mode.s is not None else None
                about = f"tau = {tau / 60:.9g} min" if tau else f"pole z = {complex(mode.z or 0).real:.9g}"
                rates = (Rate(forgotten.real, new.real, tau),)
                parts.append((complex(mode.weight).real, self._named_state(State("", "lag", of, about, rates))))
            else:
                pair = self._named_state(State("", "pair", of, "a complex pair of poles", (Rate(forgotten, new),)))
                weight = complex(mode.weight)
                parts.append((2 * weight.real, law.Symbol(f"{pair.name}_re")))
                parts.append((-2 * weight.imag, law.Symbol(f"{pair.name}_im")))
        for factor, part in parts:
            total = law.Binary("+", total, law.Binary("*", law.Number(complex(factor).real), part))
        return law.fold(total)

    def _named_state(self, state: State) -> law.Symbol:
        """What a state gives; equal ones are one. state: not yet named."""
        key = replace(state, about="")  # which is for the reader: what is computed is the same
        if key not in self.states:
            self.states[key] = replace(state, name=self.taken.take(f"x{len(self.states) + 1}", OF_STATE))
        name = self.states[key].name
        return law.Symbol(name if state.kind != "delay" else f"{name}_out")
