"""Reader of tables: CSV, XLSX and Parquet."""

from __future__ import annotations
