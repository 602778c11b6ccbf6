"""A line of a campaign file as YAML reads it: where its comment begins, and its keys."""

from __future__ import annotations

import pytest
import yaml

from thermodata.draft.writing.in_line import parted, set_in_line

LINES = [
    "{id: a, notes: it's warm}",
    "{id: a, notes: 'it''s #1, {warm}'}",
    '{id: a, notes: "4\\" pipe # }, it\'s"}',
    "{id: a, notes: 5' and 4\", tools: ['it''s', \"b\"]}",
    "{id: a,'notes': don't, more: rock-'n'-roll}",
]


@pytest.mark.parametrize("body", LINES)
def test_a_comment_begins_where_yaml_has_it(body: str) -> None:
    line = f"  - {body}   # ? role: who knows it's that?"
    assert parted(line) == (f"  - {body}   ", "# ? role: who knows it's that?")


@pytest.mark.parametrize("body", LINES)
def test_a_key_is_set_beside_the_others(body: str) -> None:
    made = set_in_line(f"  - {body}   # ? role", "role", "none", ("tests", 0))
    assert made.endswith("   # ? role")
    assert yaml.safe_load(made) == [{**yaml.safe_load(body), "role": "none"}]
