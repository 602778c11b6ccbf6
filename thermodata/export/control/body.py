"""What a control program does in one cycle: readings, start, states, contributions, correction."""

from __future__ import annotations

from thermodata.effect import law
from thermodata.effect.law_text import written
from thermodata.export.control import start
from thermodata.export.control.program import Program, State
from thermodata.export.control.statements import (
    Assign,
    Body,
    If,
    Say,
    Statement,
    Variable,
    any_of,
    number,
    truth,
    var,
    whole,
)
from thermodata.export.control.states import delay, parts, rest, update
from thermodata.schema.agreed.comparators import Comparator

MOST_COUNTED = 2_000_000_000  # a counter of 32 bits stands still there


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
    body.statements.append(If(var("running"), tuple(inner)))
    _limit(body)
    return body


def _declare(body: Body) -> None:
    p, add = body.program, body.variables.append
    add(Variable("restart", "bool", "in", "start anew: what the temperatures are now is zero"))
    for i in p.inputs:
        at = f" at {i.at}" if i.at else ""
        add(Variable(i.name, "real", "in", f"[{i.unit}] {i.quantity.replace('_', ' ')}{at}"))
        add(Variable(f"valid_{i.name}", "bool", "in", "FALSE: the control knows that the reading is bad", start=1.0))
    add(Variable("displacement", "real", "out", f"[{p.unit}] predicted displacement of {p.response}"))
    add(Variable("correction", "real", "out", f"[{p.unit}] to add to the axis: minus the displacement, limited"))
    add(Variable("running", "bool", "kept", "TRUE once every reading was good"))
    add(Variable("limited", "bool", "out", "TRUE while the correction or its rate is limited"))
    add(Variable("fault", "bool", "out", "TRUE while a reading is bad for too long: the correction stands still"))
    add(Variable("wanted", "real", "temp", ""))
    add(Variable("starting", "bool", "temp", ""))
    for i in p.inputs:
        add(Variable(f"held_{i.name}", "real", "kept", f"[{i.unit}] last good reading"))
        add(Variable(f"bad_{i.name}", "int", "kept", "bad readings on end"))
        add(Variable(f"lost_{i.name}", "int", "kept", "bad readings in all"))
        add(Variable(f"seen_{i.name}", "bool", "kept", "a good reading was seen"))
    for d in p.drives:
        add(Variable(d.name, "real", "temp", f"[{d.unit}] {d.text}" + (", from its start" if d.relative else "")))
    start.declare(body)
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
    add(Variable(f"old_{s.name}", "real", "kept", f"its input, {written(s.of)}, a cycle ago"))
    for part in parts(s):
        add(Variable(part, "real", "kept", s.about))
        if body.compensated:
            add(Variable(f"{part}_lo", "real", "kept", "what did not fit into it"))
    if s.kind == "pair":
        add(Variable(f"{s.name}_gap", "real", "temp", ""))


def _sensors(body: Body) -> None:
    p, add = body.program, body.statements.append
    add(Say("Readings: a bad one is held, and counted"))
    for i in p.inputs:
        reading = var(i.name)
        # a reading that is no number compares false with everything, and is bad
        good = law.Logic(
            "and",
            (
                var(f"valid_{i.name}"),
                law.Compare(">=", reading, law.Number(i.low)),
                law.Compare("<=", reading, law.Number(i.high)),
            ),
        )
        counters: list[Statement] = [
            If(
                law.Compare("<", var(name), whole(MOST_COUNTED)),
                (Assign(name, law.Binary("+", var(name), whole(1)), "int"),),
            )
            for name in (f"bad_{i.name}", f"lost_{i.name}")
        ]
        add(
            If(
                good,
                (
                    Assign(f"held_{i.name}", reading),
                    Assign(f"bad_{i.name}", whole(0), "int"),
                    Assign(f"seen_{i.name}", truth(True), "bool"),
                ),
                tuple(counters),
            )
        )
    late = tuple(law.Compare(">", var(f"bad_{i.name}"), whole(p.hold_cycles)) for i in p.inputs)
    add(Assign("fault", any_of(late), "bool"))


def _start(body: Body) -> None:
    p, add = body.program, body.statements.append
    add(Say("Start: temperatures count from now, all else was at rest; or from the last state where there is one"))
    add(If(var("restart"), (Assign("running", truth(False), "bool"),)))
    add(Assign("starting", truth(False), "bool"))
    good = tuple(law.Compare("==", var(f"bad_{i.name}"), whole(0)) for i in p.inputs)
    seen = tuple(var(f"seen_{i.name}") for i in p.inputs)
    ready = law.Logic("and", (law.Logic("not", (var("running"),)), *good, *seen))
    inner: list[Statement] = [Assign("running", truth(True), "bool"), Assign("starting", truth(True), "bool")]
    outer, body.statements = body.statements, inner
    start.begin(body)
    body.statements = outer
    add(If(ready, tuple(inner)))


def _run(body: Body) -> None:
    p, add = body.program, body.statements.append
    start.search(body)
    if p.drives:
        add(Say("What drives the effects"))
    for d in p.drives:
        tree = number(body, d.tree)
        add(Assign(d.name, law.Binary("-", tree, var(f"ref_{d.name}")) if d.relative else tree))
    for s in p.states:
        add(Say(f"{s.name}: {s.about}"))
        add(Assign(f"in_{s.name}", number(body, s.of)))
        if s.kind == "delay":
            delay(body, s)
        else:
            add(If(var("starting"), tuple(rest(body, s)), tuple(update(body, s))))
            add(Assign(f"old_{s.name}", var(f"in_{s.name}")))
    add(Say(f"Contributions [{p.unit}]"))
    total: law.Node = law.ZERO
    for t in p.terms:
        add(Assign(t.name, number(body, t.tree)))
        total = law.fold(law.Binary("+", total, var(t.name)))
    add(Assign("displacement", total))


def _limit(body: Body) -> None:
    p, add = body.program, body.statements.append
    most, rate = p.limits.correction, p.limits.rate * p.cycle_s / 60.0
    add(Say(f"Correction: at most {most:g} {p.unit}, and {p.limits.rate:g} {p.unit} a minute; none moves at a fault"))
    add(Assign("limited", truth(False), "bool"))
    flag = Assign("limited", truth(True), "bool")
    inner: list[Statement] = [
        Assign("wanted", law.Binary("*", law.Number(-1.0), var("displacement"))),
        *(
            If(law.Compare(op, var("wanted"), law.Number(end)), (Assign("wanted", law.Number(end)), flag))
            for op, end in _ends(most)
        ),
        Assign("wanted", law.Binary("-", var("wanted"), var("correction"))),
        *(
            If(law.Compare(op, var("wanted"), law.Number(end)), (Assign("wanted", law.Number(end)), flag))
            for op, end in _ends(rate)
        ),
        Assign("correction", law.Binary("+", var("correction"), var("wanted"))),
    ]
    add(If(law.Logic("and", (var("running"), law.Logic("not", (var("fault"),)))), tuple(inner)))


def _ends(most: float) -> tuple[tuple[Comparator, float], ...]:
    return ((">", most), ("<", -most))
