"""A draft as the text of a campaign file, with '# ?' at every question."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping, Sequence
from pathlib import PurePosixPath

from thermodata.draft.campaign.parts import DerivedChannel, Draft, DraftChannel, DraftJump, DraftSource, DraftTest
from thermodata.draft.campaign.two_campaigns import Campaigns
from thermodata.draft.probes.which_way import calibration_for
from thermodata.draft.writing.deleted import drafted_with
from thermodata.draft.writing.testsfrom import Pattern, pattern_of
from thermodata.schema.agreed.left_out import left_out

_PLACES = "at: where on the machine, e.g. spindle.bearing.front, axis.z.nut, column.rear, hall.top, floor"
_ROLES = "? role of each: calibration (fitted), verification (checked), locked (for the last word), none (kept only)"
_ALONE = (
    "one test leaves none to confirm by: of a long one make several, a line each, cut where all is at rest, as "
    "window: [0 h, 16 h], history: recording"
)
_WORDS = frozenset(("yes", "no", "on", "off", "true", "false", "null", "y", "n"))
_OPEN = "?"
_MOST_KINDS = 8
_NOBODY = (
    "? no reader claims any file here: export the logs as CSV (a line of names, a column called time, numbers), or say "
    "below what reads them; thermodata sniff FILE tells why, thermodata plugins what can be read"
)
_NOBODY_COULD = "? no file here could be read: '# not used' below says what stopped its reader"
_HEAD = """\
# Drafted by thermodata init. '# ?' marks what nobody but you knows: answer it in the line, then delete the mark.
# 'guess' is what names, units or values suggest; 'sure' is what they agree on. Where 'unknown' stands, nothing is read
# until you replace it. A line that begins with '#' is left out: fill in its '?' and delete that '#' to have it."""


def text_of(draft: Draft) -> str:
    """The whole campaign file; it loads as it stands."""
    lines = [
        _HEAD,
        "schema: thermodata/campaign/1",
        f"id: {scalar(draft.campaign)}",
        "machine:",
        f"  id: unknown                      # ? {_whose(draft.machines)}",
        "sources:"
        if draft.sources
        else f"sources: {{}}                        # {_NOBODY_COULD if draft.failed else _NOBODY}",
    ]
    lines += [_source(s) for s in draft.sources] or _sources_of_nobody(draft)
    lines.append(
        f"channels:   # {_PLACES}"
        if any(c.said.quantity for c in draft.channels)
        else "channels: {}                       # ? no signal whose quantity can be told"
    )
    lines += [_channel(c) for c in draft.channels]
    lines += [_derived(c) for c in draft.derived]
    lines += _speed_nobody_logged(draft)
    live = [j for j in draft.jumps if j.axis and j.signal]
    exported = [c for c in draft.channels if c.as_exported]
    lines += ["calibrations:"] if live or exported else []
    lines += [_as_exported(c) for c in exported]
    lines += [_jump(j) for j in draft.jumps]
    lines += _tests(draft)
    lines += [f"# damaged: {one_line(p)}: {one_line(why)}" for p, why in draft.damaged]
    lines += [left_out(one_line(p), one_line(why)) for p, why in draft.not_used]
    lines += [f"# note: {one_line(n)}" for n in draft.notes]
    return "\n".join([*lines, *drafted_with(draft)]) + "\n"


def _whose(machines: Campaigns) -> str:
    if machines.asked is not None:
        return one_line(f"{machines.asked}; else the machine's number")
    return "the machine's number" + (f": '{one_line(machines.machine)}', as logs call it?" if machines.machine else "")


def questions_in(text: str) -> int:
    """How many lines of a campaign file still hold a question."""
    return sum("# ?" in line for line in text.splitlines()) - ("# ?" in _HEAD)


def _source(s: DraftSource) -> str:
    parts: dict[str, object] = {"reader": s.reader}
    if s.files:
        parts["files"] = s.files
    if s.encoding:
        parts["encoding"] = s.encoding
    if s.timezone:
        parts["timezone"] = s.timezone
    if s.table:
        parts["table"] = s.table
    body = flow(parts)
    comments = [*s.told]
    asked = "; ".join(s.questions)
    if s.align:
        here, there = s.align.by
        clock = f"clock: {{align_to: {s.align.there}, by: [{{here: {here}, there: {there}}}]}}"
        if s.align.offset_s is None:
            asked = "; ".join(filter(None, (asked, f"{clock}? both logged it, but in {s.align.test}: {s.align.why}")))
        else:
            body += f", {clock}"
            comments.append(f"clock guess: {s.align.offset_s:+.1f} s in {one_line(s.align.test)}, by what both logged")
    said = "; ".join(filter(None, (f"? {asked}" if asked else "", *comments)))
    return f"  {s.name}: {{{body}}}" + (f"   # {one_line(said)}" if said else "")


