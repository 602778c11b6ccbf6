"""A control program as C99: a header and a source, without any library but math.h."""

from __future__ import annotations

from thermodata.export.control.body import make_body
from thermodata.export.control.printer import Printer, Words, digits, heading
from thermodata.export.control.program import Program
from thermodata.export.control.statements import Body, Variable


def c_files(program: Program, real: str) -> dict[str, str]:
    """{name.h: ..., name.c: ...}. real: REAL is float (states in two words), LREAL is double."""
    single = real == "REAL"
    body = make_body(program, compensated=single)
    name, kind = program.name, "float" if single else "double"
    header = _header(program, body, kind)
    source = _source(name, body, kind, single)
    return {f"{name}.h": "\n".join(header), f"{name}.c": "\n".join(source)}


def _words(single: bool) -> Words:
    suffix = "f" if single else ""

    def number(value: float) -> str:
        return digits(value, single) + suffix

    return Words(
        equal="==",
        unequal="!=",
        both=" && ",
        either=" || ",
        no="!",
        true="1",
        false="0",
        absolute=f"fabs{suffix}({{}})",
        power=f"pow{suffix}({{}}, {{}})",
        assign="{} = {};",
        if_="if ({}) {{",
        else_="} else {",
        end_if="}",
        fill=("for (k = 0; k < {length}; k++) {{ {ring}[k] = {value}; }}",),
        comment="/* {} */",
        real=number,
    )


def _header(program: Program, body: Body, kind: str) -> list[str]:
    """kind: of a number in C."""
    name = program.name
    return [
        *("/*", *(f" * {line}".rstrip() for line in heading(body)), " */"),
        f"#ifndef {name.upper()}_H",
        f"#define {name.upper()}_H",
        "",
        f"#define {name.upper()}_CYCLE_S {program.cycle_s!r}",
        "",
        "/* What the control reads; set every valid_* to 1, or to 0 where it knows better. */",
        "typedef struct {",
        *(f"    {_declaration(v, kind)}" for v in body.variables if v.held == "in"),
        f"}} {name}_inputs;",
        "",
        "/* What it remembers and answers: keep it over a power cut to go on from the last state. */",
        "typedef struct {",
        *(f"    {_declaration(v, kind)}" for v in body.variables if v.held in ("out", "kept")),
        f"}} {name};",
        "",
        f"void {name}_init({name} *m);",
        f"void {name}_step({name} *m, const {name}_inputs *in);",
        "",
        "#endif",
        "",
    ]


def _source(name: str, body: Body, kind: str, single: bool) -> list[str]:
    held = {v.name: v.held for v in body.variables}
    reach = {"in": "in->", "out": "m->", "kept": "m->", "temp": ""}
    printer = Printer(_words(single), lambda text: reach.get(held.get(text, "temp"), "") + text)
    temps = [v for v in body.variables if v.held == "temp"]
    temps += [Variable("k", "int", "temp")] if any(v.kind == "ring" for v in body.variables) else []
    second_word_stays = (
        "#ifdef __FAST_MATH__",
        "#error compile without -ffast-math: it removes the second word of the states",
        "#endif",
        "",
    )
    return [
        f'#include "{name}.h"',
        "",
        "#include <math.h>",
        "#include <string.h>",
        "",
        *(second_word_stays if single else ()),
        f"void {name}_init({name} *m)",
        "{",
        "    memset(m, 0, sizeof *m);",
        "}",
        "",
        f"void {name}_step({name} *m, const {name}_inputs *in)",
        "{",
        *(f"    {_declaration(v, kind, zero=True)}" for v in temps),
        *printer.block(body.statements, 1),
        *(f"    (void){v.name};" for v in temps),
        "}",
        "",
    ]


def _declaration(v: Variable, real: str, zero: bool = False) -> str:
    about = f" /* {v.about} */" if v.about else ""
    if v.kind == "ring":
        return f"{real} {v.name}[{v.length}];{about}"
    kind = {"real": real, "int": "long", "bool": "int"}[v.kind]
    return f"{kind} {v.name}{' = 0' if zero else ''};{about}"
