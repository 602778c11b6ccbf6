"""How states go on from one cycle to the next: in delta form, in two words where reals have 32 bits."""

from __future__ import annotations

from collections.abc import Iterator

from thermodata.effect import law
from thermodata.export.control.program import State
from thermodata.export.control.statements import Assign, Body, Fill, If, Statement, condition, var, whole


def parts(s: State) -> tuple[str, ...]:
    """The names of what it remembers."""
    return (s.name,) if s.kind == "lag" else (f"{s.name}_re", f"{s.name}_im")


def rest(body: Body, s: State) -> Iterator[Statement]:
    """Everything at zero: balance."""
    for part in parts(s):
        yield Assign(part, law.ZERO)
        if body.compensated:
            yield Assign(f"{part}_lo", law.ZERO)


def update(body: Body, s: State) -> Iterator[Statement]:
    """One cycle: x += forgotten (u_old - x) + new (u - u_old)."""
    if s.kind == "pair":
        yield from _update_pair(body, s)
        return
    yield _gap(body, "gap", s, s.name)
    if s.condition is None:
        yield _change(s, s.rates[0].forgotten.real, s.rates[0].new.real)
    else:
        then, other = s.rates
        yield If(
            condition(body, s.condition),
            (_change(s, then.forgotten.real, then.new.real),),
            (_change(s, other.forgotten.real, other.new.real),),
        )
    yield from _move(body, s.name)


def _gap(body: Body, into: str, s: State, part: str) -> Assign:
    gap: law.Node = law.Binary("-", var(f"old_{s.name}"), var(part))
    if body.compensated:
        gap = law.Binary("-", gap, var(f"{part}_lo"))
    return Assign(into, gap)


def _change(s: State, forgotten: float, new: float) -> Assign:
    step = law.Binary("-", var(f"in_{s.name}"), var(f"old_{s.name}"))
    return Assign(
        "change",
        law.Binary("+", law.Binary("*", law.Number(forgotten), var("gap")), law.Binary("*", law.Number(new), step)),
    )


def _move(body: Body, part: str) -> Iterator[Statement]:
    """part += change; in two words the rest is kept for the next cycle."""
    if not body.compensated:
        yield Assign(part, law.Binary("+", var(part), var("change")))
        return
    yield Assign("change", law.Binary("+", var("change"), var(f"{part}_lo")))
    yield Assign("sum", law.Binary("+", var(part), var("change")))
    yield Assign(f"{part}_lo", law.Binary("-", var("change"), law.Binary("-", var("sum"), var(part))))
    yield Assign(part, var("sum"))


def _update_pair(body: Body, s: State) -> Iterator[Statement]:
    re, im = parts(s)
    a, b = s.rates[0].forgotten, s.rates[0].new
    step = law.Binary("-", var(f"in_{s.name}"), var(f"old_{s.name}"))
    # the imaginary part rests at zero, whatever the input
    inner: law.Node = law.Binary("*", law.Number(-1.0), var(im))
    if body.compensated:
        inner = law.Binary("-", inner, var(f"{im}_lo"))
    yield _gap(body, "gap", s, re)
    yield Assign(f"{s.name}_gap", inner)

    def change(x: float, y: float, z: float) -> Assign:
        parts: list[tuple[float, law.Node]] = [(x, var("gap")), (y, var(f"{s.name}_gap")), (z, step)]
        total: law.Node = law.ZERO
        for factor, part in parts:
            total = law.fold(law.Binary("+", total, law.Binary("*", law.Number(factor), part)))
        return Assign("change", total)

    yield change(a.real, -a.imag, b.real)
    yield from _move(body, re)
    yield change(a.imag, a.real, b.imag)
    yield from _move(body, im)


def delay(body: Body, s: State) -> None:
    """The ring takes its input, and is read `late` cycles back: straight between two samples."""
    add, ring, at, back = body.statements.append, f"{s.name}_ring", f"{s.name}_at", f"{s.name}_back"
    full = int(s.late // 1)
    share = s.late - full
    wrap = If(law.Compare(">=", var(at), whole(s.length)), (Assign(at, whole(0), "int"),))
    add(
        If(
            var("starting"),
            (Fill(ring, s.length, var(f"in_{s.name}")), Assign(at, whole(0), "int")),
            (
                Assign(at, law.Binary("+", var(at), whole(1)), "int"),
                wrap,
                Assign(f"{ring}[{at}]", var(f"in_{s.name}")),
            ),
        )
    )

    def look(cycles: int) -> tuple[Statement, ...]:
        return (
            Assign(back, law.Binary("-", var(at), whole(cycles)), "int"),
            If(
                law.Compare("<", var(back), whole(0)),
                (Assign(back, law.Binary("+", var(back), whole(s.length)), "int"),),
            ),
        )

    for one in look(full):
        add(one)
    add(Assign(f"{s.name}_out", var(f"{ring}[{back}]")))
    if share:
        for one in look(full + 1):
            add(one)
        rest = law.Binary("-", var(f"{ring}[{back}]"), var(f"{s.name}_out"))
        add(Assign(f"{s.name}_out", law.Binary("+", var(f"{s.name}_out"), law.Binary("*", law.Number(share), rest))))
