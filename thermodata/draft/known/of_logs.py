"""New logs of a machine that the store knows: the campaign file that its old one makes of them."""

from __future__ import annotations

import glob
import re
from collections.abc import Collection
from pathlib import Path

from pydantic import Field

from thermodata.calibration.expression.parser import parse
from thermodata.draft.known.by_patterns import KnownSource, tests_by_patterns
from thermodata.errors import UsageError
from thermodata.reader.finding.registry import files_in
from thermodata.schema.files.campaign import Campaign, SourceSpec, Test
from thermodata.schema.files.tests_from import pattern_of
from thermodata.schema.units.quantity import PROBED
from thermodata.store.ingest.reading.resolve import natural

MOST_FILES = 100_000


class CampaignOfLogs(Campaign):
    """A campaign that no file says: bare logs, read as the sources of a known campaign.

    probed_by: sources whose record is that of the probes, though no channel here reads one. A test begins with it as
    in the known campaign, for its temperatures count from there, and so do the steps of the model.
    """

    probed_by: frozenset[str] = Field(default=frozenset(), exclude=True)

    @property
    def begun_by(self) -> frozenset[str]:
        """Of a known campaign, the sources that carry its displacements."""
        return self.probed_by


def campaign_of_logs(known: Campaign, folder: Path, channels: Collection[str]) -> Campaign:
    """The tests in a folder of bare logs, read as the sources of a known campaign say; only some channels.

    A pattern raw/{test}.csv fits raw/a.csv and, where there is no folder raw, a.csv. UsageError where no file fits, or
    where a source's files do not name the test. Which files are one test is told by all sources together (by_patterns).
    """
    wanted = _with_their_parts(known, channels)
    sources: dict[str, SourceSpec] = {}
    read: list[KnownSource] = []
    names = _files(folder)
    for name, spec in known.sources.items():
        if name not in {known.channels[c].source for c in wanted}:
            continue
        files = _fitting(name, spec, names, (known.id, folder))
        sources[name] = spec.model_copy(update={"files": files, "clock": _clock(spec, known, wanted)})
        signals = [c.signal for n, c in known.channels.items() if n in wanted and c.source == name and c.signal]
        read.append(KnownSource(name, spec, tuple(files), tuple(signals)))
    tests = tests_by_patterns(folder, read, names)
    if not tests:
        raise UsageError(
            "no log in the folder fits the sources of the model's campaign",
            where=str(folder),
            expected=", ".join(str(known.sources[s].files) for s in sources),
            got=", ".join(names[:8]) or "no file",
            hint=f"write a campaign file: thermodata init {folder}",
        )
    kept = {c: known.channels[c] for c in known.channels if c in wanted}
    calibrations = {n for c in kept.values() for n in as_list(c.calibration)}
    return CampaignOfLogs.model_validate(
        {
            "schema": "thermodata/campaign/1",
            "id": re.sub(r"[^A-Za-z0-9._-]+", "-", folder.resolve().name).strip("-._") or "logs",
            "machine": known.machine,
            "sources": sources,
            "channels": kept,
            "calibrations": {n: c for n, c in known.calibrations.items() if n in calibrations},
            "tests": [
                Test(
                    id=t, files={s: [glob.escape(p) for p in sorted(tests[t].get(s, ()), key=natural)] for s in sources}
                )
                for t in sorted(tests, key=natural)
            ],
            "probed_by": {c.source for c in known.channels.values() if c.quantity in PROBED} & sources.keys(),
        }
    )


def _with_their_parts(known: Campaign, channels: Collection[str]) -> set[str]:
    """The channels, what they are derived from, and what their sources' clocks are aligned by."""
    wanted, rest = set[str](), [c for c in channels if c in known.channels]
    while rest:
        name = rest.pop()
        if name in wanted or name not in known.channels:
            continue
        wanted.add(name)
        channel = known.channels[name]
        if channel.derive is not None:
            rest += parse(channel.derive, rates=True).names
        if channel.source is not None:
            rest += [c for by in known.sources[channel.source].clock.by for c in (by.here, by.there)]
    return wanted


def _clock(spec: SourceSpec, known: Campaign, wanted: Collection[str]) -> object:
    """Aligned only to a source that is read too."""
    there = {known.channels[c].source for c in wanted}
    if spec.clock.align_to is None or spec.clock.align_to in there:
        return spec.clock
    return spec.clock.model_copy(update={"align_to": None, "by": [], "events": []})


def _fitting(name: str, spec: SourceSpec, names: list[str], of: tuple[str, Path]) -> list[str]:
    """The patterns of a source as the files of the folder are called: with its folders, or without. of: the campaign,
    and the folder."""
    patterns = [p for p in as_list(spec.files) if "{test}" in p]
    if not patterns:
        raise UsageError(
            f"the files of source '{name}' do not name their test",
            where=f"campaign {of[0]}",
            expected="a pattern with {test}",
            got=", ".join(as_list(spec.files)) or "no files",
            hint=_with_its_file(of[1]),
        )
    bare = [p.rpartition("/")[2] for p in patterns]

    def fit(tried: list[str]) -> int:
        return sum(pattern_of(p).fullmatch(n) is not None for p in tried for n in names)

    return max((patterns, bare), key=fit)


def _with_its_file(folder: Path) -> str:
    """A campaign file says of which tests a log is that runs through several: one that stands above the logs is named,
    for a folder is read by the file in it."""
    above = folder.resolve().parent
    if (above / "campaign.yaml").is_file():
        return f"predict {above}, whose campaign.yaml says which tests these logs hold"
    return f"write a campaign file for the new logs (thermodata init {folder}), and predict the folder that has it"


def _files(folder: Path) -> list[str]:
    names = []
    for path in folder.rglob("*"):
        if path.is_file():
            names += [each.relative_to(folder).as_posix() for each in files_in(path)]
        if len(names) >= MOST_FILES:
            raise UsageError(
                "too many files in the folder",
                where=str(folder),
                expected=f"under {MOST_FILES}",
                hint="name a folder with the logs of the tests to predict, and nothing else",
            )
    return sorted(names, key=natural)


def as_list(value: str | list[str] | None) -> list[str]:
    """What a campaign file has of one or several; [] for nothing."""
    return [] if value is None else [value] if isinstance(value, str) else list(value)
