"""The logs of a folder with what a person said of their signals in the campaign file before, so that a draft made anew
takes up what follows of it: the jump test of a probe that nothing else told to be one."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace

from thermodata.draft.campaign.parts import Draft
from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.folder.scan import Scan
from thermodata.draft.signals.told_before import told
from thermodata.errors import ThermodataError
from thermodata.plugin import Signal
from thermodata.reader.finding.match import match_signal
from thermodata.schema.files.tests_from import pattern_of

Said = Iterable[tuple[str, str, Mapping[str, str]]]


def with_what_was_said(found: Scan, said: Said, draft: Draft) -> Scan:
    """said: (source, signal, key of a channel -> its value); draft: of the folder without it, which knows the files
    of each source. A jump test that is none yet is of the sources of its reader."""
    of_source: dict[str, list[tuple[str, Mapping[str, str]]]] = {}
    for source, signal, keys in said:
        of_source.setdefault(source, []).append((signal, keys))
    return replace(found, logs=tuple(_told(f, _of_file(f, of_source, draft)) for f in found.logs))


def _of_file(
    file: RawFile, of_source: Mapping[str, list[tuple[str, Mapping[str, str]]]], draft: Draft
) -> list[tuple[str, Mapping[str, str]]]:
    path = str(file.path)
    own = [s.name for s in draft.sources if any(pattern_of(p).fullmatch(path) for p in _patterns(s.name, draft))]
    sources = own or [s.name for s in draft.sources if s.reader == file.reader]
    return [one for name in sources for one in of_source.get(name, ())]


def _patterns(source: str, draft: Draft) -> list[str]:
    found = [s.files for s in draft.sources if s.name == source and s.files]
    for files in (t.files.get(source, []) for t in draft.tests):
        found += [files] if isinstance(files, str) else files
    return [*found, *(j.file for j in draft.jumps if j.source == source)]


def _told(file: RawFile, said: Iterable[tuple[str, Mapping[str, str]]]) -> RawFile:
    signals = list(file.signals)
    for wanted, keys in said:
        try:
            one = match_signal(wanted, file.signals)
        except ThermodataError:  # a log of another kind
            continue
        signals = [told(s, keys) if _is(s, one) else s for s in signals]
    return replace(file, recording=replace(file.recording, signals=tuple(signals)))


def _is(signal: Signal, other: Signal) -> bool:
    return (signal.stream, signal.name) == (other.stream, other.name)
