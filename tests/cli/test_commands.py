from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import click
import pytest

from thermodata.cli.app import COMMANDS, Commands, cli
from thermodata.errors import StoreError
from thermodata.store import Store
from thermodata.store.catalogue.models.findings import save_findings
from thermodata.store.catalogue.models.fits import find_model
from thermodata.view.lists.events import about_test

from ..commands import Said, Say
from .conftest import write_campaign

CONTRACT = {
    "demo",
    "init",
    "sniff",
    "preview",
    "ingest",
    "calibrations",
    "tests",
    "channels",
    "quality",
    "trace",
    "sql",
    "snapshot",
    "export",
    "fit",
    "compare",
    "portability",
    "diagnose",
    "add",
    "remove",
    "confirm",
    "history",
    "orders",
    "profiles",
    "show",
    "predict",
    "model",
    "report",
    "workbench",
    "simulate",
    "benchmark-diagnosis",
    "plugins",
    "schema",
    "forget",
    "gc",
}


def commands() -> list[tuple[str, click.Command]]:
    group = cli
    assert isinstance(group, Commands)
    found = [(name, group.get_command(click.Context(group), name)) for name in COMMANDS]
    return [(name, command) for name, command in found if command is not None]


def test_every_command_of_the_contract_is_there() -> None:
    assert set(COMMANDS) >= CONTRACT
    assert {name for name, _ in commands()} == set(COMMANDS)


@pytest.mark.parametrize(("name", "command"), commands())
def test_every_command_is_documented(name: str, command: click.Command) -> None:
    assert command.name == name
    first = (command.help or "").strip().split("\n\n")[0]
    assert re.match(r"[A-Z].*\.$", first, re.S), f"{name}: a help that starts with a sentence"
    assert len(first) <= 75, f"{name}: the first sentence is the line in 'thermodata --help'"
    for parameter in command.params:
        if isinstance(parameter, click.Option):
            assert parameter.help, f"{name} {parameter.opts}: an option without help"
            shown = parameter.make_metavar(click.Context(command))
            assert shown not in ("TEXT", "FLOAT"), f"{name} {parameter.opts}: say what of, as CAMPAIGN, TIME, UM"


@pytest.mark.parametrize(("name", "command"), commands())
def test_every_command_answers_json(name: str, command: click.Command) -> None:
    assert any("--json" in p.opts for p in command.params)


def test_help_loads_nothing_that_takes_time() -> None:
    code = """if True:
        import sys
        from thermodata.cli import main
        main(['--help'])
        print(sorted({'duckdb', 'numpy', 'pandas', 'pyarrow', 'scipy', 'pint'} & set(sys.modules)))"""
    done = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    assert done.stdout.splitlines()[-1] == "[]"


def test_help_imports_nothing_heavy() -> None:
    code = (
        "import sys; from thermodata.cli import main; main(['--help']); "
        "print([m for m in ('duckdb','pandas','scipy','pyarrow','nptdms','pint','pydantic') "
        "if m in sys.modules], file=sys.stderr)"
    )
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True).stderr.strip() == "[]"


