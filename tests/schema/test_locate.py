"""What only the data show is wrong is told at its line: by the key that it is said of, or by the refused word."""

from __future__ import annotations

from pathlib import Path

import pytest

from thermodata.errors import UsageError
from thermodata.schema.files.locate import located

TEXT = """schema: thermodata/model/1
name: m
campaign: c
response: {axis: X, at: tcp}
locked: [a]
effects:
  - {effect: lag, drivers: {u: T_x}}
"""


@pytest.mark.parametrize(
    ("where", "got", "line"),
    [
        ("response, campaign c", None, "m.yaml:4 (response), campaign c"),
        ("locked, model 'm'", "verify_on and locked", "m.yaml:5 (locked), model 'm'"),
        ("effect 'lag', campaign c", "T_x", "m.yaml:7 (effects[0].drivers.u), effect 'lag', campaign c"),
        ("effect 'lag', campaign c", "u: T_a; u: T_b", "m.yaml:7 (effects[0]), effect 'lag', campaign c"),
        ("expression 'T_x'", "rpm", "m.yaml:7 (effects[0].drivers.u), expression 'T_x'"),
        ("verify_on, model 'm'", None, "verify_on, model 'm'"),
    ],
)
def test_by_its_key_or_by_its_word(tmp_path: Path, where: str, got: str | None, line: str) -> None:
    path = tmp_path / "m.yaml"
    path.write_text(TEXT)
    assert located(UsageError("wrong", where=where, got=got), path).where == line
