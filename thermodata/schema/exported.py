"""What the first columns of a CSV file of our own are called, by which it is known again."""

from __future__ import annotations

from collections.abc import Collection

TIME_UTC = "time_utc"  # times in UTC, which a table has to say
OF_TEST = ("campaign", "test", "t_s")  # beside the times: of no channel
UNSIGNED = " (sign unknown)"  # after the name of a displacement that nothing turned to the machine's axes


def is_own_export(columns: Collection[str]) -> bool:
    """Whether a table with these columns, beside its times, is one that `export` wrote. Names without units."""
    return set(OF_TEST) <= set(columns)
