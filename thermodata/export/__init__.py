"""Taking measurements away in other programs' formats."""

from __future__ import annotations

from thermodata.export.table import Exported, export_test

__all__ = ["Exported", "export_test"]
