"""Quality columns of wide tables (`T1`, `T1.Quality`): rows that the source calls bad are flagged, values kept."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

import numpy as np

from thermodata.plugin import Array, Block
from thermodata_reader_cnc.columns import Column
from thermodata_reader_cnc.status import BAD, is_good, zero_is_good

_QUALITY = re.compile(
    r"^(?P<base>.+?)[ ._:/-]*(?:quality|qualit[äa]t|tagquality|status ?code|validity)$", re.IGNORECASE
)
_CODE = re.compile(r"^[+-]?\d*$")
_ROUND = re.compile(r"^quality ?\((?P<base>.+)\)$", re.IGNORECASE)
_VALUE = re.compile(r"[ ._:/-]*(?:value|wert)$", re.IGNORECASE)


def pairs(columns: Sequence[Column], rows: Sequence[Sequence[str]]) -> dict[str, tuple[str, bool]]:
    """Value column -> (its quality column, whether its code 0 is good), by names and sampled rows."""
    names = {column.name.casefold(): column for column in columns}
    found: dict[str, tuple[str, bool]] = {}
    for column in columns:
        match = _QUALITY.match(column.name) or _ROUND.match(column.name)
        if match is None:
            continue
        base = match["base"].casefold()
        for other in columns:
            if (
                other is not column
                and _VALUE.sub("", other.name).casefold() == base
                and base in (other.name.casefold(), _VALUE.sub("", other.name).casefold())
            ):
                zero = zero_is_good((row[column.place] for row in rows), column.name)
                found[other.name] = column.name, zero
                break
    return {name: said for name, said in found.items() if name.casefold() in names}


def words(columns: Sequence[Column], rows: Sequence[Sequence[str]], found: Mapping[str, tuple[str, bool]]) -> set[str]:
    """The quality columns that hold words or hexadecimal codes: text, however few these are."""
    told = {column for column, _ in found.values()}
    return {
        c.name
        for c in columns
        if c.name in told and any(not _CODE.match(row[c.place].strip().strip('"')) for row in rows)
    }


def flagged(block: Block, found: Mapping[str, tuple[str, bool]]) -> Block:
    """The block with the rows of bad quality flagged."""
    flags: dict[str, Array] = dict(block.flags or {})
    for name, (column, zero) in found.items():
        words, which = np.unique(_texts(block.values[column]), return_inverse=True)
        bad = np.array([not is_good(str(word), zero) for word in words], bool)[which]
        if bad.any():
            flags[name] = flags.get(name, np.zeros(bad.size, np.uint16)) | (bad * np.uint16(BAD))
    return Block(block.stream, block.t_ns, block.values, flags or None)


def _texts(values: Array) -> Array:
    if values.dtype.kind == "f":
        return np.where(np.isnan(values), "", np.char.mod("%d", np.nan_to_num(values)))
    return np.array(["" if v is None else str(v) for v in values.tolist()], str)
