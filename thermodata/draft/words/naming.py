"""Names as words: humps, digits and diacritics apart, whatever the script; and plain letters for channel names."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Set

from anyascii import anyascii

from thermodata.schema.files.campaign import RESERVED_NAMES
from thermodata.schema.words.numbered import numbered

_LETTERS = str.maketrans(
    {
        "ß": "ss",
        "ẞ": "SS",
        "Ł": "L",
        "ł": "l",
        "Ø": "O",
        "ø": "o",
        "đ": "d",
        "Đ": "D",
        "Æ": "AE",
        "æ": "ae",
        "œ": "oe",
        "Œ": "OE",
        "ı": "i",
        "µ": "u",
        "μ": "u",
        "°": "",
        "℃": "degC",
    }
)
# 'Xload', 'S1rpm': an axis letter before a word, as MTConnect adapters write it; S is the spindle
_DELTA = re.compile(r"(?<![^\W\d_])[\u0394\u2206\u03b4](?=\s?[A-Za-z](?![a-z]))")  # before a letter: no Greek word
_MTCONNECT = re.compile(
    r"(?<![A-Za-z])([XYZABCS])(\d?)(abs|actm|actw|act|com|cmd|current|curr|cur|frt|load|motor|"
    r"mot|ovr|pos|rpm|speed|temperature|temp|torque|velocity|vel|axis|travel|position)(?![a-z])"
)
_PART = re.compile(r"(?:\([^()]*\)|\[[^\[\]]*\]|[^/])+")
# signs of China, kana, and the syllables of Hangul
_EASTERN = "\u2e80-\u9fff\uac00-\ud7a3"


def without_marks(text: str) -> str:
    """Without diacritics, but with signs of scripts that have no letters as they are."""
    bare = "".join(c for c in unicodedata.normalize("NFKD", text.translate(_LETTERS)) if not unicodedata.combining(c))
    return unicodedata.normalize("NFC", bare)  # or a syllable of Hangul would stay in pieces


def words(name: str) -> str:
    """'Eddy/nActSpeed_Z1' -> 'eddy n act speed z 1', '主轴T1' -> '主轴 t 1', 'ΔZ' -> 'delta z': no case, no diacritics,
    humps and digits apart."""
    bare = _MTCONNECT.sub(lambda m: f"{'spindle' if m[1] == 'S' else m[1]}{m[2]} {m[3]}", without_marks(name))
    bare = _DELTA.sub("delta ", bare)
    bare = re.sub(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", " ", bare)
    bare = re.sub(r"(?<=[^\W\d_])(?=\d)|(?<=\d)(?=[^\W\d_])", " ", bare)
    bare = re.sub(rf"(?<=[A-Za-z])(?=[{_EASTERN}])|(?<=[{_EASTERN}])(?=[A-Za-z])", " ", bare)
    return " ".join(re.split(r"[\W_]+", bare)).strip().lower()


def parts_of(name: str) -> list[str]:
    """A path of names part by part, at least one: 'Temp/T06' -> ['Temp', 'T06']. The stroke within brackets parts
    none: 'Table speed (dev/dk)' is one name."""
    return _PART.findall(name) or [name]


def plain(name: str) -> str:
    """Any text in the letters, digits and '_' of a channel name (not yet a legal one): transliterated, never dropped
    where it has a letter or a number in it."""
    out: list[str] = []
    for sign in without_marks(name):
        if sign.isascii():
            out.append(sign if sign.isalnum() else "_")
        elif sign.isalpha():
            out.append(_sound(sign))
        else:
            digit = unicodedata.digit(sign, None)
            out.append("_" if digit is None else str(digit))
    return re.sub(r"_+", "_", "".join(out)).strip("_")


def _sound(sign: str) -> str:
    """Of a letter that is not Latin; of Greek its name, for labs write 'theta'."""
    said = unicodedata.name(sign, "").split()
    if said[:1] == ["GREEK"]:
        return f"_{said[-1].lower()}_"
    sound = re.sub(r"[^A-Za-z0-9]", "", anyascii(sign))
    if sign.lower() != sign.upper():  # an alphabet: its letters make one word
        return sound
    return f"_{sound.lower()}_" if sound else "_" if said[-1:] == ["MARK"] else f"_u{ord(sign):x}_"


def channel_name(wanted: str, taken: Set[str]) -> str:
    """A legal name: `wanted`, or `wanted_2` where it is taken. taken: in lower case, for case tells no two apart."""
    base = plain(wanted) or "channel"
    base = (base if base[0].isalpha() else f"ch_{base}")[:60].rstrip("_")
    return numbered(base, lambda name: name.lower() in taken or name.lower() in RESERVED_NAMES, "_")
