"""Times that are written oddly: found under any name, asked once, and no channel once they are answered."""

from __future__ import annotations

from datetime import datetime, timedelta
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.io

from thermodata.draft.make import draft_files
from thermodata.plugin import Source
from thermodata.reader.text import delimited
from thermodata.store import Store
from thermodata.store.ingest.run import ingest

MOMENTS = [datetime(2026, 3, 16, 8) + timedelta(seconds=10 * k) for k in range(60)]
JAVA, ITALIAN, ODD = "%b %d, %Y %I:%M:%S %p", "%d/%m/%Y %H.%M.%S", "x%Y_%m_%d__%H_%M_%S"


def written(folder: Path, head: str, form: str) -> Path:
    rows = [f'"{m:{form}}",{20 + k / 100:.2f},{k / 10:.1f}' for k, m in enumerate(MOMENTS)]
    (folder / "log.csv").write_text("\n".join([f"{head},T_bearing [degC],Z [um]", *rows, ""]), "utf-8")
    return folder


@pytest.mark.parametrize(("form", "asked"), [(JAVA, JAVA), (ITALIAN, ITALIAN)])
@pytest.mark.parametrize("head", ["t_stamp", "Data e ora", "Czas", "Datum en tijd", "Messpunkt"])
def test_stamps_are_found_under_any_name_and_only_to_be_confirmed(
    tmp_path: Path, head: str, form: str, asked: str
) -> None:
    draft = draft_files(written(tmp_path, head, form)).draft
    (source,) = draft.sources
    assert source.table == {"time": {"column": 1, "format": asked}}
    assert [c.name for c in draft.channels] == ["T_bearing", "Z"]


@pytest.mark.parametrize("cell", ["P-16-03-2026", "part 16", "DE 16 03", "16/03/2026"])
def test_words_with_digits_are_no_times(tmp_path: Path, cell: str) -> None:
    """Of a part, of a position, or of when something was calibrated."""
    rows = [f"{cell}{k if cell.startswith('P') else ''},{20 + k / 100:.2f},{k / 10:.1f}" for k in range(60)]
    (tmp_path / "log.csv").write_text("\n".join(["part,T_bearing [degC],Z [um]", *rows, ""]), "utf-8")
    (source,) = draft_files(tmp_path).draft.sources
    assert "format" not in source.table.get("time", {})


def ingested(folder: Path, time: str, channels: str) -> Any:
    (folder / "campaign.yaml").write_text(
        "schema: thermodata/campaign/1\nid: c\nmachine: {id: x}\n"
        f'sources:\n  log: {{reader: table, files: "{{test}}.csv", timezone: UTC, table: {{time: {time}}}}}\n'
        "channels:\n  T_b: {source: log, signal: T_bearing, quantity: temperature, at: spindle.bearing}\n"
        f"{channels}tests:\n  - {{id: log, kind: other, role: none}}\n"
    )
    store = Store(folder / "store", create=True)
    return ingest(store, folder / "campaign.yaml")


def test_a_line_for_what_is_the_time_now_is_no_loss(tmp_path: Path) -> None:
    told = ingested(
        written(tmp_path, "t_mark", ODD),
        f'{{column: t_mark, format: "{ODD}"}}',
        "  t_mark: {source: log, signal: t_mark, quantity: label}\n",
    )
    assert not told.losses
    assert any("'t_mark' is the time of 'log'" in n for n in told.notes)


def test_a_line_for_a_signal_that_no_file_has_is_one(tmp_path: Path) -> None:
    time = f'{{column: 1, format: "{ODD}"}}'
    told = ingested(written(tmp_path, "t_mark", ODD), time, "  other: {source: log, signal: other, quantity: label}\n")
    (loss,) = told.losses
    assert "no signal 'other'" in loss["reason"]
    assert "delete the channel where its column is the time" in loss["reason"]


def test_a_time_in_an_odd_spelling_is_drafted_as_no_channel(tmp_path: Path) -> None:
    draft = draft_files(written(tmp_path, "Time", ODD)).draft
    assert draft.sources[0].table == {"time": {"column": 1, "format": "unknown"}}
    assert [c.name for c in draft.channels] == ["T_bearing", "Z"]


