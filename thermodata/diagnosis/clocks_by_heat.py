"""Two logs of one machine that disagree about the time, told by heat: a body warms when its drive works, not an hour
before.

What a command moves at once says when the displacement was measured (`clocks`), and nothing of a logger of
temperatures. So each temperature of one source is foretold, in tests left out, by a heat balance with the commands of
another: over ten minutes it rises by what works, less what it is warm already. Commands are moved until that is best.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from thermodata.diagnosis.commanded import COMMANDS
from thermodata.diagnosis.known import FloatND
from thermodata.plugin import Float2D, Int1D
from thermodata.schema.diagnosis import Artefact
from thermodata.view.dataset import ChannelInfo, TestData

EVERY_S = 120.0  # between the shifts that are asked: up to these either way,
MOST_S = 3900.0
TWO_HOURS_S, ABOUT_S = 7200.0, 360.0  # and about two hours, as where a zone and daylight saving are wrong
OVER_S = 600.0  # that a temperature rises over
RIDGE = 0.02  # of a column's squares
TELLS = 0.2  # share of the squared rises of a temperature that is foretold at its best shift, else it says nothing,
LEAST_SHARE = 0.3  # and of all that tell, on average
LEAST_TELLING = 2  # temperatures: one alone may follow what nobody logged
BEATS = 4.0  # times what is foretold unmoved
UNMOVED_S = 240.0  # a body warms so much later than its drive, or is logged so much apart
LEAST_S = 600.0  # quick bodies are late by up to 4 min, others by more
LEAST_TESTS = 3


@dataclass(frozen=True, slots=True)
class Disagreement:
    """warmed: the source of the temperatures. by: that of the commands. shift_s: by which commands, moved later,
    foretell most. share: of the squared rises, mean of the temperatures that tell; unmoved: the most near no shift.
    telling: how many temperatures tell."""

    warmed: str
    by: str
    shift_s: float
    share: float
    unmoved: float
    telling: int

    @property
    def plain(self) -> bool:
        much = self.share >= max(LEAST_SHARE, BEATS * self.unmoved)
        return much and self.telling >= LEAST_TELLING and abs(self.shift_s) >= LEAST_S


@dataclass(frozen=True, slots=True)
class Late:
    """A source whose clock is off: moved later by shift_s its log agrees with the others. source: None where nobody can
    tell which of the two it is."""

    source: str | None
    shift_s: float
    of: Disagreement


def late_logs(
    tests: Sequence[TestData],
    channels: Mapping[str, ChannelInfo],
    response: str,
    step_s: float,
    right: Collection[str] = (),
) -> list[Late]:
    """Of each source the plainest. right: sources whose clock is known to agree with that of the response."""
    plain = [d for d in disagreements(tests, channels, step_s) if d.plain]
    found: list[Late] = []
    for one in sorted(plain, key=lambda d: -d.share):
        if not any({one.warmed, one.by} & {f.of.warmed, f.of.by} for f in found):
            found.append(_which(one, tests, channels, response, step_s, right))
    return found


def _which(
    of: Disagreement,
    tests: Sequence[TestData],
    channels: Mapping[str, ChannelInfo],
    response: str,
    step_s: float,
    right: Collection[str],
) -> Late:
    """The one that disagrees with the response, too: with its own clock, or with its own heat."""
    home = channels[response].source
    warmed, by = Late(of.warmed, -of.shift_s, of), Late(of.by, of.shift_s, of)
    if of.by == home or of.by in right:
        return warmed
    if of.warmed == home:
        return by
    drives = _of({n: c.source for n, c in channels.items() if c.quantity in COMMANDS and c.source}, of.by)
    own = disagreement(tests, [response], drives, step_s, warmed=home or "", by=of.by)
    if own is not None and abs(own.shift_s) < LEAST_S:
        return warmed
    if own is not None and abs(own.shift_s - of.shift_s) < LEAST_S:
        return by
    return Late(None, of.shift_s, of)


def as_artefact(late: Late, campaign: str) -> Artefact:
    of, known_to = late.of, UNMOVED_S / 60
    which = "one of the two clocks is off, and nothing tells which"
    if late.source is not None:
        which = f"the choice is made with '{late.source}' moved by {late.shift_s / 60:+.0f} min"
    return Artefact(
        kind="clock_offset",
        campaign=campaign,
        test="",
        at_s=None,
        size_um=None,
        why=f"{of.telling} temperatures of source '{of.warmed}' follow the commands of source '{of.by}' best with "
        f"these moved by {of.shift_s / 60:+.0f} min (give or take {known_to:.0f}): {of.share:.0%} of their squared "
        f"rises are foretold in tests left out, unmoved {max(of.unmoved, 0.0):.0%}. So {which}; check the time zone "
        "and the clocks, or declare clock: {offset: ...}",
    )


def disagreements(tests: Sequence[TestData], channels: Mapping[str, ChannelInfo], step_s: float) -> list[Disagreement]:
    """Of each source of temperatures with each other source of commands, where its temperatures tell. step_s: of the
    tests' common grid."""
    warm = {n: c.source for n, c in channels.items() if c.quantity == "temperature" and c.faulty is None and c.source}
    commands = {n: c.source for n, c in channels.items() if c.quantity in COMMANDS and c.source}
    found = []
    for by in sorted(set(commands.values())):
        for warmed in sorted(set(warm.values()) - {by}):
            names, drives = _of(warm, warmed), _of(commands, by)
            found.append(disagreement(tests, names, drives, step_s, warmed=warmed, by=by))
    return [d for d in found if d is not None]


def _of(sources: Mapping[str, str], source: str) -> list[str]:
    return sorted(n for n, s in sources.items() if s == source)


