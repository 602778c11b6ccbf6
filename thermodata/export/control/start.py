"""Where temperatures count from in a control: the mean of the first minutes, as a prediction of logs takes it.

One reading is wrong by its noise and by up to half its digit, and whatever is predicted from it stays wrong by that. So
readings are averaged over bins as long as the fit's step, and bins for as long as they lie within their noise, as
`thermodata.modelling.inputs.drivers.start_value` does; where they move from the first on, a line through three of them
goes back to the start. Until that is known the reference is the best so far: the program runs from its first cycle on.
"""

from __future__ import annotations

from collections.abc import Iterator

from thermodata.effect import law
from thermodata.export.control.program import Drive, Program, Start
from thermodata.export.control.statements import Assign, Body, If, Say, Statement, Variable, number, truth, var

COUNT, BINS, MEAN = "start_count", "start_bins", "start_mean"


def relative(program: Program) -> tuple[Drive, ...]:
    """The drives that count from the start."""
    return tuple(d for d in program.drives if d.relative)


def declare(body: Body) -> None:
    """What the search for the start remembers."""
    add, drives = body.variables.append, relative(body.program)
    for d in drives:
        add(Variable(f"ref_{d.name}", "real", "kept", f"{d.text} at the start"))
    if body.program.start is None or not drives:
        return
    add(Variable(COUNT, "real", "kept", "readings in this bin"))
    add(Variable(BINS, "real", "kept", "bins that are full"))
    add(Variable(MEAN, "real", "temp"))
    for d in drives:
        add(Variable(f"first_{d.name}", "real", "kept", f"{d.text}, its first reading"))
        add(Variable(f"sum_{d.name}", "real", "kept", "of this bin's readings, from the first one"))
        add(Variable(f"bin1_{d.name}", "real", "kept", "mean of the first bin"))
        add(Variable(f"bin2_{d.name}", "real", "kept", "mean of the second"))
        add(Variable(f"moves_{d.name}", "bool", "kept", "it moves from the first bins on"))
        add(Variable(f"open_{d.name}", "bool", "kept", "its start is not yet known"))


def begin(body: Body) -> None:
    """In the first cycle: each counts from its first reading."""
    p, add = body.program, body.statements.append
    for d in relative(p):
        add(Assign(f"ref_{d.name}", number(body, d.tree)))
        if p.start is not None:
            add(Assign(f"first_{d.name}", var(f"ref_{d.name}")))
            for what in ("sum", "bin1", "bin2"):
                add(Assign(f"{what}_{d.name}", law.ZERO))
            add(Assign(f"moves_{d.name}", truth(False), "bool"))
            add(Assign(f"open_{d.name}", truth(True), "bool"))
    if p.start is not None and relative(p):
        add(Assign(COUNT, law.ZERO))
        add(Assign(BINS, law.ZERO))


def search(body: Body) -> None:
    """In the first minutes: bins are averaged for as long as they stand still."""
    start, drives = body.program.start, relative(body.program)
    if start is None or not drives:
        return
    inner: list[Statement] = [Assign(COUNT, law.Binary("+", var(COUNT), law.ONE))]
    outer, body.statements = body.statements, inner
    for d in drives:
        inner.append(If(var(f"open_{d.name}"), tuple(_reading(body, d, start))))
    inner.append(If(_is_bin_full(start), (Assign(COUNT, law.ZERO), Assign(BINS, law.Binary("+", var(BINS), law.ONE)))))
    body.statements = outer
    body.statements.append(Say("Where temperatures count from: the mean of the first minutes, while they stand still"))
    body.statements.append(If(law.Compare("<", var(BINS), law.Number(start.bins - 0.5)), tuple(inner)))


def _is_bin_full(start: Start) -> law.Node:
    return law.Compare(">", var(COUNT), law.Number(start.cycles - 0.5))


def _reading(body: Body, d: Drive, start: Start) -> Iterator[Statement]:
    total, ref = f"sum_{d.name}", f"ref_{d.name}"
    inner: list[Statement] = []
    outer, body.statements = body.statements, inner
    deviation = law.Binary("-", number(body, d.tree), var(f"first_{d.name}"))
    body.statements = outer
    yield from inner
    yield Assign(total, law.Binary("+", var(total), deviation))
    yield Assign(MEAN, law.Binary("+", var(f"first_{d.name}"), law.Binary("/", var(total), var(COUNT))))
    yield If(_is_before_bin(1), (Assign(ref, var(MEAN)),))
    yield If(_is_bin_full(start), (Assign(total, law.ZERO), *_bin(d, start)))


def _is_before_bin(bins: int) -> law.Node:
    return law.Compare("<", var(BINS), law.Number(bins - 0.5))


def _bin(d: Drive, start: Start) -> Iterator[Statement]:
    ref, moves, mean = f"ref_{d.name}", f"moves_{d.name}", var(MEAN)
    one, two = f"bin1_{d.name}", f"bin2_{d.name}"
    # from the middle of the first bin's readings back to the first of them, in bins
    back = (start.cycles - 1) / (2.0 * start.cycles)
    away = law.Compare(">", law.Absolute(law.Binary("-", mean, var(ref))), law.Number(d.band))
    close = Assign(f"open_{d.name}", truth(False), "bool")
    step = law.Binary("/", law.Binary("-", mean, var(ref)), law.Binary("+", var(BINS), law.ONE))
    average = Assign(ref, law.Binary("+", var(ref), step))
    of_two = Assign(ref, _sum((1.0 + back, var(one)), (-back, var(two))))
    tilt = (1.0 + back) / 2.0
    of_three = Assign(ref, _sum((1 / 3 + tilt, var(one)), (1 / 3, var(two)), (1 / 3 - tilt, mean)))
    second = (
        Assign(two, mean),
        If(away, (Assign(moves, truth(True), "bool"), of_two), (average,)),
    )
    third = (If(law.Logic("or", (var(moves), away)), (of_three, close), (average,)),)
    later = (If(away, (close,), (average,)),)
    yield If(
        _is_before_bin(1),
        (Assign(one, mean),),
        (If(_is_before_bin(2), second, (If(_is_before_bin(3), third, later),)),),
    )


def _sum(*parts: tuple[float, law.Node]) -> law.Node:
    total: law.Node = law.ZERO
    for factor, part in parts:
        total = law.fold(law.Binary("+", total, law.Binary("*", law.Number(factor), part)))
    return total
