"""Errors that say what, where, expected and got, and what to do."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from copy import copy
from difflib import get_close_matches
from typing import Any, Self

Near = Callable[[str, Sequence[str]], str | None]
_WORD = re.compile(r"\d+|[^\W\d_]+")

INTERRUPTED = 130
"""Exit code of what Ctrl-C ended, as shells have it: 128 and the number of the signal."""

FAILED = (Exception, SystemExit)
"""What ends a plugin, and nothing else: a script that became one may still say sys.exit(). Ctrl-C is not among it."""


class ThermodataError(Exception):
    """Base of every error that a user is meant to read.

    exit_code: what the command line returns (2 wrong usage or file, 4 store busy or damaged, 1 anything else).
    """

    exit_code = 1

    def __init__(
        self,
        what: str,
        *,
        where: str | None = None,
        expected: str | None = None,
        got: str | None = None,
        hint: str | None = None,
    ) -> None:
        self.what, self.where, self.expected, self.got, self.hint = what, where, expected, got, hint
        super().__init__(str(self))

    def at(self, where: str) -> Self:
        """The same error, said of another place."""
        moved = copy(self)
        moved.where = where
        return moved

    def __reduce__(self) -> tuple[Any, ...]:
        # by default its text would become its `what` where it comes from another process
        return _as_it_was, (type(self), self.args), self.__dict__

    def __str__(self) -> str:
        lines = [self.what]
        if self.where is not None:
            lines.append(f"where: {self.where}")
        if self.expected is not None or self.got is not None:
            parts = [] if self.expected is None else [f"expected: {self.expected}"]
            parts += [] if self.got is None else [f"got: {self.got}"]
            lines.append(", ".join(parts))
        if self.hint is not None:
            lines.append(f"try: {self.hint}")
        return "\n".join(lines)


def _as_it_was(kind: type[ThermodataError], args: tuple[Any, ...]) -> ThermodataError:
    return kind.__new__(kind, *args)


class UsageError(ThermodataError):
    """Wrong command, option, name or file."""

    exit_code = 2


class SpecError(UsageError):
    """A campaign or model file is wrong; `where` names file and line."""


class FormatError(UsageError):
    """A log file is not what it claims to be; `where` names file and place."""


class QuestionError(FormatError):
    """A log that reads in several ways and does not say which: only who wrote it knows.

    ask: the question, in one line. declare: the part of `sources.*.table` that answers it, with 'unknown' where the
    answer goes; meanwhile: the same with an answer by which the file can be looked at, and never stored; times: the
    columns that are the time once it is answered, and signals until then; begins_s: where the times of the column begin
    that the question proposes.
    """

    def __init__(
        self,
        what: str,
        *,
        ask: str,
        declare: Mapping[str, Any],
        meanwhile: Mapping[str, Any],
        times: Sequence[str] = (),
        begins_s: float | None = None,
        **more: Any,
    ):
        super().__init__(what, **more)
        self.ask, self.declare, self.meanwhile, self.times = ask, declare, meanwhile, tuple(times)
        self.begins_s = begins_s


class CalibrationError(UsageError):
    """A calibration contradicts itself or its declaration."""


class RailError(CalibrationError):
    """The probe of a jump test stands at its end of range: nothing contradicts, and nothing is calibrated with it."""


class PluginError(ThermodataError):
    """A plugin broke its contract (its bug, not the data's)."""

    def __init__(self, what: str, **more: Any) -> None:
        more.setdefault("hint", "a fault of the plugin, not of the data: tell its author ('thermodata plugins')")
        super().__init__(what, **more)


class EffectError(PluginError):
    """An effect broke its contract. effect: its name, by which a search leaves it out; origin: the plugin that brought
    it."""

    def __init__(self, what: str, *, effect: str, origin: str, **more: Any) -> None:
        super().__init__(what, where=origin, **more)
        self.effect, self.origin = effect, origin


class StoreError(ThermodataError):
    """The store is busy, damaged, full, or written by a newer version."""

    exit_code = 4


class NoRoomError(StoreError):
    """There is no room to write: a full disk, a used-up quota, a file that may be no longer."""


def nearest(word: str, choices: Sequence[str]) -> str | None:
    """The choice most like `word`, or None where none is near."""
    found = get_close_matches(word.lower(), [c.lower() for c in choices], n=1, cutoff=0.6)
    return next((c for c in choices if c.lower() == found[0]), None) if found else None


def nearest_of_same_words(word: str, choices: Sequence[str]) -> str | None:
    """The choice most like `word` whose words and numbers are those of `word`, but for slips in spelling and for words
    that one of the two has more: T_front is no slip of T_rear, and T04 none of T05."""
    return nearest(word, [c for c in choices if _same_words(word, c)])


def _same_words(one: str, other: str) -> bool:
    few, many = sorted((_WORD.findall(one.lower()), _WORD.findall(other.lower())), key=len)
    left = iter(many)
    return all(any(_is_slip(word, of) for of in left) for word in few)


def _is_slip(one: str, other: str) -> bool:
    return one == other or (not one.isdecimal() and bool(get_close_matches(one, [other], cutoff=0.66)))


def unknown_channel(word: str, choices: Sequence[str], **more: str) -> UsageError:
    """The refusal of a channel's name: `unknown_name` that offers no other sensor for a likeness of its letters."""
    return unknown_name("channel", word, choices, near=nearest_of_same_words, **more)


def unknown_name(kind: str, word: str, choices: Sequence[str], *, near: Near = nearest, **more: str) -> UsageError:
    """The refusal of a name, with the nearest right one and all the choices."""
    close = near(word, choices)
    return UsageError(
        f"no {kind} '{word}'",
        expected=", ".join(sorted(choices)) or "nothing: there is none",
        got=word,
        hint=f"did you mean '{close}'?" if close else None,
        **more,
    )