def _sources_of_nobody(draft: Draft) -> list[str]:
    """A line for each kind of file, to be filled in by who knows what reads it."""
    kinds: dict[str, str] = {}
    failed, reasons = dict(draft.failed), dict(draft.not_used)
    for path in (*failed, *(path for path, _ in draft.not_used)):
        kinds.setdefault(PurePosixPath(path).suffix.lower() or PurePosixPath(path).name, path)
    lines = []
    for i, (kind, path) in enumerate(list(kinds.items())[:_MOST_KINDS], 1):
        if kind.startswith("."):
            asked = f"{'what is wrong with' if path in failed else 'what wrote'} {one_line(path)}?"
            keys = {"reader": failed.get(path, _OPEN), "files": "{test}" + kind}
            if "unpack it first" in reasons.get(path, ""):
                asked = (
                    f"{one_line(path)} is packed: unpack it and what is packed beside it, then thermodata init --force"
                )
            elif "an encoding that the file does not name" in reasons.get(path, ""):
                keys["encoding"] = _OPEN
                asked = f"in which encoding is {one_line(path)}? write it, delete the '#', then thermodata init --force"
            lines.append(f"  # {f'log{i}' if i > 1 else 'log'}: {{{flow(keys)}}}   # ? {asked}")
    return lines


def _channel(c: DraftChannel) -> str:
    said = c.said
    moves = said.quantity == "displacement" and said.at == "tcp"
    keys = {
        "source": c.source,
        "signal": c.signal,
        "quantity": said.quantity,
        "unit": said.unit,
        "instead_of": said.instead_of,
        "axis": said.axis,
        "at": said.at,
        "relative_to": "table" if moves else None,
        "calibration": c.calibration,
        "only_in": c.only_in if 0 < len(c.only_in) <= len(c.missing_in) else None,
        "missing_in": c.missing_in if len(c.missing_in) < len(c.only_in) else None,
    }
    notes = [
        said.comment(),
        f"stream {c.stream}" if c.stream else "",
        f"only in {', '.join(c.only_in[:5])}{' ...' if len(c.only_in) > 5 else ''}" if c.only_in else "",
        c.note or "",
    ]
    if said.quantity is None:
        keys |= {"quantity": _OPEN, "unit": said.unit or _OPEN}
    mark = "  " if said.quantity else "  # "
    return f"{mark}{c.name}: {{{flow(keys)}}}   # {one_line('; '.join(filter(None, notes)))}"


def _derived(c: DerivedChannel) -> str:
    keys = {"derive": c.derive, "quantity": c.quantity, "unit": c.unit, "at": c.at}
    return f"  {c.name}: {{{flow(keys)}}}   # proposed: {one_line(c.why)}"


def _speed_nobody_logged(draft: Draft) -> list[str]:
    """The spindle's speed as a channel that the names give, where no signal has it: left out, for nobody knows when it
    turned."""
    if any(c.said.quantity == "rotational_speed" for c in draft.channels):
        return []
    named = [t.id for t in draft.tests if {"speed", "schedule"} & t.conditions.keys()]
    if not named:
        return []
    return [
        "  # spindle_speed: {schedule: [[0 h, conditions.speed]], quantity: rotational_speed, unit: rpm, at: spindle}"
        f"   # ? nobody logged the speed that {one_line(named[0])} names: from when to when did it turn?"
    ]


def _as_exported(c: DraftChannel) -> str:
    """A probe that looks along +Z, and reads more as the gap grows, reads what goes along +Z."""
    axis = c.said.axis or ""
    return (
        f"  {c.calibration}: {calibration_for(axis, f'+{axis}', 'gap')}   "
        "# sure: an export of thermodata has it along the machine's axis"
    )


def _jump(j: DraftJump) -> str:
    keys = {"kind": "jump", "axis": j.axis or "?", "source": j.source, "file": j.file, "signal": j.signal}
    line = f"{j.name}: {{{flow(keys)}, moves: unknown, dwell: {j.dwell_s:g} s}}   # {one_line('? ' + j.question)}"
    return f"  {line}" if j.axis and j.signal else f"  # ? axis? then: {line}"


def _tests(draft: Draft) -> list[str]:
    if not draft.tests:
        return [
            "tests:",
            "  - {id: unknown, kind: other, role: none}   # ? no recording is known: a line for each",
        ]
    pattern = pattern_of(draft)
    if pattern is not None:
        return _tests_from(pattern, draft)
    lines = [f"tests:   # {_ROLES}"]
    if draft.table is not None:
        lines[0] += f"; conditions from {one_line(draft.table.file)}, column '{one_line(draft.table.key)}'"
    if len(draft.tests) == 1 and draft.tests[0].window is None:
        lines[0] += f"; {_ALONE}{_named_files(draft)}"
    return lines + [_test(t) for t in draft.tests]


