"""The views and macros over a store: what they show, and that they stay themselves under hostile names."""

from __future__ import annotations

import hashlib
import re
import shutil
from collections.abc import Callable
from pathlib import Path

import duckdb
import numpy as np
import pytest

from thermodata.schema.flag import INVALID, Flag
from thermodata.store import Store
from thermodata.store.base import connection
from thermodata.store.views.catalogue import read_catalogue
from thermodata.store.views.identifiers import IDENTIFIERS
from thermodata.store.views.regenerate import regenerate, statements
from thermodata.store.views.version import VIEWS as VERSION
from thermodata.store.views.version import of_this_version

Build = Callable[..., "Builder"]  # noqa: F821
LONG = ["campaign", "test", "source", "channel", "t", "t_s", "value", "flag"]
VIEWS = {
    "sample": LONG,
    "displacement": LONG,
    "temperature": LONG,
    "driver": LONG,
    "phase": ["campaign", "test", "phase", "from_s", "to_s"],
    "residual": ["campaign", "test", "model", "response", "t_s", "measured", "predicted", "residual", "valid", "stale"],
    "score": [
        "campaign",
        "test",
        "model",
        "role",
        "response",
        "phase",
        "fit",
        "rmse_um",
        "ptp_um",
        "ptp_residual_um",
        "max_um",
        "n",
        "stale",
    ],
}


def sql(store: Store, query: str, *params: object) -> list[tuple]:
    with store.reader() as con:
        return con.execute(query, list(params)).fetchall() if params else con.execute(query).fetchall()


@pytest.fixture(scope="module")
def small(build_once: Build) -> Store:
    b = build_once()
    b.test("c", "a", phases='{"heating": [0, 30], "odd \'$.name\\"": [30, 60]}')
    b.test("c", "b")
    b.test("c", "nothing")
    for test in "ab":
        b.channel("c", test, "dZ", axis="Z", at="tcp", relative_to="table")
        b.channel("c", test, "T1", "temperature")
        b.channel("c", test, "program", "label", source="nc")
        b.channel("c", test, "speed", "rotational_speed", source="nc")
    t = np.arange(6) * 10.0
    for k, test in enumerate("ab"):
        b.tidy("c", test, t, {"dZ": (t + 100 * k, [0, 0, 8, 0, 0, 0]), "T1": 20 + t / 10})
        b.tidy("c", test, t[::2], {"program": ["P1", "P1", "P2"], "speed": [0.0, 9000.0, 0.0]}, source="nc")
    b.add("quality_event", campaign="c", test="a", source="daq", channel="dZ", flag="gap", from_s=1.0, to_s=4.0, n=1)
    return b.store()


@pytest.fixture
def own(small: Store, tmp_path: Path) -> Store:
    """A copy of `small` that a test may change."""
    return Store(shutil.copytree(small.path, tmp_path / "own"))


@pytest.mark.parametrize(
    "view",
    [*VIEWS, "gap", "quality", "weak_spot", "candidate", "history", "portability", "artefact", "diagnosis", "wide"],
)
def test_an_empty_store_has_every_view_empty_and_typed(empty_store: Store, view: str) -> None:
    with empty_store.reader() as con:
        relation = con.sql(f"select * from {view}")
        assert relation.fetchall() == []
        if view in VIEWS:
            assert relation.columns == VIEWS[view]


# of the statements that make all views of `small`, by version
MADE = {13: "64d19802df04fbf6"}


def test_the_version_of_views_is_raised_with_what_they_say(small: Store) -> None:
    """Else a store that another version of this program made keeps its views when it is opened."""
    with small.reader() as con:
        texts = list(statements(con, read_catalogue(con, small.path), small.path))
    # files are called by a hash of what they hold, which a new version of a writer changes
    said = re.sub(r"\b[\w./%-]+\.parquet", "FILE", "\n".join(texts).replace(str(small.path), ""))
    assert MADE.get(VERSION) == hashlib.sha256(said.encode()).hexdigest()[:16], "raise VIEWS, and put its digest here"