@pytest.mark.parametrize(
    ("columns", "proposed"),
    [
        (
            "Nr;Status;Laufwert;T1 [°C]",
            "'Laufwert' the time? then time: {column: 3, unit: unknown} and, for unknown, s, min",
        ),
        (
            "Nr;Status;Stufe;T1 [°C]",
            "is 'Nr' the time? then time: {column: 1, unit: unknown} and, for unknown, s, min",
        ),
    ],
)
def test_the_column_that_is_proposed_for_the_time_is_none_that_numbers_the_rows(
    tmp_path: Path, columns: str, proposed: str
) -> None:
    third = [10 * k if "Laufwert" in columns else k * k % 7 for k in range(60)]
    rows = [f"{k};0;{third[k]};{20 + k % 9},5" for k in range(60)]
    (tmp_path / "log.csv").write_text("\n".join([columns, *rows, ""]), "utf-8")
    (source,) = draft_files(tmp_path).draft.sources
    assert any(proposed in q for q in source.questions)


def written_under(folder: Path, head: str) -> Path:
    path = folder / "log.csv"
    path.write_text("\n".join([f"{head};T1 [°C]", *(f"{k / 3:.4f};{20 + k % 9}.5" for k in range(60)), ""]), "utf-8")
    return path


@pytest.mark.parametrize(
    ("head", "unit"),
    [("Minuti", "min"), ("Min.", "min"), ("Minuty", "min"), ("hodiny", "h"), ("Ore", "h"), ("経過分", "min")],
)
def test_a_column_named_by_its_unit_is_proposed_in_it(tmp_path: Path, head: str, unit: str) -> None:
    written_under(tmp_path, head)
    (source,) = draft_files(tmp_path).draft.sources
    assert any(q.endswith(f"is '{head}' the time? then time: {{column: 1, unit: {unit}}}") for q in source.questions)


@pytest.mark.parametrize(
    ("head", "seconds"),
    [
        ("Čas (minuty)", 60),
        ("Čas v minutách", 60),
        ("Tempo (minuti)", 60),
        ("Tiempo en minutos", 60),
        ("时间(分钟)", 60),
        ("Время (минуты)", 60),
        ("t(min.)", 60),
        ("Tempo (ore)", 3600),
        ("Zeit in Sekunden", 1),
    ],
)
def test_units_of_time_are_words_of_many_languages(tmp_path: Path, head: str, seconds: float) -> None:
    table = delimited.open_table(written_under(tmp_path, head), Source())
    assert [table.layout.names[i] for i in table.layout.time] == [head]
    assert [g.seconds for g in table.layout.groups] == [seconds]


@pytest.mark.parametrize("head", ["Czas [s]", "Tijd [s]", "Tid (s)", "Ora [s]", "Время [s]", "t_stamp [s]"])
def test_words_for_time_of_more_languages(tmp_path: Path, head: str) -> None:
    (tmp_path / "log.csv").write_text(
        "\n".join([f"Nr;{head};T1", *(f"{k};{10 * k};{20 + k % 9},5" for k in range(60))])
    )
    table = delimited.open_table(tmp_path / "log.csv", Source())
    assert [table.layout.names[i] for i in table.layout.time] == [head]


def test_a_time_that_the_interval_above_it_contradicts_is_asked(tmp_path: Path) -> None:
    rows = [f"{k},{20 + k / 100:.2f},{k / 10:.1f}" for k in range(60)]
    head = ["# Sample interval: 10 s", "Time [s],T_bearing [degC],Z [um]"]
    (tmp_path / "log.csv").write_text("\n".join([*head, *rows, ""]), "utf-8")
    draft_files(tmp_path)
    assert "every 10 s by 'Sample interval: 10 s' above them: which one is it?" in (
        tmp_path / "campaign.yaml"
    ).read_text("utf-8")


@pytest.mark.parametrize(
    ("said", "asked"),
    [
        ("2026-05-11 06:00:00 UTC", "start: head or none? a text beside the signals says 'start_time: 2026-05-11"),
        ("03/04/2026 06:00:00", "start: dmy or mdy? a text beside the signals says 'start_time: 03/04/2026"),
        ("at once", None),
    ],
)
def test_the_start_beside_the_signals_of_a_mat_file_is_asked(tmp_path: Path, said: str, asked: str | None) -> None:
    k = np.arange(60.0)
    columns = {"time_s": 10 * k, "dZ_um": k / 100, "T_bed": 21 + k / 100, "start_time": said}
    scipy.io.savemat(tmp_path / "day.mat", columns)
    (source,) = draft_files(tmp_path).draft.sources
    assert [q.startswith(asked) for q in source.questions if asked and "start:" in q] == [True] * bool(asked)
    assert bool(source.questions) == bool(asked)
