"""By what a file of our own is known again: the first columns of a CSV file, and what a workbook, a MAT or a Parquet
file says of its channels."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping

TIME_UTC = "time_utc"  # times in UTC, which a table has to say
OF_TEST = ("campaign", "test", "t_s")  # beside the times: of no channel
PLAIN = " [1]"  # after the name of what has no unit
_ABOUT = {"quantity", "unit", "sign"}  # of a channel, in the table of a workbook
SIGN = "thermodata.sign"  # what the metadata of a Parquet column say of its sign, as the table `channel` does
_COMMENT = re.compile(rf"{re.escape(SIGN)}: (\+|-|unknown)(?:,|$)")  # begins what an MDF channel says of itself
UNSIGNED = " (sign unknown)"  # after the name of a displacement that nothing turned to the machine's axes


def is_own_export(columns: Collection[str]) -> bool:
    """Whether a table with these columns, beside its times, is one that `export` wrote. Names without units."""
    return set(OF_TEST) <= set(columns)


def is_own_about(row: Collection[str]) -> bool:
    """Whether these are the heads of the table that says in a workbook of ours what its channels are."""
    return set(row) >= {"channel", *_ABOUT}


def sign_key(name: str) -> str:
    """The property of a signal that has its sign: where a MAT file of ours says it, and under which a workbook's
    does."""
    return f"channels/{name.rpartition('/')[2]}/sign"


def own_sign(name: str, properties: Mapping[str, object]) -> str | None:
    """The sign that an export says of a channel: + or - where it goes along the machine's axis in the file, unknown
    where nobody knew; None where it says none."""
    if commented := _COMMENT.match(str(properties.get("comment", ""))):
        return commented[1]
    key = sign_key(name)
    found = (str(v) for k, v in properties.items() if k in (key, SIGN) or k.endswith(f"/{key}"))
    return next(found, None)
