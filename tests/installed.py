"""What is installed, looked at anew: a process looks once."""

from __future__ import annotations

from thermodata.reader.finding import registry


def look_at_readers_again() -> None:
    registry._readers_and_failures.cache_clear()
    registry._versions.cache_clear()
    registry._told.clear()
