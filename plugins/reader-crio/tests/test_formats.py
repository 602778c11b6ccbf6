"""The reader's formats: each claims its own example, and no other does."""

from __future__ import annotations

import pytest
from thermodata_reader_crio import Reader
from thermodata_reader_crio.formats import FORMATS

from thermodata.plugin import Head


@pytest.mark.parametrize("name", FORMATS)
def test_a_format_claims_its_own_example_and_no_other(name: str) -> None:
    example = Reader().heads[name]
    claimed = [n for n, form in FORMATS.items() if form.claims(Head("x.dat", len(example), example))]
    assert claimed == [name]
