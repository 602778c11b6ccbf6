"""What a signal is, where its draft could not tell: 'feed [m/min]' as one answer. A channel that stood there as a
comment comes to life with it; one whose quantity was a guess gets another."""

from __future__ import annotations

import re
from collections.abc import Sequence

from thermodata.draft.probes.which_way import CALIBRATION_ASKED
from thermodata.errors import UsageError, unknown_name
from thermodata.schema.units.conversion import converts, linear_conversion
from thermodata.schema.units.quantity import CANONICAL_UNIT, QUANTITIES

WHAT: tuple[str, ...] = tuple(f"{q} [{CANONICAL_UNIT[q]}]" for q in QUANTITIES if q != "label")
_LINE = re.compile(r"^  # (?P<name>[^:#]+): (?P<body>\{.*\bquantity: \?.*\})\s+# \? (?P<hint>.*)$")
_ANSWER = re.compile(r"^(?P<quantity>[a-z_ ]+?)\s*\[(?P<unit>[^\[\]{},]*)\]$")


def unread(lines: Sequence[str]) -> dict[str, tuple[int, str]]:
    """Name of a channel that is left out for want of its quantity -> (index of its line, what the draft says of it)."""
    found = ((i, _LINE.match(line)) for i, line in enumerate(lines))
    return {m["name"].strip(): (i, m["hint"]) for i, m in found if m}


def quantity_and_unit(answer: str, where: str) -> tuple[str, str]:
    """('feed', 'm/min') of 'feed [m/min]'. UsageError for another form, a quantity that there is not, or a unit that
    is none of it."""
    said = _ANSWER.match(answer.strip())
    if said is None:
        raise UsageError(
            "what a signal is has its unit in brackets",
            where=where,
            expected="feed [m/min]",
            got=answer,
            hint="a quantity as in the campaign files, then its unit: temperature [degC]",
        )
    quantity = said["quantity"].strip().replace(" ", "_")
    if quantity not in QUANTITIES:
        raise unknown_name("quantity", quantity, QUANTITIES)
    unit = said["unit"].strip() or CANONICAL_UNIT[quantity]
    if quantity != "displacement":  # a probe's volts become one by its calibration
        linear_conversion(unit, CANONICAL_UNIT[quantity])
    return quantity, unit


def come_to_life(line: str, answer: str) -> str:
    """A line that was left out, as one of the channels; its place is what is asked next, and of a displacement its axis
    and, where it is no length, what turns it into one."""
    found = _LINE.match(line)
    assert found is not None
    quantity, unit = quantity_and_unit(answer, found["name"].strip())
    asked = [f"at: where on the machine? ({found['hint'].strip()})"]
    if quantity == "displacement":
        asked = ["axis?", *([] if converts(unit, "um") else [CALIBRATION_ASKED]), *asked]
    return f"  {found['name']}: {found['body']}   # ? {', '.join(asked)}"