@pytest.mark.parametrize("macro", ["signal('c', 't', 'x')", "aligned('c', 't', '1 s')", "binned('c', 't', 30)"])
def test_macros_of_an_empty_store_are_empty(empty_store: Store, macro: str) -> None:
    assert sql(empty_store, f"select * from {macro}") == []


def test_sample_is_long_over_numeric_channels(small: Store) -> None:
    assert sql(small, "select distinct channel from sample order by 1") == [("T1",), ("dZ",), ("speed",)]
    assert sql(small, "select test, count(*), sum(value) from sample where channel = 'dZ' group by 1 order by 1") == [
        ("a", 6, 150.0),
        ("b", 6, 750.0),
    ]
    assert sql(small, "select t_s, flag, epoch_ns(t) from sample where test = 'b' and channel = 'dZ' and t_s = 20") == [
        (20.0, 8, 1_772_000_020_000_000_000)
    ]
    with small.reader() as con:
        relation = con.sql("select * from sample")
        assert relation.columns == LONG
        assert [str(t) for t in relation.types][4:] == ["TIMESTAMP_NS", "DOUBLE", "DOUBLE", "USMALLINT"]


@pytest.mark.parametrize(
    ("view", "channels"), [("displacement", {"dZ"}), ("temperature", {"T1"}), ("driver", {"T1", "speed"})]
)
def test_selections_by_quantity(small: Store, view: str, channels: set[str]) -> None:
    assert {c for (c,) in sql(small, f"select distinct channel from {view}")} == channels


@pytest.mark.parametrize(
    ("view", "channel"), [("displacement", "dZ"), ("temperature", "T1"), ("driver", "T1"), ("driver", "speed")]
)
def test_selections_hold_the_rows_of_sample_flagged_ones_too(small: Store, view: str, channel: str) -> None:
    rows = sql(small, f"select * from {view} where channel = ? order by all", channel)
    assert rows == sql(small, "select * from sample where channel = ? order by all", channel)
    assert rows
    assert any(flag for *_, flag in rows) == (view == "displacement")


def test_valid_tells_what_counts_in_means(small: Store) -> None:
    counting = "select test, count(*), sum(value) from displacement where valid(flag) group by 1 order by 1"
    assert sql(small, counting) == [("a", 5, 130.0), ("b", 5, 630.0)]  # the spike at 20 s is out
    wide = sql(small, "select view from wide where source = 'daq'")[0][0]
    assert sql(small, f"select count(*) from {wide} where test = 'a' and valid(dZ__flag)") == [(5,)]
    for flag in Flag:
        assert sql(small, f"select valid({int(flag)})") == [(not flag & INVALID,)], flag
    assert sql(small, "select valid(null), valid(1 + 8)") == [(True, False)]


def made_by_an_older_version(store: Store) -> None:
    """As stores were when the selections by quantity held the samples that count only, and nothing counted views."""
    with store._attached_for_writing(con := connection.memory(store.path)):
        con.execute("drop macro views_version; drop macro valid")
        con.execute("create or replace view displacement as select * from sample where channel = 'dZ' and flag = 0")
        kept = con.execute("select object, digest from made_from where object not like 'macro v%'").fetchall()
        rows = ", ".join(f"('{name}', '{'old' if name == 'view displacement' else digest}')" for name, digest in kept)
        con.execute(f"create or replace view made_from as select * from (values {rows}) v(object, digest)")
    (store.path / "generation").write_text("of the older version")


def test_a_store_of_an_older_version_is_read_with_our_views(own: Store) -> None:
    made_by_an_older_version(own)
    before = (own.path / "catalog.duckdb").read_bytes()
    other = Store(own.path)
    assert sql(other, "select count(*), count(*) filter (where valid(flag)) from displacement") == [(12, 10)]
    assert (own.path / "catalog.duckdb").read_bytes() == before, "who reads writes nothing"


