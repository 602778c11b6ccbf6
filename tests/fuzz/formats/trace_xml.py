"""Sinumerik Trace XML: interpolator records are counted; a servo record that is gone changes only what is held, which
no count can tell."""

from __future__ import annotations

import random
import re

from tests.fuzz.formats.cnc_csv import ABSURD, common
from tests.fuzz.harness import Mutation, Seed
from tests.fuzz.mutations import edit_parts

READER = "cnc"


def _frame(rows: int, start: str, drops: int = 0, step: str = "0.002") -> str:
    recs = "".join(
        f'  <rec time="{k * 0.002:.6f}" f1="{k / 8}"'
        + (f' f2="{k * k}"' if k % 2 else "")
        + (f' f3="{k // 4}"/>\n' if k % 4 == 1 else "/>\n")
        for k in range(rows)
    )
    signals = "".join(
        f'  <dataSignal id="{key}" name="{name}" interval="{step if event == 255 else "0.008"}" event="{event}" '
        f'datapointCount="{count}" unitsType="posn" dataType="double"/>\n'
        for key, name, event, count in (
            ("f1", "/Nck/!SD/a [u1, 7]", 255, rows),
            ("f2", "/Nck/!SD/b [u1, 7]", 255, rows),
            ("f3", "/Nck/!SEMA/c [u1, 7]", 1, (rows + 2) // 4),
        )
    )
    return (
        f' <dataFrame>\n  <frameHeader startTime="{start}" dropOuts="{drops}" stopInc="{(rows - 1) * 0.002:.6f}"/>\n'
        + signals
        + recs
        + " </dataFrame>\n"
    )


def seeds() -> list[Seed]:
    def session(*frames: str) -> bytes:
        return (
            '<?xml version="1.0" encoding="utf-8" ?>\n<!--XML file by SINUMERIK-->\n<traceSession version="1">\n'
            '<traceCaptureSetup><signal name="x" key="s1"/></traceCaptureSetup>\n'
            f'<traceData dataFrames="{len(frames)}">\n{"".join(frames)}</traceData>\n</traceSession>\n'
        ).encode()

    return [
        Seed("one.xml", session(_frame(60, "2026-03-02T09:00:00.5Z"))),
        Seed("two.xml", session(_frame(30, "2026-03-02T09:00:00Z"), _frame(40, "2026-03-02T10:00:00Z"))),
        Seed("ms.xml", session(_frame(40, "2012-01-20T20:01:47.526Z", 0, "2"))),
    ]


def mutate(seed: Seed, rng: random.Random) -> Mutation:
    if (found := common(seed.data, rng, rows=False)) is not None:
        return found
    data, what = seed.data, rng.randrange(6)
    if what == 0:
        lines = data.splitlines(keepends=True)
        done, kind = edit_parts(lines, rng, 3)
        return Mutation(b"".join(done), f"line {kind}", False, True)
    if what == 1:
        m = rng.choice(list(re.finditer(rb'  <rec [^\n]* f3="[^\n]*\n', data)))
        return Mutation(data[: m.start()] + data[m.end() :], "counted record dropped", False, True)
    if what == 2:
        frames = list(re.finditer(rb" <dataFrame>.*?</dataFrame>\n", data, re.DOTALL))
        m = rng.choice(frames)
        return Mutation(data[: m.start()] + data[m.end() :], "frame dropped", False, False)
    if what == 3:
        at = rng.choice([m.end() for m in re.finditer(rb">", data)])
        junk = rng.choice(
            (b"<x>", b"</x>", b"<!-- c -->", b"&bomb;", b"<!DOCTYPE a [<!ENTITY b 'c'>]>", b"<x/>", b"\0")
        )
        return Mutation(data[:at] + junk + data[at:], "markup inserted", False, False)
    if what == 4:
        m = rng.choice(list(re.finditer(rb'(\w+)="([^"]*)"', data)))
        return Mutation(data[: m.start(2)] + rng.choice(ABSURD) + data[m.end(2) :], "attribute replaced", False, True)
    m = rng.choice(list(re.finditer(rb' (\w+)="([^"]*)"', data)))
    return Mutation(data[: m.start()] + data[m.end() :], "attribute dropped", False, True)
