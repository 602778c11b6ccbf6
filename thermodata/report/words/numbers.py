"""Figures in words, the same in the terminal and on the page."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING, Any

from thermodata.schema.words.sentences import listed, with_count

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Mapping

    from thermodata.schema.answers.missing_heat import HeatCompanion, MissingHeat
    from thermodata.schema.answers.result import Score

COMPANIONS = 8  # most channels that are named beside a missing heat
_HOURS_FROM_S = 5400
_SMALLEST = 1e-10  # probability that is told as a number
_TO_COPY = re.compile(r"(\{(?:[^{}]|\{[^{}]*\})*\})")  # a line of a file, in braces, which may hold braces


def number(value: Any, digits: int = 3) -> str:
    """`digits` significant figures, no exponent between 1e-4 and 1e7; '-' for none."""
    if value is None:
        return "-"
    if isinstance(value, bool) or not isinstance(value, int | float):
        return str(value)
    if isinstance(value, int):
        return str(value)
    if math.isnan(value):
        return "-"
    if value == 0 or math.isinf(value):
        return f"{value:g}"
    size = math.floor(math.log10(abs(value)))
    if not -4 <= size < 7:
        return f"{value:.{digits - 1}e}"
    return f"{value:.{max(0, digits - 1 - size)}f}"


def quantity(value: float, unit: str) -> str:
    """'8.59 um', and '1.43' of what has no unit: '1.43 1' would be two numbers."""
    return number(value) if unit in ("", "1") else f"{number(value)} {unit}"


def in_unit(text: str, unit: str | None) -> str:
    """A text that says um, in the unit of the response that it is of (None: um): a model may be one of temperatures."""
    return text if unit in (None, "um") else re.sub(r"(?<=\d )um\b", str(unit), text)


def in_units(text: str, units: Mapping[str, str]) -> str:
    """A text with tables that says um, in the units of its responses. Of responses in several units each row is in its
    own, and a line below says which."""
    each = set(units.values())
    # headings keep their width, or the columns below would not stand under them
    if len(each) > 1:
        told = ", ".join(f"{name} [{unit}]" for name, unit in units.items())
        return f"{text.replace('[um]', ' [*]')}\n\n[*] in the unit of the row's response: {told}"
    if not each or "um" in each:
        return text
    unit = each.pop()
    return in_unit(text.replace("[um]", f"[{unit}]".ljust(4)), unit)


def typeset(text: str) -> str:
    """A terminal's text as a page shows it: 'um' as 'µm', 'degC' as '°C', '->' as an arrow, hyphens before digits as
    minus, and a dash where there is none; but for lines in braces, which are copied into a file."""
    if text == "-":
        return "–"
    return "".join(part if i % 2 else _typeset(part) for i, part in enumerate(_TO_COPY.split(text)))


def _typeset(text: str) -> str:
    text = re.sub(r"\bdegC\b", "°C", re.sub(r"\bum\b", "µm", text)).replace("->", "→")
    text = re.sub(r"(?<=\d) (?=%|µm|rpm)", "\u00a0", text)  # a number stays with its unit
    return re.sub(r"(?<![\w.])-(?=\d)", "−", text)


def correlation_text(r: float) -> str:
    """'+0.42', '-0.07'; '0.00' of what is nothing, which has no sign."""
    text = f"{r:+.2f}"
    return text[1:] if float(text) == 0.0 else text


def probability_text(p: float) -> str:
    """'p 0.031'; of one too small for a number 'p below 1e-10': no test of samples says that it is 0."""
    return f"p {p:.2g}" if p >= _SMALLEST else f"p below {_SMALLEST:.0e}"


def time_unit(longest_s: float) -> tuple[float, str]:
    """(seconds, name) of the unit that an axis of times has best that ends there, as `duration` tells them: (60, 'min')
    below 1.5 h, else (3600, 'h')."""
    return (3600.0, "h") if longest_s >= _HOURS_FROM_S else (60.0, "min")


def duration(seconds: float | None) -> str:
    """'14.0 h', '25 min', '8 s'."""
    if seconds is None or math.isnan(seconds):
        return "-"
    if abs(seconds) >= _HOURS_FROM_S:
        return f"{seconds / 3600:.1f} h"
    return f"{seconds / 60:.0f} min" if abs(seconds) >= 120 else f"{seconds:.3g} s"


def clock(seconds: float) -> str:
    """'0:25:00', hours, minutes and seconds from the start of a test: stretches of minutes are told apart by it."""
    whole = round(seconds)
    sign, whole = ("-" if whole < 0 else "", abs(whole))
    return f"{sign}{whole // 3600}:{whole // 60 % 60:02d}:{whole % 60:02d}"


def change(before: float | None, after: float | None) -> str:
    """'-62 %', '0 %' for less than half of one; '-' where either is missing. A fall to under 1 % has two digits of what
    is left: '-99.54 %'; a rise to MANY_TIMES and more is told as times: 'x 229'."""
    if not before or after is None:
        return "-"
    left = after / before
    if left >= MANY_TIMES:
        return f"x {number(left)}"
    digits = 1 - math.floor(math.log10(100 * left)) if 0 < left < ALL_BUT else 0
    changed = round(100 * (left - 1), digits)
    return f"{changed:+.{digits}f} %" if changed else "0 %"


MANY_TIMES = 10.0
ALL_BUT = 0.01  # of an error: a fall to less is not told as one by all of it
MOST_NAMED = 6  # tests; more are counted
LITTLE = 0.05  # of a squared error: what makes less is not named


def base_role(role: str) -> str:
    """'verification (in-sample)' -> 'verification': the role that the campaign gave a test."""
    return role.partition(" ")[0]


def in_sample(scores: Iterable[Score]) -> set[tuple[str, str]]:
    """(campaign, test) of those that were fitted though they are no calibration tests."""
    return {(s.campaign, s.test) for s in scores if s.role != base_role(s.role)}


def pooled(scores: Iterable[Score], *roles: str, responses: Collection[str]) -> float | None:
    """Root mean square over whole tests of these roles (none named: all), each sample counted once. responses: in one
    unit, which it is in."""
    rows = [
        s
        for s in scores
        if s.phase == "all"
        and s.rmse_um is not None
        and s.response in responses
        and (not roles or base_role(s.role) in roles)
    ]
    n = sum(s.n for s in rows)
    return math.sqrt(sum(s.n * (s.rmse_um or 0.0) ** 2 for s in rows) / n) if n else None


def heat_lines(heat: MissingHeat) -> list[tuple[str, str]]:
    """What is told of an estimated missing heat beside its course: (what, figures); what does not apply is left out."""
    low, high = (
        None if h is None else duration(3600 * h) for h in (heat.time_constant_low_h, heat.time_constant_high_h)
    )
    if low and high:
        span = f"{low} to {high}"
    else:
        span = f"at least {low}" if low else f"at most {high}" if high else "not bounded by these tests"
    direction = {"+": "to plus when heated", "-": "to minus when heated", None: "both ways"}[heat.direction]
    lines = [
        ("time constant", f"{duration(3600 * heat.time_constant_h)} ({span} over tests drawn anew)"),
        ("direction", direction + ("" if heat.agreed is None else f" ({100 * heat.agreed:.0f} % of the draws agree)")),
        (
            "explains",
            f"{percent(heat.left_out)} of the squared residual in parts of the tests that were left out in turn "
            f"({percent(heat.explained)} of what it is drawn through, as any free course does)",
        ),
        ("its source is on at (UTC)", ", ".join(f"{h:.0f} h" for h in heat.hours_of_day)),
        ("goes with", _companions(heat.goes_with)),
        ("not with", _companions(heat.goes_not_with)),
    ]
    return [(what, text) for what, text in lines if text]


def _companions(found: list[HeatCompanion]) -> str:
    """What runs and rests first, for it tells more than a temperature does."""
    ordered = sorted(found, key=lambda c: c.follows is not None)
    return with_count(map(_companion, ordered), COMPANIONS, ", and")


def percent(share: float) -> str:
    """'94 %', and never all: 'over 99 %'."""
    return "over 99 %" if 0.99 < share < 1 else f"{100 * share:.0f} %"


def _companion(one: HeatCompanion) -> str:
    if one.follows is not None:
        return f"{one.channel} ({percent(one.follows)} alike)"
    on, off = one.on_with or 0.0, one.on_without or 0.0
    if off > on:
        return f"{one.channel} (on in {percent(off)} while it is off, {percent(on)} else)"
    return f"{one.channel} (on in {percent(on)} while it runs, {percent(off)} else)"


def tests_of_role(scores: Iterable[Score], role: str) -> str:
    """'t1, t2 and t4', or how many they are: those whose errors a row of a role counts. Fitted verification tests are
    verification tests."""
    names = list(dict.fromkeys(s.test for s in scores if base_role(s.role) == role and s.phase == "all"))
    return listed(names) if len(names) <= MOST_NAMED else f"{len(names)} tests"
