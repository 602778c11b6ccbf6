"""Milliseconds without the zeros in front, and decimals that only look so."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from thermodata.reader.text.times.one_cell.unpadded import unpadded_note


def _clock(of: Callable[[int], str], step: int) -> list[str]:
    return [f"2026-03-02 08:00:{k // 1000:02d}.{of(k % 1000)}" for k in range(0, 5000, step)]


@pytest.mark.parametrize("step", [50, 10, 40])
def test_milliseconds_without_their_zeros_are_told(step: int) -> None:
    assert "milliseconds without the zeros" in (unpadded_note(_clock(str, step)) or "")


@pytest.mark.parametrize(
    "of",
    [
        lambda ms: f"{ms:03d}",
        lambda ms: f"{ms:03d}000",
        lambda ms: f"{ms / 1000:.3f}"[2:].rstrip("0") or "0",
        lambda ms: f"{ms // 10:02d}",
        lambda ms: f"{ms // 100}",
    ],
)
def test_decimals_are_none(of: Callable[[int], str]) -> None:
    assert unpadded_note(_clock(of, 50)) is None


def test_times_without_fractions_are_none() -> None:
    assert unpadded_note([f"08:{m:02d}:00" for m in range(60)]) is None
