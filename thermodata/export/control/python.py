"""A control program as one Python module that needs nothing but the standard library."""

from __future__ import annotations

from thermodata.export.control.body import make_body
from thermodata.export.control.printer import Printer, Words, digits, heading
from thermodata.export.control.program import Program

_MAIN = '''

def main(lines, out):
    """One row a cycle: CSV with the inputs' names in its first row; an empty cell is a bad reading."""
    model, rows = Model(), csv.reader(lines)
    names = next(rows)
    missing = [name for name in INPUTS if name not in names]
    if missing:
        raise SystemExit("no column " + ", ".join(missing))
    at = [names.index(name) for name in INPUTS]
    writer = csv.writer(out, lineterminator="\\n")
    writer.writerow(["t_s", "displacement", "correction", "limited", "fault"])
    for k, row in enumerate(rows):
        model.step(*(float(row[i]) if row[i].strip() else None for i in at))
        writer.writerow(
            [repr(k * CYCLE_S), repr(model.displacement), repr(model.correction), int(model.limited), int(model.fault)]
        )


if __name__ == "__main__":
    main(sys.stdin, sys.stdout)
'''

PYTHON = Words(
    equal="==",
    unequal="!=",
    both=" and ",
    either=" or ",
    no="not ",
    true="True",
    false="False",
    absolute="abs({})",
    power="({} ** {})",
    assign="{} = {}",
    if_="if {}:",
    else_="else:",
    end_if=None,
    fill=("{ring}[:] = [{value}] * {length}",),
    comment="# {}",
    real=lambda value: digits(value, False),
)


def python_module(program: Program) -> str:
    """The module: class Model with step, state and restore; as a program it reads CSV from stdin."""
    body = make_body(program, compensated=False)
    held = {v.name: v.held for v in body.variables}
    printer = Printer(PYTHON, lambda text: f"self.{text}" if held.get(text) in ("out", "kept") else text)
    inputs = [i.name for i in program.inputs]
    kept = [v for v in body.variables if v.held in ("out", "kept")]
    start = {"real": "0.0", "int": "0", "bool": "False"}
    lines = [
        '"""' + "\n".join(heading(body)).replace("\\", "/").replace('"""', "'''"),
        '"""',
        "",
        "import csv",
        "import sys",
        "",
        f"CYCLE_S = {program.cycle_s!r}",
        f"INPUTS = {inputs!r}",
        "",
        "",
        "class Model:",
        '    """Inputs in the units below; None or a reading out of range is bad, and held."""',
        "",
        "    def __init__(self):",
        *(
            f"        self.{v.name} = {f'[0.0] * {v.length}' if v.kind == 'ring' else start[v.kind]}"
            + (f"  # {v.about}" if v.about else "")
            for v in kept
        ),
        "",
        "    def state(self):",
        '        """What to keep to go on from here: plain numbers."""',
        "        return {k: list(v) if isinstance(v, list) else v for k, v in vars(self).items()}",
        "",
        "    def restore(self, state):",
        '        """Go on from a state that was kept."""',
        "        for k, v in state.items():",
        "            setattr(self, k, list(v) if isinstance(v, list) else v)",
        "",
        f"    def step(self, {', '.join([*inputs, *(f'valid_{i}=True' for i in inputs), 'restart=False'])}):",
        f'        """One cycle of {program.cycle_s:g} s. Returns (displacement, correction) [{program.unit}]."""',
        *(f"        {i} = float('nan') if {i} is None else {i}" for i in inputs),
        *printer.block(body.statements, 2),
        "        return self.displacement, self.correction",
        "",
    ]
    return "\n".join(lines) + _MAIN
