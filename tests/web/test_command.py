"""The command of a page is one that a shell takes, and that a person can read."""

from __future__ import annotations

import shlex
from pathlib import Path

import pytest

from thermodata.web.command import command
from thermodata.web.desk import DEFAULT_STORE


@pytest.mark.parametrize(
    ("query", "typed"),
    [
        ("select * from binned('c', 't', '60 s')", "\"select * from binned('c', 't', '60 s')\""),
        ("select\n  'a'", "\"select\n  'a'\""),
        ('select "dZ" from score', "'select \"dZ\" from score'"),
        ("select 'a' where x != 1", None),
        ("select '$HOME', '`ls`'", None),
        ("select '\\', \"'\"", None),
        ("select 1", "'select 1'"),
    ],
)
def test_a_query_is_quoted_as_a_person_would(query: str, typed: str | None) -> None:
    said = command(Path.cwd() / DEFAULT_STORE, "sql", query)
    assert shlex.split(said) == ["thermodata", "sql", query]
    assert typed is None or said == f"thermodata sql {typed}"
    if typed is None:
        assert said == shlex.join(["thermodata", "sql", query]), "nothing is left to the shell"
