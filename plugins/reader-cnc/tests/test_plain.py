"""Plain CSV exports: encodings, decimal marks, units, types, and what is not claimed."""

from __future__ import annotations

from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest
from thermodata_reader_cnc import Reader

from thermodata.errors import FormatError
from thermodata.plugin import Block, Head, Loss, Recording, Source
from thermodata.reader.contract.guard import described, guarded
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
    return write(tmp_path_factory.mktemp("kit"), HEADER + "\n".join(rows(8)) + "\n")


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
