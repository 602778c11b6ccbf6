"""A channel that is empty in the whole of a test, and rows whose times stand still: told at ingest, and asked."""

from __future__ import annotations

from pathlib import Path

import pytest

from thermodata.draft.make import draft_files
from thermodata.store import Store
from thermodata.store.ingest.run import ingest
from thermodata.store.ingest.summary import IngestSummary

pytestmark = pytest.mark.usefixtures("installed_readers")


def write(folder: Path, speeds: dict[str, str], step_s: int = 60, missing_in: str = "", cut: int = 16) -> Path:
    """A campaign of CSV files, one a test, with its speed in all rows; times are cut to `cut` letters."""
    folder.mkdir(exist_ok=True)
    for test, speed in speeds.items():
        seconds = [i * step_s for i in range(40)]
        times = [f"2026-03-02 08:{t // 60:02d}:{t % 60:02d}" for t in seconds]
        rows = "".join(f"{time[:cut]},{20 + i / 10:.1f},{speed}\n" for i, time in enumerate(times))
        (folder / f"{test}.csv").write_text(f"time,T1 [degC],n [rpm]\n{rows}")
    (folder / "campaign.yaml").write_text(
        "schema: thermodata/campaign/1\nid: lab\nsources:\n"
        '  log: {reader: table, files: "{test}.csv"}\nchannels:\n'
        "  T1: {source: log, signal: T1, quantity: temperature}\n"
        f"  n: {{source: log, signal: n, quantity: rotational_speed{missing_in}}}\n"
        "tests:\n" + "".join(f"  - {{id: {test}, kind: mixed, role: none}}\n" for test in speeds)
    )
    return folder / "campaign.yaml"


def losses(summary: IngestSummary) -> list[tuple[str, str]]:
    return [(x["test"], x["reason"]) for x in summary.losses]


def test_a_channel_that_is_empty_in_one_test_is_its_loss(store: Store, tmp_path: Path) -> None:
    path = write(tmp_path / "lab", {"a": "3000", "b": "", "c": "9000"})
    for _ in range(2):  # the second time nothing changed
        ((test, reason),) = losses(ingest(store, path))
        assert test == "b"
        assert "channel 'n' has no value in the whole of b, and has in a, c" in reason
    write(tmp_path / "lab", {"a": "3000", "b": "6000", "c": "9000"})
    assert losses(ingest(store, path)) == []


def test_it_is_told_too_where_only_another_test_is_looked_at(store: Store, tmp_path: Path) -> None:
    path = write(tmp_path / "lab", {"a": "", "b": ""})
    assert losses(ingest(store, path)) == [], "nothing says that there should be any"
    write(tmp_path / "lab", {"a": "", "b": "3000"})
    assert [test for test, _ in losses(ingest(store, path))] == ["a"]


@pytest.mark.parametrize("channels", ["{}", "{T9: {source: log, signal: T1, quantity: temperature}}"])
def test_an_ingest_that_brings_nothing_says_so(store: Store, tmp_path: Path, channels: str) -> None:
    path = write(tmp_path / "lab", {"a": "3000"})
    before, _, rest = path.read_text().partition("channels:\n")
    path.write_text(f"{before}channels: {channels}\ntests:{rest.partition('tests:')[2]}")
    said = " ".join(reason for _, reason in losses(ingest(store, path)))
    assert ("no sample of 1 file of 1 test is in the store: no channel is declared" in said) == (channels == "{}")


def test_an_empty_channel_that_is_declared_missing_is_none(store: Store, tmp_path: Path) -> None:
    path = write(tmp_path / "lab", {"a": "3000", "b": ""}, missing_in=", missing_in: [b]")
    assert losses(ingest(store, path)) == []


@pytest.mark.parametrize(("step_s", "told"), [(5, True), (50, False), (60, False)])
def test_rows_whose_times_stand_still_are_told_and_asked(store: Store, tmp_path: Path, step_s: int, told: bool) -> None:
    path = write(tmp_path / "lab", {"a": "3000"}, step_s)
    notes = [n for n in ingest(store, path).notes if "at the time of the row before" in n]
    assert bool(notes) is told
    path.unlink()
    asked = [q for s in draft_files(tmp_path / "lab").draft.sources for q in s.questions if "row before" in q]
    assert bool(asked) is told
    assert all("table: {time: {period: ...}}, which is about 4.6 s" in note for note in notes)
    assert all("table: {time: {period: 5 s}}" in question for question in asked)


@pytest.mark.parametrize(
    ("keys", "said"),
    [
        ("zero: {over: 100 h}", "a: zero is the mean over 100 h, and the test lasts 0.65 h: the mean of all of it"),
        ("zero: {over: 10 min}", ""),
        ("phases: {late: [2 h, 3 h]}", "a: the phase 'late' begins at 2 h, and the recording ends at 0.65 h"),
        (
            "phases: {most: [0 h, 3 h]}",
            "a: the phase 'most' ends at 3 h, and the recording ends at 0.65 h: it is taken",
        ),
        ("phases: {all: [0 h, 0.65 h]}", ""),
        (
            "window: [0.1 h, 50 h]",
            "a: the window ends at 50 h, and the last sample in it is at 0.65 h: the test is taken",
        ),
        ("window: [0.1 h, 0.5 h]", ""),
        ("window: [0 h, 0.65 h]", ""),
        ("window: [0 h, 0.651 h]", ""),  # less than a sample more
    ],
)
def test_times_behind_the_end_of_the_recording_are_told(store: Store, tmp_path: Path, keys: str, said: str) -> None:
    path = write(tmp_path / "lab", {"a": "3000", "b": "6000"})
    path.write_text(path.read_text().replace("{id: a,", f"{{id: a, {keys},"))
    for _ in range(2):
        told = [n for n in ingest(store, path).notes if n.startswith("a: ")]
        assert len(told) == bool(said)
        assert all(n.startswith(said) for n in told)


def test_a_phase_goes_no_further_than_the_recording(store: Store, tmp_path: Path) -> None:
    path = write(tmp_path / "lab", {"a": "3000", "b": "6000"})
    keys = "phases: {heat: [0.1 h, 90 h], late: [2 h, 3 h], all: [0 h, 0.3 h]}"
    path.write_text(path.read_text().replace("{id: a,", f"{{id: a, {keys},"))
    ingest(store, path)
    with store.reader() as con:
        (lasts,) = con.execute("select duration_s from test where test = 'a'").fetchone()
        rows = con.execute("select phase, from_s, to_s from phase where test = 'a' order by phase").fetchall()
    assert rows == [("all", 0.0, 1080.0), ("heat", 360.0, lasts), ("late", 7200.0, 10800.0)]


@pytest.mark.parametrize("history", ["test", "recording"])
def test_a_window_behind_the_end_says_when_the_recording_has_rows(store: Store, tmp_path: Path, history: str) -> None:
    path = write(tmp_path / "lab", {"a": "3000", "b": "6000"})
    path.write_text(path.read_text().replace("{id: a,", f"{{id: a, window: [7 h, 9 h], history: {history},"))
    for _ in range(2):
        ((test, reason),) = losses(summary := ingest(store, path))
        assert test == "a"
        assert "window, from 7 to 9 h after the recording's start: they run from 0 to 0.65 h" in reason
        assert (summary.losses[0]["file"], summary.losses[0]["where"]) == ("campaign.yaml", "line 9")