def disagreement(
    tests: Sequence[TestData], names: Sequence[str], drives: Sequence[str], step_s: float, *, warmed: str, by: str
) -> Disagreement | None:
    """names: of the temperatures, or of what else heat moves; drives: of the commands. None where nothing tells."""
    if step_s > UNMOVED_S:
        return None  # one sample is as much as bodies are late by
    every = max(1, round(EVERY_S / step_s))
    over = max(1, round(OVER_S / (every * step_s)))
    long = [t for t in tests if len(t.t_s) // every > 2 * over]
    if len(long) < LEAST_TESTS:
        return None
    shifts = _shifts(every * step_s)
    shares = _foretold([(_held(t, drives, every), _even(t, names, every)) for t in long], shifts, over)
    telling = shares[shares.max(axis=1) >= TELLS]
    if not len(telling):
        return None
    mean = telling.mean(axis=0)
    best, near = int(np.argmax(mean)), np.abs(shifts) * every * step_s <= UNMOVED_S
    shift_s = float(shifts[best] * every * step_s)
    return Disagreement(warmed, by, shift_s, float(mean[best]), float(mean[near].max()), len(telling))


def _shifts(step_s: float) -> Int1D:
    """In samples, in order."""
    most, about = int(MOST_S / step_s), np.arange(-int(ABOUT_S / step_s), int(ABOUT_S / step_s) + 1)
    two_hours = [sign * round(TWO_HOURS_S / step_s) + about for sign in (-1, 1)]
    return np.unique(np.concatenate([np.arange(-most, most + 1), *two_hours])).astype(np.int64)


def _held(test: TestData, names: Sequence[str], every: int) -> Float2D:
    """Sizes of commands, each value held until the next; 0 where a command was not logged. Shape (n, commands)."""
    columns = np.zeros((len(test.t_s), len(names)))
    for column, name in zip(columns.T, names, strict=True):
        known = np.flatnonzero(np.isfinite(test.values[name])) if name in test.values else np.empty(0, np.int64)
        if len(known):
            last = np.searchsorted(known, np.arange(len(column)), side="right") - 1
            column[:] = np.abs(test.values[name][known[np.clip(last, 0, None)]])
    return _means(columns, every)


def _even(test: TestData, names: Sequence[str], every: int) -> Float2D:
    """Channels at even times, drawn straight over holes; zeros where one was not measured. Shape (n, channels)."""
    columns = np.zeros((len(test.t_s), len(names)))
    for column, name in zip(columns.T, names, strict=True):
        if name in test.values:
            seen = np.flatnonzero(np.isfinite(test.values[name]) & test.valid[name])
            if len(seen) > 1:
                column[:] = np.interp(test.t_s, test.t_s[seen], test.values[name][seen])
    return _means(columns, every)


def _means(columns: Float2D, every: int) -> Float2D:
    whole = columns[: len(columns) // every * every]
    return np.asarray(whole.reshape(-1, every, columns.shape[1]).mean(axis=1))


def _foretold(parts: Sequence[tuple[Float2D, Float2D]], shifts: Int1D, over: int) -> Float2D:
    """Share of the squared rises of each channel that the other tests foretell, shape (channels, shifts). parts:
    commands and channels of each test."""
    drives, channels = parts[0][0].shape[1], parts[0][1].shape[1]
    gram = np.zeros((len(parts), channels, len(shifts), drives + 1, drives + 1))
    cross = np.zeros((len(parts), channels, len(shifts), drives + 1))
    energy = np.zeros((len(parts), channels))
    for i, (held, value) in enumerate(parts):
        rise, warm = _centred(value[over:] - value[:-over]), _centred(value[:-over])
        energy[i] = np.sum(rise**2, axis=0)
        seen = (energy[i] > 0).astype(np.float64)  # what was not measured there says nothing of the commands
        gram[i, :, :, -1, -1] = np.sum(warm**2, axis=0)[:, None]
        cross[i, :, :, -1] = np.sum(warm * rise, axis=0)[:, None]
        for k, shift in enumerate(shifts):
            worked = _centred(_worked(held, int(shift), over))
            gram[i, :, k, :-1, :-1] = seen[:, None, None] * (worked.T @ worked)
            gram[i, :, k, :-1, -1] = gram[i, :, k, -1, :-1] = (worked.T @ warm).T
            cross[i, :, k, :-1] = (worked.T @ rise).T
    size = np.sqrt(np.einsum("tnscc->nsc", gram))
    size[size == 0] = 1.0
    gram, cross = gram / (size[..., :, None] * size[..., None, :]), cross / size
    whole, of_all = gram.sum(axis=0), cross.sum(axis=0)
    left: FloatND = np.zeros(size.shape[:2])
    for g, c, e in zip(gram, cross, energy, strict=True):
        gains = np.linalg.solve(whole - g + RIDGE * np.eye(drives + 1), (of_all - c)[..., None])[..., 0]
        left += e[:, None] - 2 * np.einsum("nsc,nsc->ns", gains, c) + np.einsum("nsc,nscd,nsd->ns", gains, g, gains)
    total = energy.sum(axis=0)[:, None]
    return np.where(total > 0, 1 - left / np.maximum(total, 1e-300), 0.0)


def _centred(columns: Float2D) -> Float2D:
    return np.asarray(columns - columns.mean(axis=0))


def _worked(held: Float2D, shift: int, over: int) -> Float2D:
    """Mean of the commands over each interval, moved later by so many samples; ends hold their value. Shape (n - over,
    commands)."""
    rows = np.clip(np.arange(len(held)) - shift, 0, len(held) - 1)
    total = np.vstack([np.zeros(held.shape[1]), np.cumsum(held[rows], axis=0)])
    return np.asarray((total[over:-1] - total[: len(held) - over]) / over)
