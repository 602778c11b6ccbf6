"""Lines between the names and the data that are part of neither: noted; rows of factors and offsets are asked, for the
values may have them or not."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

from thermodata.errors import QuestionError
from thermodata.reader.text.cells.values.number import of_either_mark
from thermodata.reader.text.names.header_rows import rows_between, texts_of
from thermodata.reader.text.page.header.head import Head
from thermodata.schema.units.scale import with_power_of_ten

_FACTOR = re.compile(
    r"(?i)(?:(?P<factor>fa[kc]tors?|faktoren|scal(?:e|ing)(?: factor)?|skalierung(?:sfaktor)?|gain|multiplier|slope|"
    r"verstärkung|facteur|fattore|násobek|měřítko)|offset|nullpunkt|zero)[ :=]*"
)
_SHOWN, _MOST = 60, 3


def lines_between(head: Head, names: Sequence[str], units: Sequence[str | None]) -> list[str]:
    """A note for such lines. names, units: of the columns. Nothing is asked where no separator is
    known (whose file it is does not hang on that).

    QuestionError where one says a factor other than 1, or an offset other than 0.
    """
    odd = rows_between(head.above, head.width)
    texts = {i: texts_of(head.above[i]) for i in odd}
    scaled = {i: cells for i, cells in texts.items() if _scales(cells)}
    if scaled and head.between is not None:
        raise _question(scaled, head, names, units)
    if not odd:
        return []
    first = odd[0]
    quoted = " ".join(filter(None, texts[first]))[:_SHOWN]
    return [f"line {head.line(first)} between header and data is not read ({len(odd)} such): '{quoted}'"]


def _numbers(cells: Sequence[str]) -> list[float | None]:
    """The numbers behind the first cell; None where there is none."""
    return [of_either_mark(c) if c else None for c in cells[1:]]


def _scales(cells: Sequence[str]) -> bool:
    """Whether a row says factors or offsets that change values."""
    match = _FACTOR.fullmatch(cells[0].strip()) if cells else None
    nothing = 1.0 if match is not None and match["factor"] else 0.0
    return match is not None and any(n is not None and n != nothing for n in _numbers(cells))


def _question(
    scaled: Mapping[int, Sequence[str]], head: Head, names: Sequence[str], units: Sequence[str | None]
) -> QuestionError:
    header = len(head.above)
    lines = ", ".join(f"line {head.line(i)} '{' '.join(filter(None, row))[:_SHOWN]}'" for i, row in scaled.items())
    proposed, factors = list[str](), False
    for row in scaled.values():
        match = _FACTOR.fullmatch(row[0].strip())
        of_units = zip(names[1:], units[1:], _numbers(row), strict=False) if match and match["factor"] else ()
        for name, unit, number in of_units:
            if number is None or number == 1.0:
                continue
            own = with_power_of_ten(number, unit or "?")
            factors |= own is None
            if own is not None:
                proposed.append(f'{name}: unit: "{own}"' + (f", instead_of: {unit}" if unit else ""))
        factors |= not of_units
    if factors or len(proposed) > _MOST:
        proposed = [*proposed[:_MOST], "an export that has them, or, of a displacement, a calibration of kind scale"]
    how = "; ".join(proposed)
    said = {"header_rows": header}
    return QuestionError(
        "factors or offsets between header and data, which values may have or not",
        where=head.where,
        expected="values as they count, or factors that are declared",
        got=lines,
        hint=f"declare table: {{header_rows: {header}}} to read the values as they stand; where they are still to be "
        f"scaled: {how}",
        ask=f"header_rows: do the values count as they stand? {lines} is not applied; else: {how}",
        declare=said,
        meanwhile=said,
    )
