"""A column whose name is a word of SQL: what a query that fails over it is told to write."""

from __future__ import annotations

import pytest

from thermodata.errors import UsageError
from thermodata.store import Store
from thermodata.view import StoreView
from thermodata.view.query.reserved import reserved_hint


@pytest.mark.parametrize(
    ("query", "told"),
    [
        ("select at from channel", True),
        ("select channel, AT from channel", True),
        ('select "at" form channel', False),
        ("select 'at' form channel", False),
        ("select attribute form channel", False),
    ],
)
def test_only_the_bare_word_is_told(query: str, told: bool) -> None:
    assert (reserved_hint(query) is not None) is told


def test_a_query_that_fails_over_it_says_how_it_is_written(empty_store: Store) -> None:
    view = StoreView(empty_store)
    with pytest.raises(UsageError) as caught:
        view.sql("select at from channel")
    assert caught.value.hint == 'the column at is a word of SQL too: write "at"'
    view.sql('select "at" from channel')
    with pytest.raises(UsageError) as caught:
        view.sql("selec channel from channel")
    assert caught.value.hint is None
