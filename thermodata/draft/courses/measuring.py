"""When a test measures, told from its recording: probes that leave their range exactly while an axis is elsewhere or
feeds, or a state says so, as with a spindle that meets its probes once a cycle."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.files.sample import Course
from thermodata.draft.times.clocks import Named
from thermodata.plugin import Bool1D, Float1D

_LEAST = 0.02  # of the samples out of range, and in it
_AGREES = 0.99  # of the samples
_FEWEST = 50
Key = tuple[str, str]


def rule_of(files: Sequence[RawFile], named: Mapping[int, Named]) -> str | None:
    """`measuring:` of a test; None where the probes stay in range, or nothing moves with them.

    named: id of a file -> (stream, signal) -> (quantity, place, channel).
    """
    for file in files:
        courses = {k: c for k, c in file.sample.courses.items() if k in named.get(id(file), {})}
        names = named.get(id(file), {})
        probes = [k for k in courses if names[k][0] == "displacement" and names[k][1] == "tcp"]
        for probe in probes:
            out = _out_of_range(courses[probe].values)
            if out is None:
                continue
            for way in (_by_state, _by_position, _by_feed):
                if (found := way(courses, names, probe, out)) is not None:
                    return found
    return None


def _out_of_range(x: Float1D) -> Bool1D | None:
    """Where a probe has no reading, or stands at an end of its range; None where it does so never, or nearly always."""
    none = ~np.isfinite(x)
    out = none.copy()
    fine = x[~none]
    if x.size < _FEWEST or not fine.size:
        return None
    span = float(np.ptp(fine))
    rails: list[tuple[float, Bool1D]] = []
    for end in (float(fine.min()), float(fine.max())):
        at_end = ~none & (np.abs(x - end) <= 1e-3 * span)
        rest = fine[np.abs(fine - end) > 1e-3 * span]
        # a rail is one reading again and again, and far from all others
        if rest.size and at_end.mean() > _LEAST and np.abs(rest - end).min() > 0.2 * span:
            rails.append((np.unique(x[at_end]).size / at_end.sum(), at_end))
    # a machine at rest stays near one reading too, beside a rail: the rail is the end that repeats it more exactly
    rails.sort(key=lambda rail: rail[0])
    if len(rails) == 2 and rails[0][1].sum() + rails[1][1].sum() == fine.size and rails[0][0] < rails[1][0]:
        rails.pop()
    for _, at_end in rails:
        out |= at_end
    return out if _LEAST < out.mean() < 1 - _LEAST else None


def _beside(courses: Mapping[Key, Course], probe: Key, other: Key) -> Float1D | None:
    """Another signal at the probe's times: its own rows, or what held then. Shape (n,)."""
    one, two = courses[probe], courses[other]
    if one.t_ns.size == two.t_ns.size and bool((one.t_ns == two.t_ns).all()):
        return two.values
    if not two.t_ns.size:
        return None
    at = np.clip(np.searchsorted(two.t_ns, one.t_ns, side="right") - 1, 0, two.t_ns.size - 1)
    return np.asarray(two.values[at])


def _by_state(courses: Mapping[Key, Course], names: Named, probe: Key, out: Bool1D) -> str | None:
    for key in courses:
        if names[key][0] != "state" or (x := _beside(courses, probe, key)) is None:
            continue
        for level in np.unique(x[np.isfinite(x)])[:8]:
            if _agree(x == level, ~out):
                return f"{names[key][2]} == {level:g}"
    return None


def _by_position(courses: Mapping[Key, Course], names: Named, probe: Key, out: Bool1D) -> str | None:
    for key in courses:
        if names[key][0] != "position" or (x := _beside(courses, probe, key)) is None:
            continue
        inside, beyond = x[~out & np.isfinite(x)], x[out & np.isfinite(x)]
        if not inside.size or not beyond.size:
            continue
        middle = float(np.median(inside))
        near = float(np.quantile(np.abs(inside - middle), 0.995))
        far = float(np.quantile(np.abs(beyond - middle), 0.01))
        if far <= 2 * near or far <= 0:
            continue
        limit = float(f"{np.sqrt(max(near, 1e-3 * far) * far):.2g}")
        if _agree(np.abs(x - middle) < limit, ~out):
            return f"abs({names[key][2]} - {middle:.6g}) < {limit:g}"
    return None


def _by_feed(courses: Mapping[Key, Course], names: Named, probe: Key, out: Bool1D) -> str | None:
    """A feed that is 0 exactly while the probe has a reading, whatever its unit."""
    for key in courses:
        if names[key][0] == "feed" and (x := _beside(courses, probe, key)) is not None and _agree(x == 0, ~out):
            return f"{names[key][2]} == 0"
    return None


def _agree(rule: Bool1D, measured: Bool1D) -> bool:
    return bool((rule == measured).mean() >= _AGREES)
