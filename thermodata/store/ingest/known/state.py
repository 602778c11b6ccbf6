"""What a fit depends on of a test: one digest of it all, and one of each kind of thing, which says what differs."""

from __future__ import annotations

import json
from collections.abc import Collection, Mapping, Sequence
from functools import lru_cache

from thermodata.store.base.files import key_of
from thermodata.store.catalogue.models.fits import GONE
from thermodata.store.catalogue.models.renamed import CHANNELS, origins
from thermodata.store.ingest.known.inventory import Row, comparable, meta_of

Rows = Mapping[str, Mapping[str, Sequence[Row]]]
State = Mapping[str, str]
"""`VERSION` and each of what may differ, in words -> a digest of it."""

VERSION = "version"
_ELSE = "how it is read"

# what a fit reads: words about a test or a channel don't make it stale
_DESCRIBING = ("test", "machine", "channel")
_WORDS = ("notes", "repeat_of", "added_at", "start", "sensor", "raw_unit")
# in words -> the table, its columns, and of files the layer; None: all that a fit reads. A channel is the signal that
# it comes from: its name differs by itself
_NAMED = {
    "role": ("test", ("role",), None),
    "calibration": ("channel", ("source", "signal", "calibration"), None),
    "data": ("file", ("key",), "raw"),
    "units or signals": ("channel", ("source", "signal", "quantity", "unit", "raw_unit"), None),
}
_NAMES = "channel names"
# word -> the digest that stands for it where a state has one: states of before have another one under the word
_ANEW = {"calibration": "gains"}
# not compared: why data differ that are of the same logs
_LOGS, _READERS = "logs", "readers"
# of a calibration, what a fit reads
_GAINS = ("calibration", "kind", "axis", "gain", "gain_unit", "offset_value", "sign", "uncertainty_pct", "crosstalk")
_DESCRIPTION = "description"  # said where none of these differs


@lru_cache(maxsize=64)
def _read_by_a_fit(columns: tuple[str, ...]) -> tuple[str, ...]:
    return tuple(sorted(c for c in columns if c not in _WORDS))


def _read_by_fits(rows: Rows, test: str) -> list[str]:
    """What fits read of a test's rows, in no order of these."""
    return sorted(
        repr([(k, row[k]) for k in _read_by_a_fit(tuple(row))])
        for table in _DESCRIBING
        for row in rows[table].get(test, [])
    )


def version_of(rows: Rows, test: str) -> str:
    """A digest of everything about a test that a fit depends on."""
    parts = _read_by_fits(rows, test)
    parts += sorted({r["key"] for r in rows["file"].get(test, []) if r["layer"] == "tidy"})
    return key_of(*sorted(parts))


def states(rows: Rows, calibrations: list[Row], tests: Collection[str]) -> dict[str, State | None]:
    """Test -> its state; None where it is not there. calibrations: of the campaign."""
    calibrated = key_of(*comparable(calibrations))
    gains = key_of(*sorted(repr([row[c] for c in _GAINS]) for row in calibrations))

    def of(test: str) -> State | None:
        if not rows["test"].get(test):
            return None
        named = {
            word: key_of(
                *sorted(
                    repr([r[c] for c in columns]) for r in rows[table].get(test, []) if layer in (None, r.get("layer"))
                )
            )
            for word, (table, columns, layer) in _NAMED.items()
        }
        named |= {_ANEW["calibration"]: named["calibration"] + gains, "calibration": named["calibration"] + calibrated}
        raw = [r for r in rows["file"].get(test, []) if r["layer"] == "raw"]
        readers = {(meta_of(r)["reader"], meta_of(r)["reader_version"]) for r in raw}
        channels = origins(rows["channel"].get(test, []))
        return {
            VERSION: version_of(rows, test),
            **named,
            CHANNELS: channels,
            _LOGS: key_of(*sorted({repr((r["source"], r["source_path"], r["sha256"])) for r in raw})),
            _READERS: json.dumps(sorted(readers)),
            _DESCRIPTION: key_of(*_read_by_fits(rows, test)),
        }

    return {test: of(test) for test in tests}


def what_differs(then: State, now: State | None) -> list[str]:
    """In words: gone, role, calibration, data, reader, units or signals, channel names, description, or else how it is
    read."""
    if now is None:
        return [GONE]
    keys = {word: _ANEW[word] if _ANEW.get(word) in then else word for word in _NAMED}
    found = [word for word, key in keys.items() if then.get(key) != now.get(key)]
    if "data" in found and (other := _other_readers(then, now)):
        found[found.index("data")] = other
    if CHANNELS in then and then[CHANNELS] != now.get(CHANNELS) and "units or signals" not in found:
        found.append(_NAMES)
    return found or [_DESCRIPTION if then.get(_DESCRIPTION) != now.get(_DESCRIPTION) else _ELSE]


def _other_readers(then: State, now: State) -> str | None:
    """'reader table 0.3.1 -> 0.3.2', where the logs are the same."""
    if _LOGS not in then or then[_LOGS] != now.get(_LOGS):
        return None
    was, is_now = (dict(json.loads(state[_READERS])) for state in (then, now))
    other = [
        f"{name} {was[name]} -> {is_now[name]}"
        for name in sorted(was)
        if is_now.get(name, "") != was[name] and name in is_now
    ]
    return f"reader {', '.join(other)}" if other else None
