"""A model's results as one self-contained HTML page."""

from __future__ import annotations

from typing import TYPE_CHECKING

from thermodata.lazy import on_demand

if TYPE_CHECKING:
    from thermodata.report.page.page import build_report

__all__ = ["build_report"]
__getattr__ = on_demand(__name__, {"page.page": "build_report"})
