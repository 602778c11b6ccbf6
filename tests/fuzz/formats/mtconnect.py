"""MTConnect stream documents: the agent's sequences tell what is missing, whatever is dropped, moved or cut."""

from __future__ import annotations

import random
import re
from dataclasses import replace

from tests.fuzz.formats.cnc_csv import ABSURD, common
from tests.fuzz.harness import Mutation, Seed
from tests.fuzz.mutations import edit_parts

READER = "cnc"
_NS = 'xmlns="urn:mtconnect.org:MTConnectStreams:2.{}"'


def _item(tag: str, name: str, sequence: int, value: str, more: str = "") -> str:
    time = f"2026-03-02T08:00:{sequence // 10:02d}.{sequence % 10}00Z"
    return f'<{tag} dataItemId="{name}" name="{name}" sequence="{sequence}" timestamp="{time}"{more}>{value}</{tag}>\n'


def _document(first: int, last: int, items: str, prefix: str = "") -> str:
    p = f"{prefix}:" if prefix else ""
    ns = f'xmlns:{prefix}="urn:mtconnect.org:MTConnectStreams:1.7"' if prefix else _NS.format(first % 4)
    body = re.sub(r"<(/?)(?=\w)", rf"<\1{p}", items) if prefix else items
    return (
        f'<?xml version="1.0" encoding="UTF-8"?>\n<{p}MTConnectStreams {ns}>\n<{p}Header instanceId="7" '
        f'firstSequence="1" lastSequence="{last}" nextSequence="{last + 1}"/>\n<{p}Streams><{p}DeviceStream name="M">'
        f'<{p}ComponentStream component="Rotary" name="C">\n<{p}Samples>\n{body}</{p}Samples>\n</{p}ComponentStream>'
        f"</{p}DeviceStream></{p}Streams></{p}MTConnectStreams>\n"
    )


def seeds() -> list[Seed]:
    def part(first: int, last: int) -> str:
        return "".join(_item("Temperature", f"T{s % 3}", s, str(20 + s / 8)) for s in range(first, last + 1))

    log = "".join(_document(s, s + 11, part(s, s + 11)) for s in range(1, 60, 12))
    prefixed = "".join(_document(s, s + 11, part(s, s + 11), "m") for s in range(1, 40, 12))
    rich = _document(
        1,
        12,
        _item("VariableDataSet", "v", 1, '<Entry key="a">1</Entry><Entry key="b">x</Entry>')
        + _item("OffsetTable", "w", 2, '<Entry key="G54"><Cell key="X">1</Cell></Entry>')
        + _item("AccelerationTimeSeries", "acc", 3, "1 2 3", ' sampleCount="3" sampleRate="100"')
        + part(4, 12)
        + "</Samples><Condition>"
        + _item("Fault", "servo", 13, "hot", ' nativeCode="7"')
        + "</Condition><Samples>",
    )
    return [Seed("log.xml", log.encode()), Seed("prefixed.xml", prefixed.encode()), Seed("rich.xml", rich.encode())]


def mutate(seed: Seed, rng: random.Random) -> Mutation:
    if (found := common(seed.data, rng, rows=False)) is not None:
        # a log of whole documents is one of what was sent until then
        whole = found.kind == "cut" and re.search(rb"</(?:m:)?MTConnectStreams>\s*$", found.data)
        return replace(found, well_formed=True) if whole else found
    data, what = seed.data, rng.randrange(6)
    if what == 0:
        documents = re.split(rb"(?=<\?xml)", data)[1:]
        done, kind = edit_parts(documents, rng)
        # the last of a log may be gone, and a moved one is put in order by its sequences or reported
        return Mutation(
            b"".join(done),
            f"document {kind}",
            False,
            (kind == "dropped" and done == documents[:-1]) or kind == "swapped",
        )
    if what == 1:
        lines = data.splitlines(keepends=True)
        done, kind = edit_parts(lines, rng)
        return Mutation(b"".join(done), f"line {kind}", False, True)
    if what == 2:
        items = [m.start() for m in re.finditer(rb"<(?:m:)?Temperature", data)]
        at = rng.choice(items)
        end = data.index(b"\n", at) + 1
        first, last = at == items[0], data.find(b"Temperature", end) < 0
        return Mutation(data[:at] + data[end:], "observation dropped", False, first or last or seed.name == "rich.xml")
    if what == 3:
        tags = [m.end() for m in re.finditer(rb">", data)]
        at = rng.choice(tags)
        junk = rng.choice(
            (
                b"<x>",
                b"</x>",
                b"<!-- c -->",
                b"&bomb;",
                b"<!DOCTYPE a [<!ENTITY b 'c'>]>",
                b"<![CDATA[x]]>",
                b"\0\0",
                b"<x/>",
                b"--boundary\r\n",
            )
        )
        return Mutation(data[:at] + junk + data[at:], "markup inserted", False, True)
    if what == 4:
        m = rng.choice(list(re.finditer(rb'(\w+)="([^"]*)"', data)))
        return Mutation(data[: m.start(2)] + rng.choice(ABSURD) + data[m.end(2) :], "attribute replaced", False, True)
    m = rng.choice(list(re.finditer(rb"</?[\w:]+", data)))
    return Mutation(data[: m.start()] + data[m.end() :], "tag dropped", False, True)
