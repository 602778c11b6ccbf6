"""Tables of delimited text as blocks and losses: damage costs its own rows, and is told with its line."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from thermodata.errors import FormatError
from thermodata.plugin import Array, Block, Loss, Source
from thermodata.reader.text.delimited import blocks, describe, open_table, signals
from thermodata.reader.text.file.lines import chunks
from thermodata.schema.flag import Flag

S = 1_000_000_000
HEAD = "time;a;state\n"


@dataclass(frozen=True)
class Read:
    """All of a file: its lines, times, values and flags by column, losses, and what was noted."""

    at: list[int]
    t_ns: list[int]
    values: dict[str, Array]
    flags: dict[str, list[int]]
    losses: list[Loss]
    notes: tuple[str, ...]

    @property
    def said(self) -> list[str]:
        return [f"{loss.where}: {loss.reason}" for loss in self.losses]


def read(folder: Path, text: str | bytes, source: Source | None = None, stream: str = "table") -> Read:
    path = folder / "a.csv"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    source = source or Source(timezone="UTC")
    table = open_table(path, source)
    items = list(blocks(path, table, source))
    parts = [b for b in items if isinstance(b, Block) and b.stream == stream]
    names = list(parts[0].values) if parts else []
    flags = {
        n: np.concatenate([(b.flags or {}).get(n, np.zeros(b.t_ns.size, np.uint16)) for b in parts]).tolist()
        for n in names
        if any(n in (b.flags or {}) for b in parts)
    }
    return Read(
        [int(n) for b in parts if b.at is not None for n in b.at],
        [int(t) for b in parts for t in b.t_ns],
        {n: np.concatenate([b.values[n] for b in parts]) for n in names},
        flags,
        [b for b in items if isinstance(b, Loss)],
        describe(table, source).notes,
    )


def rows(first: int, last: int, word: str = "on") -> str:
    return "".join(f"2026-03-02 08:{k // 60:02d}:{k % 60:02d};{k}.5;{word}\n" for k in range(first, last))


# ---- headers -------------------------------------------------------------------------------------


@pytest.mark.parametrize("mark", ["", "\ufeff"])
@pytest.mark.parametrize("before", [1, 2, 30])
def test_files_that_were_joined_repeat_their_header(tmp_path: Path, before: int, mark: str) -> None:
    """Even behind the first row, and with the byte order mark that each had: nothing is lost, nothing to be told."""
    found = read(tmp_path, mark + HEAD + rows(0, before) + mark + HEAD + rows(before, 40))
    assert found.values["a"].tolist() == [k + 0.5 for k in range(40)]
    assert found.at == [*range(2, before + 2), *range(before + 3, 43)]
    assert found.said == []


def test_a_header_of_other_names_ends_the_reading(tmp_path: Path) -> None:
    found = read(tmp_path, HEAD + rows(0, 9) + "time;state;b\n" + rows(9, 20))
    assert len(found.t_ns) == 9
    assert found.said == [
        "a.csv line 11: another header begins here, nothing after it is read: 'time;state;b'; split the file there"
    ]


@pytest.mark.parametrize(("first", "share"), [(100, 0.9), (500, 0.5), (400_000, 0.3)])
def test_what_stands_behind_another_header_is_told_as_lost(tmp_path: Path, first: int, share: float) -> None:
    """As a share of the file, wherever it begins: in a first part that is read, or in a later one."""
    path = tmp_path / "a.csv"
    behind = round(first * share / (1 - share))
    at = np.datetime64("2026-03-02T08:00:00") + np.arange(first + behind).astype("timedelta64[s]")
    lines = [f"{t};20.5;on\n" for t in at.astype(str).tolist()]
    path.write_text("".join([HEAD, *lines[:first], "time;state;b\n", *lines[first:]]))
    (loss,) = [p for p in blocks(path, open_table(path, Source()), Source()) if isinstance(p, Loss)]
    assert loss.fraction == pytest.approx(share, abs=0.02)


def test_nothing_of_the_rest_is_read_behind_another_header(tmp_path: Path) -> None:
    """Nor are losses told of rows that are not read."""
    found = read(tmp_path, HEAD + rows(0, 9) + "torn\n" + "time;b;state\n" + rows(9, 20) + "torn;;;;;\n")
    assert [said.split(":")[0] for said in found.said] == ["a.csv line 11", "a.csv line 12"]


def test_nothing_is_read_in_any_later_part(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("thermodata.reader.text.delimited.chunks", lambda path, encoding: chunks(path, encoding, 64))
    found = read(tmp_path, HEAD + rows(0, 9) + "time;state;b\n" + rows(9, 20))
    assert found.at == [*range(2, 11)]
    assert [said.split(":")[0] for said in found.said] == ["a.csv line 11"]


# ---- cells ---------------------------------------------------------------------------------------


def test_a_quote_alone_is_no_empty_cell(tmp_path: Path) -> None:
    found = read(tmp_path, HEAD + rows(0, 9) + '2026-03-02 08:00:09;";on\n' + rows(10, 20))
    np.testing.assert_array_equal(found.values["a"][8:11], [8.5, np.nan, 10.5])
    assert found.said == ["a.csv line 11 column 'a': expected a number, got '\"'"]


def test_overload_and_nothing_are_told_apart_by_flags(tmp_path: Path) -> None:
    cells = [*(str(2**60 + k) for k in range(8)), "OL", "---"]
    data = "time [s];a;b\n" + "".join(f"{k};{cell};{cell[:3]}\n" for k, cell in enumerate(cells))
    found = read(tmp_path, data)
    assert found.values["a"].tolist() == [*(2**60 + k for k in range(8)), 0, 0]
    assert found.flags == {
        "a": [*[0] * 8, int(Flag.SATURATED), int(Flag.NOT_MEASURING)],
        "b": [*[0] * 8, int(Flag.SATURATED), 0],  # NaN says it already
    }
    assert found.said == []


def test_a_bad_quality_flags_its_value(tmp_path: Path) -> None:
    data = "time [s];T1;T1.Quality;T2\n" + "".join(
        f"{k};2{k % 10}.5;{'Bad' if k == 4 else 'Good'};1\n" for k in range(9)
    )
    found = read(tmp_path, data)
    assert found.flags == {"T1": [int(Flag.NOT_MEASURING) if k == 4 else 0 for k in range(9)]}
    assert found.values["T1"][4] == 24.5
    assert found.values["T1.Quality"][4] == "Bad"


def thousands(folder: Path, common: str, rows_before: int, decimal: str | None) -> Read:
    text = "time [s];a\n" + "".join(f"{k};{common}\n" for k in range(rows_before))
    text += f"{rows_before};1.500\n" + "".join(f"{rows_before + k};{common}\n" for k in range(1, 40_000))
    return read(folder, text, Source(table={"decimal": decimal} if decimal else None))


@pytest.mark.parametrize(("decimal", "common", "value"), [(",", "20,5", 1500.0), (".", "20.5", 1.5)])
def test_one_group_of_thousands_is_as_the_declared_mark_has_it(
    tmp_path: Path, decimal: str, common: str, value: float
) -> None:
    for before in (8, 40_000):
        found = thousands(tmp_path, common, before, decimal)
        assert found.values["a"][before] == value
        assert found.said == []


def test_one_group_of_thousands_is_asked_about_or_lost(tmp_path: Path) -> None:
    with pytest.raises(FormatError, match="decimal point and with a decimal comma"):
        thousands(tmp_path, "20,5", 8, None)
    found = thousands(tmp_path, "20,5", 40_000, None)  # where no sample sees it
    assert np.flatnonzero(np.isnan(found.values["a"])).tolist() == [40_000]
    assert found.said == [
        "a.csv line 40002 column 'a': '1.500' may be thousands or a fraction: declare table: {decimal: ','} or '.'"
    ]


@pytest.mark.parametrize("mark", [".", ","])
def test_the_first_fraction_far_down_tells_the_mark(tmp_path: Path, mark: str) -> None:
    """Where the sampled rows are whole numbers."""
    count = 120_000
    text = "time [s];a\n" + "".join(f"{k};7\n" for k in range(count // 2))
    text += f"{count // 2};7{mark}25\n" + "".join(f"{k};7\n" for k in range(count // 2 + 1, count))
    found = read(tmp_path, text)
    assert len(text) > 900_000  # of which the first look sees a part
    assert found.values["a"][count // 2] == 7.25
    assert found.said == []


# ---- rows ----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("line", "told"),
    [
        ("2026-03-02 08:00:09;9.5", "expected 3 cells, got 2: '2026-03-02 08:00:09;9.5'"),
        ("2026-03-02 08:00:09;9.5;on;", "expected 3 cells, got 4: '2026-03-02 08:00:09;9.5;on;'"),
        ("2026-03-02 08:00:09;9.5;on;1", "expected 3 cells, got 4: '2026-03-02 08:00:09;9.5;on;1'"),
        ("2026-03-02 08;9.5;on", "expected a time YYYY-MM-DD HH:MM:SS, got '2026-03-02 08'"),
        ("2026-03-02 08:00:09Z;9.5;on", "expected a time YYYY-MM-DD HH:MM:SS, got '2026-03-02 08:00:09Z'"),
        (";9.5;on", "expected a time YYYY-MM-DD HH:MM:SS, got ''"),
        ("\0\0\0", "3 NUL bytes: what was written here is lost"),
    ],
)
def test_a_damaged_row_is_lost_alone_and_told(tmp_path: Path, line: str, told: str) -> None:
    found = read(tmp_path, HEAD + rows(0, 9) + line + "\n" + rows(10, 20))
    assert found.values["a"].tolist() == [k + 0.5 for k in range(20) if k != 9]
    assert found.at == [*range(2, 11), *range(12, 22)]
    assert found.said == [f"a.csv line 11: {told}"]
    (loss,) = found.losses
    assert (loss.from_ns, loss.to_ns) == (found.t_ns[8], found.t_ns[9])


@pytest.mark.parametrize("line", ["", "   ", ";;", "\r"])
def test_a_line_of_nothing_is_no_loss(tmp_path: Path, line: str) -> None:
    found = read(tmp_path, HEAD + rows(0, 9) + line + "\n" + rows(9, 20))
    assert found.at == [*range(2, 11), *range(12, 23)]
    assert found.said == []


def test_twenty_losses_are_named_and_the_rest_counted(tmp_path: Path) -> None:
    bad = "".join(f"2026-03-02 09:00:{k:02d};x;on\n" for k in range(23))
    found = read(tmp_path, HEAD + rows(0, 40) + bad)
    assert [loss.where for loss in found.losses[:20]] == [f"a.csv line {42 + k} column 'a'" for k in range(20)]
    assert found.said[20:] == ["a.csv: 3 more cells or rows that do not read"]
    assert found.losses[-1].fraction == pytest.approx(3 / (tmp_path / "a.csv").stat().st_size)


@pytest.mark.parametrize(
    ("end", "kept", "said"),
    [
        ("2026-03-02 08:00:09;9.5;on", 10, []),
        (
            "2026-03-02 08:00:09;9.5;o",
            9,
            ["a.csv line 11: expected a whole row (the file ends without a line end), got"],
        ),
        ("2026-03-02 08:00:09;9", 9, ["a.csv line 11: expected a whole row (the file ends without a line end), got"]),
        ("\0\0\x1a", 9, []),
    ],
)
def test_a_last_line_without_an_end(tmp_path: Path, end: str, kept: int, said: list[str]) -> None:
    found = read(tmp_path, HEAD + rows(0, 9) + end)
    assert len(found.t_ns) == kept
    assert [text.rsplit(" ", 1)[0] if said else text for text in found.said] == [
        f"{s} '{end}'".rsplit(" ", 1)[0] for s in said
    ]


def test_bytes_of_another_encoding_are_told_by_their_line(tmp_path: Path) -> None:
    text = ("time;a;stav\n" + rows(0, 30, "žluťoučký kůň")).encode()
    found = read(tmp_path, text + b"2026-03-02 08:00:30;30.5;T\xfcr\n")
    assert found.values["stav"][-1] == "Tür"
    assert found.said == ["a.csv line 32: its bytes are not of the file's encoding; read as they look"]


# ---- times ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(("back", "nights"), [(43_199, 0), (43_200, 0), (43_201, 1), (86_399, 1)])
def test_a_step_back_by_more_than_half_a_day_is_midnight(tmp_path: Path, back: int, nights: int) -> None:
    def clock(second: int) -> str:
        return f"{second // 3600:02d}:{second // 60 % 60:02d}:{second % 60:02d}"

    seconds = [86_395, 86_396, 86_399, 86_399 - back, 86_400 - back + 10]
    found = read(tmp_path, "time;a\n" + "".join(f"{clock(s)};1.5\n" for s in seconds))
    start = seconds[0]
    wanted = [s - start for s in seconds[:3]] + [s - start + nights * 86_400 for s in seconds[3:]]
    assert found.t_ns == [w * S for w in wanted]
    assert "times of day without a date: counted from the first row" in found.notes


def test_the_hour_that_repeats_is_told_apart_by_the_order_of_the_rows(tmp_path: Path) -> None:
    times = ["01:59:00", "02:10:00", "02:50:00", "02:10:00", "02:50:00", "03:10:00"]
    text = "time;a\n" + "".join(f"2026-10-25 {t};1.5\n" for t in times)
    for lines in (1, 100):
        found = read(tmp_path, text, Source(timezone="Europe/Prague", options={"block_rows": lines}))
        minutes = [(t - found.t_ns[0]) // (60 * S) for t in found.t_ns]
        assert minutes == [0, 11, 51, 71, 111, 131]


# ---- groups --------------------------------------------------------------------------------------


def test_a_row_that_lacks_a_group_before_longer_ones_is_told(tmp_path: Path) -> None:
    data = "t1 [s];T1;t2 [s];T2\n" + "".join(f"{k};2{k}.5;{k}.25;3{k}.5\n" for k in range(5))
    found = read(tmp_path, data + "5;25.5\n6;26.5;6.25;36.5\n7;27.5\n", stream="t1 [s]")
    assert found.values["T1"].tolist() == [20.5, 21.5, 22.5, 23.5, 24.5, 25.5, 26.5, 27.5]
    assert found.said == ["a.csv line 7: fewer cells than the lines behind it: what is missing is lost"]
    other = read(tmp_path, data + "5;25.5\n6;26.5;6.25;36.5\n7;27.5\n", stream="t2 [s]")
    assert other.values["T2"].tolist() == [30.5, 31.5, 32.5, 33.5, 34.5, 36.5]
    assert other.at == [2, 3, 4, 5, 6, 8]


def test_an_empty_line_lacks_no_group(tmp_path: Path) -> None:
    """Where most rows lack one, which is why it looks like one that does."""
    data = "t1 [s];T1;t2 [s];T2\n" + "".join(f"{k};{k}.5;{k}.25;{k}.75\n" for k in range(600))
    end = "600;1.5;600.25;2.5\n" + "".join(f"{k};1.5\n" for k in range(601, 3000))
    found = read(tmp_path, data + "\n" + end, stream="t1 [s]")
    assert len(found.t_ns) == 3000
    assert found.said == []


# ---- what is asked for ---------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "an empty file"),
        ("\n\n", "an empty file|no whole line"),
        ("a word\nanother\n", "no columns found"),
        ("a;b\nx;y\nz;w\n", "no data rows found"),
        ("time [s]\n1\n2\n", "no columns found"),
        ('time [s],a\n0,"8,000"\n1,"9,000"\n2,"7,500"\n', "commas that may part thousands"),
        ("time;a\n03/04/2026 08:00;1.5\n03/04/2026 09:00;2.5\n", "either way round"),
        ("time [s];a\n0;1.5\n1;2,5\n2;3.5\n", "decimal point and with a decimal comma"),
    ],
)
def test_what_is_no_table_is_refused(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "a.csv"
    path.write_text(text, "utf-8")
    with pytest.raises(FormatError, match=message):
        open_table(path, Source())


def test_a_row_of_words_and_relative_times_above_a_repeated_header_is_data(tmp_path: Path) -> None:
    """Nothing but the repetition tells it from a preamble such as 'Serial;4711;A'."""
    header = "time [s];T;mode"
    rows = [f"{i};{20 + i / 8};RUN" for i in range(20)]
    path = tmp_path / "x.csv"
    path.write_text("\n".join([header, rows[0], header, *rows[1:]]) + "\n")
    source = Source()
    table = open_table(path, source)
    assert [s.name for s in signals(table)] == ["T", "mode"]
    read = [item for item in blocks(path, table, source) if isinstance(item, Block)]
    assert np.concatenate([b.values["T"] for b in read]).tolist() == [20 + i / 8 for i in range(20)]


def test_a_header_that_is_longer_than_a_look_is_said_to_be_so(tmp_path: Path) -> None:
    names = ",".join(f"c{i} [degC]" for i in range(20_000))
    path = tmp_path / "wide.csv"
    path.write_text(f"Time [s],{names}\n" + 3 * ("0.0" + 20_000 * ",20.0" + "\n"))
    with pytest.raises(FormatError, match="first line is too long") as found:
        describe(open_table(path, Source()), Source())
    assert "128 KiB" in str(found.value)


def test_rows_whose_time_is_torn_decide_nothing_however_many_rows_there_are(tmp_path: Path) -> None:
    rows = [f"2026-03-01 08:{k // 60:02d}:{k % 60:02d};{20 + k / 100:.2f};1" for k in range(1200)]
    for k in (150, 700, 1100):
        rows[k] = f"2026-03-01 08:;half;{rows[k][-1]}"
    for n in (300, 1200):
        got = read(tmp_path, HEAD + "\n".join(rows[:n]) + "\n")
        assert got.values["a"].dtype == np.float64
        assert len(got.t_ns) == n - sum(k < n for k in (150, 700, 1100))
