"""The moment, as the catalogue keeps it."""

from __future__ import annotations

from datetime import UTC, datetime


def utc_now() -> datetime:
    """UTC, without a zone: columns of the catalogue have none."""
    return datetime.now(UTC).replace(tzinfo=None)
