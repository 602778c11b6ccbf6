"""The signs that stand in units: what keyboards and fonts write for one, and those that no unit has.

Pint leaves signs that it does not know out without a word: it takes 'µ"' (a micro-inch) and '?m' (a letter that was
lost) for um and m, and '1⁄min' for a minute.
"""

from __future__ import annotations

import re
import unicodedata
from functools import lru_cache

# full-width letters, and signs that hold a whole unit (㎜ ㎛ ㎾ ℓ): what keyboards of East Asia write
_WIDE = re.compile("[\uff01-\uff5e\u3351\u3371-\u33df\u2113\u2103\u2109]")
_LITRE = "\u3351"
# soft hyphens, marks of direction and of order, and what chooses a picture: nobody sees them
_UNSEEN = re.compile("[\u00ad\u200b-\u200f\u2060\ufe0e\ufe0f\ufeff]")
_ALIKE = str.maketrans(
    {
        **dict.fromkeys("º˚", "°"),
        "µ": "μ",
        "\u2206": "\u0394",  # a sign of mathematics, and the Greek letter
        **dict.fromkeys("−–‐‑", "-"),
        **dict.fromkeys("∙⋅•", "·"),
        "×": "*",
        **dict.fromkeys("⁄∕÷", "/"),
    }
)
_IN_BRACKETS = re.compile(r"[\[(]*([^\[\]()]*)[\])]*")
_IN_QUOTES = re.compile(r"[{<'\"“‘]([^{}<>'\"“”‘’]*\w)[}>'\"”’]")
_OF_UNITS = re.compile(r"[\w\s*/^.()\-·°%‰⁻]*")
_STUCK_SHARE = re.compile(r"[^\W\d_]\s*[%‰]|[%‰]\s*[^\W\d_]")  # 'm%' and '%m' are no product


@lru_cache(maxsize=4096)
def plain_letters(text: str) -> str:
    """A unit without full-width letters, signs that hold a whole unit and signs that nobody sees: '㎏f/㎠' is 'kgf/cm2'
    and 'ｒｐｍ' is 'rpm'."""
    return _WIDE.sub(lambda m: "l" if m[0] == _LITRE else unicodedata.normalize("NFKC", m[0]), _UNSEEN.sub("", text))


def plain_signs(text: str) -> str:
    """A unit in plain letters in which one sign stands for all that look like it: 'm∕s−1' -> 'm/s-1'."""
    return plain_letters(text).translate(_ALIKE)


def bare_unit(text: str) -> str:
    """A unit without blanks, without brackets or quotes around it and in plain letters: '[deg C]' -> 'degC'."""
    return unwrapped(re.sub(r"\s+", "", plain_signs(text)))


def unwrapped(text: str) -> str:
    """A text without brackets or quotes around all of it: '[degC]' and '<degC>' -> 'degC'."""
    for around in (_IN_BRACKETS, _IN_QUOTES):
        if found := around.fullmatch(text):
            text = found[1]
    return text


def may_be_unit(text: str) -> bool:
    """Whether a text holds no sign but those of units, and no share that is stuck to another unit."""
    return _OF_UNITS.fullmatch(text) is not None and _STUCK_SHARE.search(text) is None
