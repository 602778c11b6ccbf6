"""Renders the quality of a campaign's tests as one HTML page that needs nothing beside it."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING, Any

from thermodata.report.page.write import page_values, write_page
from thermodata.report.quality.data import TestQuality, Trace, collect
from thermodata.report.quality.figure import SEVERITY, draw_test, span_text
from thermodata.report.words.causes import Cause, by_cause
from thermodata.report.words.numbers import clock, duration, typeset
from thermodata.schema.flag import INVALID, OVERRULED, Flag
from thermodata.schema.words.sentences import counted, with_count
from thermodata.store.tidy.flags.measured.not_measuring import ONLY
from thermodata.view.lists.alike import Alike, folded
from thermodata.view.lists.events import Flagged

if TYPE_CHECKING:
    from thermodata.view import StoreView

_MOST_CHANNELS = 3  # that are named of those that are alike
_WORST_FIRST = [f.word for f in reversed(SEVERITY)]
_INFORMATION = {f.word for f in Flag if f and not f & INVALID}


def build_quality_report(view: StoreView, campaign: str | None, out: Path | str) -> Path:
    """Writes the page of a campaign (the store's only one where None) to `out`; a cut write leaves no half page."""
    return write_page(out, render(collect(view, campaign)))


def render(tests: Sequence[TestQuality]) -> str:
    """The page's HTML. Names and texts from data are escaped; figures stand in it as JSON."""
    import jinja2

    own = files("thermodata.report.quality")
    environment = jinja2.Environment(autoescape=True, trim_blocks=True, lstrip_blocks=True)
    pictures = {f"test{i}": draw_test(t) for i, t in enumerate(tests)}
    shown = [_shown(t, f"test{i}") for i, t in enumerate(tests)]
    used = {name for row in shown for name, _ in row["counts"]} | {
        n for t in tests for trace in t.traces for n in _names(trace)
    }
    return environment.from_string((own / "page.html.j2").read_text(encoding="utf-8")).render(
        campaign=tests[0].campaign if tests else "no tests",
        tests=shown,
        legend=[n for n in _WORST_FIRST if n in used],
        headline=headline(tests),
        sentences=sentences(tests),
        **page_values(pictures),
    )


def headline(tests: Sequence[TestQuality]) -> str:
    """The page's first sentence: how much does not count, and why most of it."""
    samples = sum(t.samples for test in tests for t in test.traces)
    idle = sum(t.idle for test in tests for t in test.traces)
    flagged = idle + sum(t.flagged for test in tests for t in test.traces)
    if not samples:
        return "No samples"
    reasons = Counter({Flag.NOT_MEASURING.word: idle})
    for test in tests:
        for event in test.events:
            if event["flag"] not in _INFORMATION and not _overruled(event) and event["detail"] != ONLY:
                reasons[event["flag"]] += event["n"] or 0
    if not flagged:
        return f"All of {count(samples)} samples in {counted(len(tests), 'test')} count"
    why = ", ".join(name.replace("_", " ") for name, n in reasons.most_common(3) if n)
    return f"{share(flagged, samples)} of {count(samples)} samples do not count" + (f": {why}" if why else "")


def sentences(tests: Sequence[TestQuality]) -> list[str]:
    """What a reader must know first: lost data, sensors that failed, clocks."""
    said = []
    lost = [t.test for t in tests if t.losses]
    if lost:
        said.append(f"Data were lost in {', '.join(lost[:6])}{' and others' if len(lost) > 6 else ''}: see below.")
    for flag, words in (
        ("foreign", "with a part of another recording"),
        ("offset", "stepped against what came before"),
        ("stuck", "stuck at one value"),
        ("held", "frozen for a while"),
        ("clock_suspect", "with a suspect clock"),
    ):
        where = {
            (e["channel"] or e["source"] or "all channels"): t.test
            for t in reversed(tests)
            for e in t.events
            if e["flag"] == flag and not _overruled(e)
        }
        if where:
            named = ", ".join(f"{channel} (from {test})" for channel, test in list(where.items())[:5])
            more = " …" if len(where) > 5 else ""
            thing = "source" if flag in ("clock_suspect", "foreign") else "channel"
            said.append(f"{len(where)} {thing}{'' if len(where) == 1 else 's'} {words}: {named}{more}.")
    said += [
        f"{len(cause.members)} overruled by the campaign file: {cause.text}."
        for cause in by_cause(
            [(t, e) for t in tests for e in t.events if _overruled(e)],
            lambda x: f"{x[1]['channel'] or 'all channels'} ({x[0].test}, {x[1]['flag']}): {_reason(x[1])}",
            {t.test for t in tests} | {str(e["channel"]) for t in tests for e in t.events},
        )
    ]
    return said


def _overruled(event: Mapping[str, Any]) -> bool:
    return bool((event["detail"] or "").startswith(OVERRULED))


def _reason(event: Mapping[str, Any]) -> str:
    return str(event["detail"])[len(OVERRULED) :].partition(" (was: ")[0]


def share(part: int, whole: int) -> str:
    """'0.31 %', '14 %'; 'none' for none."""
    if not part or not whole:
        return "none" if whole else "-"
    percent = 100 * part / whole
    return f"{percent:.0f} %" if percent >= 9.95 else f"{percent:.2g} %"


def count(n: int) -> str:
    """'4.1 M', '12.3 k', '870'."""
    for size, letter in ((1_000_000, "M"), (1_000, "k")):
        if n >= size:
            return f"{n / size:.3g}\u00a0{letter}"
    return str(n)


def _counted(cause: Cause[str]) -> str:
    return f"{len(cause.members)} times: {cause.text}" if len(cause.members) > 1 else cause.text


def _names(trace: Trace) -> set[str]:
    import numpy as np

    seen = int(np.bitwise_or.reduce(trace.flags)) if len(trace.flags) else 0
    return {f.word for f in Flag if f and seen & f}


def _shown(test: TestQuality, key: str) -> dict[str, Any]:
    samples, idle = sum(t.samples for t in test.traces), sum(t.idle for t in test.traces)
    flagged = idle + sum(t.flagged for t in test.traces)
    counts = Counter(e["flag"] for e in test.events if not _overruled(e))
    worst = sorted((t for t in test.traces if t.flagged), key=lambda t: -t.flagged)[:3]
    return {
        "idle": f", {'all of them' if idle == flagged else share(idle, samples)} while not measuring" if idle else "",
        "key": key,
        "test": test.test,
        "kind": test.kind,
        "length": duration(test.duration_s),
        "samples": count(samples),
        "share": share(flagged, samples),
        "counts": [(n, counts[n]) for n in _WORST_FIRST if n in counts],
        "losses": [_counted(c) for c in by_cause(test.losses, str)],
        "worst": [f"{t.name} {share(t.flagged, t.samples)}" for t in worst],
        "total": len(test.events),
        "events": [_alike(a) for a in folded(map(Flagged.of_row, test.events))],
    }


def _alike(one: Alike) -> dict[str, Any]:
    """A row of the table: what is alike, and each stretch of it where there are several."""
    several = len(one.stretches) > 1
    each = [(_when(s), s.n, typeset(s.detail)) for s in one.stretches] if several else []
    return {
        "flag": one.flag,
        "channel": with_count(one.channels, _MOST_CHANNELS) or f"all of {one.source or 'the test'}",
        "when": span_text(*(None if math.isnan(at) else at for at in (one.from_s, one.to_s))),
        "stretches": len(one.stretches),
        "total": duration(one.total_s),
        "n": count(one.n) if one.n else "-",
        "detail": typeset(one.details[0]) if one.details else "-",
        "reasons": len(one.details),
        "each": each,
    }


def _when(one: Flagged) -> str:
    return "the whole test" if math.isnan(one.from_s) else f"{clock(one.from_s)} to {clock(one.to_s)}"