def test_the_next_write_of_any_kind_brings_the_views_of_an_older_version_up(own: Store) -> None:
    made_by_an_older_version(own)
    with own._attached_for_writing(con := connection.memory(own.path)):
        assert not of_this_version(con)
    with own.write(views=False):
        pass
    with own._attached_for_writing(con := connection.memory(own.path)):
        assert of_this_version(con)
        assert con.execute("select count(*) from displacement").fetchone() == (12,)


def test_an_older_store_with_a_damaged_file_is_still_read(own: Store) -> None:
    made_by_an_older_version(own)
    for path in (own.path / "tidy").iterdir():
        path.write_bytes(b"x" * path.stat().st_size)  # as long as it was: only DuckDB sees it
    assert sql(Store(own.path), "select count(*) from test") == [(3,)]


def test_signal_gives_the_rows_of_sample(small: Store) -> None:
    for channel, source in (("dZ", "daq"), ("speed", "nc")):
        rows = sql(small, "select * from signal(?, ?, ?)", "c", "b", channel)
        assert rows == sql(small, "select * from sample where test = 'b' and channel = ? order by t", channel)
        assert {r[2] for r in rows} == {source}


def test_signal_of_a_test_without_files_is_empty(small: Store) -> None:
    assert sql(small, "select * from signal('c', 'nothing', 'dZ')") == []


@pytest.mark.parametrize(
    ("call", "word"),
    [
        ("'x', 'a', 'dZ'", "no campaign 'x'; there is: c"),
        ("'c', 'x', 'dZ'", "no test 'x' in campaign 'c'; there is: a, b, nothing"),
        ("'c', 'a', 'x'", "no channel of numbers 'x'"),
        ("'c', 'a', 'program'", "no channel of numbers 'program'"),
    ],
)
def test_signal_names_the_choices(small: Store, call: str, word: str) -> None:
    with pytest.raises(duckdb.Error, match=word):
        sql(small, f"select * from signal({call})")


def test_wide_views_have_units_as_comments(small: Store) -> None:
    assert sql(small, "select source, view from wide order by 1") == [("daq", "wide_c_daq"), ("nc", "wide_c_nc")]
    assert sql(small, "select test, dZ, dZ__flag from wide_c_daq where t_s = 20 order by 1") == [
        ("a", 20.0, 8),
        ("b", 120.0, 8),
    ]
    assert sql(small, "select program from wide_c_nc where test = 'a' and t_s = 40") == [("P2",)]
    assert sql(
        small, "select comment from duckdb_columns() where table_name = 'wide_c_daq' and column_name = 'dZ'"
    ) == [("[um] displacement, axis Z, at tcp, relative to table",)]


def test_every_column_of_numbers_says_its_unit(small: Store) -> None:
    assert (
        sql(
            small,
            "select table_name, column_name from duckdb_columns() where not internal and comment is null "
            "and data_type in ('DOUBLE', 'DOUBLE[]', 'TIMESTAMP_NS')",
        )
        == []
    )


def test_every_column_by_which_rows_are_told_apart_says_what_it_is(small: Store) -> None:
    names = ", ".join(f"'{name}'" for name in IDENTIFIERS)
    query = (
        "select c.table_name, c.column_name from duckdb_columns() c join duckdb_views() v "
        "on v.view_name = c.table_name and v.database_name = c.database_name "
        f"where not c.internal and c.comment is null and c.column_name in ({names})"
    )
    assert sql(small, query) == []
    said = "select comment from duckdb_columns() where table_name = 'sample' and column_name = 'test'"
    assert sql(small, said) == [(IDENTIFIERS["test"],)]


def test_phases_gaps_and_quality(small: Store) -> None:
    assert sql(small, "select * from phase") == [
        ("c", "a", "heating", 0.0, 30.0),
        ("c", "a", "odd '$.name\"", 30.0, 60.0),
    ]
    assert sql(small, "select test, channel, duration_s from gap") == [("a", "dZ", 3.0)]
    assert sql(small, "select flag, n from quality") == [("gap", 1)]