def _named_files(draft: Draft) -> str:
    """', files: {daq: raw/day_daq.csv}': of sources that find files by the test's name, for others would find none."""
    (test,) = draft.tests
    by_name = {s.name: s.files.replace("{test}", test.id) for s in draft.sources if s.files and "{test}" in s.files}
    files = {**by_name, **test.files}
    return f", files: {{{one_line(flow(files))}}}" if files else ""


def _test(t: DraftTest) -> str:
    body = flow({"id": t.id, "start": t.kind.start, "kind": t.kind.kind, "role": "none"})
    if t.window is not None:
        body += f", window: [{t.window[0]:.12g} s, {t.window[1]:.12g} s]"
    if t.measuring:
        body += f", measuring: {scalar(t.measuring.when)}"
    if t.conditions:
        body += f", conditions: {{{flow(t.conditions)}}}"
    if t.files:
        body += f", files: {{{flow(t.files)}}}"
    if t.channels:
        body += f", channels: {{{flow({name: own.keys for name, own in t.channels.items()})}}}"
    comment = one_line(_test_comment(t))
    return f"  - {{{body}}}" + (f"   # {comment}" if comment else "")


def _test_comment(t: DraftTest) -> str:
    hint = f"role: {t.kind.role_hint}, as {t.kind.role_by} says?" if t.kind.role_hint else ""
    asked = [*filter(None, (hint, t.kind.question)), *t.doubts, *dict.fromkeys(c.asked for c in t.channels.values())]
    said = f"kind {t.kind.comment}" if t.kind.comment else ""
    if t.measuring:
        said = "; ".join(filter(None, (said, f"measuring guess: {t.measuring.why}")))
    if said and t.length_s:
        said += f"; {t.length_s / 3600:.1f} h" if t.length_s >= 3600 else f"; {t.length_s / 60:.2g} min"
    return "; ".join(filter(None, (f"? {'; '.join(asked)}" if asked else "", said)))


def _tests_from(p: Pattern, draft: Draft) -> list[str]:
    kinds = {t.kind.kind for t in draft.tests}
    lines = [
        f"tests_from:   # {len(draft.tests)} tests: {one_line(', '.join(t.id for t in draft.tests[:4]))} ...",
        f"  files: {scalar(p.files)}",
    ]
    if len(draft.sources) > 1:
        lines.append(f"  source: {p.source}")
    if p.units:
        asked = f"   # ? {', '.join(p.doubts)}" if p.doubts else ""
        lines.append(f"  units: {{{flow(p.units)}}}{asked}")
    said = "; ".join(dict.fromkeys(t.kind.question or f"kind {t.kind.comment}" for t in draft.tests[:3]))
    lines.append(f"  set: {{kind: {kinds.pop()}, role: none}}   # {_ROLES}; {one_line(said)}")
    return lines


def flow(keys: Mapping[str, object]) -> str:
    """Keys and values as they stand between the braces of a YAML mapping; those without a value are left out."""
    return ", ".join(f"{scalar(k)}: {_value(v)}" for k, v in keys.items() if v is not None)


def _value(value: object) -> str:
    if isinstance(value, str | int | float):
        return scalar(value)
    if isinstance(value, Mapping):
        return f"{{{flow(value)}}}"
    assert isinstance(value, Sequence)
    return "[" + ", ".join(scalar(v) for v in value) + "]"


def scalar(value: object) -> str:
    """A YAML scalar, quoted where it must be (inside a flow mapping)."""
    text = str(value)
    if isinstance(value, int | float) or text == _OPEN:
        return text
    safe = (
        re.fullmatch(r"[A-Za-z_][A-Za-z0-9_./%*-]*|\d+(?:\.\d+)? [A-Za-z%][A-Za-z0-9/%^]*", text)
        and text.lower() not in _WORDS
    )
    return text if safe else _quoted(text)


def _quoted(text: str) -> str:
    """In the quotes of YAML. Only what nobody sees is escaped, each character as one: of those beyond 16 bits JSON
    makes two, which YAML reads as none."""
    return "".join(c if c.isprintable() else _escaped(c) for c in json.dumps(text, ensure_ascii=False))


def _escaped(character: str) -> str:
    code = ord(character)
    return f"\\u{code:04x}" if code < 1 << 16 else f"\\U{code:08x}"


def one_line(text: str) -> str:
    """Text of files in a comment: on one line, whatever it holds."""
    return "".join(c if c.isprintable() else " " for c in text)
