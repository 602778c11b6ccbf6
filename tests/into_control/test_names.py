"""Names of channels in a program: none is a word of a language, or of what the program makes of another."""

from __future__ import annotations

import keyword
from collections import Counter

import pytest

from tests.into_control.programs import driven, program
from thermodata.effect import law
from thermodata.export.control.body import make_body
from thermodata.export.control.build import build
from thermodata.export.control.names import RESERVED, Names
from thermodata.export.control.program import Input, Limits, Program
from thermodata.modelling.seen.laws import Drive, GainLaw, TermLaw

C99 = (
    "auto break case char const continue default do double else enum extern float for goto if inline int long register"
)
C99 += " restrict return short signed sizeof static struct switch typedef union unsigned void volatile while"


def test_words_of_python_and_c_are_reserved() -> None:
    assert {word.lower() for word in keyword.kwlist} | set(C99.split()) <= RESERVED


def of_channels(*names: str) -> Program:
    """A lag of each channel while the first is on: with parts of formulas and states of all."""
    inputs = {n: Input(n, n, "temperature", "degC", -1e3, 1e3) for n in names}
    gate = law.Compare(">", law.Symbol("a"), law.ONE)
    terms = []
    for k, name in enumerate(names):
        drives = {
            "u": Drive("u", name, law.Symbol(name), True, "K"),
            "a": Drive("a", names[0], law.Symbol(names[0]), False, "1"),
        }
        tree = law.Binary("*", law.Lag(law.Symbol("u"), law.Number(600.0)), law.Binary("-", gate, law.Number(0.5)))
        terms.append(TermLaw(f"e{k}", "lag", "", "", drives, {}, (GainLaw("gain", 1.0, "um/K", tree),)))
    return build(Program("m", "dZ", "um", 1.0, Limits(1e6, 1e9)), terms, inputs, {})


@pytest.mark.parametrize(
    "names",
    [
        ("auto", "assert", "T"),
        ("tmp_1", "TMP_2", "T"),
        ("valid_T", "T", "held_T"),
        ("T", "valid_T", "bad_valid_T"),
        ("x1", "old_x1", "in_x2", "x3_lo", "x4"),
        ("ref_d_T", "T", "sum_d_T"),
    ],
)
def test_no_two_variables_have_one_name(names: tuple[str, ...]) -> None:
    for compensated in (False, True):
        body = make_body(of_channels(*names), compensated)
        variables = [v.name.lower() for v in body.variables]
        assert not [n for n, k in Counter(variables).items() if k > 1]
        assert RESERVED.isdisjoint(i.name for i in body.program.inputs)


def test_a_plain_name_stays() -> None:
    assert [i.name for i in program([driven("spindle_bearing")], 1.0).inputs] == ["temperature_0"]
    assert Names().take("tmp_front") == "tmp_front"
