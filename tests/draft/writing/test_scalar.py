"""Any text comes out of a campaign file as it went in, and what can be seen is seen."""

from __future__ import annotations

import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from thermodata.draft.writing.write import scalar


@settings(max_examples=300, deadline=None)
@given(st.text(st.characters(exclude_categories=["Cs"]), min_size=1))
def test_a_text_is_the_same_in_yaml(text: str) -> None:
    assert str(yaml.safe_load(f"{{a: {scalar(text)}}}")["a"]) == text


@pytest.mark.parametrize(
    ("text", "written"),
    [
        ("Température d'huile\xa0[°C]", '"Température d\'huile\\u00a0[°C]"'),
        ("𠮷野\x85😀", '"𠮷野\\u0085😀"'),
        ("\U000f0000 of an own font", '"\\U000f0000 of an own font"'),
    ],
)
def test_only_what_nobody_sees_is_escaped(text: str, written: str) -> None:
    assert scalar(text) == written
