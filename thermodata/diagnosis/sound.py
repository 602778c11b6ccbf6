"""What a diagnosis asks of: the open tests as far as they are sound, clocks put right and turned probes left out.

Nothing is changed but in what is asked: each fault is said, and the log stays as it is until somebody declares it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

from thermodata.diagnosis.candidates.basis import Means
from thermodata.diagnosis.clocks.by_commands import timings
from thermodata.diagnosis.clocks.by_heat import as_artefact as by_heat
from thermodata.diagnosis.clocks.by_heat import late_in_one, late_logs
from thermodata.diagnosis.clocks.declared import Declared
from thermodata.diagnosis.clocks.ends_of_logs import UNKNOWN, Ends, is_alike, meets
from thermodata.diagnosis.clocks.logs_compared import Logs, compared
from thermodata.diagnosis.clocks.moves import with_clocks_right
from thermodata.diagnosis.clocks.sides import in_order
from thermodata.diagnosis.clocks.timings import Timing, as_artefact
from thermodata.diagnosis.locked.confirm import on_all_open
from thermodata.diagnosis.question.compressed import compressed
from thermodata.diagnosis.question.once import as_artefacts, each_once
from thermodata.diagnosis.question.problem import TARGET_ROWS, Problem
from thermodata.diagnosis.sensors.turned import turned_probes
from thermodata.diagnosis.steps import repeating
from thermodata.diagnosis.steps.artefact import find_steps
from thermodata.diagnosis.steps.fitted_beside import fitted_beside, levelled
from thermodata.diagnosis.steps.step import Step
from thermodata.modelling.fit.model import fit_model
from thermodata.modelling.terms.fitted import FittedModel
from thermodata.plugin import Effect
from thermodata.schema.answers.diagnosis import Artefact, ClockMoved, PutRight
from thermodata.schema.files.model import Model
from thermodata.view.grid.dataset import Dataset, TestData


@dataclass(frozen=True, slots=True)
class Sound:
    """spec, fitted: the model, calibrated on `tests`. data: clocks that are off moved. tests: open, and sound. faults:
    as they are told. put_right: what was mended or left out. fine: the response in as many samples as there are, where
    it was asked so already, and steps: its own, where they were. means: what candidates do in the tests
    (`basis.sharing`). level: the data without the slips of the response; None where it has none."""

    spec: Model
    fitted: FittedModel
    data: Dataset
    tests: tuple[TestData, ...]
    faults: tuple[Artefact, ...] = ()
    put_right: PutRight = field(default_factory=PutRight)
    fine: Problem | None = None
    steps: tuple[Step, ...] | None = None
    means: Means = field(default_factory=dict, repr=False)
    level: Dataset | None = None


def beside_slips(found: Sound, index: int) -> Sound:
    """With the response's effects as they are beside its slips, for what is asked of it. What a fit or `add` makes of
    the model is not changed by that: it has the slips until somebody declares them."""
    if not found.tests:
        return found
    response = found.fitted.responses[index]
    fine = found.fine or compressed(response, found.data, found.tests, TARGET_ROWS)
    every = find_steps(fine)
    steps = repeating.single(every)
    if not steps:
        return replace(found, fine=fine, steps=tuple(every))
    level = levelled(steps, response.bound, found.data)
    return replace(found, fitted=fitted_beside(level, found.fitted, found.spec, index), fine=None, level=level)


def told(put_right: PutRight) -> PutRight | None:
    """What was put right; None where nothing was."""
    return put_right if put_right != PutRight() else None


def sound(
    fitted: FittedModel,
    index: int,
    data: Dataset,
    tests: Sequence[TestData],
    library: Mapping[str, Effect],
    ends: Ends = UNKNOWN,
) -> Sound:
    """index: of the response among the model's responses. tests: open ones that can be predicted. ends: how the logs
    begin and end beside each other.

    All of them take part: gains that only a verification test excites must not be guesses.
    """
    data, tests, repeated = each_once(data, tests, fitted.responses[index].bound.channel_of)
    found = replace(_fitted_to(fitted, data, tests), faults=tuple(as_artefacts(repeated)))
    if not tests:
        return _with_ends_told(found, index, ends)
    asked, found = found, _clocks_right(_with_ends_right(found, index, ends), index, ends)
    if ends.is_met(found.put_right.clocks):  # heat tells of one test what the ends of the logs tell of all of them
        found = _clocks_right(_with_ends_right(asked, index, ends, met=found.put_right.clocks), index, ends)
    found = _with_ends_told(found, index, ends)
    turned = turned_probes(found.fitted.responses[index], found.data, found.tests, library, found.means)
    if not turned:
        return found
    wrong = {(a.campaign, a.test) for a in turned}
    upright = [t for t in found.tests if (t.campaign, t.test) not in wrong]
    return replace(
        _fitted_to(fitted, found.data, upright),
        faults=(*found.faults, *turned),
        put_right=found.put_right.model_copy(update={"left_out": sorted(wrong)}),
    )


def _fitted_to(fitted: FittedModel, data: Dataset, tests: Sequence[TestData]) -> Sound:
    """As it is fitted where there are no tests."""
    spec = on_all_open(fitted.spec, tests, fitted.tests(data, "locked"))
    return Sound(spec, fit_model(spec, data, uncertainty=False) if tests else fitted, data, tuple(tests))


def _with_ends_right(found: Sound, index: int, ends: Ends, met: Sequence[ClockMoved] = ()) -> Sound:
    """By how logs begin and end beside each other, which is exact, where heat bears it out. met: what heat alone moved,
    a test each."""
    response, data = found.fitted.responses[index].name, found.data
    alike = ends.moves(data.channels[response].source)
    if not alike:
        return found
    logs = compared(found.tests, data.channels, response, data.step_s)
    borne_out = [some for some in alike if meets(some, met) or logs.bears_out(some)]
    clocks = [move for some in alike if some in borne_out or any(is_alike(some, o) for o in borne_out) for move in some]
    return _with_clocks_moved(found, clocks) if clocks else found


def _with_ends_told(found: Sound, index: int, ends: Ends) -> Sound:
    """With what the ends of the logs say, once it is known what was moved."""
    home = found.data.channels[found.fitted.responses[index].name].source
    return replace(found, faults=(*found.faults, *ends.artefacts(home, found.put_right.clocks)))


def _with_clocks_moved(found: Sound, clocks: Sequence[ClockMoved]) -> Sound:
    """With further clocks moved."""
    keys = {t.key for t in found.tests}
    data = with_clocks_right(found.data, clocks)
    right = _fitted_to(found.fitted, data, [t for t in data.tests if t.key in keys])
    every = [*found.put_right.clocks, *clocks]
    return replace(right, faults=found.faults, put_right=PutRight(clocks=every))


def not_refuted(off: Sequence[Timing], logs: Logs) -> list[Timing]:
    """Without clocks of single tests that heat says are right there. Of one that is off in all tests heat is asked once
    it is moved."""
    in_all = {t.source for t in off if not t.test}
    return [t for t in off if not t.test or t.source in in_all or not logs.comes_as_logged(t.source, t.key, t.shift_s)]


def _clocks_right(found: Sound, index: int, ends: Ends) -> Sound:
    """By what commands move at once; then, by heat, of the logs that no such command is in."""
    response, keys = found.fitted.responses[index], {t.key for t in found.tests}
    problem = compressed(response, found.data, found.tests, TARGET_ROWS)
    known = timings(problem, found.data.channels)
    word = Declared.of(found.data, response.name)
    by_ends: dict[tuple[str, str], frozenset[str]] = {}
    for c in found.put_right.clocks:
        by_ends[c.campaign, c.test] = by_ends.get((c.campaign, c.test), frozenset()) | {c.source}
    in_one = {key: (sources - word.of_all) | by_ends.get(key, frozenset()) for key, sources in word.in_one.items()}
    order = in_order([*found.tests, *found.fitted.tests(found.data, "locked")])
    off = [t for t in known.off(order, in_one) if t.source not in word.of_clock(t.campaign, t.test)]
    if any(t.test for t in off):  # heat is asked of single tests only, and takes its time
        off = not_refuted(off, compared(found.tests, found.data.channels, response.name, found.data.step_s))
    clocks = [move for t in off for move in t.moves()]
    home = {source} if (source := found.data.channels[response.name].source) else set()
    faults = [as_artefact(t, problem, bool(home) and ends.agree([t.key], {t.source} | home)) for t in off]

    data = with_clocks_right(found.data, clocks)
    tests = [t for t in data.tests if t.key in keys]
    locked = found.fitted.tests(data, "locked")
    logs = compared(tests, data.channels, response.name, data.step_s, locked=locked, declared=in_one)
    late = late_logs(logs, known.told)
    if not late and all(c.test for c in clocks):  # of a log that was moved in all tests the ends are not known
        agreed = {key: sources | ends.together.get(key, frozenset()) for key, sources in in_one.items()}
        late = late_in_one(replace(logs, declared=agreed), known.told_in_one)
        late = [one for one in late if not ends.agree(one.tests, {one.of.warmed, one.of.by})]
    late = [one for one in late if not word.settles(one)]
    faults += [by_heat(one, tests[0].campaign) for one in late]
    clocks += [move for one in late for move in one.moves()]
    found = replace(found, faults=(*found.faults, *faults), fine=problem)
    return _with_clocks_moved(found, clocks) if clocks else found
