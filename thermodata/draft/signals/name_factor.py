"""A factor or a sign in a name, `dY x10 [um]` or `-dZ [um]`: asked, for values may have it or not."""

from __future__ import annotations

import re
from dataclasses import replace

from thermodata.draft.signals.quantity import Guess
from thermodata.reader.text import split_unit
from thermodata.schema.units.scale import with_power_of_ten

_SIGN = re.compile(r"^(?P<said>[-−–])\s*(?=[^\W\d_])")
_NUMBER = r"(?P<minus>[-−–]?)\s*(?P<number>\d+(?:[.,]\d+)?)"
_FACTOR = re.compile(rf"(?P<said>[*·]\s*\(?\s*{_NUMBER}\s*\)?|(?<=[\s_(])[x×]\s?(?P<ten>10+)\)?)$")


def with_factor_asked(found: Guess, name: str) -> Guess:
    """With a question where the name says a factor or a sign. name: the last part of a signal's."""
    bare = split_unit(name)[0].strip()
    match = _FACTOR.search(bare) or _SIGN.match(bare)
    if match is None or found.quantity in (None, "state", "label"):
        return found
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
