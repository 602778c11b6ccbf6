"""A factor or a sign in a name, `dY x10 [um]` or `-dZ [um]`: asked, for values may have it or not."""

from __future__ import annotations

import re
from dataclasses import replace

from thermodata.draft.signals.quantity.guessed import Guess
from thermodata.reader.text import split_unit
from thermodata.schema.units.scale import with_power_of_ten

_SIGN = re.compile(r"^(?P<said>[-−–])\s*(?=[^\W\d_])")
_NUMBER = r"(?P<minus>[-−–]?)\s*(?P<number>\d+(?:[.,]\d+)?)"
_FACTOR = re.compile(rf"(?P<said>[*·]\s*\(?\s*{_NUMBER}\s*\)?|(?<=[\s_(])[x×]\s?(?P<ten>10+)\)?)$")
# 'dX_tenths_um', 'T_zehntel': what a count is of the unit, in words
_SHARES = (
    (10, r"tenths?|zehntel|dixi[eè]mes?|d[eé]cimas?|decim[io]|desetin[ay]?"),
    (100, r"hundredths?|hundertstel|centi[eè]mes?|cent[eé]simas?|centesim[io]|setin[ay]?"),
    (1000, r"thousandths?|tausendstel|milli[eè]mes?|mil[eé]simas?|millesim[io]|tisicin[ay]?"),
)
_IN_WORDS = re.compile(
    "|".join(rf"(?P<of_{n}>(?<![^\W_]){words}(?![^\W_]))" for n, words in ((n, f"(?:{w})") for n, w in _SHARES)),
    re.IGNORECASE,
)


def with_factor_asked(found: Guess, name: str) -> Guess:
    """With a question where the name says a factor or a sign. name: the last part of a signal's."""
    bare = split_unit(name)[0].strip()
    match = _FACTOR.search(bare) or _SIGN.match(bare)
    if found.quantity in (None, "state", "label"):
        return found
    if match is None:
        return _with_share_asked(found, bare)
    said = match.groupdict()
    number = (said.get("number") or said.get("ten") or "1").replace(",", ".")
    factor = float(number)
    turned = bool(said.get("minus")) or match.re is _SIGN
    asked = f"the name says '{match['said'].strip()}': is that in the values?"
    ways = [with_power_of_ten(f, found.unit or "?") for f in (1 / factor, factor)] if factor else [None, None]
    if all(ways):
        own = f", instead_of: {found.unit}" if found.unit else ""
        asked += f' then unit: "{ways[0]}"{own} takes it out; "{ways[1]}" where values still need it'
    elif factor != 1.0:
        asked += " values are read as they stand"
    if turned:
        asked += " their sign is kept as it stands in the file"
    return replace(found, sure=False, questions=(*found.questions, asked))


def _with_share_asked(found: Guess, bare: str) -> Guess:
    """The same where a word of the name says what one count is of the unit."""
    match = _IN_WORDS.search(bare)
    if match is None:
        return found
    number = float(str(match.lastgroup).removeprefix("of_"))
    way = with_power_of_ten(1 / number, found.unit or "?")
    own = f", instead_of: {found.unit}" if found.unit else ""
    asked = f"unit: the name says '{match[0]}': are the values counts of these? then unit: \"{way}\"{own}"
    return replace(found, sure=False, questions=(*found.questions, asked))
