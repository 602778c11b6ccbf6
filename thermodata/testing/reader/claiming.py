"""Checks: how a reader is made, and which files it claims."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from thermodata.plugin import Head, Reader, Source
from thermodata.reader.finding.registry import readers
from thermodata.testing.impostors import impostors
from thermodata.testing.reader.case import Case, fault, head


def it_is_made_without_arguments_and_has_a_name(case: Case) -> None:
    try:
        reader = case.make()
    except TypeError as error:
        fault(
            f"not made without arguments: {error}",
            "give __init__ no arguments; what a user may choose comes in `source.options`",
        )
    if not isinstance(reader, Reader):
        missing = [n for n in ("name", "sniff", "describe", "blocks") if not hasattr(reader, n)]
        fault(f"no reader: {', '.join(missing)} missing", "add them; thermodata.plugin.Reader states their signatures")
    if not isinstance(reader.name, str) or not reader.name:
        fault(f"its name is {reader.name!r}", "set `name` on the class to the name of its entry point")


def it_claims_its_own_file_and_says_why(case: Case, path: Path, source: Source) -> None:
    reason = case.make().sniff(head(path))
    if reason is None:
        fault(
            f"{path.name}: not claimed",
            "let sniff return a reason for this file's first bytes; `head.start` holds "
            "at most 64 KiB, `head.size_bytes` is the whole file's",
        )
    if not isinstance(reason, str) or len(reason) <= 3:
        fault(
            f"{path.name}: the reason is {reason!r}",
            "return a few words that a user understands, such as 'starts with FOO1'",
        )


def it_claims_no_file_of_another_format(case: Case) -> None:
    reader = case.make()
    gives_way = bool(getattr(reader, "gives_way", False))
    for name, start in impostors(reader).items():
        if name.split(" ")[0] in case.claims:
            continue
        suffix = case.files[0][0].suffix if case.files else ".dat"
        for size in (len(start), 10_000_000):
            head = Head(f"file{suffix}", size, start)
            reason = reader.sniff(head)
            if reason is not None and not (gives_way and _another_claims(reader, head)):
                fault(
                    f"claims a file of {name}: {reason}",
                    f"sniff by content (a magic word, a header line), never by the suffix '{suffix}' alone; where "
                    f"{name.split(' ')[0]} is this reader's own format, pass claims=({name.split(' ')[0]!r},); where "
                    "it is a general one, which reads what no other reader claims, set `gives_way = True` on its class",
                )


def _another_claims(reader: Reader, head: Head) -> bool:
    return any(name != reader.name and each.sniff(head) is not None for name, each in readers().items())


def a_sniff_survives_any_head(case: Case, path: Path, source: Source) -> None:
    reader, whole = case.make(), head(path)
    rng = np.random.default_rng(0)
    for n in sorted({0, 1, 2, 3, 4, 7, 16, 27, 28, 100, 1000, len(whole.start) // 2}):
        for start in (whole.start[:n], whole.start[:n] + rng.bytes(200), rng.bytes(n)):
            try:
                reason = reader.sniff(Head(path.name, len(start), start))
            except Exception as error:
                raise AssertionError(
                    f"sniff raised {error!r} at a head of {len(start)} bytes\ntry: return None for what is not "
                    "yours; look at the length of `head.start` before unpacking or decoding it"
                ) from error
            if reason is not None and not isinstance(reason, str):
                fault(f"sniff returned {type(reason).__name__}", "return the reason as text, or None")
