"""Looking into a store: tests, channels, calibrations, and where a result comes from."""

from __future__ import annotations

import json
from typing import Any, get_args

import click

from thermodata.cli.start.ingest import calibrations_text
from thermodata.cli.terminal import completing
from thermodata.cli.terminal.common import Session, as_shown, command, plain
from thermodata.errors import UsageError, unknown_name
from thermodata.report.collected.records import records, written_conditions
from thermodata.report.text.table import table
from thermodata.report.words.numbers import duration
from thermodata.schema.words.sentences import counted
from thermodata.view.lists.overview import WantedTests, find_tests

campaign_option = click.option(
    "--campaign", "-c", metavar="CAMPAIGN", help="Only this campaign.", shell_complete=completing.campaigns
)

machine_option = click.option(
    "--machine", metavar="MACHINE", help="Only of this machine, as its campaign file calls it (machine: {id: ...})."
)
_LOOKED_IN = "campaign, name, kind, role, machine, conditions or notes"
_TESTS = "select * from (select t.*, m.machine from test t left join machine m using (campaign, test))"


def rows_of(session: Session, query: str, campaign: str | None, order: str) -> list[dict[str, Any]]:
    """Rows of a catalogue table, of one campaign where one is named; JSON columns decoded."""
    view = session.view()
    if campaign is not None:
        names = [row["campaign"] for row in records(view, "select campaign from campaign order by 1")]
        if campaign not in names:
            raise unknown_name("campaign", campaign, names)
    where = " where campaign = ?" if campaign is not None else ""
    found = records(view, f"{query}{where} order by {order}", [campaign] if campaign is not None else None)
    for row in found:
        for key in (
            "conditions",
            "pose",
            "tool",
            "phases",
            "measuring",
            "sensor",
            "crosstalk",
            "checks",
            "detail",
            "notes",
        ):
            if isinstance(row.get(key), str) and row[key][:1] in ("{", "[", '"'):
                row[key] = json.loads(row[key])
    return found


def _refuse_unknown(role: str | None, kind: str | None) -> None:
    from thermodata.schema.files.campaign import Role, TestKind  # a third of the time that a list of tests takes

    for what, word, known in (("role", role, get_args(Role)), ("kind", kind, get_args(TestKind))):
        if word and word not in known:
            raise unknown_name(what, word, known, where=f"--{what}")


@command("tests")
@campaign_option
@click.option("--role", metavar="ROLE", help="Only of this role: calibration, verification, locked or none.")
@click.option(
    "--kind", metavar="KIND", help="Only of this kind: spindle, linear_axis, etve, ... as the campaign file says."
)
@machine_option
@click.option("--find", metavar="WORDS", help=f"Only where all WORDS stand in {_LOOKED_IN}.")
def tests_command(
    session: Session, campaign: str | None, role: str | None, kind: str | None, machine: str | None, find: str | None
) -> None:
    """List the tests: machine, kind, role, length and conditions."""
    if role or kind:
        _refuse_unknown(role, kind)
    rows = rows_of(session, _TESTS, campaign, "campaign, test")
    if role or kind or find or machine:
        asked = WantedTests(
            find or "", campaign or "", role or "", kind or "", machine=machine or "", per_page=max(1, len(rows))
        )
        found = {(r.campaign, r.test) for r in find_tests(session.store(), asked).rows}
        if rows and not found:
            words = f": all of '{find}' would have to stand in its {_LOOKED_IN}" if find else ""
            session.say(f"none of {counted(len(rows), 'test')} is such a one{words}")
        rows = [row for row in rows if (row["campaign"], row["test"]) in found]
    specs = records(session.view(), "select spec from campaign")
    written = written_conditions(row["spec"] for row in specs)
    shown = [
        {
            **row,
            "length": duration(row["duration_s"]),
            "begin": str(row["start"] or "-")[:16],
            "conditions": written.get((row["campaign"], row["test"]), row["conditions"]),
        }
        for row in rows
    ]
    session.answer(
        rows,
        lambda: table(
            shown,
            [
                ("campaign", "campaign"),
                ("test", "test"),
                ("kind", "kind"),
                ("role", "role"),
                *([("machine", "machine")] if any(row["machine"] for row in shown) else []),
                ("begin", "start (UTC)"),
                ("length", "length"),
                ("conditions", "conditions"),
            ],
        ),
    )


