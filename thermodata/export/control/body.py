"""What a control program does in one cycle, as declarations and statements that every language has."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Literal, TypeAlias

from thermodata.effect import law
from thermodata.export.control.program import Program, State

Kind = Literal["real", "int", "bool", "ring"]
Held = Literal["in", "out", "kept", "temp"]
MOST_COUNTED = 2_000_000_000  # a counter of 32 bits stands still there


@dataclass(frozen=True)
class Variable:
    """held: an input, an output, kept from cycle to cycle (and over power off), or of one cycle. length: of a ring."""

    name: str
    kind: Kind
    held: Held
    about: str = ""
    start: float = 0.0
    length: int = 0


@dataclass(frozen=True)
class Assign:
    """target := value. kind: of the value."""

    target: str
    value: law.Node
    kind: Kind = "real"


@dataclass(frozen=True)
class If:
    """Statements where a condition holds, and others where it does not."""

    condition: law.Node
    then: tuple[Statement, ...]
    other: tuple[Statement, ...] = ()


@dataclass(frozen=True)
class Fill:
    """All places of a ring := value."""

    ring: str
    length: int
    value: law.Node


@dataclass(frozen=True)
class Say:
    """A comment."""

    text: str


Statement: TypeAlias = Assign | If | Fill | Say


@dataclass
class Body:
    """compensated: states are kept in two words, for reals of 32 bits."""

    program: Program
    compensated: bool
    variables: list[Variable] = field(default_factory=list)
    statements: list[Statement] = field(default_factory=list)
    _temps: int = 0


def make_body(program: Program, compensated: bool) -> Body:
    """The cycle of a program. Symbols are the names of its variables."""
    body = Body(program, compensated)
    _declare(body)
    _sensors(body)
    _start(body)
    inner: list[Statement] = []
    outer, body.statements = body.statements, inner
    _run(body)
    body.statements = outer
    body.statements.append(If(_s("running"), tuple(inner)))
    _limit(body)
    return body


def _declare(body: Body) -> None:
    p, add = body.program, body.variables.append
    add(Variable("restart", "bool", "in", "start from balance: what the inputs say now is zero"))
    for i in p.inputs:
        at = f" at {i.at}" if i.at else ""
        add(Variable(i.name, "real", "in", f"[{i.unit}] {i.quantity.replace('_', ' ')}{at}"))
        add(Variable(f"valid_{i.name}", "bool", "in", "FALSE: the control knows that the reading is bad", start=1.0))
    add(Variable("displacement", "real", "out", f"[{p.unit}] predicted displacement of {p.response}"))
    add(Variable("correction", "real", "out", f"[{p.unit}] to add to the axis: minus the displacement, limited"))
    add(Variable("running", "bool", "kept", "TRUE once every reading was good"))
    add(Variable("limited", "bool", "out", "TRUE while the correction or its rate is limited"))
    add(Variable("fault", "bool", "out", "TRUE while a reading is bad for too long: the correction stands still"))
    add(Variable("move", "real", "temp", ""))
    add(Variable("begin", "bool", "temp", ""))
    for i in p.inputs:
        add(Variable(f"held_{i.name}", "real", "kept", f"[{i.unit}] last good reading"))
        add(Variable(f"bad_{i.name}", "int", "kept", "bad readings on end"))
        add(Variable(f"lost_{i.name}", "int", "kept", "bad readings in all"))
        add(Variable(f"seen_{i.name}", "bool", "kept", "a good reading was seen"))
    for d in p.drives:
        add(Variable(d.name, "real", "temp", f"[{d.unit}] {d.text}" + (", from balance" if d.relative else "")))
        if d.relative:
            add(Variable(f"ref_{d.name}", "real", "kept", f"{d.text} in balance"))
    for s in p.states:
        _declare_state(body, s)
    for t in p.terms:
        add(Variable(t.name, "real", "temp", f"[{p.unit}] {t.effect}"))
    if p.states:
        add(Variable("gap", "real", "temp", ""))
        add(Variable("change", "real", "temp", ""))
        if body.compensated:
            add(Variable("sum", "real", "temp", ""))


def _declare_state(body: Body, s: State) -> None:
    add = body.variables.append
    add(Variable(f"in_{s.name}", "real", "temp", ""))
    if s.kind == "delay":
        add(Variable(f"{s.name}_ring", "ring", "kept", s.about, length=s.length))
        add(Variable(f"{s.name}_at", "int", "kept", "where the newest sample stands"))
        add(Variable(f"{s.name}_back", "int", "temp", ""))
        add(Variable(f"{s.name}_out", "real", "kept", ""))
        return
    add(Variable(f"old_{s.name}", "real", "kept", f"its input, {law.written(s.of)}, a cycle ago"))
    for part in _parts(s):
        add(Variable(part, "real", "kept", s.about))
        if body.compensated:
            add(Variable(f"{part}_lo", "real", "kept", "what did not fit into it"))
    if s.kind == "pair":
        add(Variable(f"{s.name}_gap", "real", "temp", ""))


def _parts(s: State) -> tuple[str, ...]:
    return (s.name,) if s.kind == "lag" else (f"{s.name}_re", f"{s.name}_im")


def _sensors(body: Body) -> None:
    p, add = body.program, body.statements.append
    add(Say("Readings: a bad one is held, and counted"))
    for i in p.inputs:
        reading = _s(i.name)
        # a reading that is no number compares false with everything, and is bad
        good = law.Logic(
            "and",
            (
                _s(f"valid_{i.name}"),
                law.Compare(">=", reading, law.Number(i.low)),
                law.Compare("<=", reading, law.Number(i.high)),
            ),
        )
        counters: list[Statement] = [
            If(
                law.Compare("<", _s(name), _int(MOST_COUNTED)),
                (Assign(name, law.Binary("+", _s(name), _int(1)), "int"),),
            )
            for name in (f"bad_{i.name}", f"lost_{i.name}")
        ]
        add(
            If(
                good,
                (
                    Assign(f"held_{i.name}", reading),
                    Assign(f"bad_{i.name}", _int(0), "int"),
                    Assign(f"seen_{i.name}", _bool(True), "bool"),
                ),
                tuple(counters),
            )
        )
    late = tuple(law.Compare(">", _s(f"bad_{i.name}"), _int(p.hold_cycles)) for i in p.inputs)
    add(Assign("fault", _any(late), "bool"))


def _start(body: Body) -> None:
    p, add = body.program, body.statements.append
    add(Say("Start: from balance, or from the last state where there is one"))
    add(If(_s("restart"), (Assign("running", _bool(False), "bool"),)))
    add(Assign("begin", _bool(False), "bool"))
    good = tuple(law.Compare("==", _s(f"bad_{i.name}"), _int(0)) for i in p.inputs)
    seen = tuple(_s(f"seen_{i.name}") for i in p.inputs)
    ready = law.Logic("and", (law.Logic("not", (_s("running"),)), *good, *seen))
    inner: list[Statement] = [Assign("running", _bool(True), "bool"), Assign("begin", _bool(True), "bool")]
    outer, body.statements = body.statements, inner
    for d in p.drives:
        if d.relative:
            inner.append(Assign(f"ref_{d.name}", _number(body, d.tree)))
    body.statements = outer
    add(If(ready, tuple(inner)))


def _run(body: Body) -> None:
    p, add = body.program, body.statements.append
    if p.drives:
        add(Say("What drives the effects"))
    for d in p.drives:
        tree = _number(body, d.tree)
        add(Assign(d.name, law.Binary("-", tree, _s(f"ref_{d.name}")) if d.relative else tree))
    for s in p.states:
        add(Say(f"{s.name}: {s.about}"))
        add(Assign(f"in_{s.name}", _number(body, s.of)))
        if s.kind == "delay":
            _delay(body, s)
        else:
            add(If(_s("begin"), tuple(_rest(body, s)), tuple(_update(body, s))))
            add(Assign(f"old_{s.name}", _s(f"in_{s.name}")))
    add(Say(f"Contributions [{p.unit}]"))
    total: law.Node = law.ZERO
    for t in p.terms:
        add(Assign(t.name, _number(body, t.tree)))
        total = law.fold(law.Binary("+", total, _s(t.name)))
    add(Assign("displacement", total))


def _rest(body: Body, s: State) -> Iterable[Statement]:
    for part in _parts(s):
        yield Assign(part, law.ZERO)
        if body.compensated:
            yield Assign(f"{part}_lo", law.ZERO)


def _update(body: Body, s: State) -> Iterable[Statement]:
    if s.kind == "pair":
        yield from _update_pair(body, s)
        return
    yield _gap(body, "gap", s, s.name)
    if s.condition is None:
        yield _change(s, s.rates[0].forgotten.real, s.rates[0].new.real)
    else:
        then, other = s.rates
        yield If(
            _condition(body, s.condition),
            (_change(s, then.forgotten.real, then.new.real),),
            (_change(s, other.forgotten.real, other.new.real),),
        )
    yield from _move(body, s.name)


def _gap(body: Body, into: str, s: State, part: str) -> Assign:
    gap: law.Node = law.Binary("-", _s(f"old_{s.name}"), _s(part))
    if body.compensated:
        gap = law.Binary("-", gap, _s(f"{part}_lo"))
    return Assign(into, gap)


def _change(s: State, forgotten: float, new: float) -> Assign:
    step = law.Binary("-", _s(f"in_{s.name}"), _s(f"old_{s.name}"))
    return Assign(
        "change",
        law.Binary(
            "+", law.Binary("*", law.Number(forgotten), _s("gap")), law.Binary("*", law.Number(new), step)
        ),
    )


def _move(body: Body, part: str) -> Iterable[Statement]:
    """part += change; in two words the rest is kept for the next cycle."""
    if not body.compensated:
        yield Assign(part, law.Binary("+", _s(part), _s("change")))
        return
    yield Assign("change", law.Binary("+", _s("change"), _s(f"{part}_lo")))
    yield Assign("sum", law.Binary("+", _s(part), _s("change")))
    yield Assign(f"{part}_lo", law.Binary("-", _s("change"), law.Binary("-", _s("sum"), _s(part))))
    yield Assign(part, _s("sum"))


def _update_pair(body: Body, s: State) -> Iterable[Statement]:
    re, im = _parts(s)
    a, b = s.rates[0].forgotten, s.rates[0].new
    step = law.Binary("-", _s(f"in_{s.name}"), _s(f"old_{s.name}"))
    # the imaginary part rests at zero, whatever the input
    inner: law.Node = law.Binary("*", law.Number(-1.0), _s(im))
    if body.compensated:
        inner = law.Binary("-", inner, _s(f"{im}_lo"))
    yield _gap(body, "gap", s, re)
    yield Assign(f"{s.name}_gap", inner)

    def change(x: float, y: float, z: float) -> Assign:
        parts = [(x, _s("gap")), (y, _s(f"{s.name}_gap")), (z, step)]
        total: law.Node = law.ZERO
        for factor, part in parts:
            total = law.fold(law.Binary("+", total, law.Binary("*", law.Number(factor), part)))
        return Assign("change", total)

    yield change(a.real, -a.imag, b.real)
    yield from _move(body, re)
    yield change(a.imag, a.real, b.imag)
    yield from _move(body, im)


def _delay(body: Body, s: State) -> None:
    add, ring, at, back = body.statements.append, f"{s.name}_ring", f"{s.name}_at", f"{s.name}_back"
    whole = int(s.late // 1)
    share = s.late - whole
    wrap = If(law.Compare(">=", _s(at), _int(s.length)), (Assign(at, _int(0), "int"),))
    add(
        If(
            _s("begin"),
            (Fill(ring, s.length, _s(f"in_{s.name}")), Assign(at, _int(0), "int")),
            (
                Assign(at, law.Binary("+", _s(at), _int(1)), "int"),
                wrap,
                Assign(f"{ring}[{at}]", _s(f"in_{s.name}")),
            ),
        )
    )

    def look(cycles: int) -> tuple[Statement, ...]:
        return (
            Assign(back, law.Binary("-", _s(at), _int(cycles)), "int"),
            If(
                law.Compare("<", _s(back), _int(0)),
                (Assign(back, law.Binary("+", _s(back), _int(s.length)), "int"),),
            ),
        )

    for one in look(whole):
        add(one)
    add(Assign(f"{s.name}_out", _s(f"{ring}[{back}]")))
    if share:
        for one in look(whole + 1):
            add(one)
        rest = law.Binary("-", _s(f"{ring}[{back}]"), _s(f"{s.name}_out"))
        add(
            Assign(
                f"{s.name}_out", law.Binary("+", _s(f"{s.name}_out"), law.Binary("*", law.Number(share), rest))
            )
        )


def _limit(body: Body) -> None:
    p, add = body.program, body.statements.append
    most, rate = p.limits.correction, p.limits.rate * p.cycle_s / 60.0
    add(Say(f"Correction: at most {most:g} {p.unit}, and {p.limits.rate:g} {p.unit} a minute; it stands still at a fault"))
    add(Assign("limited", _bool(False), "bool"))
    flag = Assign("limited", _bool(True), "bool")
    inner: list[Statement] = [
        Assign("move", law.Binary("*", law.Number(-1.0), _s("displacement"))),
        *(
            If(law.Compare(op, _s("move"), law.Number(end)), (Assign("move", law.Number(end)), flag))
            for op, end in ((">", most), ("<", -most))
        ),
        Assign("move", law.Binary("-", _s("move"), _s("correction"))),
        *(
            If(law.Compare(op, _s("move"), law.Number(end)), (Assign("move", law.Number(end)), flag))
            for op, end in ((">", rate), ("<", -rate))
        ),
        Assign("correction", law.Binary("+", _s("correction"), _s("move"))),
    ]
    add(If(law.Logic("and", (_s("running"), law.Logic("not", (_s("fault"),)))), tuple(inner)))


def _number(body: Body, node: law.Node) -> law.Node:
    """The node as arithmetic alone: conditions and choices become statements before it, a square a product."""
    match node:
        case law.Binary("**", left, law.Number(2.0)):
            base = _number(body, left)
            base = base if isinstance(base, law.Symbol) else _hoist(body, base)
            return law.Binary("*", base, base)
        case law.Binary(operator, left, right):
            return law.Binary(operator, _number(body, left), _number(body, right))
        case law.Absolute(of):
            return law.Absolute(_number(body, of))
        case law.Compare() | law.Logic():
            return _number(body, law.Where(node, law.ONE, law.ZERO))
        case law.Where(condition, then, other):
            name = _temp(body)
            held = _condition(body, condition)
            a, b = _number(body, then), _number(body, other)
            body.statements.append(If(held, (Assign(name, a),), (Assign(name, b),)))
            return _s(name)
    return node


def _condition(body: Body, node: law.Node) -> law.Node:
    match node:
        case law.Compare(operator, left, right):
            return law.Compare(operator, _number(body, left), _number(body, right))
        case law.Logic(operator, parts):
            return law.Logic(operator, tuple(_condition(body, p) for p in parts))
    return law.Compare("!=", _number(body, node), law.ZERO)


def _hoist(body: Body, value: law.Node) -> law.Node:
    name = _temp(body)
    body.statements.append(Assign(name, value))
    return _s(name)


def _temp(body: Body) -> str:
    body._temps += 1
    name = f"tmp_{body._temps}"
    body.variables.append(Variable(name, "real", "temp"))
    return name


@dataclass(frozen=True, slots=True)
class Whole:
    """A whole number or, as `truth`, a truth value: languages write them otherwise than reals."""

    value: int
    truth: bool = False


def _s(name: str) -> law.Symbol:
    return law.Symbol(name)


def _int(value: int) -> law.Node:
    return Whole(value)  # type: ignore[return-value]


def _bool(value: bool) -> law.Node:
    return Whole(int(value), truth=True)  # type: ignore[return-value]


def _any(parts: tuple[law.Node, ...]) -> law.Node:
    if not parts:
        return _bool(False)
    return parts[0] if len(parts) == 1 else law.Logic("or", parts)
