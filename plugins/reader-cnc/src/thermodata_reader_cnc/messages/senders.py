"""Which keys of flat messages say whose each is: as declared, or as the columns of a table show it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from thermodata.plugin import Array, Source
from thermodata.reader.signals.interleaved import series_columns
from thermodata.reader.signals.series import Declaration
from thermodata.reader.text.cells.time_forms.time_pattern import TimeFormat
from thermodata.reader.text.cells.values.number import to_float
from thermodata.reader.text.times.one_cell import timestamp
from thermodata.reader.times.zone import NAT
from thermodata_reader_cnc.events import GONE
from thermodata_reader_cnc.messages.reports import Report

_NEARLY_ALL = 0.9  # of the messages are alike


class Senders(NamedTuple):
    """keys: whose words part the messages; notes: on them, and on others that may."""

    keys: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()

    def named(self, found: Sequence[Report]) -> list[Report]:
        """The reports of a message, with what it says of where it comes from as their first labels."""
        if not self.keys:
            return list(found)
        told = {report.name: report.value for report in found if report.name in self.keys}
        own = tuple(told.get(key, GONE) for key in self.keys)
        return [r._replace(labels=(*own, *r.labels)) for r in found if r.name not in self.keys]


def senders(messages: Sequence[Sequence[Report]], source: Source, form: TimeFormat) -> Senders:
    """FormatError where a key is declared that no message has."""
    declared = Declaration.of((source.table or {}).get("series"))
    if declared.columns is not None:
        declared.check({report.name for found in messages for report in found})
        return Senders(declared.columns)
    alike = [found for found in messages if found[0].time and len({r.name for r in found}) == len(found) > 1]
    if len(alike) < _NEARLY_ALL * len(messages) or len({found[0].labels for found in alike}) != 1:
        return Senders()
    t_ns = timestamp.parse([found[0].time for found in alike], form)
    if (t_ns == NAT).any():
        return Senders()
    parting = series_columns(t_ns, _columns(alike), absolute=True)
    notes = [f"'{key}' says which sensor or host a message is of; {declared.declined()}" for key in parting.tags]
    return Senders(parting.tags, (*notes, *declared.doubts(parting)))


def _columns(alike: Sequence[Sequence[Report]]) -> dict[str, Array]:
    """The values of the names that all messages have, shape (n,) each."""
    held = [{r.name: r.value for r in found} for found in alike]
    shared = set(held[0]).intersection(*held)
    names = [name for name in held[0] if name in shared]
    columns = dict[str, Array]()
    for name in names:
        texts = [one[name] for one in held]
        numbers = [to_float(text, ".") for text in texts]
        words = np.empty(len(texts), object)
        words[:] = ["" if text == GONE else text for text in texts]
        columns[name] = words if None in numbers else np.array(numbers, np.float64)
    return columns
