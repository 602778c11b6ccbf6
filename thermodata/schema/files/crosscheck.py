"""What the types of a campaign file cannot say: that names refer to something."""

from __future__ import annotations

from thermodata.errors import SpecError
from thermodata.schema.files.campaign import Campaign, JumpCalibration
from thermodata.schema.files.crosscheck_channels import check_channels
from thermodata.schema.files.crosscheck_tests import check_tests
from thermodata.schema.strict.lines import Document, Place
from thermodata.schema.strict.refer import inside, must_be, only_known_fields
from thermodata.schema.words.zone_names import hint_for_offset, meant_zone


def check_campaign(campaign: Campaign, document: Document) -> None:
    """SpecError at the first name that refers to nothing, and at paths that leave the folder."""
    check_channels(campaign, document)
    _calibrations(campaign, document)
    _sources(campaign, document)
    check_tests(campaign, document)
    _tests_of_channels(campaign, document)
    _overruled(campaign, document)


def _tests_of_channels(campaign: Campaign, document: Document) -> None:
    tests = [test.id for test in campaign.tests]
    for name, channel in campaign.channels.items():
        for key in ("only_in", "missing_in"):
            for i, test in enumerate(getattr(channel, key)):
                must_be("test", test, tests, document, ("channels", name, key, i))


def _calibrations(campaign: Campaign, document: Document) -> None:
    for name, calibration in campaign.calibrations.items():
        if isinstance(calibration, JumpCalibration):
            must_be("source", calibration.source, campaign.sources, document, ("calibrations", name, "source"))
            inside(calibration.file, document, ("calibrations", name, "file"))
            known = calibration.moves if isinstance(calibration.moves, list) else [1.0]
            if not known or any(move == 0 for move in known):
                raise SpecError(
                    "a jump test needs moves, none of them 0",
                    where=document.where(("calibrations", name, "moves")),
                    expected="for example [100 um, -100 um]",
                    got=str(calibration.moves),
                    hint="list the moves in the order in which the axis made them, each from where it stood",
                )


def _sources(campaign: Campaign, document: Document) -> None:
    for name, source in campaign.sources.items():
        if source.clock.align_to is not None:
            place = ("sources", name, "clock", "align_to")
            must_be("source", source.clock.align_to, campaign.sources, document, place)
            if source.clock.align_to == name:
                raise SpecError(
                    "a source cannot be aligned to itself",
                    where=document.where(place),
                    expected="one of "
                    + (", ".join(sorted({*campaign.sources} - {name})) or "none: it is the only one"),
                    got=name,
                    hint="leave 'align_to' out of the source whose clock is right",
                )
            if not source.clock.by and not source.clock.events:
                raise SpecError(
                    "'align_to' needs 'by' or 'events'",
                    where=document.where(place),
                    expected="by: [{here: channel_of_this_source, there: channel_of_the_other}], or "
                    "events: [{here: a time, there: the same moment}]",
                    hint="'by' a quantity that both log, such as the spindle speed; 'events' where a person saw "
                    "one moment in both",
                )
            for i, pair in enumerate(source.clock.by):
                must_be("channel", pair.here, campaign.channels, document, ("sources", name, "clock", "by", i, "here"))
                must_be(
                    "channel", pair.there, campaign.channels, document, ("sources", name, "clock", "by", i, "there")
                )
        files = [source.files] if isinstance(source.files, str) else source.files or []
        for text in files:
            inside(text, document, ("sources", name, "files"))
            if not (document.path.parent / text).exists():  # braces may stand in a file's own name
                only_known_fields(text, document, ("sources", name, "files"))
        if source.table is not None and isinstance(source.table.sheet, str):
            only_known_fields(source.table.sheet, document, ("sources", name, "table", "sheet"))
        if source.timezone is not None:
            _timezone(source.timezone, document, ("sources", name, "timezone"))


def _timezone(name: str, document: Document, place: Place) -> None:
    from zoneinfo import ZoneInfo, available_timezones

    try:
        ZoneInfo(name)
    except (KeyError, ValueError, OSError):
        hint = hint_for_offset(name)
        close = None if hint else meant_zone(name, sorted(available_timezones()))
        raise SpecError(
            f"no time zone '{name}'",
            where=document.where(place),
            expected="an IANA name, Europe/Prague, or an offset that holds all year, +01:00",
            got=name,
            hint=f"did you mean '{close}'?" if close else hint,
        ) from None


def _overruled(campaign: Campaign, document: Document) -> None:
    tests = [test.id for test in campaign.tests]
    for i, rule in enumerate(campaign.overrule):
        if rule.channel is not None:
            must_be("channel", rule.channel, campaign.channels, document, ("overrule", i, "channel"))
        for k, test in enumerate(rule.tests):
            must_be("test", test, tests, document, ("overrule", i, "tests", k))
        if rule.window is not None and rule.window[1] <= rule.window[0]:
            raise SpecError(
                "a window that ends before it starts",
                where=document.where(("overrule", i, "window")),
                expected="[from, to] with from < to, from the start of the test",
                got=f"[{rule.window[0]:g} s, {rule.window[1]:g} s]",
                hint="exchange the two, or leave 'window' out, which means the whole test",
            )
