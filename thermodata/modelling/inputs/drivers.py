"""The drivers that an effect sees of one test: channels or expressions on the test's grid, gaps filled by straight
lines; what is held, as a command or a state that is written on change, stands there as it did before.

Temperatures count from the start of the record (history included): a constant is the offset's business, and a
lag that starts at zero is then in balance. So a sensor that is off by one number through the test drives as ever, but
where an expression makes more of that than a constant. Quantities that are zero at rest (speed, power, state) stay as
they are.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from thermodata.effect.binding import ANY
from thermodata.effect.guard import read_only
from thermodata.effect.lag import step_between
from thermodata.errors import UsageError, unknown_channel
from thermodata.plugin import Bool1D, Drivers, Effect, Float1D
from thermodata.schema.units.quantity import STATES
from thermodata.view.grid.dataset import TestData

# zero means at rest; everything else has an arbitrary zero and counts from the start of the record
ZERO_AT_REST = frozenset(
    {
        "rotational_speed",
        "feed",
        "power",
        "load",
        "current",
        "torque",
        "flow",
        "state",
        "irradiance",
    }
)
FILL_S = 1800.0  # a driver may be missing this long before what it predicts stops counting
CYCLE_S = 7200.0  # a driver that changes sides TURNS times within this long goes in cycles
TURNS = 4
BAND = 0.15  # of its range, about its mean: no side
EDGE = 0.08  # of its range: where a start is a start
BACK = 14.49 / 12.0  # of the noise, where a line through three samples goes back half a step
ALIKE = 1e-6  # a difference that is a constant, but for rounding
START_S = 300.0  # the start value is a mean of at most this, while the driver does not move


def make_drivers(test: TestData, effect: Effect, binding: Mapping[str, str], name: str | None = None) -> Drivers:
    """binding: role -> channel name or expression ("T_a - T_b"). name: of the effect in its model. All values are
    finite, and read-only. UsageError where the test lacks a channel, or a driver has no valid sample in it."""
    values: dict[str, Float1D] = {}
    valid: dict[str, Bool1D] = {}
    quantity = {need.role: need.quantity for need in effect.needs}
    for role, text in binding.items():
        coordinate = quantity.get(role) == "position"  # an effect that names position means the coordinate
        key = "driver", text, coordinate
        if key not in test.kept:
            raw, good, relative = evaluate(test, text)
            if not good.any():
                raise _nothing_valid(test, text, f"effect '{name or effect.name}', driver '{role}'")
            relative = relative and not coordinate
            test.kept[key] = prepare(raw, good, step_s(test), relative, held=_is_held(test, text))
        values[role], valid[role] = test.kept[key]
    return read_only(Drivers(test.t_s, values, valid, test.conditions))


def names_of(text: str) -> tuple[str, ...]:
    """The channels that a driver expression reads, in alphabetical order."""
    if text.isidentifier():
        return (text,)
    from thermodata.calibration.expression.parser import parse

    return tuple(sorted(parse(text).names))


def has_drivers(test: TestData, binding: Mapping[str, str]) -> bool:
    """Whether the test has all that the binding reads, with at least one valid sample each."""
    return all(_has_driver(test, text) for text in binding.values())


def _has_driver(test: TestData, text: str) -> bool:
    """Of one driver; kept with the test."""
    key = "has driver", text
    if key not in test.kept:
        logged = all(name in test.values and bool(np.any(_is_valid(test, name))) for name in names_of(text))
        test.kept[key] = logged and is_known(test, text)
    return bool(test.kept[key])


def shifted_in(test: TestData, text: str) -> tuple[str, ...]:
    """The channels of a driver whose sensor is off by one number through the test."""
    return tuple(n for n in names_of(text) if n in test.channels and test.channels[n].shifted)


def is_known(test: TestData, text: str) -> bool:
    """False where a number that a sensor is off by does not go out with the start: in a product, or a condition."""
    shifted = shifted_in(test, text)
    if not shifted or text.isidentifier():
        return True
    from thermodata.calibration.expression.parser import parse

    tree = parse(text)
    if tree.logical:
        return False
    names = names_of(text)
    units = {name: _unit(test, name) for name in names}
    as_read = tree.evaluate({n: test.values[n] for n in names}, units)
    otherwise = tree.evaluate({n: test.values[n] + (n in shifted) for n in names}, units)
    by = np.asarray(otherwise, dtype=np.float64) - np.asarray(as_read, dtype=np.float64)
    return bool(np.nanmax(by, initial=-np.inf) - np.nanmin(by, initial=np.inf) <= ALIKE)


def evaluate(test: TestData, text: str) -> tuple[Float1D, Bool1D, bool]:
    """(values, valid, relative) of a channel or expression, shapes (n,); NaN where not valid."""
    names = names_of(text)
    if not names:
        raise UsageError(
            f"the driver '{text}' reads no channel",
            expected="a channel or an expression of channels",
            hint="name a channel of the campaign; 'thermodata channels' lists them",
        )
    for name in names:
        if name not in test.values:
            raise unknown_channel(name, list(test.values), where=f"test {test.campaign}/{test.test}")
    good = np.asarray(np.logical_and.reduce([_is_valid(test, name) for name in names]))
    relative = not all(_quantity(test, name) in ZERO_AT_REST for name in names)
    if text.isidentifier():
        raw = np.asarray(test.values[text], dtype=np.float64)
    else:
        from thermodata.calibration.expression.parser import parse

        tree = parse(text)
        values = tree.evaluate({name: test.values[name] for name in names}, {name: _unit(test, name) for name in names})
        raw = np.asarray(values, dtype=np.float64)
        relative = relative and not tree.logical  # a condition is a state: zero is off
    if not is_known(test, text):
        good = np.zeros_like(good)
    return np.where(good, raw, np.nan), good & np.isfinite(raw), relative


def _nothing_valid(test: TestData, text: str, where: str) -> UsageError:
    names = names_of(text)
    counts = {name: int(np.count_nonzero(_is_valid(test, name))) for name in names}
    together = int(np.count_nonzero(np.logical_and.reduce([_is_valid(test, name) for name in names])))
    each = ", ".join(f"{n} valid in {k} of {len(test.t_s)} samples" for n, k in counts.items())
    if together:
        got, hint = f"{each}, and no number comes of them", "divide by nothing that stays zero"
    else:
        got = each if not all(counts.values()) else f"{each}, and never at once"
        hint = "thermodata quality tells which samples are flagged, and why"
    return UsageError(
        f"the driver '{text}' has no valid sample in test '{test.campaign}/{test.test}'",
        where=where + ("" if text.isidentifier() else f", expression '{text}'"),
        expected="a number at one time at least",
        got=got,
        hint=f"{hint}; where the effect does not act, name the tests in which it does: tests: [...]",
    )


def prepare(raw: Float1D, good: Bool1D, step: float, relative: bool, *, held: bool = False) -> tuple[Float1D, Bool1D]:
    """Gaps filled by straight lines (ends held), counted from the start; and where the filling is short enough. held:
    the value before a gap stands through it."""
    if not good.any():
        raise UsageError(
            "a driver has no valid sample",
            hint="'thermodata quality' says why its samples don't count; leave the test out of the fit, "
            "or the effect out of the model",
        )
    index = np.arange(len(raw))
    known = index[good]
    if good.all():
        filled, near = raw.copy(), good
    else:
        before = known[np.clip(np.searchsorted(known, index, side="right") - 1, 0, None)]
        filled = raw[before] if held else np.interp(index, known, raw[good])
        after = known[np.clip(np.searchsorted(known, index), None, len(known) - 1)]
        reach = np.maximum(np.abs(index - before), np.abs(after - index)) * step
        near = good | (reach <= FILL_S)
    if relative:
        filled = filled - start_value(raw[good], step)
    return filled, near


def start_value(values: Float1D, step: float) -> float:
    """The value at the start: a mean over the first minutes as long as it does not move more than its noise.

    A longer mean of a temperature that already rises would put the lag out of balance by that much. Where it moves
    from the first samples on, a line through them goes back half a step: a sample is the mean of its bin, and the
    test starts at the bin's start.
    """
    if len(values) < 3:
        return float(values[0])
    cycle = cycle_mean(values[: int(CYCLE_S / step) + 1])
    if cycle is not None:
        return cycle
    count = _still(values, step)
    if count < 3:
        return float((13.0 * values[0] + 4.0 * values[1] - 5.0 * values[2]) / 12.0)
    return float(values[:count].mean())


def start_deviation(values: Float1D, step: float) -> float:
    """The standard deviation of `start_value`, by the values' own noise, and by how far they went meanwhile; 0 where
    nothing tells it.

    A mean lies from the start by half of what the values went while it lasted. A line through them says how much that
    is, and errs in its square by its own variance.
    """
    if len(values) < 4 or cycle_mean(values[: int(CYCLE_S / step) + 1]) is not None:
        return 0.0
    count, noise = _still(values, step), _noise(values)
    if count < 3:
        return noise * BACK
    since = np.arange(count) - (count - 1) / 2.0
    went = float(since @ values[:count] / (since @ since)) * count / 2.0
    of_noise = (count / 2.0) ** 2 * noise**2 / float(since @ since)
    return float(np.sqrt(noise**2 / count + max(0.0, went**2 - of_noise)))


def _still(values: Float1D, step: float) -> int:
    """Samples from the start on that lie within their noise."""
    most = min(most_bins(step), len(values))
    within = still_within(values)
    count = 1
    while count < most and abs(values[count] - values[:count].mean()) <= within:
        count += 1
    return count


def most_bins(step: float) -> int:
    """Of how many samples the value at the start is a mean, at most."""
    return max(3, int(START_S / step))


def still_within(values: Float1D) -> float:
    """How far a sample lies from a mean by noise alone."""
    return 3.0 * _noise(values) + 1e-12


def cycle_mean(values: Float1D) -> float | None:
    """The mean of a driver that goes up and down from the start (a chiller): its balance is not where the record
    happened to cut its cycle. None for one that starts at an end of its range: there the start is a start."""
    if len(values) < 8:
        return None
    low, high, mean = float(values.min()), float(values.max()), float(values.mean())
    span = high - low
    inside = low + EDGE * span < values[0] < high - EDGE * span
    if not inside or span < 2.0 / EDGE * _noise(values):
        return None
    sides = np.sign(values - mean) * (np.abs(values - mean) > BAND * span)
    turns = int(np.count_nonzero(np.diff(sides[sides != 0])))
    return mean if turns >= TURNS else None


def _noise(values: Float1D) -> float:
    """Standard deviation of white noise on something smooth."""
    bends = np.diff(values, n=2) if len(values) > 3 else np.zeros(1)
    return 1.4826 * float(np.median(np.abs(bends))) / float(np.sqrt(6.0))


def step_s(test: TestData) -> float:
    """The grid's step [s]."""
    return step_between(test.t_s)


def _is_valid(test: TestData, name: str) -> Bool1D:
    valid = test.valid.get(name)
    finite = np.isfinite(test.values[name])
    return finite if valid is None else finite & valid


def _quantity(test: TestData, name: str) -> str:
    info = test.channels.get(name)
    return info.quantity if info else ANY


def _is_held(test: TestData, text: str) -> bool:
    """Whether all channels of a driver are held between their rows."""
    infos = [test.channels.get(name) for name in names_of(text)]
    return all(info is not None and (info.held or info.quantity in STATES) for info in infos)


def _unit(test: TestData, name: str) -> str:
    info = test.channels.get(name)
    return info.unit if info else ""
