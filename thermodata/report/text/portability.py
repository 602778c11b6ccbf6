"""How a model carries over to tests, as a terminal has it: which of them it was fitted to is said of each."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import Any

from thermodata.report.text.table import prose, table
from thermodata.report.words.numbers import base_role

_FITTED = "fitted: the model was fitted to the test, so what it does there says nothing of how it carries over"


def portability_text(rows: Sequence[Mapping[str, Any]], campaigns: Collection[str]) -> str:
    """rows: as `Portability.to_json` gives them. campaigns: of the model, whose calibration tests it was fitted to."""
    several = len({row["response"] for row in rows}) > 1
    shown = [
        {
            **row,
            "role": base_role(str(row["role"])),
            "fitted": "yes" if _is_fitted(row, campaigns) else "no",
            "verdict": "not asked" if row["verdict"] == "x" else row["verdict"],
        }
        for row in rows
    ]
    told = table(
        shown,
        [
            ("campaign", "campaign"),
            ("test", "test"),
            *([("response", "response")] if several else []),
            ("machine", "machine"),
            ("role", "role"),
            ("fitted", "fitted"),
            ("g", "g"),
            ("g_end", "g at end of heating"),
            ("fit_n", "FIT n [%]"),
            ("fit_c", "FIT c [%]"),
            ("ptp_measured", "PTP measured [um]"),
            ("ptp_n", "PTP n [um]"),
            ("ptp_c", "PTP c [um]"),
            ("verdict", "class"),
            ("why", "not asked, for"),
        ],
    )
    return f"{told}\n\n{prose(_FITTED)}" if any(row["fitted"] == "yes" for row in shown) else told


def _is_fitted(row: Mapping[str, Any], campaigns: Collection[str]) -> bool:
    """Roles of another campaign are its own: the model was fitted to none of its tests."""
    role = str(row["role"])
    return row["campaign"] in campaigns and (role == "calibration" or base_role(role) != role)
