"""What a calibration gave: one frozen row, the same columns as the catalogue's table `calibration`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

Sign = Literal["+", "-", "unknown"]
Check = dict[str, Any]
_SAME_NAME = (
    "kind",
    "axis",
    "gain",
    "gain_unit",
    "sign",
    "uncertainty_pct",
    "noise_um",
    "nonlinearity_pct",
    "drift_um",
    "crosstalk",
    "checks",
    "detail",
)


@dataclass(frozen=True, slots=True)
class CalibrationResult:
    """value [unit_out] = gain * reading [unit_in] + offset, with gain_unit = "unit_out/unit_in" (or "1").

    sign: of the gain, "+" where the reading rises as the tool centre point moves along the + axis relative to
    the table; "unknown" where nothing says so. uncertainty_pct: standard (k = 1) uncertainty of the gain [%].
    noise_um: of one reading within a plateau [um]. nonlinearity_pct: largest departure of a plateau from the
    line, of the span [%]. drift_um: over the whole jump test [um]. crosstalk: other probe -> its answer to the
    move, of this one's [%]. None: does not apply or cannot be told from this test.
    checks: rows of name, value, threshold, passed, advice. detail: unit_in, unit_out, plateaus and more.
    """

    name: str
    kind: str
    axis: str | None = None
    gain: float = 1.0
    gain_unit: str = "1"
    offset: float = 0.0
    sign: Sign = "unknown"
    uncertainty_pct: float | None = None
    noise_um: float | None = None
    nonlinearity_pct: float | None = None
    drift_um: float | None = None
    crosstalk: dict[str, float] = field(default_factory=dict)
    checks: list[Check] = field(default_factory=list)
    detail: dict[str, Any] = field(default_factory=dict)

    @property
    def unit_in(self) -> str:
        """Unit of the reading; "" where the calibration takes whatever unit the channel has."""
        return str(self.detail.get("unit_in", ""))

    @property
    def unit_out(self) -> str:
        """Unit of the value; "" where it is the reading's."""
        return str(self.detail.get("unit_out", ""))

    @property
    def passed(self) -> bool:
        """Whether every check passed."""
        return all(bool(c["passed"]) for c in self.checks)

    def row(self, campaign: str) -> dict[str, Any]:
        """The row of table `calibration`; crosstalk, checks and detail are plain data, to be stored as JSON: an advice
        that there is none of is null there."""
        # here, for the keys of tidy files hold the checks as they are
        return {
            "campaign": campaign,
            "calibration": self.name,
            "offset_value": self.offset,
            **{k: getattr(self, k) for k in _SAME_NAME},
            "checks": [row | {"advice": row["advice"] or None} for row in self.checks],
        }

    @classmethod
    def from_row(cls, row: Mapping[str, Any]) -> CalibrationResult:
        """The reverse of `row` (JSON columns already decoded)."""
        offset = row["offset_value"]
        known = {k: row[k] for k in _SAME_NAME} | {"checks": [c | {"advice": c["advice"] or ""} for c in row["checks"]]}
        return cls(name=row["calibration"], offset=0.0 if offset is None else offset, **known)


def check(name: str, value: float | None, threshold: float | None, passed: bool, advice: str) -> Check:
    """One row of a calibration's checks; advice is empty where there is nothing to do."""
    return {
        "name": name,
        "value": None if value is None else float(value),
        "threshold": None if threshold is None else float(threshold),
        "passed": bool(passed),
        "advice": "" if passed else advice,
    }