def test_histories_before_a_window_are_not_shown(build: Build) -> None:
    b = build()
    b.test("c", "a")
    b.tidy("c", "a", [0.0, 1.0], {"dZ": [1.0, 2.0]})
    b.tidy("c", "a", [-2.0, -1.0], {"dZ": [7.0, 8.0]}, part="history")
    assert sql(b.store(), "select value from sample order by t") == [(1.0,), (2.0,)]


HOSTILE = ["it's", 'quo"te', "a b; drop table test; --", "ünï", "x' || error('no') || '", "$1 {test}", "p__test"]


def test_hostile_names_stay_names(build: Build) -> None:
    b = build('st\'ore "x" ü')
    for k, test in enumerate(HOSTILE):
        b.test("c", test)
        b.tidy(
            "c",
            test,
            [0.0, 1.0],
            {"k": [k + 0.25, k + 0.75], "step": [1.0, 2.0], "g": [0.0, 1.0], "channel": [5.0, 5.0]},
            source="s'r\"c",
            name=f"f{k}'%s" if k % 2 else f"h'\"{k}",
        )
    store = b.store()
    for k, test in enumerate(HOSTILE):
        assert sql(store, "select test, value from signal('c', ?, 'k')", test) == [(test, k + 0.25), (test, k + 0.75)]
        assert sql(
            store, "select test, source, sum(value) from sample where test = ? and channel = 'k' group by all", test
        ) == [(test, "s'r\"c", 2 * k + 1.0)]
        assert sql(store, "select test, k, step, g, channel from binned('c', ?, '2 s')", test) == [
            (test, k + 0.5, 1.5, 0.5, 5.0)
        ]
        assert sql(store, "select test, k from aligned('c', ?, 1)", test) == [(test, k + 0.25), (test, k + 0.75)]
    assert sql(store, "select count(*) from test") == [(len(HOSTILE),)]


@pytest.mark.parametrize("folder", ["a [1]", "st*r", " padded ", "per%cent", "~home", "../b"])
def test_any_folder_may_be_a_store(build: Build, folder: str) -> None:
    b = build(folder)
    b.test("c", "a")
    b.tidy("c", "a", [0.0], {"dZ": [1.0]})
    store = b.store()
    assert sql(store, "select value from sample") == [(1.0,)]
    assert sql(store, "select value from signal('c', 'a', 'dZ')") == [(1.0,)]


def test_names_that_sanitise_alike_get_their_own_views(build: Build) -> None:
    b = build()
    for campaign in ("a-b", "a_b", "A.b"):
        b.test(campaign, "t")
        b.tidy(campaign, "t", [0.0], {"dZ": [float(len(b.rows["file"]) if "file" in b.rows else 0)]})
    store = b.store()
    assert sql(store, 'select count(distinct lower("view")) from wide') == [(3,)]
    found = [sql(store, "select campaign, value from signal(?, 't', 'dZ')", c) for c in ("a-b", "a_b", "A.b")]
    assert found == [[("a-b", 0.0)], [("a_b", 1.0)], [("A.b", 2.0)]]


def test_two_streams_of_a_source_have_two_views(build: Build) -> None:
    b = build()
    b.test("c", "t")
    b.tidy("c", "t", [0.0, 1.0], {"dZ": [1.0, 2.0]}, stream="fast")
    b.tidy("c", "t", [0.0], {"T1": [20.0]}, stream="slow")
    store = b.store()
    assert sql(store, 'select "view" from wide order by 1') == [("wide_c_daq_fast",), ("wide_c_daq_slow",)]
    assert sql(store, "select channel, count(*) from sample group by 1 order by 1") == [("T1", 1), ("dZ", 2)]


def test_a_channel_that_moved_to_another_source_is_one_channel(build: Build) -> None:
    b = build()
    for test, source in (("t1", "daq"), ("t2", "nc")):
        b.test("c", test)
        b.tidy("c", test, [0.0, 30.0], {"T1": [20.0, 21.0]}, source=source)
    store = b.store()
    for test, source in (("t1", "daq"), ("t2", "nc")):
        assert sql(store, "select source, value from signal('c', ?, 'T1')", test) == [(source, 20.0), (source, 21.0)]
        assert sql(store, "select T1 from binned('c', ?, '30 s')", test) == [(20.0,), (21.0,)]


