"""Whether the tests of a campaign file refer to something, and what they say of their times can be."""

from __future__ import annotations

from thermodata.errors import SpecError
from thermodata.schema.files.campaign import Campaign, Test
from thermodata.schema.strict.lines import Document, Place
from thermodata.schema.strict.refer import inside, must_be
from thermodata.schema.words.slips import slip_of


def check_tests(campaign: Campaign, document: Document) -> None:
    """SpecError at the first that does not."""
    if not campaign.tests and campaign.tests_from is None:
        raise SpecError(
            "the campaign has no tests",
            where=document.where(("tests",)),
            expected="tests: [{id: ..., ...}] or tests_from: {files: ...}",
            hint="'thermodata init FOLDER' drafts a campaign file with the tests that a folder of logs holds",
        )
    seen: dict[str, str] = {}
    for i, test in enumerate(campaign.tests):
        if test.id.lower() in seen:
            raise SpecError(
                f"the test '{test.id}' stands twice",
                where=document.where(("tests", i, "id")),
                expected="unique ids, ignoring case",
                got=seen[test.id.lower()],
                hint="give one of them another id; a test of several files lists them under its sources",
            )
        seen[test.id.lower()] = test.id
    for i, test in enumerate(campaign.tests):
        _names(campaign, test, i, document)
        _times(test, ("tests", i), document)


def _names(campaign: Campaign, test: Test, i: int, document: Document) -> None:
    for source, files in test.files.items():
        must_be("source", source, campaign.sources, document, ("tests", i, "files", source))
        for text in [files] if isinstance(files, str) else files:
            inside(text, document, ("tests", i, "files", source))
    for source in test.clocks:
        must_be("source", source, campaign.sources, document, ("tests", i, "clocks", source))
    for channel in test.channels:
        must_be("channel", channel, campaign.channels, document, ("tests", i, "channels", channel))
    if test.repeat_of is not None:
        others = [other.id for other in campaign.tests if other is not test]
        must_be("other test", test.repeat_of, others, document, ("tests", i, "repeat_of"))
    own = {*(campaign.machine.model_extra or {}), *type(campaign.machine).model_fields}
    for key in test.machine:
        meant = None if key in own else slip_of(key, own - set(test.machine))
        if meant is not None:
            raise SpecError(
                f"unknown attribute '{key}' of the machine",
                where=document.where(("tests", i, "machine", key)),
                expected=f"one of {', '.join(sorted(own))}, or an attribute that is called by none like them",
                got=key,
                hint=f"did you mean '{meant}'?",
            )


def _times(test: Test, place: Place, document: Document) -> None:
    if test.window is not None and test.window[1] <= test.window[0]:
        raise SpecError(
            "a window that ends before it starts",
            where=document.where((*place, "window")),
            expected="[from, to] with from < to",
            got=f"[{test.window[0]:g} s, {test.window[1]:g} s]",
            hint="exchange the two: times count from the start of the log, as in [0.5 h, 8 h]",
        )
    if (
        test.window is not None
        and "over" in test.zero.model_fields_set
        and test.zero.over > test.window[1] - test.window[0]
    ):
        raise SpecError(
            "the zero is taken over more than the test",
            where=document.where((*place, "zero", "over")),
            expected=f"at most the {test.window[1] - test.window[0]:g} s of its window",
            got=f"{test.zero.over:g} s",
            hint="a shorter 'over' (1 min, say), or a longer window",
        )
    for name, (begin, end) in test.phases.items():
        if end <= begin:
            raise SpecError(
                f"the phase '{name}' ends before it starts",
                where=document.where((*place, "phases", name)),
                expected="[from, to] with from < to",
                got=f"[{begin:g} s, {end:g} s]",
                hint="exchange the two: times count from the start of the test",
            )
        if test.window is not None and (end <= test.window[0] or begin >= test.window[1]):
            raise SpecError(
                f"the phase '{name}' lies outside the test's window",
                where=document.where((*place, "phases", name)),
                expected=f"a part of [{test.window[0]:g} s, {test.window[1]:g} s]",
                got=f"[{begin:g} s, {end:g} s]",
                hint="phases count from the start of the recording, as the window does",
            )
