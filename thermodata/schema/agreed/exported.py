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
_FLAG, _FLAGS = ".flag", "flags"  # of the flags of a channel: behind its name, and in a MAT file the struct of theirs


def is_own_export(columns: Collection[str]) -> bool:
    """Whether a table with these columns, beside its times, is one that `export` wrote. Names without units."""
    return set(OF_TEST) <= set(columns)


def is_own_about(row: Collection[str]) -> bool:
    """Whether these are the heads of the table that says in a workbook of ours what its channels are."""
    return set(row) >= {"channel", *_ABOUT}


def said_key(name: str, key: str) -> str:
    """The property of a signal under which a MAT file of ours, and the table of a workbook of ours, says it."""
    return f"channels/{name.rpartition('/')[2]}/{key}"


def own_channel(name: str) -> str:
    """The channel that a signal of an export is, whose name stands behind the one of its stream. Without its unit."""
    return name.rpartition("/")[2].removesuffix(PLAIN).replace(UNSIGNED, "")


def flags_of(name: str) -> str | None:
    """The signal of an export whose flags a signal of it holds; None where it holds none."""
    if name.endswith(_FLAG):
        return name.removesuffix(_FLAG)
    *above, last = name.split("/")
    return "/".join([*above[:-1], last]) if above[-1:] == [_FLAGS] else None


def is_own(name: str, properties: Mapping[str, object]) -> bool:
    """Whether an export says of a signal which channel it is."""
    return own_sign(name, properties) is not None or own_says(name, "quantity", properties) is not None


def own_says(name: str, key: str, properties: Mapping[str, object]) -> str | None:
    """What a MAT file of ours, or the table of a workbook of ours, says of a signal, under a key of the table
    `channel`; None where it says nothing."""
    wanted = said_key(name, key)
    return next((str(v) for k, v in properties.items() if k == wanted or k.endswith(f"/{wanted}")), None)


def own_sign(name: str, properties: Mapping[str, object]) -> str | None:
    """The sign that an export says of a channel: + or - where it goes along the machine's axis in the file, unknown
    where nobody knew; None where it says none."""
    if commented := _COMMENT.match(str(properties.get("comment", ""))):
        return commented[1]
    return str(properties[SIGN]) if SIGN in properties else own_says(name, "sign", properties)
