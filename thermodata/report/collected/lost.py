"""Tests that a version of a model predicts no more, in a sentence: what is compared is without them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING

from thermodata.modelling.compare.common import lost_tests, on_common, predicted
from thermodata.schema.words.sentences import counted, listed, with_count

if TYPE_CHECKING:
    from thermodata.report.collected.data import Version
    from thermodata.schema.answers.result import Check, Score

_NAMED = 6  # tests that a sentence names


def lost_sentence(before: Iterable[Score], after: Iterable[Score], checks: Iterable[Check] = ()) -> str:
    """'2 of 6 tests are lost, ...; errors are over the 4 that both versions predict'; '' where none is lost."""
    before, after = list(before), list(after)
    shared = {s.response for s in after}
    lost = [t for t in lost_tests(before, after, checks) if t.response in shared or not shared]
    if not lost:
        return ""
    had = {key[:2] for key in predicted(before)}
    names = list(dict.fromkeys(f"{t.campaign}/{t.test}" for t in lost))
    whose = dict.fromkeys(t.response for t in lost)
    of = f" for {' and '.join(whose)}" if len(whose) < len({s.response for s in before}) else ""
    left = len({key[:2] for key in predicted(on_common([before, after])[0])})
    why = list(dict.fromkeys(t.why for t in lost if t.why))
    do, them = ("is", "it") if len(names) == 1 else ("are", "them")
    return (
        f"{len(names)} of {counted(len(had), 'test')} {do} lost{of}, for this version does not predict {them}: "
        f"{_some(names)}"
        + (f" ({'; '.join(why[:2])})" if why else "")
        + "; "
        + (f"before and after are over the {left} that both predict" if left else "nothing is left to compare")
    )


def lost_of_chain(versions: Sequence[tuple[str, Sequence[str], int]], compared: int) -> str:
    """The same of a chain, '' where all versions predict the same tests. versions: (what it is called, the tests that
    it lost, how many it predicts); compared: how many all of them predict."""
    if all(tests == compared for _, _, tests in versions):
        return ""
    lost = [
        f"{counted(len(names), 'test')} lost with {called}: {_some(names)}" for called, names, _ in versions if names
    ]
    over = (
        f"the {counted(compared, 'test')} that all versions predict"
        if compared
        else "none: no test is predicted by all"
    )
    return "; ".join([*lost, f"errors are over {over}"])


def results_gone_of_chain(versions: Sequence[tuple[str, Sequence[str]]]) -> str:
    """Which tests were forgotten after the fits of versions, whose errors are without them; '' where none was.
    versions: (id, such tests)."""
    of: dict[tuple[str, ...], list[str]] = {}
    for model, names in versions:
        if names:
            of.setdefault(tuple(names), []).append(model)
    return "; ".join(
        f"{_some(names)} {'was' if len(names) == 1 else 'were'} forgotten after the fit of {listed(models)}: errors "
        f"are without {'it' if len(names) == 1 else 'them'}, thermodata fit takes in again what is back"
        for names, models in of.items()
    )


def lost_of_versions(versions: Sequence[Version], label: Callable[[Version], str]) -> str:
    """The same of versions as a page has them."""
    return lost_of_chain([(label(v), v.lost, v.tests) for v in versions], versions[-1].compared if versions else 0)


def lost_of_compared(models: Mapping[str, Sequence[Score]]) -> str:
    """Of models beside each other: what only some of them predict; '' where all predict the same. models: label ->
    scores."""
    known = {label: {key[:2] for key in predicted(scores)} for label, scores in models.items()}
    common = {key[:2] for scores in on_common(list(models.values())) for key in predicted(scores)}
    every = dict.fromkeys(key for tests in known.values() for key in tests)
    if all(key in common for key in every):
        return ""
    told = []
    for label, tests in known.items():
        if names := [f"{c}/{t}" for c, t in every if (c, t) not in tests]:
            told.append(f"{label} predicts {len(names)} of {counted(len(every), 'test')} not: {_some(names)}")
    over = f"the {len(common)} that all of them predict" if common else "none: no test is predicted by all"
    return "; ".join([*told, f"errors are over {over}"])


def _some(names: Sequence[str]) -> str:
    return with_count(names, _NAMED, ", and")
