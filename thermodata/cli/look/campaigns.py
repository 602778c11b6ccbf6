"""`campaigns`: what a store holds, a line a campaign."""

from __future__ import annotations

from typing import Any

from thermodata.cli.look.look import machine_option
from thermodata.cli.terminal.common import Session, command
from thermodata.errors import unknown_name
from thermodata.report.collected.records import records
from thermodata.report.text.table import table
from thermodata.report.words.numbers import number

_CAMPAIGNS = """
select c.campaign,
       (select list(distinct m.machine order by m.machine) from machine m where m.campaign = c.campaign) as machines,
       count(t.test) as tests, count(*) filter (t.role = 'locked') as locked,
       sum(t.duration_s) / 3600 as hours, min(t.start) as start, c.ingested_at, c.path
from campaign c left join test t using (campaign) group by all order by c.campaign
"""


@command("campaigns")
@machine_option
def campaigns_command(session: Session, machine: str | None) -> None:
    """List the campaigns: machine, tests, hours, and their files."""
    rows = records(session.view(), _CAMPAIGNS)
    known = dict.fromkeys(m for row in rows for m in row["machines"] or [])
    if machine is not None:
        if machine not in known:
            raise unknown_name("machine", machine, list(known))
        rows = [row for row in rows if machine in (row["machines"] or [])]
    session.answer(rows, lambda: table([_cells_of(row) for row in rows], _COLUMNS) if rows else "no campaign")


_COLUMNS = [
    ("campaign", "campaign"),
    ("machine", "machine"),
    ("tests", "tests"),
    ("locked", "locked"),
    ("hours", "hours"),
    ("begin", "first test (UTC)"),
    ("ingested", "ingested (UTC)"),
    ("path", "file"),
]


def _cells_of(row: dict[str, Any]) -> dict[str, Any]:
    return {
        **row,
        "machine": ", ".join(row["machines"] or []),
        "hours": "-" if row["hours"] is None else number(row["hours"]),
        "begin": str(row["start"] or "-")[:16],
        "ingested": str(row["ingested_at"] or "-")[:16],
    }