def test_residuals_of_models_with_different_effects(build: Build) -> None:
    b = build()
    for k, extra in enumerate(({}, {"c__a": [0.1, 0.2]}, {"c__b": [0.3, 0.4]})):
        b.prediction(
            "c",
            "t",
            f"m{k}",
            "dZ",
            {
                **extra,
                "t_s": [0.0, 30.0],
                "measured": [1.0 + k, 2.0],
                "predicted": [0.5, 0.5],
                "residual": [0.5 + k, 1.5],
                "valid": [True, False],
            },
        )
    store = b.store()
    assert sql(store, "select * from residual where model = 'm1' order by t_s") == [
        ("c", "t", "m1", "dZ", 0.0, 2.0, 0.5, 1.5, True, False),
        ("c", "t", "m1", "dZ", 30.0, 2.0, 0.5, 1.5, False, False),
    ]
    assert sql(store, "select count(*) from residual") == [(6,)]


def test_findings_and_history(build: Build) -> None:
    b = build()
    b.model("m1", "baseline")
    b.model("m2", "baseline", "m1")
    for model, rmse in (("m1", 4.0), ("m2", 1.0)):
        for test, role, n in (("t1", "calibration", 10), ("t2", "verification", 30), ("t3", "verification", 10)):
            b.add(
                "score_row",
                campaign="c",
                test=test,
                model=model,
                role=role,
                response="dZ",
                phase="all",
                fit=90.0,
                rmse_um=rmse * (2 if test == "t3" else 1),
                n=n,
            )
    b.finding(
        "m1",
        "weak_spot",
        {"campaign": "c", "test": "t2", "from_s": 0, "to_s": 60, "rmse_um": 5.5, "state": "heating"},
        campaign="c",
        test="t2",
        rank=1,
    )
    b.finding(
        "m1",
        "candidate",
        {
            "rank": 1,
            "id": "x",
            "effect": "lag",
            "family": "generic",
            "drivers": ["T1"],
            "claimed": True,
            "p_value": None,
            "rmse_um_before": 4,
            "beside": ["y"],
            "equivalent": [],
            "parameters": {},
            "why": "it's",
        },
        rank=1,
    )
    b.finding("m1", "diagnosis", {"verdict": "effect", "response": "dZ"})
    b.finding(
        "m1",
        "portability",
        {
            "machine": "139",
            "campaign": "d",
            "test": "t",
            "role": "none",
            "response": "dZ",
            "g": 0.5,
            "fit_n": None,
            "verdict": "portable",
        },
    )
    store = b.store()
    assert sql(
        store,
        "select version, model, rmse_um_calibration, round(rmse_um_verification, 6), rmse_um_locked, "
        "tests from history",
    ) == [
        (1, "m1", 4.0, round(float(np.sqrt((16 * 30 + 64 * 10) / 40)), 6), None, 3),
        (2, "m2", 1.0, round(float(np.sqrt((30 + 4 * 10) / 40)), 6), None, 3),
    ]
    assert sql(store, "select campaign, test, to_s, rmse_um, state, response from weak_spot") == [
        ("c", "t2", 60.0, 5.5, "heating", "dZ")
    ]
    assert sql(store, "select rank, id, drivers, claimed, p_value, rmse_um_before, why from candidate") == [
        (1, "x", ["T1"], True, None, 4.0, "it's")
    ]
    # of the whole model: its campaign, and no single test
    assert sql(store, "select campaign, test, beside from candidate") == [("c", None, ["y"])]
    assert sql(store, "select campaign, test, verdict from diagnosis") == [("c", None, "effect")]
    assert sql(store, "select machine, campaign, test, g, fit_n, verdict from portability") == [
        ("139", "d", "t", 0.5, None, "portable")
    ]


