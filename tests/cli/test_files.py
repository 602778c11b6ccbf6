"""`init`, `sniff` and `preview` on the command line."""

from __future__ import annotations

import json
import os
from pathlib import Path

import numpy as np
import pytest

from thermodata.reader.finding import registry

from ..commands import Say
from .conftest import write_campaign


def csv(path: Path, rows: int = 200, gap: bool = False) -> Path:
    """A log with a spike, and a gap where wished."""
    rng = np.random.default_rng(1)
    t = np.arange(rows) * 10.0
    if gap:
        t[rows // 2 :] += 3600
    temperature = 20 + 5 * (1 - np.exp(-np.arange(rows) / 60)) + rng.normal(0, 0.02, rows)
    temperature[rows // 3] = 85.0
    lines = ["time [s],T_bearing_front [degC],Spindle speed [rpm],state"]
    lines += [
        f"{a:.0f},{b:.3f},{6000 if 20 < i < 150 else 0},{'on' if i > 20 else 'off'}"
        for i, (a, b) in enumerate(zip(t, temperature, strict=True))
    ]
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def test_init_never_overwrites(say: Say, tmp_path: Path) -> None:
    csv(tmp_path / "a.csv")
    (tmp_path / "campaign.yaml").write_text("mine\n")
    assert say("init", tmp_path).code == 2
    assert (tmp_path / "campaign.yaml").read_text() == "mine\n"
    assert say("init", tmp_path, "--force").code == 0
    assert (tmp_path / "campaign.1.yaml").read_text() == "mine\n"
    assert "schema: thermodata/campaign/1" in (tmp_path / "campaign.yaml").read_text("utf-8")


def test_init_of_a_folder_without_logs_says_what_it_saw(say: Say, tmp_path: Path) -> None:
    (tmp_path / "notes.txt").write_text("nothing\n")
    said = say("init", tmp_path)
    assert said.code == 0
    assert "no reader claims any file" in said.err
    draft = (tmp_path / "campaign.yaml").read_text()
    assert "notes.txt" in draft
    assert "# ?" in draft


def test_init_says_how_many_files_it_leaves_out_and_which(say: Say, tmp_path: Path) -> None:
    csv(tmp_path / "a.csv")
    assert "not used" not in say("init", tmp_path).err
    for k in range(7):
        (tmp_path / f"notes{k}.txt").write_text("nothing\n")
    *_, left_out, summary, _ = say("init", tmp_path, "--force").err.splitlines()
    assert left_out.startswith("7 of 8 files are not used (notes0.txt, notes1.txt, ")
    assert left_out.endswith("notes4.txt and 2 more): the end of campaign.yaml says why")
    assert summary.startswith("1 file, ")


def test_init_talks_on_stderr_and_shows_no_progress_when_piped(say: Say, tmp_path: Path) -> None:
    csv(tmp_path / "a.csv")
    said = say("init", tmp_path)
    assert said.out.strip().endswith("campaign.yaml")
    assert "lines hold a question" in said.err
    assert "\x1b" not in said.err


def test_sniff_explains_every_readers_answer(say: Say, tmp_path: Path) -> None:
    log, notes = csv(tmp_path / "a.csv"), tmp_path / "notes.txt"
    notes.write_text("The door was open.\n")
    said = say("sniff", log, notes, "--json")
    assert said.code == 2
    good, bad = json.loads(said.out)
    assert (good["reader"], good["advice"]) == ("table", None)
    assert set(good["others"]) == {"cnc", "crio", "mcap"}
    assert "TDMS" in good["others"]["crio"]
    assert (bad["reader"], bad["claims"]) == (None, {})
    assert bad["kind"].startswith("text")
    assert all("made to try" in why for why in bad["others"].values())
    text = say("sniff", log, notes).out
    assert "  yes      table:" in text
    assert "table: table:" not in text
    assert "  no       crio:" in text


def test_sniff_takes_folders(say: Say, tmp_path: Path) -> None:
    for i in range(7):
        csv(tmp_path / "raw" / f"{i}.csv")
    said = say("sniff", tmp_path / "raw", "--json")
    assert said.code == 0
    assert {r["reader"] for r in json.loads(said.out)} == {"table"}
    assert len(say("sniff", tmp_path / "raw").out.splitlines()) > 7


def test_sniff_passes_stores_over(say: Say, tmp_path: Path) -> None:
    for name in ("a.csv", "thermodata.store/lock.csv", "kept/catalog.duckdb", "kept/raw/b.csv"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        csv(tmp_path / name)
    found = json.loads(say("sniff", tmp_path, tmp_path / "thermodata.store", "--json").out)
    assert [r["file"] for r in found] == [str(tmp_path / "a.csv")]
    assert "1 file, " in say("init", tmp_path).err


def test_a_reader_that_does_not_load_shows_in_the_exit_code(
    say: Say, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    log = csv(tmp_path / "a.csv")
    good = registry.readers()
    monkeypatch.setattr(registry, "_readers_and_failures", lambda: (good, {"cnc": "ImportError: no part"}))
    del good["cnc"]
    said = say("sniff", log, "--json")
    assert said.code == 3
    assert json.loads(said.out)[0]["others"]["cnc"] == "does not load: ImportError: no part"
    assert say("init", tmp_path).code == 3


@pytest.mark.parametrize(
    ("content", "kind"),
    [
        (b"", "an empty file"),
        (b"PK\x03\x04rest", "a ZIP file"),
        (b"\x00\x01\x02\x03", "binary"),
        (b"  \n \n", "blanks only"),
        (b"TDSh\x0e", "the index of a TDMS file"),
        (b"\x1f\x8b\x08", "gzip"),
    ],
)
def test_sniff_says_what_a_foreign_file_is(say: Say, tmp_path: Path, content: bytes, kind: str) -> None:
    (tmp_path / "x.bin").write_bytes(content)
    assert json.loads(say("sniff", tmp_path / "x.bin", "--json").out)[0]["kind"].startswith(kind)


def test_preview_flags_the_end_of_a_probe_as_an_ingest_does(say: Say, tmp_path: Path) -> None:
    """Between two visits to its probe a machine takes it to its rail, for minutes and in its converter's noise."""
    rng = np.random.default_rng(4)
    n = 1500
    here = np.arange(n) % 30 < 4
    volts = np.where(here, 5 + np.arange(n) / 5000 + rng.normal(0, 0.002, n), 9.998 + rng.normal(0, 4e-4, n))
    rows = [f"{10 * i},{x:.6f},{20 + i / 1000:.3f}" for i, x in enumerate(volts)]
    (tmp_path / "work.csv").write_text("\n".join(["t [s],Probe Z [V],T bed [degC]", *rows, ""]), "utf-8")
    stream = json.loads(say("preview", tmp_path / "work.csv", "--json").out)["streams"][0]
    probe = next(s for s in stream["signals"] if s["name"].startswith("Probe Z"))
    assert probe["flags"] == {"saturated": int((~here).sum())}
    assert {e["flag"] for e in stream["events"]} == {"saturated"}


def test_preview_shows_rate_gaps_courses_and_flags(say: Say, tmp_path: Path) -> None:
    found = json.loads(say("preview", csv(tmp_path / "a.csv", gap=True), "--rows", 3, "--json").out)
    stream = found["streams"][0]
    assert (stream["rows"], stream["step_s"], stream["gaps"], stream["largest_step_s"]) == (200, 10.0, 1, 3610.0)
    assert found["whole"] is True
    signals = {s["name"]: s for s in stream["signals"]}
    front = signals["T_bearing_front [degC]"]
    assert front["quantity"] == "temperature"
    assert front["guess"] == "sure: name and unit"
    assert front["flags"]["spike"] == 1
    assert len(front["sparkline"]) == 32
    assert front["values"]["high"] == 85.0
    assert any(e["flag"] == "spike" and e["signal"] == front["name"] for e in stream["events"])
    text = say("preview", tmp_path / "a.csv").out
    assert "would be flagged" in text
    assert "1 gaps (longest step 60.2 min)" in text


def test_preview_flags_no_time_stamp_or_count(say: Say, tmp_path: Path) -> None:
    """An ingest makes no channel of these; a column of which nothing is known is flagged as a probe's."""
    lines = [f"{k},{(1_772_438_400 + k) * 10**9},{5 * 10**9 + k},{5 * 10**9 + k}" for k in range(600)]
    (tmp_path / "a.csv").write_text("\n".join(["t [s],publish_time,counter,ai0", *lines, ""]), encoding="utf-8")
    (stream,) = json.loads(say("preview", tmp_path / "a.csv", "--json").out)["streams"]
    by_name = {s["name"]: s for s in stream["signals"]}
    assert {n: by_name[n]["quantity"] for n in ("publish_time", "counter")} == {"publish_time": None, "counter": None}
    assert {n: bool(s["flags"]) for n, s in by_name.items()} == {"publish_time": False, "counter": False, "ai0": True}


def test_preview_reads_a_file_as_its_campaign_declares_it(say: Say, tmp_path: Path) -> None:
    path = write_campaign(tmp_path / "c")
    log = tmp_path / "c" / "raw" / "heat1.csv"
    found = json.loads(say("preview", log, "--json").out)
    assert found["campaign"] == {"file": str(path), "source": "log", "test": "heat1"}
    assert {s["channel"] for s in found["streams"][0]["signals"]} >= {"dZ", "T_nut_Z"}
    other = csv(tmp_path / "other.csv")
    assert "does not name this file" in say("preview", other, "--campaign", path).err
    assert json.loads(say("preview", other, "--json").out)["campaign"] is None


def test_preview_of_a_part_says_so(tmp_path: Path) -> None:
    from thermodata.cli.start.preview_text import preview_text, previewed

    shown = previewed(csv(tmp_path / "a.csv"), None, None, 2, None)
    assert "all 200 rows" in preview_text(shown)
    shown["whole"] = False
    assert "the first 200 rows only: the file is large" in preview_text(shown)


def test_preview_looks_closely_at_a_share_of_very_many_signals_and_says_so(tmp_path: Path) -> None:
    from nptdms import ChannelObject, TdmsWriter

    from thermodata.cli.start.preview_text import previewed

    wave = {"wf_start_time": np.datetime64("2026-03-02T06:00:00", "us"), "wf_increment": 1.0, "unit_string": "degC"}
    t = 20.0 + np.arange(3)
    with TdmsWriter(str(tmp_path / "wide.tdms")) as writer:
        writer.write_segment([ChannelObject(f"g{i // 60}", f"c{i}", t + i, wave) for i in range(2400)])
    found = previewed(tmp_path / "wide.tdms", None, None, 2, None)
    assert found["notes"] == [
        "2000 of 2400 signals were looked at, the first of each stream: quantities, ranges, flags and courses of the "
        "others are left open"
    ]
    for i, stream in enumerate(found["streams"]):
        assert [s["values"] is not None for s in stream["signals"]] == [True] * 50 + [False] * 10
        assert stream["signals"][49]["values"]["high"] == 22.0 + 60 * i + 49
        assert stream["first_rows"][1][f"g{i}/c{60 * i + 59}"] == 21.0 + 60 * i + 59
    few = previewed(csv(tmp_path / "a.csv"), None, None, 2, None)
    assert not any("looked at" in note for note in few["notes"])


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no named pipes here")
@pytest.mark.parametrize("words", [("sniff",), ("preview",), ("preview", "--reader", "table")])
def test_a_named_pipe_is_refused_and_nobody_waits_for_it(say: Say, tmp_path: Path, words: tuple[str, ...]) -> None:
    os.mkfifo(tmp_path / "log.csv")
    said = say(*words, tmp_path / "log.csv")
    assert said.code == 2
    assert "this is a pipe" in said.err
    assert "expected: a file" in said.err
    (tmp_path / "log.csv").unlink()
    assert say(*words, csv(tmp_path / "log.csv")).code == 0
