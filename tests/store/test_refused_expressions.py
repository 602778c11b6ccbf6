"""Channels that derive from each other in many ways: each is looked at once, and a circle behind them is found."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from thermodata.errors import UsageError
from thermodata.store.tidy.plan import derive, refused

MANY = 40


def ladder(first: str | None) -> Any:
    """Channels that each derive from the two before: as many ways lead down as Fibonacci has rabbits."""
    texts = {"a0": first, "a1": None, **{f"a{k}": f"a{k - 1} + a{k - 2}" for k in range(2, MANY)}}
    return SimpleNamespace(channels={n: SimpleNamespace(derive=t) for n, t in texts.items()}, tests=())


def test_each_channel_is_looked_at_once_a_channel(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[str] = []
    names = derive.names

    def count(text: str) -> frozenset[str]:
        asked.append(text)
        return names(text)

    monkeypatch.setattr(derive, "names", count)
    refused.check_derived(ladder(None))
    assert len(asked) <= MANY * (MANY + 1)


@pytest.mark.parametrize("back", ["a39", "a20", "a2"])
def test_a_circle_behind_many_ways_is_found(back: str) -> None:
    with pytest.raises(UsageError, match="circle") as failed:
        refused.check_derived(ladder(f"{back} * 2"))
    assert failed.value.got is not None
    way = failed.value.got.split(" -> ")
    assert way[0] == way[-1]
    assert back in way
    assert "a0" in way
