"""A factor or a sign in a name, `dY x10 [um]` or `-dZ [um]`: asked, for values may have it or not."""

from __future__ import annotations

import re
from dataclasses import replace

from thermodata.draft.signals.quantity import Guess
from thermodata.reader.text import split_unit

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
    if factor not in (0.0, 1.0):
        unit = found.unit or "its unit"
        asked += (
            f' then unit: "{1 / factor:g} {unit}" takes it out; "{factor:g} {unit}" where it is still to be applied'
        )
    if turned:
        asked += " their sign is kept as it stands in the file"
    return replace(found, sure=False, questions=(*found.questions, asked))
