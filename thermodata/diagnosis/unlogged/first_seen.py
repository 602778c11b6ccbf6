"""In words: what kind of body misses, when it is heated, and where a sensor would see it first."""

from __future__ import annotations

from collections.abc import Sequence

from thermodata.diagnosis.unlogged.goes_with import Companion
from thermodata.diagnosis.unlogged.missing_heat import TAUS_S, MissingHeat
from thermodata.diagnosis.verdict.suspect import NOTHING_SUPPOSED, Doubt, First, Supposed, Suspect
from thermodata.schema.words.sentences import in_percent
from thermodata.view.grid.dataset import TestData

SURE = 0.8  # of the draws of tests must agree
NAMED = 4
# [s]: what a lag of such a length is on a machine tool (docs/model.md, "Bounds of the effects")
SMALL_S, LARGE_S = 900.0, 5400.0

_DOUBTED = (
    "It may be no heat at all, for models of machines that lack nothing leave as much, and any course can be drawn as "
    "that of a body. If heat is missing, it is that of"
)
# what machines that lack nothing leave is foretold as well in parts that are left out, but goes both ways
_WEIGHED = (
    "Models of machines that lack nothing leave as much, but what they leave mostly goes both ways, while this goes "
    "one way in {share} of the draws of the tests, which speaks for heat"
)


def where(
    heat: MissingHeat,
    found: Sequence[Companion],
    strong: Sequence[TestData],
    weak: Sequence[TestData],
    supposed: Supposed = NOTHING_SUPPOSED,
    warm: tuple[str, str] | None = None,
) -> str:
    """A sentence or two; what the data can't say is said to be so. strong, weak: the tests in which it is strongest,
    and absent; warm: the key of the test at whose warm start the model fails most."""
    suspect, first = supposed.suspect, supposed.first
    told = _when_it_runs(found, [_test_in_words(t, heat) for t in strong], [_test_in_words(t, heat) for t in weak])
    said = [*_body_with_doubt(heat, supposed.doubt), told]
    strongest, is_warm = name_of(strong[0], heat), strong[0].key == warm
    if is_warm:
        said.append(_began_warm(strongest))
    if suspect is not None:
        # one channel alone says little for or against an effect of several, or of heat that it doesn't measure
        found = [c for c in found if c.info.name not in suspect.channels]
        said.append(suspect.told)
    elif first is not None:
        found = [c for c in found if c.verdict == "with" or c.info.name not in first.cause.channels]
    look_at = _to_look_at(strong[0], strongest, first, is_warm)
    # what ranks first may be the cause, whose heat comes by another way than one lag
    # a heat that goes both ways is never on or off, and is compared with temperatures alone
    channel = "channel" if heat.sign else "temperature"
    none = f"No logged {channel} {'goes with it' if first is None else 'has just its course'}"
    return ". ".join([*said, *_where_to_measure(found, none, look_at, suspect), *_doubt_of_direction(heat)])


def minutes(seconds: float) -> str:
    """'40 min', '2.7 h'."""
    return f"{seconds / 60:.0f} min" if seconds < 5400 else f"{seconds / 3600:.1f} h"


def _body_with_doubt(heat: MissingHeat, doubt: Doubt) -> list[str]:
    """The body, after the doubt whether there is any, or before it where its direction speaks against that doubt."""
    if doubt == "none":
        return [_capital(_body(heat))]
    if heat.sign and heat.agreed >= SURE:
        return [_capital(_body(heat)), _WEIGHED.format(share=in_percent(heat.agreed))]
    return [f"{_DOUBTED} {_body(heat)}"]


def _body(heat: MissingHeat) -> str:
    low, high = heat.tau_range_s
    size = "small and thin" if high < SMALL_S else "large and thick" if low > LARGE_S else ""
    if not size:
        size = (
            "of the size of a screw, a motor or a housing"
            if low >= SMALL_S / 2 and high <= 2 * LARGE_S
            else "of a size that these tests leave open"
        )
    least, most = TAUS_S[0], TAUS_S[-1]
    if low <= least and high >= most:
        span = "which these tests do not settle"
    elif low <= least:
        span = f"at most {minutes(high)}"
    elif high >= most:
        span = f"at least {minutes(low)}"
    else:
        span = f"{minutes(low)} to {minutes(high)}" if high > low else "in every draw of the tests"
    text = f"a body with a time constant of {minutes(heat.tau_s)} ({span}), {size}"
    if not heat.sign:
        return (
            f"{text}; it warms and cools from where it starts, as a body does that follows a temperature, or as the "
            "probes do where they drift"
        )
    return f"{text}, that moves the response to {'plus' if heat.sign > 0 else 'minus'} when it is heated"


