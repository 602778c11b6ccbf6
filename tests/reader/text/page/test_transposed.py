"""A table whose rows are signals is told to be transposed: no declaration reads it."""

from __future__ import annotations

from pathlib import Path

import pytest

from thermodata.errors import FormatError
from thermodata.plugin import Source
from thermodata.reader.text import delimited
from thermodata.reader.text.clocks.transposed import ADVICE


def lines(named: bool, rising: bool = True) -> str:
    rows = [[str(10 * k if rising else k % 7) for k in range(300)]]
    rows += [[f"{n + (k % 9) / 7:.3f}" for k in range(300)] for n in (5, 21, 22)]
    names = ("time [s]", "Z [um]", "T bed", "T hall")
    return "\n".join(";".join([*([name] if named else []), *row]) for name, row in zip(names, rows, strict=True)) + "\n"


@pytest.mark.parametrize(("named", "rising", "told"), [(True, True, True), (False, True, True), (False, False, False)])
def test_rows_that_are_signals_are_told(tmp_path: Path, named: bool, rising: bool, told: bool) -> None:
    (tmp_path / "q.csv").write_text(lines(named, rising))
    with pytest.raises(FormatError) as caught:
        delimited.open_table(tmp_path / "q.csv", Source())
    hint = str(caught.value.hint)
    assert (hint == ADVICE or (named and hint.startswith("turn it round: "))) is told
