"""A control program as structured text: IEC 61131-3, and Siemens SCL, which is nearly that."""

from __future__ import annotations

from thermodata.export.control.body import make_body
from thermodata.export.control.printer import Printer, Words, digits, heading
from thermodata.export.control.program import Program
from thermodata.export.control.statements import Variable

_SECTIONS = (("in", "VAR_INPUT"), ("out", "VAR_OUTPUT"), ("kept", "VAR RETAIN"), ("temp", "VAR_TEMP"))


def structured_text(program: Program, real: str = "REAL", dialect: str = "st") -> str:
    """A function block. real: REAL (32 bits, states in two words) or LREAL. dialect: st, or scl."""
    single = real == "REAL"
    body = make_body(program, compensated=single)
    scl = dialect == "scl"

    def number(value: float) -> str:
        return digits(value, single).replace("e", "E")

    words = Words(
        equal="=",
        unequal="<>",
        both=" AND ",
        either=" OR ",
        no="NOT ",
        true="TRUE",
        false="FALSE",
        absolute="ABS({})",
        power="({} ** {})" if scl else "EXPT({}, {})",
        assign="{} := {};",
        if_="IF {} THEN",
        else_="ELSE",
        end_if="END_IF;",
        fill=(
            f"FOR {'#' if scl else ''}k := 0 TO {{last}} DO",
            f"    {{ring}}[{'#' if scl else ''}k] := {{value}};",
            "END_FOR;",
        ),
        comment="// {}" if scl else "(* {} *)",
        real=number,
    )
    printer = Printer(words, (lambda name: f"#{name}") if scl else (lambda name: name))
    note = words.comment
    lines = [note.format(line) if line else "" for line in heading(body)]
    lines += [f'FUNCTION_BLOCK "{program.name}"' if scl else f"FUNCTION_BLOCK {program.name}"]
    lines += ["{ S7_Optimized_Access := 'TRUE' }", "VERSION : 0.1"] if scl else []
    for held, word in _SECTIONS:
        section = [v for v in body.variables if v.held == held]
        if held == "temp" and any(v.kind == "ring" for v in body.variables):
            section = [*section, Variable("k", "int", "temp")]
        if section:
            lines += [f"    {word}", *(f"        {_declaration(v, real, words)}" for v in section), "    END_VAR"]
    lines += ["BEGIN"] if scl else []
    lines += printer.block(body.statements, 0)
    return "\n".join([*lines, "END_FUNCTION_BLOCK", ""])


def _declaration(v: Variable, real: str, words: Words) -> str:
    kind = {"real": real, "int": "DINT", "bool": "BOOL", "ring": f"ARRAY[0..{v.length - 1}] OF {real}"}[v.kind]
    start = " := TRUE" if v.kind == "bool" and v.start else ""
    about = f" {words.comment.format(v.about)}" if v.about else ""
    return f"{v.name} : {kind}{start};{about}"
