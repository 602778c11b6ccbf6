"""Readers: one log format each, found by entry point. See `thermodata.plugin` for their contract."""

from __future__ import annotations

from thermodata.reader.finding.registry import claims, failed_readers, head, reader, readers, sniff

__all__ = ["claims", "failed_readers", "head", "reader", "readers", "sniff"]
