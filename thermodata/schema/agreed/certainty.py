"""What '95 %' means in every number and every picture."""

from __future__ import annotations

Z95 = 1.96
"""Half of an interval of 95 %, in standard deviations."""
