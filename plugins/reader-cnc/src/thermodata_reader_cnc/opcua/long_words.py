"""What loggers and historians call the columns of a long table that hold the tag and the value."""

from __future__ import annotations

import re
from collections.abc import Sequence

from thermodata.reader.signals.header_words import NAME_WORDS, VALUE_WORDS
from thermodata.reader.text.cells.values.number import is_number
from thermodata.reader.text.cells.values.quotes import clean

VALUES = (
    *("tagval", "tagvalue", "varvalue", *VALUE_WORDS, "payload"),
    *("valeur", "valore", "valor", "waarde", "wartość", "值", "数值", "测量值", "數值", "値", "測定値", "計測値", "값"),
)
TAGS = (
    *NAME_WORDS,
    *("topic", "pointname", "channelname", "parametername", "variablename", "messstellenname", "signalbezeichnung"),
    *("repère", "étiquette", "grandeur", "voie", "etiqueta", "etichetta", "grandezza", "señal", "zmienna"),
    *(
        "标签",
        "标签名",
        "变量",
        "变量名",
        "位号",
        "点名",
        "测点",
        "信号",
        "信号名",
        "通道",
        "標籤",
        "タグ",
        "タグ名",
        "信号名称",
        "태그",
    ),
    "tagid",
)
# a database's columns of a value, one for each type; a row fills the one of its tag
TYPED = ("floatvalue", "doublevalue", "realvalue", "intvalue", "longvalue", "boolvalue", "stringvalue", "textvalue")
_NUMBER_AT_END = re.compile(r"\d{1,2}$")
_FEWEST = 2  # values of a row that come in pairs with their tags


def value_columns(names: Sequence[str]) -> tuple[int, ...]:
    """The column of values by its bare name, or the typed ones; () where there is none. Home Assistant has states of
    entities, which elsewhere are the machine's."""
    words = (*VALUES, "state") if "entityid" in names else VALUES
    found = next((names.index(n) for n in words if n in names), None)
    return tuple(names.index(n) for n in TYPED if n in names) if found is None else (found,)


def value_pairs(names: Sequence[str], rows: Sequence[Sequence[str]]) -> list[tuple[int, int]]:
    """(column of the tag, column of its value) of a row that holds several of them, by names that come again, numbered
    or not: 'kanal;wert;kanal;wert'. names: bare; rows: below them. Nothing where a row holds one."""
    stems = [_NUMBER_AT_END.sub("", n) for n in names]
    tags = [k for k, n in enumerate(stems) if n in TAGS]
    values = [k for k, n in enumerate(stems) if n in VALUES]
    if len(tags) != len(values) or len(tags) < _FEWEST or len({stems[k] for k in (*tags, *values)}) != _FEWEST:
        return []
    order = [k for pair in zip(tags, values, strict=True) for k in pair]
    turned = [k for pair in zip(values, tags, strict=True) for k in pair]
    if sorted(order) not in (order, turned):
        return []
    words = [clean(cells[k]) for cells in rows if len(cells) == len(names) for k in tags]
    return [] if not words or any(map(is_number, words)) else list(zip(tags, values, strict=True))


def bare(name: str) -> str:
    """A name without what names are written with: 'Tag Name', '_TAG_NAME'."""
    return re.sub(r"[\s_.#()-]", "", clean(name)).casefold()
