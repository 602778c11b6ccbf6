"""What the types of a campaign file cannot say: that names refer to something."""

from __future__ import annotations

from collections.abc import Collection
from pathlib import PurePosixPath, PureWindowsPath

from thermodata.errors import SpecError, nearest
from thermodata.schema.campaign import Campaign, JumpCalibration
from thermodata.schema.lines import Document, Place
from thermodata.schema.zone_names import meant_zone


def check_campaign(campaign: Campaign, document: Document) -> None:
    """SpecError at the first name that refers to nothing, and at paths that leave the folder."""
    _channels(campaign, document)
    _calibrations(campaign, document)
    _sources(campaign, document)
    _tests(campaign, document)
    _tests_of_channels(campaign, document)
    _overruled(campaign, document)


def _known(kind: str, name: str, choices: Collection[str], document: Document, place: Place) -> None:
    if name in choices:
        return
    close = nearest(name, list(choices))
    raise SpecError(
        f"no {kind} '{name}'",
        where=document.where(place),
        expected="one of " + ", ".join(sorted(choices)) if choices else f"a {kind} declared in this file",
        got=name,
        hint=f"did you mean '{close}'?" if close else f"declare it, or correct the {kind}'s name",
    )


def inside(text: str, document: Document, place: Place) -> None:
    """Refuses a path that leaves the campaign's folder."""
    pure = PurePosixPath(text.replace("\\", "/"))
    if pure.is_absolute() or ".." in pure.parts or PureWindowsPath(text).drive:
        raise SpecError(
            "a path that leaves the campaign's folder",
            where=document.where(place),
            expected="a path below the folder of the campaign file",
            got=text,
            hint="move the file below the campaign file, or the campaign file above it",
        )


def _channels(campaign: Campaign, document: Document) -> None:
    for name, channel in campaign.channels.items():
        if channel.source is not None:
            _known("source", channel.source, campaign.sources, document, ("channels", name, "source"))
        used = [channel.calibration] if isinstance(channel.calibration, str) else channel.calibration or []
        for calibration in used:
            _known("calibration", calibration, campaign.calibrations, document, ("channels", name, "calibration"))


def _tests_of_channels(campaign: Campaign, document: Document) -> None:
    tests = [test.id for test in campaign.tests]
    for name, channel in campaign.channels.items():
        for key in ("only_in", "missing_in"):
            for i, test in enumerate(getattr(channel, key)):
                _known("test", test, tests, document, ("channels", name, key, i))


def _calibrations(campaign: Campaign, document: Document) -> None:
    for name, calibration in campaign.calibrations.items():
        if isinstance(calibration, JumpCalibration):
            _known("source", calibration.source, campaign.sources, document, ("calibrations", name, "source"))
            inside(calibration.file, document, ("calibrations", name, "file"))
            known = calibration.moves if isinstance(calibration.moves, list) else [1.0]
            if not known or any(move == 0 for move in known):
                raise SpecError(
                    "a jump test needs moves, none of them 0",
                    where=document.where(("calibrations", name, "moves")),
                    expected="for example [100 um, -100 um]",
                    got=str(calibration.moves),
                )


def _sources(campaign: Campaign, document: Document) -> None:
    for name, source in campaign.sources.items():
        if source.clock.align_to is not None:
            place = ("sources", name, "clock", "align_to")
            _known("source", source.clock.align_to, campaign.sources, document, place)
            if source.clock.align_to == name:
                raise SpecError("a source cannot be aligned to itself", where=document.where(place))
            if not source.clock.by and not source.clock.events:
                raise SpecError(
                    "'align_to' needs 'by' or 'events'",
                    where=document.where(place),
                    expected="by: [{here: channel_of_this_source, there: channel_of_the_other}], or "
                    "events: [{here: a time, there: the same moment}]",
                )
            for i, pair in enumerate(source.clock.by):
                _known("channel", pair.here, campaign.channels, document, ("sources", name, "clock", "by", i, "here"))
                _known("channel", pair.there, campaign.channels, document, ("sources", name, "clock", "by", i, "there"))
        files = [source.files] if isinstance(source.files, str) else source.files or []
        for text in files:
            inside(text, document, ("sources", name, "files"))
        if source.timezone is not None:
            _timezone(source.timezone, document, ("sources", name, "timezone"))


def _timezone(name: str, document: Document, place: Place) -> None:
    from zoneinfo import ZoneInfo, available_timezones

    try:
        ZoneInfo(name)
    except (KeyError, ValueError, OSError):
        close = meant_zone(name, sorted(available_timezones()))
        raise SpecError(
            f"no time zone '{name}'",
            where=document.where(place),
            expected="an IANA name, Europe/Prague",
            got=name,
            hint=f"did you mean '{close}'?" if close else None,
        ) from None


def _tests(campaign: Campaign, document: Document) -> None:
    if not campaign.tests and campaign.tests_from is None:
        raise SpecError(
            "the campaign has no tests",
            where=document.where(("tests",)),
            expected="tests: [{id: ..., ...}] or tests_from: {files: ...}",
        )
    seen: dict[str, str] = {}
    for i, test in enumerate(campaign.tests):
        if test.id.lower() in seen:
            raise SpecError(
                f"the test '{test.id}' stands twice",
                where=document.where(("tests", i, "id")),
                expected="unique ids, ignoring case",
                got=seen[test.id.lower()],
            )
        seen[test.id.lower()] = test.id
    for i, test in enumerate(campaign.tests):
        for source, files in test.files.items():
            _known("source", source, campaign.sources, document, ("tests", i, "files", source))
            for text in [files] if isinstance(files, str) else files:
                inside(text, document, ("tests", i, "files", source))
        for source in test.clocks:
            _known("source", source, campaign.sources, document, ("tests", i, "clocks", source))
        for channel in test.channels:
            _known("channel", channel, campaign.channels, document, ("tests", i, "channels", channel))
        if test.repeat_of is not None:
            _known("test", test.repeat_of, list(seen.values()), document, ("tests", i, "repeat_of"))
        if test.window is not None and test.window[1] <= test.window[0]:
            raise SpecError(
                "a window that ends before it starts",
                where=document.where(("tests", i, "window")),
                expected="[from, to] with from < to",
                got=f"[{test.window[0]:g} s, {test.window[1]:g} s]",
            )
        for name, (begin, end) in test.phases.items():
            if test.window is not None and (end <= test.window[0] or begin >= test.window[1]):
                raise SpecError(
                    f"the phase '{name}' lies outside the test's window",
                    where=document.where(("tests", i, "phases", name)),
                    expected=f"a part of [{test.window[0]:g} s, {test.window[1]:g} s]",
                    got=f"[{begin:g} s, {end:g} s]",
                    hint="phases count from the start of the recording, as the window does",
                )


def _overruled(campaign: Campaign, document: Document) -> None:
    tests = [test.id for test in campaign.tests]
    for i, rule in enumerate(campaign.overrule):
        if rule.channel is not None:
            _known("channel", rule.channel, campaign.channels, document, ("overrule", i, "channel"))
        for k, test in enumerate(rule.tests):
            _known("test", test, tests, document, ("overrule", i, "tests", k))
        if rule.window is not None and rule.window[1] <= rule.window[0]:
            raise SpecError(
                "a window that ends before it starts",
                where=document.where(("overrule", i, "window")),
                expected="[from, to] with from < to, from the start of the test",
                got=f"[{rule.window[0]:g} s, {rule.window[1]:g} s]",
            )
