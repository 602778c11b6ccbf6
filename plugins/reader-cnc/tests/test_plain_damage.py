"""What is left of damaged plain CSV exports: what is gone is told, and nothing else is lost."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from thermodata_reader_cnc import Reader

from thermodata.plugin import Source
from thermodata.testing.reader import load

from .test_plain import HEADER, PRAGUE, read, rows, write


def damaged(lines: Sequence[str]) -> str:
    return HEADER + "\n".join(lines) + "\n"


def test_a_garbage_row_is_one_loss_that_names_its_line(tmp_path: Path) -> None:
    lines = rows(5000)
    lines[2500] = "02.03.2026;08:0"
    lines[3000] = "xx.03.2026;08:00:00;1,0;2;P"
    lines[3500] = "02.03.2026;24:61:00;1,0;2;P"
    _, t_ns, values, losses = read(write(tmp_path, damaged(lines)))
    assert t_ns.size == len(values["nActSpeed"]) == 4997
    assert [loss.where for loss in losses] == ["nc.csv line 2503", "nc.csv line 3003", "nc.csv line 3503"]
    assert losses[0].reason == "expected 5 cells, got 2: '02.03.2026;08:0'"
    assert losses[1].reason.startswith("expected a time DD.MM.YYYY and HH:MM:SS, got 'xx.03.2026; 08:00:00'")
    assert losses[0].from_ns == t_ns[2499]


def test_a_garbage_cell_loses_only_itself(tmp_path: Path) -> None:
    lines = rows(300)
    lines[200] = lines[200].replace(lines[200].split(";")[2], "4x,7")
    _, _, values, losses = read(write(tmp_path, damaged(lines)))
    assert [(loss.where, loss.reason) for loss in losses] == [
        ("nc.csv line 203 column 'T1 [°C]'", "expected a number, got '4x,7'")
    ]
    assert np.flatnonzero(np.isnan(values["T1 [°C]"])).tolist() == [200]
    assert values["nActSpeed"] == list(range(1000, 1300))


@pytest.mark.parametrize("cut", ["02.03.2026;08:49:50;57", "02.03.2026;08:4", "0"])
def test_a_cut_last_row_is_a_loss(tmp_path: Path, cut: str) -> None:
    path = write(tmp_path, damaged(rows(299)) + cut)
    recording, t_ns, _, losses = read(path)
    assert t_ns.size == 299
    assert recording.complete is False
    assert len(losses) == 1
    assert "without a line end" in losses[0].reason
    assert losses[0].fraction == pytest.approx(len(cut) / path.stat().st_size)


def test_a_last_row_without_line_end_is_kept_where_its_last_digits_prove_it(tmp_path: Path) -> None:
    text = "Time;n;T\n" + "".join(f"2026-03-02 08:00:{k:02d};{k};{k},25\n" for k in range(20))
    recording, t_ns, _, losses = read(write(tmp_path, text[:-1]))
    assert (recording.complete, t_ns.size, losses) == (None, 20, [])
    recording, t_ns, _, losses = read(write(tmp_path, text[:-2]))
    assert (recording.complete, t_ns.size, len(losses)) == (False, 19, 1)


def test_nul_bytes_of_a_power_cut_cost_one_loss(tmp_path: Path) -> None:
    lines = rows(300)
    lines[100] = "\0" * 4096 + lines[100]
    _, t_ns, _, losses = read(write(tmp_path, damaged(lines)))
    assert t_ns.size == 300
    assert len(losses) == 1
    assert "4096 NUL" in losses[0].reason


def test_a_repeated_header_is_skipped_and_another_one_stops(tmp_path: Path) -> None:
    lines = rows(20)
    same = write(tmp_path, damaged([*lines[:10], *HEADER.splitlines(), *lines[10:]]))
    assert (read(same)[1].size, read(same)[3]) == (20, [])
    other = write(tmp_path, damaged([*lines[:10], "Datum;Čas;nActSpeed;T2 [°C];Program", *lines[10:]]))
    _, t_ns, _, losses = read(other)
    assert t_ns.size == 10
    assert "another header" in losses[0].reason


def test_many_losses_are_counted_after_twenty(tmp_path: Path) -> None:
    lines = rows(400)
    for k in range(200, 300):
        lines[k] = "junk"
    _, t_ns, _, losses = read(write(tmp_path, damaged(lines)))
    assert t_ns.size == 300
    assert len(losses) == 21
    assert losses[-1].reason.startswith("80 more")


def test_a_quote_that_is_never_closed_swallows_nothing(tmp_path: Path) -> None:
    lines = [f'2026-03-02 08:{k // 60:02d}:{k % 60:02d};{k}.5;"P {k}; a"' for k in range(300)]
    lines[150] = '2026-03-02 08:02:30;150.5;"P 150'
    _, t_ns, values, losses = read(write(tmp_path, "Time;T;Program\n" + "\n".join(lines) + "\n"))
    assert not losses
    assert t_ns.size == 300
    assert values["Program"][149:152] == ["P 149; a", "P 150", "P 151; a"]


def test_a_line_of_another_encoding_is_kept_and_named(tmp_path: Path) -> None:
    path = tmp_path / "nc.csv"
    rows = "".join(f"02.03.2026 08:{k // 60 % 60:02d}:{k % 60:02d};{k};Tür\n" for k in range(3000))
    data = (("Zeit;n;Ort\n" + rows) * 8).encode().replace(b";7;T\xc3\xbcr", b";7;T\xfcr", 5)
    path.write_bytes(data)
    got = load(Reader(), path, Source(timezone="Europe/Prague"))
    assert "not all UTF-8" in got.recording.notes[0]
    assert any("file's encoding" in loss.reason and loss.where == "nc.csv line 9" for loss in got.losses)
    assert set(got.values["nc", "Ort"].tolist()) == {"Tür"}


@pytest.mark.parametrize(
    "junk",
    [";" * 100_000, "x" * 300_000, "\0" * 200_000, "\n" * 100_000, '"' * 99_999, f'"{"x" * 200_000}";1'],
    ids=["cells", "text", "zeros", "blank", "quotes", "quoted"],
)
def test_huge_lines_are_lost_alone(tmp_path: Path, junk: str) -> None:
    path = tmp_path / "nc.csv"
    rows = [f'2026-03-02T08:00:{k:02d}Z;{k}.5;"A, B"\n' for k in range(40)]
    path.write_text("time;a;b\n" + "".join(rows[:20]) + junk + "\n" + "".join(rows[20:]))
    data = load(Reader(), path, Source())
    assert set(range(40)) - {int(v) for v in data.values["nc", "a"]} <= {19, 20}
    assert data.losses or not junk.strip("\n;\t")  # a line of nothing is none


def test_a_first_row_that_lost_a_delimiter_is_a_loss_and_no_header(tmp_path: Path) -> None:
    rows = "".join(f"02.03.2026 08:{m:02d}:00;{20 + m / 10:.1f};{m};RUN\n".replace(".", ",", 0) for m in range(1, 30))
    text = "Datum;T1 [°C];nActSpeed;Program\n02.03.2026 08:00:00;20,00;RUN\n" + rows.replace(";2", ";2")
    data = load(Reader(), write(tmp_path, text), PRAGUE)
    assert len(data.t_ns["nc"]) >= 29
    assert data.losses
