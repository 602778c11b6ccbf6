"""Plain CSV exports: encodings, decimal marks, times, units, types, and what is left of damaged files."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest
from thermodata_reader_cnc import Reader

from thermodata.errors import FormatError
from thermodata.plugin import Block, Head, Loss, Recording, Source
from thermodata.reader.guard import described, guarded
from thermodata.reader.registry import head
from thermodata.testing.reader import load, reader_checks

PRAGUE = Source(timezone="Europe/Prague")
HEADER = "Datum;Čas;T1 [°C];nActSpeed;Program\n;;°C;1/min;\n"


def ns(text: str) -> int:
    return int(np.datetime64(text, "ns").astype(np.int64))


def write(tmp_path: Path, text: str, encoding: str = "utf-8", name: str = "nc.csv") -> Path:
    path = tmp_path / name
    path.write_bytes(text.encode(encoding))
    return path


def read(path: Path, source: Source = PRAGUE) -> tuple[Recording, np.ndarray, dict[str, list], list[Loss]]:
    recording = described(Reader(), path, source)
    times, values, losses = [], {s.name: [] for s in recording.signals}, []
    for item in guarded(Reader(), path, source, recording):
        if isinstance(item, Loss):
            losses.append(item)
        else:
            times.append(item.t_ns)
            for name, part in item.values.items():
                values[name] += part.tolist()
    return recording, np.concatenate(times) if times else np.empty(0, np.int64), values, losses


def rows(n: int, step_s: int = 10, start: str = "2026-03-02T08:00:00") -> list[str]:
    first = datetime.fromisoformat(start).replace(tzinfo=UTC).timestamp()
    out = []
    for k in range(n):
        at = datetime.fromtimestamp(first + k * step_s, UTC)
        number = f"{20 + k / 8:.3f}".replace(".", ",")
        out.append(f"{at:%d.%m.%Y;%H:%M:%S};{number};{1000 + k};MPF{k // 4}")
    return out


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "cp1250", "utf-16"])
@pytest.mark.parametrize("newline", ["\n", "\r\n"])
def test_encodings_give_the_same_values(tmp_path: Path, encoding: str, newline: str) -> None:
    path = write(tmp_path, (HEADER + "\n".join(rows(30)) + "\n").replace("\n", newline), encoding)
    recording, t_ns, values, losses = read(path)
    assert losses == []
    assert [(s.name, s.unit, s.dtype) for s in recording.signals] == [
        ("T1 [°C]", "°C", "float64"),
        ("nActSpeed", "1/min", "float64"),
        ("Program", None, "str"),
    ]
    assert recording.start_ns == t_ns[0] == ns("2026-03-02T07:00:00")
    np.testing.assert_array_equal(np.diff(t_ns), np.full(29, 10_000_000_000))
    np.testing.assert_allclose(values["T1 [°C]"], np.round(20 + np.arange(30) / 8, 3))
    assert values["nActSpeed"] == list(range(1000, 1030))
    assert values["Program"][:5] == ["MPF0"] * 4 + ["MPF1"]
    assert (recording.notes != ()) == (encoding == "cp1250")


@pytest.mark.parametrize(
    ("cells", "expected"),
    [
        ("02.03.2026 08:00:00", "2026-03-02T07:00:00"),
        ("2.3.2026 8:00:00", "2026-03-02T07:00:00"),
        ("02.03.26 08:00:00,250", "2026-03-02T07:00:00.250"),
        ("2026-03-02 08:00:00.5", "2026-03-02T07:00:00.5"),
        ("2026-03-02T08:00:00,123456", "2026-03-02T07:00:00.123456"),
        ("2026/03/02 08:00:00:042", "2026-03-02T07:00:00.042"),
        ("2026-03-02T08:00:00Z", "2026-03-02T08:00:00"),
        ("2026-03-02T08:00:00+05:30", "2026-03-02T02:30:00"),
        ("03/25/2026 08:00:00", "2026-03-25T07:00:00"),
        ("25/03/2026 08:00", "2026-03-25T07:00:00"),
        ("3/25/2026 1:05:00 PM", "2026-03-25T12:05:00"),
        ("3/4/2026 12:05:00 AM", "2026-03-03T23:05:00"),
    ],
)
def test_times_as_controls_write_them(tmp_path: Path, cells: str, expected: str) -> None:
    path = write(tmp_path, "Zeitstempel\tF\n" + f"{cells}\t1.5\n" * 3)
    recording, t_ns, _, losses = read(path)
    assert not losses
    assert recording.start_ns == ns(expected)
    assert t_ns.tolist() == [ns(expected)] * 3
    assert Reader().sniff(head(path)) is not None


def test_day_and_month_that_nothing_tells_apart_are_an_error_and_can_be_declared(tmp_path: Path) -> None:
    path = write(tmp_path, "Date;F\n03/04/2026 08:00:00;1\n03/04/2026 09:00:00;1\n")
    assert Reader().sniff(head(path)) is not None
    with pytest.raises(FormatError, match="day and month"):
        described(Reader(), path, PRAGUE)
    declared = Source(timezone="UTC", table={"time": {"column": "Date", "format": "%d/%m/%Y %H:%M:%S"}})
    assert read(path, declared)[1][0] == ns("2026-04-03T08:00:00")


def test_a_number_above_12_late_in_the_file_tells_day_from_month(tmp_path: Path) -> None:
    text = "Date;F\n" + "03/04/2026 08:00:00;1\n" * 50_000 + "13/04/2026 08:00:00;1\n" * 50_000
    path = write(tmp_path, text)
    assert read(path, Source(timezone="UTC"))[1][[0, -1]].tolist() == [
        ns("2026-04-03T08:00:00"),
        ns("2026-04-13T08:00:00"),
    ]


def test_times_without_a_zone_are_utc_with_a_note(tmp_path: Path) -> None:
    recording, t_ns, _, _ = read(write(tmp_path, HEADER + "\n".join(rows(3)) + "\n"), Source())
    assert t_ns[0] == ns("2026-03-02T08:00:00")
    assert any("UTC" in note for note in recording.notes)


def local_rows(first: str, last: str, zone: str, step_s: int) -> list[str]:
    from zoneinfo import ZoneInfo

    a, b = (datetime.fromisoformat(t).replace(tzinfo=UTC).timestamp() for t in (first, last))
    stamps = [datetime.fromtimestamp(s, ZoneInfo(zone)) for s in np.arange(a, b, step_s)]
    return [f"{s:%d.%m.%Y;%H:%M:%S};{k}" for k, s in enumerate(stamps)]


@pytest.mark.parametrize(
    ("first", "last"), [("2026-10-24T20:00:00", "2026-10-25T06:00:00"), ("2026-03-28T20:00:00", "2026-03-29T06:00:00")]
)
@pytest.mark.parametrize("chunk", [1 << 20, 700])
def test_daylight_saving_is_resolved_across_chunks(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, first: str, last: str, chunk: int
) -> None:
    from thermodata.reader.text import lines

    monkeypatch.setattr(lines.chunks, "__defaults__", (chunk,))
    path = write(tmp_path, "Datum;Uhrzeit;k\n" + "\n".join(local_rows(first, last, "Europe/Prague", 30)) + "\n")
    recording, t_ns, values, losses = read(path)
    assert not losses
    assert values["k"] == list(range(1200))
    np.testing.assert_array_equal(t_ns, ns(first) + np.arange(1200) * 30_000_000_000)
    assert any("daylight" in note for note in recording.notes)


def test_preamble_padding_unnamed_and_repeated_columns(tmp_path: Path) -> None:
    text = "Maschine: 138;;;;;\nAuftrag;4711;;;;\n\nDatum;Zeit;T;T;;\n" + "".join(
        f"02.03.2026;08:00:{k:02d};{k},5;{k};;\n" for k in range(5)
    )
    recording, _, values, losses = read(write(tmp_path, text))
    assert not losses
    assert values == {"T": [0.5, 1.5, 2.5, 3.5, 4.5], "T#2": [0, 1, 2, 3, 4]}
    assert any("numbered" in note for note in recording.notes)


def test_blank_cells_booleans_and_big_integers(tmp_path: Path) -> None:
    big = 2**53
    lines = [
        f"2026-03-02 08:00:{k:02d};{k if k % 3 else ''};{'TRUE' if k % 2 else 'FALSE'};{big + k};{k}" for k in range(6)
    ]
    lines[4] = "2026-03-02 08:00:04;---;;;4"
    path = write(tmp_path, "Time;T;door;count;n\n" + "\n".join(lines) + "\n")
    recording, _, values, losses = read(path)
    assert not losses
    assert {s.name: s.dtype for s in recording.signals} == {
        "T": "float64",
        "door": "bool",
        "count": "int64",
        "n": "float64",
    }
    np.testing.assert_array_equal(values["T"], [np.nan, 1, 2, np.nan, np.nan, 5])
    assert values["door"] == [False, True, False, True, False, True]
    assert values["count"] == [big, big + 1, big + 2, big + 3, 0, big + 5]
    flagged = next(item for item in guarded(Reader(), path, PRAGUE) if isinstance(item, Block)).flags
    assert flagged is not None
    assert {k: v.tolist() for k, v in flagged.items()} == {"door": [0, 0, 0, 0, 128, 0], "count": [0, 0, 0, 0, 128, 0]}


def test_separate_milliseconds_belong_to_the_time(tmp_path: Path) -> None:
    path = write(tmp_path, "Datum;Zeit;ms;T\n" + "".join(f"02.03.2026;08:00:00;{k * 100};1\n" for k in range(5)))
    recording, t_ns, _, _ = read(path)
    assert [s.name for s in recording.signals] == ["T"]
    assert np.diff(t_ns).tolist() == [100_000_000] * 4


def test_relative_time_is_read_when_the_column_says_so(tmp_path: Path) -> None:
    path = write(tmp_path, "Zeit [s];T\n0,0;20,5\n0,1;20,6\n0,2;20,7\n")
    recording, t_ns, values, _ = read(path)
    assert recording.clock == "relative"
    assert t_ns.tolist() == [0, 100_000_000, 200_000_000]
    assert values["T"] == [20.5, 20.6, 20.7]
    assert Reader().sniff(head(path)) is None


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
    other = write(tmp_path, damaged([*lines[:10], "Datum;Čas;nActSpeed;T1 [°C];Program", *lines[10:]]))
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


def test_a_decimal_mark_that_comes_late_is_found(tmp_path: Path) -> None:
    text = "Time;T\n" + "".join(f"2026-03-02 08:00:{k % 60:02d};20\n" for k in range(300_000))
    middle = len(text) // 2 + text[len(text) // 2 :].find("\n") + 1
    path = write(tmp_path, text[:middle] + "2026-03-02 09:00:00;20.25\n" + text[middle:])
    _, t_ns, values, losses = read(path)
    assert not losses
    assert t_ns.size == 300_001
    assert values["T"].count(20.25) == 1


@pytest.mark.parametrize(
    "text",
    [
        "a,b,c\n1,2,3\n",
        "Time,T\n2026-03-02 08:00:00,1\n2026-03-02 08:00:01,1\n",
        "x;y\n1;2\n3;4\n",
        "LabVIEW Measurement\t\nSeparator\tTab\n",
        "",
        "Zeit [s];T\n0;1\n1;2\n",
    ],
)
def test_other_files_are_not_claimed(text: str) -> None:
    assert Reader().sniff(Head("x.csv", len(text), text.encode())) is None


@pytest.mark.parametrize("start", [b"TDSm\x0e\0\0\0", b"\x89MCAP0\r\n", b"PK\x03\x04", bytes(range(256)) * 20])
def test_binary_files_are_not_claimed(start: bytes) -> None:
    assert Reader().sniff(Head("x.bin", len(start), start)) is None


@pytest.fixture(scope="module")
def sample(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write(tmp_path_factory.mktemp("kit"), HEADER + "\n".join(rows(16)) + "\n")


@pytest.mark.parametrize("number", range(len(reader_checks(Reader, [(Path("x"), PRAGUE)]))))
def test_it_keeps_the_rules_of_readers(sample: Path, number: int) -> None:
    reader_checks(Reader, [(sample, PRAGUE)])[number]()


ASIAN = "时间;主轴转速 (rpm);温度（°C）\n" + "".join(
    f"2026-03-02 08:00:{k:02d};{k * 10};{20 + k / 4}\n" for k in range(30)
)


@pytest.mark.parametrize(
    ("encoding", "text"),
    [
        ("gb18030", "时;梦想;花园\n" + ASIAN.split("\n", 1)[1]),
        ("cp932", "刻;桜吹雪;春眠不覚暁\n" + ASIAN.split("\n", 1)[1]),
        ("cp1251", "Время;Обороты;Температура\n" + ASIAN.split("\n", 1)[1]),
    ],
)
def test_encodings_of_other_scripts_are_declared_where_no_word_tells(tmp_path: Path, encoding: str, text: str) -> None:
    path = tmp_path / "nc.csv"
    path.write_bytes(text.encode(encoding))
    with pytest.raises(FormatError, match="encoding that the file does not name") as caught:
        load(Reader(), path, Source())
    assert encoding in str(caught.value)
    data = load(Reader(), path, Source(encoding=encoding, timezone="Asia/Shanghai"))
    assert [s.name for s in data.recording.signals] == text.split("\n", 1)[0].split(";")[1:]
    assert not data.losses
    assert data.t_ns["nc"].size == 30


def test_dates_of_the_east_and_utf8_names(tmp_path: Path) -> None:
    path = tmp_path / "nc.csv"
    path.write_text(ASIAN.replace("2026-03-02 ", "2026年3月2日 "), "utf-8")
    data = load(Reader(), path, Source(timezone="Asia/Shanghai"))
    assert data.recording.start_ns == np.datetime64("2026-03-02T00:00:00", "ns").astype(np.int64)
    assert [s.unit for s in data.recording.signals] == ["rpm", "°C"]


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
    ("names", "bad"),
    [
        ("T1;T1.Quality;T2", "0"),
        ("T1;T1_Quality;T2", "Bad"),
        ("T1_VALUE;T1_QUALITY;T2", "24"),
        ("T1;Quality(T1);T2", "0x80000000"),
    ],
)
def test_quality_columns_of_a_wide_table_flag_their_values(tmp_path: Path, names: str, bad: str) -> None:
    path = tmp_path / "nc.csv"
    good = "Good" if bad == "Bad" else "0" if bad.startswith("0x") else "192"
    path.write_text(
        f"Time;{names}\n" + "".join(f"2026-03-02T08:00:{k:02d}Z;{k}.5;{bad if k == 3 else good};1\n" for k in range(20))
    )
    data = load(Reader(), path, Source())
    name = names.split(";", 1)[0]
    assert np.flatnonzero(data.flags["nc", name]).tolist() == [3]
    assert data.values["nc", name][3] == 3.5


def test_text_states_numbers_with_exponents_and_groups(tmp_path: Path) -> None:
    path = tmp_path / "nc.csv"
    path.write_text(
        "Datum;Zeit;Pumpe;Čerpadlo;P;n\n;;;;[kW];[1/min]\n"
        + "".join(
            f"02.03.26;08:00:{k:02d},250;{'EIN' if k % 2 else 'AUS'};{'ZAP' if k % 3 else 'VYP'};1,5E+0{k % 4};"
            f"1.{k:03d},5\n"
            for k in range(30)
        ),
        "utf-8",
    )
    data = load(Reader(), path, Source(timezone="Europe/Prague"))
    assert not data.losses
    assert data.values["nc", "P"].tolist() == [1.5 * 10 ** (k % 4) for k in range(30)]
    assert data.values["nc", "n"].tolist() == [1000.5 + k for k in range(30)]
    assert set(data.values["nc", "Pumpe"].tolist()) == {"EIN", "AUS"}
    assert set(data.values["nc", "Čerpadlo"].tolist()) == {"ZAP", "VYP"}
    assert data.t_ns["nc"][0] % 10**9 == 250_000_000


def test_a_repeated_header_does_not_hide_the_milliseconds(tmp_path: Path) -> None:
    path = tmp_path / "nc.csv"
    rows = [f"2026-03-02T08:00:{k:02d}Z;{k * 7};{k}.5\n" for k in range(20)]
    path.write_text("time;ms;a\n" + "".join(rows[:10]) + "time;ms;a\n" + "".join(rows[10:]))
    data = load(Reader(), path, Source())
    assert [s.name for s in data.recording.signals] == ["a"]
    assert (np.diff(data.t_ns["nc"]) == 1_007_000_000).all()


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


def test_rows_of_limits_between_names_and_units_are_no_names(tmp_path: Path) -> None:
    lines = [
        '"DATUM:";"ZEIT:";"M00: Lager";"M01: Halle"',
        '"KOMMENTAR:";"";"Lager vorn";"Halle"',
        '"GW-MAX:";"";"80,0";""',
        '"EINHEIT:";"";"°C";"°C"',
        *(f'"27.03.26";"06:00:{i:02d}";{20 + i},5;19,25' for i in range(20)),
        "",
    ]
    recording, _, values, _ = read(write(tmp_path, "\r\n".join(lines)))
    assert [(s.name, s.unit) for s in recording.signals] == [("Lager vorn", "°C"), ("Halle", "°C")]
    assert list(values["Lager vorn"]) == [20.5 + i for i in range(20)]


def test_a_first_row_that_lost_a_delimiter_is_a_loss_and_no_header(tmp_path: Path) -> None:
    rows = "".join(f"02.03.2026 08:{m:02d}:00;{20 + m / 10:.1f};{m};RUN\n".replace(".", ",", 0) for m in range(1, 30))
    text = "Datum;T1 [°C];nActSpeed;Program\n02.03.2026 08:00:00;20,00;RUN\n" + rows.replace(";2", ";2")
    data = load(Reader(), write(tmp_path, text), PRAGUE)
    assert len(data.t_ns["nc"]) >= 29
    assert data.losses