@pytest.mark.parametrize("view", ["candidate", "diagnosis"])
def test_what_is_of_several_campaigns_is_found_by_each_and_counted_once(build: Build, view: str) -> None:
    b = build()
    for campaign in ("one", "two", "other"):
        b.test(campaign, "day", role="verification")
    b.model("both", "both", campaigns=["one", "two"])
    b.finding("both", view, {"rank": 1, "id": "x", "effect": "lag", "response": "dZ", "verdict": "effect"}, rank=1)
    store = b.store()
    assert sql(store, f"select campaign, campaigns from {view}") == [(None, ["one", "two"])]
    for campaign, found in (("one", 1), ("two", 1), ("other", 0)):
        assert sql(store, f"select count(*) from {view} where list_contains(campaigns, '{campaign}')") == [(found,)]
    joined = f"select t.campaign, t.test from {view} join test t on list_contains(campaigns, t.campaign) order by all"
    assert sql(store, joined) == [("one", "day"), ("two", "day")]


def test_views_follow_the_tables(own: Store) -> None:
    with own.write() as con:
        con.execute("delete from file where test = 'a'")
    assert sql(own, "select distinct test from sample") == [("b",)]
    with own.write() as con:
        con.execute("delete from file")
    assert sql(own, "select count(*) from sample") == [(0,)]
    assert sql(own, "select count(*) from wide") == [(0,)]


def test_a_moved_store_works_also_from_inside_its_folder(
    own: Store, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    moved = tmp_path / "elsewhere"
    shutil.move(own.path, moved)
    assert sql(Store(moved), "select count(*) from sample where test = 'a'") == [(15,)]
    monkeypatch.chdir(moved)
    con = duckdb.connect("catalog.duckdb", read_only=True)
    try:
        assert con.execute("select count(*) from sample where test = 'a'").fetchall() == [(15,)]
        assert con.execute("select count(*) from signal('c', 'a', 'dZ')").fetchall() == [(6,)]
        assert con.execute("select count(*) from binned('c', 'a', '10 s')").fetchall() == [(6,)]
    finally:
        con.close()


def test_a_lost_file_is_named_to_who_asks_for_it_and_stops_nobody_else(own: Store) -> None:
    for path in (own.path / "tidy").iterdir():
        path.unlink()
    with own.reader() as con:
        regenerate(con, own.path)
        assert con.execute("select count(*) from test").fetchone() != (0,)
        with pytest.raises(duckdb.Error, match=r"damaged store: tidy/.*parquet is gone"):
            con.execute(f"select count(*) from {con.execute('select view from wide').fetchall()[0][0]}").fetchall()


def texts_of(store: Store) -> list[tuple[object, ...]]:
    # words sorted: DuckDB keeps the names after EXCLUDE in no order
    return sql(
        store,
        "select view_name, list_sort(string_split_regex(sql, '\\W+'))::varchar, comment "
        "from duckdb_views() where not internal "
        "union all select function_name || function_type, coalesce(macro_definition, ''), comment "
        "from duckdb_functions() where not internal "
        "union all select table_name || '.' || column_name, data_type, comment from duckdb_columns() "
        "where not internal order by all",
    )


def test_what_commits_change_step_by_step_equals_what_is_made_at_once(own: Store) -> None:
    for statement in (
        "delete from file where test = 'a'",
        "update channel set unit = 'mm' where channel = 'dZ'",
        "insert into campaign select 'd', spec, spec_hash, path, ingested_at, data_version from campaign",
        "delete from campaign where campaign = 'd'",
        "delete from file",
    ):
        with own.write() as con:
            con.execute(statement)
        stepwise = texts_of(own)
        with own.write() as con:
            con.execute("drop view made_from")  # as in a store of another version: all is made anew
        assert set(texts_of(own)) ^ set(stepwise) == set(), statement


def test_a_view_that_somebody_dropped_comes_back(own: Store) -> None:
    with own.write(views=False) as con:
        con.execute("drop view sample; drop view gap")
    with own.write() as con:
        con.execute("update campaign set data_version = data_version")
    assert sql(own, "select count(*) from sample where test = 'a'") == [(15,)]
