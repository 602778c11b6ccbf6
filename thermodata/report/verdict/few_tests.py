"""What is wanting where too few tests are open, in words: nobody guesses by himself what parts of a test mean."""

from __future__ import annotations

from typing import TYPE_CHECKING

from thermodata.schema.words.sentences import counted

if TYPE_CHECKING:
    from thermodata.schema.answers.diagnosis import Diagnosis

FORETELLS = "one is claimed only where it also foretells a test that it was not fitted to"
_HOW = (
    "record more, each source (spindle, an axis, hall air) working in two of them, with role: calibration or "
    "verification, then ingest and fit again"
)


def few_tests(found: Diagnosis) -> str:
    """'1 open test took part, so errors are of parts of that one, ...: record more, ...'; '' where there are enough.
    Answers of older versions, which do not count tests, say of what can't be told why alone."""
    asked = _asked(found)
    if found.verdict == "not_testable":
        return FORETELLS if asked is None else _not_testable(found, asked)
    if asked is None or not _in_parts(found):
        return ""
    which = "that one" if asked == 1 else "those"
    return (
        f"{_took_part(found, asked)}, so errors are of parts of {which}, which its other hours foretell: whether that "
        f"holds in another test no part can say. Three tests at least can be left out whole: {_how(found)}"
    )


def _not_testable(found: Diagnosis, asked: int) -> str:
    if asked == 0:
        return (
            f"{_took_part(found, asked)}, for none has enough samples that count (thermodata quality shows what was "
            "flagged), or all lack a channel of the model (thermodata fit says which)"
        )
    if asked == 1:
        return (
            f"{_took_part(found, asked)}, and it is too short for parts that foretell each other, but {FORETELLS}: "
            f"{_how(found)}"
        )
    return (
        "no effect of the library fits the channels that were logged: thermodata channels shows their quantities and "
        "places, which the campaign file gives them (quantity, at)"
    )


def _took_part(found: Diagnosis, asked: int) -> str:
    """'1 open test took part', and of how many where others did not."""
    if found.open_tests is None or found.open_tests <= asked:
        return f"{counted(asked, 'open test')} took part" if asked else "no test is open"
    lack = "for the others lack samples or a channel of the model" if asked else ""
    told = f"{asked or 'none'} of {counted(found.open_tests, 'open test')} took part"
    return f"{told} ({lack})" if lack else told


def _how(found: Diagnosis) -> str:
    """With the tests that are there and locked, where one may be spared."""
    return (
        f"{_HOW}, or take one of the {found.locked_tests} locked ones for it" if (found.locked_tests or 0) > 1 else _HOW
    )


def _in_parts(found: Diagnosis) -> bool:
    parts = next((c.left_out for c in found.candidates if c.left_out), [])
    return len({(p.campaign, p.test) for p in parts}) < len(parts)


def _asked(found: Diagnosis) -> int | None:
    """How many open tests took part; of an answer of an older version as many as were left out in parts."""
    if found.open_tests_asked is not None:
        return found.open_tests_asked
    parts = next((c.left_out for c in found.candidates if c.left_out), [])
    return len({(p.campaign, p.test) for p in parts}) or None
