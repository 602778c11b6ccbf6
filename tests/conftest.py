"""What tests of several floors share."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from .chromium import Chromium, find
from .commands import Said, Say


@pytest.fixture
def say(capsys: pytest.CaptureFixture[str]) -> Say:
    """Runs a command in this process."""
    from thermodata.cli import main  # the lower floors are tested without the commands

    def run(*words: object) -> Said:
        capsys.readouterr()
        code = main([str(w) for w in words])
        out, err = capsys.readouterr()
        return Said(code, out, err)

    return run


@pytest.fixture(scope="session")
def browsers() -> Iterator[list[Chromium]]:
    """The browser of this run, the last of them where one ended."""
    made: list[Chromium] = []
    yield made
    for one in made:
        one.close()


@pytest.fixture
def chromium(browsers: list[Chromium]) -> Chromium:
    """A real browser; tests skip where there is none, and say so."""
    program = find()
    if program is None:
        pytest.skip("no Chromium: install one, or name it in THERMODATA_CHROMIUM")
    if not browsers or browsers[-1].ended:
        browsers.append(Chromium(program))
    return browsers[-1]
