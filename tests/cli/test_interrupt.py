"""Ctrl-C within a computation of a library."""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from thermodata.errors import StoreError
from thermodata.store.base import connection

from .conftest import Said

LONG = "select count(*) from range(100000) a, range(100000) b"  # many seconds


@pytest.fixture
def pressed() -> Iterator[threading.Timer]:
    """Ctrl-C after a second."""
    if signal.getsignal(signal.SIGINT) is not signal.default_int_handler:
        pytest.skip("started in the background of a shell, where Ctrl-C is ignored")
    timer = threading.Timer(1.0, lambda: os.kill(os.getpid(), signal.SIGINT))
    timer.start()
    yield timer
    timer.cancel()


def test_a_query_is_interrupted(say: Callable[..., Said], campaign: Path, pressed: threading.Timer) -> None:
    said = say("--store", campaign / "thermodata.store", "sql", LONG)
    assert (said.code, said.err.strip()) == (1, "error: interrupted")
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_an_interrupted_opening_is_no_damage(
    say: Callable[..., Said], campaign: Path, pressed: threading.Timer, monkeypatch: pytest.MonkeyPatch
) -> None:
    def opened(*_: object) -> None:
        con = connection.memory(campaign)
        try:
            con.execute(LONG)
        except Exception as error:
            raise StoreError("the catalogue is damaged") from error
        finally:
            con.close()

    monkeypatch.setattr("thermodata.store.Store._copy_into", opened)
    said = say("--store", campaign / "thermodata.store", "tests")
    assert (said.code, said.err.strip()) == (1, "error: interrupted")
