"""Several tests in one call: a file each, called after its test."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from thermodata.errors import UsageError
from thermodata.export.content import check_test
from thermodata.store.base.files import safe_name

if TYPE_CHECKING:
    from thermodata.view import StoreView

_PLACE = "{test}"


def paths_of(view: StoreView, campaign: str, tests: Sequence[str], out: Path) -> dict[str, Path]:
    """Test -> its file. tests: none named: all of the campaign that have data. UsageError for a name that is unknown,
    and where the files of several tests would be one; their folder is made."""
    named = list(dict.fromkeys(tests)) or _with_data(view, campaign)
    for test in tests:
        check_test(view, campaign, test)
    if _PLACE not in str(out):
        if tests and len(named) == 1:
            return {named[0]: out}
        if not tests and not out.suffix:
            raise UsageError(
                "no file to write to",
                where="OUT",
                expected="the name of a file behind the tests, .csv, .xlsx, .mat, .mf4 or .parquet",
                got=str(out),
                hint=f"thermodata export {campaign} {out.name} {out.name}.csv",
            )
        raise UsageError(
            "several tests are a file each",
            where=str(out),
            expected=f"a name that holds {_PLACE}",
            got=f"{len(named)} tests, one name" if tests else "no TEST: all of the campaign",
            hint=f"name it '{out.with_name(f'{out.stem}_{_PLACE}{out.suffix}')}', or name one TEST",
        )
    paths = {test: Path(str(out).replace(_PLACE, safe_name(test))) for test in named}
    for folder in {path.parent for path in paths.values()}:
        folder.mkdir(parents=True, exist_ok=True)
    return paths


def _with_data(view: StoreView, campaign: str) -> list[str]:
    found = view.sql(
        "select test from test t where campaign = ? and exists (select 1 from file f where f.campaign = t.campaign "
        "and f.test = t.test and f.layer = 'tidy') order by rowid",
        [campaign],
    ).fetchall()
    if not found:
        check_test(view, campaign, "")
    return [str(test) for (test,) in found]
