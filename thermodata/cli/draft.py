"""Drafts a campaign file from raw files: groups them, guesses, and marks every question with '# ?'."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import PurePosixPath

from thermodata.cli.naming import channel_name, guess, words
from thermodata.plugin import Recording, Signal

_CALIBRATION = re.compile(r"\b(jump|jumps|calib\w*|kalib\w*|cal|skok\w*|sprung\w*)\b")
_KINDS = (("etve", r"\b(etve|idle|ambient|klid|ruhe|umgebung)\b"), ("spectrum", r"\b(spectrum|spektrum|spec)\b"),
          ("cutting", r"\b(cut\w*|fras\w*|obrab\w*|zersp\w*)\b"),
          ("rotary_axis", r"\b(rotary|table|tisch|stul|[bc] axis)\b"),
          ("linear_axis", r"\b(feed|linear|axis|vorschub|posuv|[xyz]\d+)\b"),
          ("spindle", r"\b(spindle|spindel|vreten\w*|sp\d+|s\d{3,5}|rpm\d*|\d+ ?rpm)\b"),
          ("mixed", r"\b(day|mixed|den|tag)\w*\b"))
_ROLES = (("locked", r"\b(locked|secret|geheim)\b"),
          ("verification", r"\b(verif\w*|valid\w*|overe\w*|pruf\w*|day|den|tag)\w*\b"))


@dataclass(frozen=True, slots=True)
class RawFile:
    """One file of the folder that a reader claims. path: relative to the folder."""

    path: PurePosixPath
    reader: str
    recording: Recording


@dataclass(frozen=True, slots=True)
class Group:
    """Files of one reader with the same signals: one source. template: with {test}, or None; tests: id -> file."""

    source: str
    reader: str
    files: tuple[RawFile, ...]
    template: str | None
    tests: Mapping[str, str]

    @property
    def signals(self) -> tuple[Signal, ...]:
        return self.files[0].recording.signals


def group(files: Sequence[RawFile]) -> list[Group]:
    """One group a reader and set of signals, named after the reader; calibration recordings left out."""
    kept = [f for f in files if not is_calibration(f.path)]
    by_signals: dict[tuple[str, frozenset[str]], list[RawFile]] = {}
    for f in kept:
        by_signals.setdefault((f.reader, frozenset(s.name for s in f.recording.signals)), []).append(f)
    names: dict[str, int] = {}
    groups = []
    for (reader, _), members in sorted(by_signals.items(), key=lambda item: (item[0][0], -len(item[1]))):
        names[reader] = names.get(reader, 0) + 1
        source = reader if names[reader] == 1 else f"{reader}{names[reader]}"
        template, tests = template_of([str(f.path) for f in members])
        groups.append(Group(source, reader, tuple(members), template, tests))
    every = {str(f.path) for f in files}
    ids = {test for g in groups for test in g.tests}
    return [g if _holds(g, ids, every) else replace(g, template=None) for g in groups]


def _holds(group: Group, ids: set[str], every: set[str]) -> bool:
    """Whether the template names, for every test of the campaign, a file of this group or none at all; a source
    that only one of many tests has is better named there."""
    return group.template is not None and (len(group.tests) > 1 or len(ids) == 1) and all(
        (path := group.template.replace("{test}", test)) not in every or group.tests.get(test) == path for test in ids)


def is_calibration(path: PurePosixPath) -> bool:
    """Whether the name says jump test or calibration."""
    return bool(_CALIBRATION.search(words(path.stem)))


def template_of(paths: Sequence[str]) -> tuple[str | None, dict[str, str]]:
    """('raw/{test}_daq.tdms', {test: path}) where all paths share folder and ending, else (None, stem -> path)."""
    folders, suffixes = {str(PurePosixPath(p).parent) for p in paths}, {PurePosixPath(p).suffix for p in paths}
    stems = [PurePosixPath(p).stem for p in paths]
    if len(folders) > 1 or len(suffixes) > 1 or len(set(stems)) < len(stems):
        unique = len(set(stems)) == len(stems)
        return None, {(s if unique else p.replace("/", "_")): p for s, p in zip(stems, paths, strict=True)}
    tail = common_tail(stems) if len(stems) > 1 else ""
    folder = "" if folders == {"."} else f"{folders.pop()}/"
    return (f"{folder}{{test}}{tail}{suffixes.pop()}",
            {s.removesuffix(tail): p for s, p in zip(stems, paths, strict=True)})


def common_tail(stems: Sequence[str]) -> str:
    """The ending that all stems share, from a separator on ('_daq'), never a whole stem."""
    tail = stems[0]
    for stem in stems[1:]:
        while not stem.endswith(tail):
            tail = tail[1:]
    cut = re.search(r"[_\-. ][A-Za-z].*$", tail)
    return cut[0] if cut and all(len(s) > len(cut[0]) for s in stems) else ""


def draft(campaign: str, files: Sequence[RawFile], ignored: Sequence[tuple[str, str]] = ()) -> str:
    """The text of a campaign file that loads; ignored: (file, why) of files that no reader claims."""
    groups, taken = group(files), set[str]()
    calibrations = [f for f in files if is_calibration(f.path)]
    lines = ["# Drafted by thermodata init. Every '# ?' is a guess or a question: settle it, then delete the mark.",
             "schema: thermodata/campaign/1", f"id: {campaign}",
             "machine:", "  id: unknown                      # ? the machine's number", "sources:"]
    for g in groups:
        absolute = g.files[0].recording.clock == "absolute"
        local = "   # ? timezone: Europe/Prague, if it logs local time" if absolute else ""
        where = f", files: {_text(g.template)}" if g.template else ""
        lines.append(f"  {g.source}: {{reader: {g.reader}{where}}}{local}")
    lines.append("channels:")
    displacements = []
    for g in groups:
        several = len({s.stream for s in g.signals}) > 1
        for signal in g.signals:
            name, found = channel_name(signal.name, taken), guess(signal.name, signal.unit, signal.dtype)
            moves = found.quantity == "displacement"
            if moves:
                displacements.append((name, found.axis, g, signal))
            jump = f"jump_{name}" if moves and found.axis and _jump_for(signal, found.axis, calibrations) else None
            keys = {"source": g.source, "signal": signal.name, "quantity": found.quantity, "unit": found.unit,
                    "axis": found.axis, "at": found.at,
                    "relative_to": "table" if moves else None, "calibration": jump}
            doubts = [*found.doubts, *(["calibration?"] if moves and not jump else [])]
            stream = f"stream {signal.stream}" if several else ""
            note = "; ".join(filter(None, ["? " + ", ".join(doubts) if doubts else "", stream]))
            flow = ", ".join(f"{k}: {_text(v)}" for k, v in keys.items() if v is not None)
            mark = "  " if found.quantity else "# "
            lines.append(f"{mark}{name}: {{{flow}}}" + (f"   # {note}" if note else ""))
    jumps = [(name, axis, g, s, f) for name, axis, g, s in displacements
             if axis and (f := _jump_for(s, axis, calibrations))]
    if jumps:
        lines.append("calibrations:")
        lines += [f"  jump_{name}: {{kind: jump, axis: {axis}, source: {g.source}, file: {_text(str(f.path))}, "
                  f"signal: {_text(s.name)}, moves: [100 um, -100 um], dwell: 10 s}}   # ? the commanded moves"
                  for name, axis, g, s, f in jumps]
    lines += _tests(groups)
    lines += [f"# not used: {path} ({why})" for path, why in ignored]
    return "\n".join(lines) + "\n"


def _tests(groups: Sequence[Group]) -> list[str]:
    ids = list(dict.fromkeys(test for g in groups for test in g.tests))
    lines = ["tests:" if ids else "tests: []                          # ? no recording was found"]
    for test in ids:
        kind = next((kind for kind, pattern in _KINDS if re.search(pattern, words(test))), "other")
        files = {g.source: g.tests[test] for g in groups if test in g.tests and g.template is None}
        extra = ", files: {" + ", ".join(f"{k}: {_text(v)}" for k, v in files.items()) + "}" if files else ""
        role = next((role for role, pattern in _ROLES if re.search(pattern, words(test))), "calibration")
        lines.append(f"  - {{id: {_text(test)}, kind: {kind}, role: {role}{extra}}}   # ? kind, role, conditions")
    return lines


def _jump_for(signal: Signal, axis: str | None, calibrations: Sequence[RawFile]) -> RawFile | None:
    """The calibration recording that holds this signal; first the one whose name ends like it or names its axis."""
    holding = [f for f in calibrations if any(s.name == signal.name for s in f.recording.signals)]
    named = [words(f.path.stem).split() for f in holding]
    last = words(signal.name).split()[-1:]
    alike = [f for f, name in zip(holding, named, strict=True) if name[-1:] == last]
    axial = [f for f, name in zip(holding, named, strict=True) if axis is not None and axis.lower() in name]
    return next(iter([*alike, *axial, *holding]), None)


def _text(value: object) -> str:
    """A YAML scalar, quoted where it must be (inside a flow mapping)."""
    text = str(value)
    safe = re.fullmatch(r"[A-Za-z_][A-Za-z0-9_./%{}*-]*", text) and text.lower() not in (
        "yes", "no", "on", "off", "true", "false", "null", "y", "n") and not set("{}") & set(text)
    return text if safe else json.dumps(text, ensure_ascii=False)
