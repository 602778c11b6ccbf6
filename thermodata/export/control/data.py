"""A control program as numbers: JSON for any program, MAT for one that simulates with matrices."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from thermodata.effect import law
from thermodata.export.control.printer import Printer
from thermodata.export.control.program import Program
from thermodata.export.control.python import PYTHON

SCHEMA = "thermodata/control/1"
RULE = "x += forgotten * (u_old - x) + new * (u - u_old), from x = 0 and u_old = u"
START_RULE = (
    "what counts from balance counts from the mean of its first bins of bin_cycles readings, of most_bins at most and "
    "for as long as a bin is within still_within of their mean; where the second or third is not, from where a line "
    "through the first three was at the first reading"
)


def as_data(program: Program) -> dict[str, Any]:
    """All of it as plain values. Formulas are text over the names in it; a complex number is [real, imaginary]."""
    return {
        "schema": SCHEMA,
        "name": program.name,
        "about": dict(program.about),
        "response": program.response,
        "unit": program.unit,
        "cycle_s": program.cycle_s,
        "rule": f"{RULE}; u as `of` says",
        "start": None
        if program.start is None
        else {"rule": START_RULE, "bin_cycles": program.start.cycles, "most_bins": program.start.bins},
        "inputs": [
            {
                "name": i.name,
                "channel": i.channel,
                "quantity": i.quantity,
                "unit": i.unit,
                "at": i.at,
                "low": i.low,
                "high": i.high,
            }
            for i in program.inputs
        ],
        "drives": [
            {
                "name": d.name,
                "formula": _formula(d.tree),
                "unit": d.unit,
                "counts_from_balance": d.relative,
                "still_within": d.band if d.relative and program.start is not None else None,
            }
            for d in program.drives
        ],
        "states": [
            {
                "name": s.name,
                "kind": s.kind,
                "of": _formula(s.of),
                "about": s.about,
                "while": None if s.condition is None else _formula(s.condition),
                "rates": [
                    {"forgotten": _as_json_number(r.forgotten), "new": _as_json_number(r.new), "tau_s": r.tau_s}
                    for r in s.rates
                ],
                "late_cycles": s.late if s.kind == "delay" else None,
            }
            for s in program.states
        ],
        "terms": [
            {"name": t.name, "effect": t.effect, "formula": _formula(t.tree), "parameters": list(t.about)}
            for t in program.terms
        ],
        "limits": {
            "correction": program.limits.correction,
            "rate_per_min": program.limits.rate,
            "hold_s": program.limits.hold_s,
        },
    }


def json_text(program: Program) -> str:
    """The same as text; every number reads back as itself."""
    return json.dumps(as_data(program), indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def write_mat(program: Program, path: Path) -> None:
    """MAT 5 with one struct, the program's name: the JSON's fields, and forgotten, new, tau_s as columns."""
    from scipy.io import savemat

    states = [s for s in program.states if s.kind != "delay"]
    content: dict[str, Any] = {
        "about": "\n".join(f"{k}: {v}" for k, v in program.about),
        "response": program.response,
        "unit": program.unit,
        "cycle_s": program.cycle_s,
        "rule": f"{RULE}; u as `state_inputs` says; the first column of `forgotten` and `new` counts while "
        "`state_while` holds or is empty, the second one else",
        "inputs": _cells([i.name for i in program.inputs]),
        "input_units": _cells([i.unit for i in program.inputs]),
        "input_low": _column([i.low for i in program.inputs]),
        "input_high": _column([i.high for i in program.inputs]),
        "drives": _cells([d.name for d in program.drives]),
        "drive_formulas": _cells([_formula(d.tree) for d in program.drives]),
        "counts_from_balance": _column([float(d.relative) for d in program.drives]),
        "still_within": _column([d.band for d in program.drives]),
        "start_bin_cycles": program.start.cycles if program.start else 0,
        "start_most_bins": program.start.bins if program.start else 0,
        "start_rule": START_RULE if program.start else "",
        "states": _cells([s.name for s in states]),
        "state_inputs": _cells([_formula(s.of) for s in states]),
        "state_while": _cells(["" if s.condition is None else _formula(s.condition) for s in states]),
        "forgotten": np.array([[r.forgotten for r in (*s.rates, *s.rates)[:2]] for s in states]).reshape(-1, 2),
        "new": np.array([[r.new for r in (*s.rates, *s.rates)[:2]] for s in states]).reshape(-1, 2),
        "tau_s": _column([s.rates[0].tau_s or np.nan for s in states]),
        "delays": _cells([s.name for s in program.states if s.kind == "delay"]),
        "delay_cycles": _column([s.late for s in program.states if s.kind == "delay"]),
        "delay_inputs": _cells([_formula(s.of) for s in program.states if s.kind == "delay"]),
        "terms": _cells([t.name for t in program.terms]),
        "term_formulas": _cells([_formula(t.tree) for t in program.terms]),
        "limit": program.limits.correction,
        "limit_rate_per_min": program.limits.rate,
        "hold_s": program.limits.hold_s,
    }
    for key in ("forgotten", "new"):
        content[key] = content[key].real if np.isrealobj(content[key]) or not content[key].imag.any() else content[key]
    savemat(path, {program.name[:31]: content}, long_field_names=True)


def _cells(texts: list[str]) -> Any:
    return np.array(texts, dtype=object).reshape(-1, 1)


def _column(values: list[float]) -> Any:
    return np.array(values, dtype=np.float64).reshape(-1, 1)


def _as_json_number(value: complex) -> float | list[float]:
    number = complex(value)
    return number.real if number.imag == 0 else [number.real, number.imag]


def _formula(node: law.Node) -> str:
    words = replace(PYTHON, true="1", false="0", real=repr, choose="({} if {} else {})")
    return Printer(words, lambda name: name).text(node)