@command("channels")
@campaign_option
@click.option(
    "--test",
    "-t",
    metavar="TEST",
    shell_complete=completing.tests,
    help="As they are in this test (default: each channel once).",
)
def channels_command(session: Session, campaign: str | None, test: str | None) -> None:
    """List the channels: quantity, unit, place, sign, origin."""
    rows = rows_of(session, "select * from channel", campaign, "campaign, test, source, channel")
    if test is not None:
        if not any(row["test"] == test for row in rows):
            raise unknown_name("test", test, sorted({row["test"] for row in rows}))
        rows = [row for row in rows if row["test"] == test]
    else:
        rows = list({(row["campaign"], row["channel"]): row for row in rows}.values())
    session.answer(
        rows,
        lambda: table(
            rows,
            [
                ("campaign", "campaign"),
                ("channel", "channel"),
                ("quantity", "quantity"),
                ("unit", "unit"),
                ("at", "at"),
                ("axis", "axis"),
                ("sign", "sign"),
                ("source", "source"),
                ("signal", "signal"),
                ("raw_unit", "raw unit"),
                ("calibration", "calibration"),
            ],
            widest=64,
        ),
    )


@command("calibrations")
@campaign_option
def calibrations_command(session: Session, campaign: str | None) -> None:
    """Show the calibrations.

    Signed sensitivity, offset, uncertainty, noise, and what failed a check. JSON has all checks, each with the limit by
    which it passes, and how well one move of a jump test is known (move_uncertainty of the campaign file).
    """
    from thermodata.calibration.jump.limits import MOVES, with_limits

    asked = f"""select c.*, try_cast(json_extract_string(m.spec,
        '$.calibrations."' || c.calibration || '".move_uncertainty') as double) as {MOVES}
        from calibration c join campaign m using (campaign)"""
    rows = rows_of(session, f"select * from ({asked})", campaign, "campaign, calibration")
    rows = [{**row, "checks": with_limits(row["checks"])} for row in rows]
    session.answer(rows, lambda: as_shown(calibrations_text(rows)) if rows else "no calibrations")


@command("trace")
@click.argument("what", metavar="CAMPAIGN|MODEL", shell_complete=completing.campaigns_and_models)
@click.argument("test", required=False, shell_complete=completing.tests)
@click.argument("channel", required=False, shell_complete=completing.channels)
@click.option("--at", metavar="TIME", help="One sample: '2.5 h' from the start of the test, or 2026-03-30T08:30Z.")
@click.option("--verify", is_flag=True, help="Hash the source files again, and read the sample in its file again.")
def trace_command(
    session: Session, what: str, test: str | None, channel: str | None, at: str | None, verify: bool
) -> None:
    """Show where a value comes from.

    Of a TEST or of one CHANNEL: raw files with their SHA-256 and their earlier versions, reader, scaling,
    calibration, sign; with --at the row in the file. Of a MODEL: its data and the versions behind it.
    """
    from thermodata.cli.look.tracing_text import trace_text
    from thermodata.store.trace.lineage import trace
    from thermodata.store.trace.moment import seconds_at

    if at is not None and channel is None:
        raise UsageError("--at needs a channel", hint="thermodata trace CAMPAIGN TEST CHANNEL --at '2.5 h'")
    t_s, said = (None, None) if at is None or test is None else seconds_at(session.store(), what, test, at)
    if said is not None:
        session.say(said)
    found = trace(session.store(), what, test, channel, t_s=t_s, verify=verify)
    session.answer(found, lambda: trace_text(plain(found)))