@pytest.mark.parametrize(
    "words",
    [["tests"], ["channels"], ["sql", "select campaign, test, rows, step_s, complete from source"]],
    ids=lambda words: words[0],
)
def test_a_look_at_the_catalogue_loads_no_schema_of_files_and_no_arrow(tmp_path: Path, words: list[str]) -> None:
    Store(tmp_path / "store", create=True)
    code = (
        f"import sys; from thermodata.cli import main; main({['--store', str(tmp_path / 'store'), *words]}); "
        "print([m for m in ('pyarrow', 'pandas', 'pydantic', 'scipy') if m in sys.modules], file=sys.stderr)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.stderr.splitlines()[-1] == "[]"


@pytest.mark.parametrize(
    "query",
    [
        "select x, -x, x / 3, x > 1, x::varchar || 'ä', null::varchar, x::usmallint, x::tinyint from range(3) r(x)",
        "select 'nan'::double, 'inf'::double, 1e300, true, 9223372036854775807",
        "select date '2026-03-02', timestamp '2026-03-02 08:00:00', [1, 2], 1.50::decimal(9, 2)",
        "select 1 where false",
    ],
)
def test_a_table_is_the_same_with_and_without_arrow(
    say: Say, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, query: str
) -> None:
    Store(tmp_path / "store", create=True)
    shown = say("--store", tmp_path / "store", "sql", query)
    assert shown.code == 0, shown.err
    monkeypatch.setattr("thermodata.cli.look.query._ALIKE", set())
    assert say("--store", tmp_path / "store", "sql", query) == shown


def test_an_unknown_command_names_the_nearest(say: Say) -> None:
    said = say("diagnos", "x")
    assert (said.code, said.out) == (2, "")
    assert said.err.startswith("error: no command 'diagnos'")
    assert "did you mean 'diagnose'?" in said.err
    for word, meant in (("new-plugin", "plugins new"), ("export-model", "model export"), ("ingets", "ingest")):
        assert f"did you mean '{meant}'?" in say(word).err


@pytest.mark.parametrize("words", [["fit"], ["fit", "a", "b", "c"], ["tests", "--nope"], ["report", "--nope"]])
def test_wrong_usage_is_2_and_says_where_help_is(say: Say, words: list[str]) -> None:
    said = say(*words)
    assert (said.code, said.out) == (2, "")
    assert said.err.startswith("error: ")
    assert "--help" in said.err


def test_columns_without_a_value_that_have_no_room_are_named(say: Say, made_campaign: Path) -> None:
    done = say(
        "--store",
        made_campaign / "thermodata.store",
        "sql",
        "select * from channel where quantity = 'temperature' limit 3",
    )
    assert "relative_to" not in done.out
    (said,) = [line for line in done.err.splitlines() if line.startswith("without a value")]
    assert "without a value in these rows: axis, relative_to" in said
    done = say(
        "--store",
        made_campaign / "thermodata.store",
        "sql",
        "select channel, axis from channel where quantity = 'temperature' limit 3",
    )
    assert "without a value" not in done.err, "it is seen"


@pytest.mark.parametrize("command", [["tests"], ["fit", "baseline"], ["sql", "select 1"], ["gc"], ["report", "x"]])
def test_without_a_store_the_hint_is_ingest(say: Say, tmp_path: Path, command: list[str]) -> None:
    said = say("--store", tmp_path / "none", *command)
    assert said.code == 2
    assert f"where: {tmp_path / 'none'}" in said.err
    assert "thermodata ingest" in said.err
    assert not (tmp_path / "none").exists()


def test_the_store_may_stand_after_the_command_or_in_the_environment(
    say: Say, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert str(tmp_path / "after") in say("tests", "--store", tmp_path / "after").err
    monkeypatch.setenv("THERMODATA_STORE", str(tmp_path / "variable"))
    assert str(tmp_path / "variable") in say("tests").err


@pytest.mark.parametrize(
    ("error", "code", "text"),
    [
        (
            StoreError("the store is busy", where="s", expected="a turn", got="60 s", hint="again"),
            4,
            "error: the store is busy\nwhere: s\nexpected: a turn, got: 60 s\ntry: again\n",
        ),
        (KeyboardInterrupt(), 130, "error: interrupted\n"),
        (
            PermissionError(13, "Permission denied", "x.tdms"),
            1,
            "error: no right to read or write there\nwhere: x.tdms\n"
            "got: Permission denied\n"
            "try: name a folder of your own, or give yourself the right\n",
        ),
    ],
)
def test_errors_become_lines_and_codes(
    say: Say, monkeypatch: pytest.MonkeyPatch, error: BaseException, code: int, text: str
) -> None:
    def fail(*_: object) -> None:
        raise error

    monkeypatch.setattr("thermodata.cli.keep.plugins.installed", fail)
    said = say("plugins")
    assert (said.code, said.out, said.err.lstrip("\n")) == (code, "", text)  # click ends the line of ^C


def test_a_defect_says_so_and_keeps_the_traceback_for_debugging(say: Say, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail() -> None:
        raise KeyError("x")

    monkeypatch.setattr("thermodata.cli.keep.plugins.installed", fail)
    said = say("plugins")
    assert said.code == 1
    assert said.err.startswith("error: a defect in thermodata: KeyError: 'x'")
    monkeypatch.setenv("THERMODATA_DEBUG", "1")
    with pytest.raises(KeyError):
        say("plugins")


def test_quality_counts_what_ingest_did_not_measure(say: Callable[..., Said], tmp_path: Path) -> None:
    path = write_campaign(tmp_path / "lab")
    store = tmp_path / "store"
    say("--store", store, "ingest", path)
    assert "not_measuring" not in say("--store", store, "quality").out
    path.write_text(path.read_text().replace("id: day1,", 'id: day1, measuring: "spindle_speed == 0",'))
    flags = json.loads(say("--store", store, "ingest", path, "--json").out)["flags"]
    assert flags["not_measuring"] > 0
    for more in ((), ("--events",)):
        rows = json.loads(say("--store", store, "quality", *more, "--json").out)
        (row,) = [row for row in rows if row["flag"] == "not_measuring"]
        assert (row["test"], row["n"], row["from_s"]) == ("day1", flags["not_measuring"], None)
    said = " ".join(say("--store", store, "quality").out.split())
    assert f"not_measuring {flags['not_measuring']}" in said


def test_what_a_log_did_not_measure_is_told_with_its_times_and_does_not_count(say: Say, tmp_path: Path) -> None:
    """Where no `measuring` is declared it is the log that says so: here in its comments."""
    (tmp_path / "raw").mkdir()
    head = "LabVIEW Measurement\nSeparator\tTab\nDecimal_Separator\t.\nX_Columns\tOne\nTime_Pref\tAbsolute\n"
    head += "Date\t2026/03/02\nTime\t08:00:00.0\n***End_of_Header***\n\nChannels\t1\nSamples\t120\nX0\t0.0\n"
    head += "Delta_X\t60.0\n***End_of_Header***\nX_Value\tT_bed\tComment\n"
    lost = {50, 51, 52, 90}
    rows = [f"{60 * i}.0\t{20 + i % 7 / 10:.1f}\t{'LOST COMMUNICATION' if i in lost else ''}\n" for i in range(120)]
    (tmp_path / "raw" / "day1.lvm").write_text(head + "".join(rows), encoding="utf-8")
    path, store = tmp_path / "campaign.yaml", tmp_path / "store"
    path.write_text(
        "schema: thermodata/campaign/1\nid: small\nmachine: {id: m}\n"
        'sources: {daq: {reader: crio, files: "raw/{test}.lvm", timezone: UTC}}\n'
        "channels: {T_bed: {source: daq, signal: T_bed, quantity: temperature, unit: degC, at: bed}}\n"
        "tests: [{id: day1, kind: other, role: calibration}]\n",
        encoding="utf-8",
    )
    say("--store", store, "ingest", path)
    found = json.loads(say("--store", store, "quality", "--events", "--json").out)
    events = [e for e in found if e["flag"] == "not_measuring"]
    assert [(e["test"], e["channel"], e["from_s"], e["to_s"], e["n"]) for e in events] == [
        ("day1", "T_bed", 3000.0, 3120.0, 3),
        ("day1", "T_bed", 5400.0, 5400.0, 1),
    ]
    assert events[0]["detail"].startswith("the log has no value there")
    out = tmp_path / "q.html"
    say("--store", store, "quality", "--report", out)
    page = out.read_text(encoding="utf-8")
    assert re.search(r"samples do not count: [a-z, ]*not measuring", page)
    told = about_test(Store(store), "small", "day1").flagged
    assert [(f.channel, f.flag, f.from_s) for f in told] == [
        ("T_bed", "not_measuring", 3000.0),
        ("T_bed", "not_measuring", 5400.0),
    ]


def test_several_tests_are_exported_to_a_file_each(say: Say, campaign: Path, tmp_path: Path) -> None:
    words = ("--store", campaign / "thermodata.store", "export", "small")
    out = tmp_path / "new" / "{test}.csv"
    made = json.loads(say(*words, "heat1", "day1", out, "--json").out)
    assert [one["path"] for one in made] == [str(tmp_path / "new" / f"{test}.csv") for test in ("heat1", "day1")]
    assert all(Path(one["path"]).read_text().count("\n") == one["rows"] + 1 for one in made)
    assert "--force replaces it" in say(*words, "heat2", "day1", out).err
    assert not (tmp_path / "new" / "heat2.csv").exists(), "none where one is refused"
    every = json.loads(say(*words, out, "--force", "--json").out)
    assert [Path(one["path"]).stem for one in every] == ["heat1", "heat2", "day1", "day2"]
    one = json.loads(say(*words, "heat1", tmp_path / "one.csv", "--json").out)
    assert one["path"] == str(tmp_path / "one.csv")
    said = say(*words, "heat1", "heat2", tmp_path / "both.csv")
    assert said.code == 2
    assert f"name it '{tmp_path / 'both_{test}.csv'}'" in said.err
    assert "no test 'heat9'" in say(*words, "heat1", "heat9", out, "--force").err
    assert say(*words, "heat1", "heat1", tmp_path / "once.csv").code == 0, "named twice it is one test"
    assert "try: thermodata export small heat1 heat1.csv" in say(*words, "heat1").err
    told = say(*words, "heat1", tmp_path / "two.csv").out
    assert re.search(r"^columns  campaign, test, time_utc, t_s \[s\], ", told, re.M), "each column once, with its unit"
    assert "units " not in told
    told = say(*words, "heat1", "day1", out, "--force").out
    assert told.count("T_hall") == 1, "columns that are alike are told once"
    assert re.search(r"^columns  the same \d+$", told, re.M)


def test_quality_tells_what_a_diagnosis_told_of_the_logs_and_no_flag_does(
    say: Say, campaign: Path, tmp_path: Path
) -> None:
    shutil.copytree(campaign / "thermodata.store", tmp_path / "store")
    store = Store(tmp_path / "store")
    model = find_model(store, "baseline").model
    assert "told by diagnose" not in say("--store", store.path, "quality").out
    told = [("step", "day1", 10_410.0, 25.0), ("sensor", "day1", None, None), ("clock_offset", "", None, None)]
    rows = [("small", test, {"kind": kind, "at_s": at, "size_um": size}) for kind, test, at, size in told]
    save_findings(store, model, "artefact", rows)
    save_findings(store, model, "diagnosis", [("", "", {"response": "dZ"})])
    said = say("--store", store.path, "quality").out
    assert f"  - step in small/day1 at 2.9 h, dZ by +25 (baseline {model[:6]})" in said
    assert f"  - clock_offset in all tests of small (baseline {model[:6]})" in said
    assert "sensor" not in said