def _when_it_runs(found: Sequence[Companion], strong: Sequence[str], weak: Sequence[str]) -> str:
    close = [c for c in found if c.verdict == "with" and c.on_with is not None]
    parts = []
    if close:
        parts.append("on while " + ", ".join(map(_how_often_it_runs, close[:NAMED])))
    parts.append("strongest in " + ", ".join(strong[:NAMED]))
    if weak:
        parts.append("absent in " + ", ".join(weak[:NAMED]))
    return _capital("; ".join(parts))


def _how_often_it_runs(one: Companion) -> str:
    then, other = (one.on_without, one.on_with) if one.is_inverse else (one.on_with, one.on_without)
    often = f"{in_percent(then or 0.0)} of that time, else {in_percent(other or 0.0)}"
    return f"{one.info.name} {'is off' if one.is_inverse else 'runs'} ({often})"


def _where_to_measure(found: Sequence[Companion], none: str, look_at: str, suspect: Suspect | None) -> list[str]:
    """Where a sensor would see it; beside a suspect, where else, for nothing has to be logged that it is. none: that
    nothing goes with it; look_at: what is to be looked at then."""
    near = _places([c for c in found if c.verdict == "with"])
    # the least alike first
    far = [p for p in _places([c for c in reversed(found) if c.verdict == "not"]) if p not in near]
    followed = [c.info.name for c in found if c.verdict == "with" and c.follows is not None]
    said = []
    if near:
        sensor = "If it is not, a" if suspect else "A"
        said.append(
            f"{sensor} sensor would see it first near {_joined_by_or(near)}"
            + (f" rather than near {_joined_by_or(far)}" if far else "")
        )
    elif suspect is None:
        said.append(
            f"{none}, so the data can't say where it is"
            # heat on its way through a machine looks unlike what is logged where it came from
            + (f"; least like it is what is logged near {_joined_by_or(far)}" if far else "")
            + look_at
        )
    elif far:
        said.append(f"Least like it is what is logged near {_joined_by_or(far)}")
    if followed:
        said.append(
            f"{', '.join(followed[:NAMED])} {'is' if len(followed) == 1 else 'are'} logged and already "
            f"{'goes' if len(followed) == 1 else 'go'} with it: try {'it' if len(followed) == 1 else 'them'} as a "
            "driver before a new sensor"
        )
    return said


def _began_warm(test: str) -> str:
    return (
        f"{test} is declared to start warm, and the model fails most at its start: what was warm before it began is in "
        "no log of it. So run it again from a cold start before anything is looked for"
    )


def _to_look_at(strongest: TestData, name: str, first: First | None, is_warm: bool) -> str:
    """What ranks first of what is logged; and where it doesn't act, what is not logged, unless it began warm. name: of
    the test."""
    unlogged = "" if is_warm else f"note what runs in {name} and is not logged"
    if first is None:
        return unlogged and f"; {unlogged}"
    one = first.cause
    if first.probability is not None:
        ranks = f"{one.id} is the likeliest of what is logged ({in_percent(first.probability)})"
    else:
        ranks = f"{one.id} comes nearest of what is logged (where it acts the error goes {first.error})"
    if strongest.key not in first.acts_in:
        return f"; {ranks}, but hardly acts in {name}{unlogged and f': {unlogged}'}"
    names, verb = " and ".join(one.channels), "is" if len(one.channels) == 1 else "are"
    return f"; {ranks} and acts in {name}: {names} {verb} to be looked at before anything that is not logged"


def _doubt_of_direction(heat: MissingHeat) -> list[str]:
    if not heat.sign or heat.agreed >= SURE:
        return []
    return [f"Only {in_percent(heat.agreed)} of the draws of the tests agree on the direction: more tests are needed"]


def _test_in_words(test: TestData, heat: MissingHeat) -> str:
    kind, name = test.kind.replace("_", " "), name_of(test, heat)
    return f"{name} ({kind})" if kind not in ("", "other", test.test) else name


def name_of(test: TestData, heat: MissingHeat) -> str:
    """campaign/test, where the tests are of several campaigns."""
    return "/".join(test.key) if len({c.test.campaign for c in heat.courses}) > 1 else test.test


def _places(found: Sequence[Companion]) -> list[str]:
    """Each place once, in the order of the channels; a channel without a place stands for itself."""
    return list(dict.fromkeys(c.info.at or c.info.name for c in found))


def _joined_by_or(names: Sequence[str]) -> str:
    shown = list(names[:NAMED])
    return shown[0] if len(shown) == 1 else f"{', '.join(shown[:-1])} or {shown[-1]}"


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]
