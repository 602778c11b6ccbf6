"""What tests of several floors share."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from .chromium import Chromium, browser, find


@pytest.fixture(scope="session")
def chromium() -> Iterator[Chromium]:
    """A real browser; tests skip where there is none, and say so."""
    program = find()
    if program is None:
        pytest.skip("no Chromium: install one, or name it in THERMODATA_CHROMIUM")
    with browser(program) as made:
        yield made
