"""Taking data away: one self-contained DuckDB file, or a test as Parquet, CSV, Excel, MAT or MDF4."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import click

from thermodata.cli.terminal import completing
from thermodata.cli.terminal.common import Session, command, plain
from thermodata.errors import UsageError
from thermodata.report.text.table import fields, prose


@command("snapshot")
@click.argument("out", type=click.Path(path_type=Path, dir_okay=False), metavar="OUT.duckdb")
def snapshot_command(session: Session, out: Path) -> None:
    """Write the whole store as one DuckDB file.

    Samples and all; it needs nothing beside it.
    """
    from thermodata.store.keep.snapshot import snapshot

    if out.exists():
        raise UsageError("the file exists", where=str(out), hint="name another file or delete it first")
    snapshot(session.store(), out)
    result = {"snapshot": str(out), "bytes": out.stat().st_size}
    session.answer(result, lambda: fields(result.items()))


@command("export")
@click.argument("campaign", shell_complete=completing.campaigns)
@click.argument("tests", metavar="[TEST]...", nargs=-1, shell_complete=completing.tests)
@click.argument("out", type=click.Path(path_type=Path, dir_okay=False))
@click.option(
    "--step",
    metavar="TIME",
    default="30 s",
    show_default=True,
    help="Means of so long (10 s, 1 min), states held; 'logged': as it was logged, with flags (Excel, MAT, MDF4).",
)
@click.option(
    "--format",
    "kind",
    type=click.Choice(["parquet", "csv", "xlsx", "mat", "mdf4"]),
    help="Default: by the name of OUT.",
)
@click.option("--force", is_flag=True, help="Replace OUT where it exists.")
def export_command(
    session: Session, campaign: str, tests: tuple[str, ...], out: Path, step: str, kind: str | None, force: bool
) -> None:
    """Write tests as Parquet, CSV, Excel, MAT or MDF4.

    All sources together on a uniform grid, or as logged; the name of OUT says the format. Times are in UTC. CSV has
    decimal points; Excel (.xlsx) has numbers in any language, units in the second row. On the grid t_s is where a step
    begins, and a value its mean over that step: it belongs to the step's middle. Rows before t_s 0 are what a source
    logged before the test began (the record of its probes, or its window).

    Several tests are a file each, where OUT says their names: export gantry day1 day2 'out/{test}.csv'; without a
    TEST all of the campaign.
    """
    from thermodata.export import export_test
    from thermodata.export.several import paths_of

    view = session.view()
    paths = paths_of(view, campaign, tests, out)
    there = [str(path) for path in paths.values() if path.exists()]
    if there and not force:
        raise UsageError("the file exists", where=", ".join(there), hint="--force replaces it")
    found = [plain(export_test(view, campaign, test, path, step=step, kind=kind)) for test, path in paths.items()]

    def text() -> str:
        # the columns of several tests are alike mostly, and told with the first of those that are
        before = [None, *(one["columns"] for one in found)]
        return "\n\n".join(_export_in_words(one, other) for one, other in zip(found, before, strict=False))

    session.answer(found[0] if len(tests) == 1 else found, text)


def _export_in_words(one: Mapping[str, Any], before: list[str] | None) -> str:
    """Of an export for a person: each column once, with its unit. before: the columns of the one told before it."""
    units = one["units"]
    alike = before == one["columns"]
    columns = [f"{name} [{units[name]}]" if units.get(name) not in (None, "", "1") else name for name in one["columns"]]
    shown = {**one, "rows": one["streams"] or one["rows"], "columns": f"the same {len(columns)}" if alike else columns}
    lines = fields([(key, value) for key, value in shown.items() if key not in ("streams", "units")]).splitlines()
    # a path stays whole, to be copied
    return "\n".join(prose(line) if line.startswith("columns ") else line for line in lines)
