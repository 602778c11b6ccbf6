"""Lines of a table that are no rows of it, and no loss: statistics over its columns, marks of its end."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

from thermodata.reader.text.cells.cell import Cell, is_empty, is_number
from thermodata.schema.words.sentences import with_dots

_STATISTIC = re.compile(
    r"(?i)(min|max)(imum|imal|\.)?([ -]?(value|wert))?|mean|average|avg|mittel(wert)?|mw|durchschnitt|median|"
    r"(std|sd|stdev|std[ ._-]?(dev|abw)(iation|eichung)?|standard[ -]?(deviation|abweichung))|rms|effektivwert|"
    r"(grenzwert|limit|alarm)[ -]?(verletzung(en)?|überschreitung(en)?|violations?|exceedances?|count)|"
    r"varian[cz]e?|sum|summe|total|gesamt|range|spann(e|weite)|peak[ -]?(to[ -]?)?peak|count|anzahl|"
    r"last([ -]?(value|reading))?|letzter?([ -]?wert)?|"
    r"(minim|maxim)(um|ální)|průměr|moyenne|écart[ -]type|minimo|máximo|massimo|media|promedio|"
    r"(最大|最小|平均|中央|合計|合计|总计)[値值]?|(標準|标准)偏?差|최대값?|최소값?|평균값?|합계"
)
_END = re.compile(
    r"(?i)\$rt_[a-z]+\$|[-=*# ]*(end|ende|eof|end of (file|data|record)|dateiende|konec( souboru)?|"
    r"fin( de fichier| del archivo)?)[-=*#. ]*"
)
_THOUSANDS = re.compile(r"(?<=\d)[ \u00a0\u202f'’](?=\d{3}(?!\d))")
_NOTED = 4


def is_footer(cells: Sequence[Cell]) -> bool:
    """Whether cells are those of a line of statistics ("Max", "", 24.1), or of a mark that the table ends
    ("$RT_COUNT$", 5965): beside the word stand numbers alone, no time and nothing that is damaged."""
    full = [str(c).strip() for c in cells if not is_empty(c)]
    if not full:
        return False
    first, others = full[0].rstrip(" :=."), full[1:]
    numbers = all(is_number(_THOUSANDS.sub("", c)) or not any(map(str.isalnum, c)) for c in others)
    return numbers and (_END.fullmatch(first) is not None or (bool(others) and _STATISTIC.fullmatch(first) is not None))


def footer_notes(lines: Iterable[Sequence[str]]) -> list[str]:
    """A note on the lines of these that are no rows and no loss. lines: the cells of each."""
    called = list(dict.fromkeys(next(c for c in cells if c.strip()).strip() for cells in lines if is_footer(cells)))
    if not called:
        return []
    shown = with_dots([f"'{name}'" for name in called], _NOTED)
    return [f"lines of statistics or of the end of the table are not read: {shown}"]
