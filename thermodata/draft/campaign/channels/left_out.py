"""What of a source is no channel of a draft: signals that say something of others, or of the file alone."""

from __future__ import annotations

import re
from collections.abc import Sequence

from thermodata.draft.campaign.channels.extremes import extremes_among, extremes_note
from thermodata.draft.folder.into_sources.one_signal import OneSignal
from thermodata.draft.signals.quantity.guessed import Guess
from thermodata.draft.words.naming import parts_of
from thermodata.reader.signals.row_units import UNIT_OF
from thermodata.reader.text import split_unit
from thermodata.reader.text.rows.quality_columns import QUALITY_OF
from thermodata.schema.agreed.exported import OF_TEST, flags_of
from thermodata.schema.words.sentences import listed, with_count

_TAG_NUMBER = re.compile(r"(?i)(?:numeric|tag|item|point|node)[ _]?id$")
_QUERY = {"_start", "_stop"}  # the range of a query of InfluxDB, which it writes into each row
_OF_QUERY = {*_QUERY, "#group", "#datatype", "#default", "result", "table"}


class LeftOut:
    """Takes the signals of a source that are no channels, and tells of them."""

    def __init__(self, source: str, found: Sequence[OneSignal], exported: bool) -> None:
        """found: all signals of the source; exported: it is an export of this program."""
        self._source, self._found, self._exported = source, found, exported
        self._names = {one.signal.name for one in found}
        self._notes: list[str] = []  # on each that says something by itself
        self._of_test: set[str] = set()  # columns of an export that say which test it is of
        self._flags: list[str] = []  # the store's, in an export
        self._beside: list[str] = []  # what tells the quality or the number of another signal
        self._query: list[str] = []  # what a query of InfluxDB says of itself
        self._mean_of = {} if exported else extremes_among(found)
        self._extremes: dict[str, str] = {}  # what a logger wrote of one that it averaged, and that one
        self._ways = (self._as_exported, self._by_itself, self._of_query, self._of_others, self._as_extreme)

    def takes(self, one: OneSignal, said: Guess) -> bool:
        """Whether a signal is no channel; it is told of then."""
        return any(way(one, said) for way in self._ways)

    def _as_exported(self, one: OneSignal, said: Guess) -> bool:
        """What an export of this program holds beside its channels."""
        last = parts_of(split_unit(one.signal.name)[0])[-1]
        if not self._exported:
            return False
        if last in OF_TEST:
            self._of_test.add(last)
            return True
        return _kept(self._flags, one) if flags_of(one.signal.name) in self._names else False

    def _by_itself(self, one: OneSignal, said: Guess) -> bool:
        why = _why_left_out(one, said, self._found)
        if why is not None:
            self._notes.append(f"{self._source}: '{one.written}' {why}: left out")
        return why is not None

    def _of_query(self, one: OneSignal, said: Guess) -> bool:
        return self._names >= _QUERY and one.signal.name in _OF_QUERY and _kept(self._query, one)

    def _of_others(self, one: OneSignal, said: Guess) -> bool:
        return _is_of_others(one) and _kept(self._beside, one)

    def _as_extreme(self, one: OneSignal, said: Guess) -> bool:
        mean = self._mean_of.get(one.signal.name)
        if mean is not None:
            self._extremes[one.written] = mean
        return mean is not None

    def told(self) -> tuple[str, ...]:
        """All notes on them."""
        notes = [*self._notes]
        if self._exported:
            say = "says" if len(self._of_test) == 1 else "say"
            left = f"; {listed(sorted(self._of_test))} {say} of which test: left out" if self._of_test else ""
            notes.append(f"{self._source}: an export of thermodata{left}")
        if self._flags:
            notes.append(
                f"{self._source}: {with_count(self._flags, 4)}: left out, for they hold the flags of the store that "
                "the export is of; ingest flags anew"
            )
        if self._beside:
            shown = with_count(self._beside, 4)
            notes.append(
                f"{self._source}: {shown}: left out, for they tell the quality or the number of a signal beside them"
            )
        if self._query:
            shown = with_count(self._query, 4)
            notes.append(f"{self._source}: {shown}: left out, for they say what was asked of InfluxDB")
        if self._extremes:
            notes.append(extremes_note(self._source, self._extremes))
        return tuple(notes)


def _kept(names: list[str], one: OneSignal) -> bool:
    names.append(one.written)
    return True


def _why_left_out(one: OneSignal, said: Guess, found: Sequence[OneSignal]) -> str | None:
    """Why a signal is no channel, though it says something by itself; None where it is one."""
    # Lutron calls the number of a row its position
    if said.quantity in (None, "position") and one.signal.unit is None and _counts_rows(one):
        return "numbers the rows of each file"
    if (of := _unit_of(one, found)) is not None:
        return f"holds the unit of '{of.written}', which is taken"
    return None


def _is_of_others(one: OneSignal) -> bool:
    """Whether a signal says something of another one and nothing of the machine: the quality by which its reader flags
    a column beside it, or the constant number of a tag (`T_air_NUMERICID`)."""
    own = one.seen()
    if own and all(QUALITY_OF in s.properties for s, _ in own):
        return True
    if one.signal.unit is not None or not _TAG_NUMBER.search(one.signal.name):
        return False
    seen = [v for _, v in own]
    return bool(seen) and all(v is not None and v.constant and v.whole for v in seen)


def _counts_rows(one: OneSignal) -> bool:
    """Whether a signal numbers the rows of each file that has it."""
    seen = [v for _, v in one.seen()]
    return bool(seen) and all(v is not None and v.counts_rows for v in seen)


def _unit_of(one: OneSignal, found: Sequence[OneSignal]) -> OneSignal | None:
    """The signal of numbers whose unit a column says, by its reader."""
    of = one.signal.properties.get(UNIT_OF)
    return next(
        (o for o in found if of is not None and (o.signal.stream, o.signal.name) == (one.signal.stream, of)), None
    )
