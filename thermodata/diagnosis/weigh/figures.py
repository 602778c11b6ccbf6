"""Two errors side by side, so that words and figures agree."""

from __future__ import annotations

HARDLY = 0.005  # of an error: a fall by less is one by 0 % in words


def short(value: float) -> str:
    """'0.2', '93', '120': two digits that count, and no power of ten up to a million."""
    return f"{float(f'{value:.2g}'):g}"


def from_to(before: float, after: float, unit: str, begins: str = "", to: str = "->") -> str:
    """'0.95 -> 0.94 um', or 'from 0.95 to 0.94 um', with as many digits as tell the two, four at most."""
    texts = [(f"{before:.{digits}f}", f"{after:.{digits}f}") for digits in (2, 3, 4)]
    first, last = next((both for both in texts if both[0] != both[1]), texts[0])
    return " ".join(filter(None, (begins, first, to, last, unit)))


def way(before: float, after: float) -> str:
    """'falls', 'hardly falls', 'does not fall'."""
    if after >= before:
        return "does not fall"
    return "falls" if before - after >= HARDLY * before else "hardly falls"


def of_more_than_noise(fall: float, before: float, after: float) -> str:
    """What a fall is a share of where that is not the error beside it: ' of what is more than noise'; else ''."""
    seen = 1.0 - after / before if before > 0 else 0.0
    return " of what is more than noise" if round(100 * fall) != round(100 * seen) else ""
