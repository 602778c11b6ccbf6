"""Plain LabVIEW text: what is claimed, and what is read of it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from thermodata_reader_crio import Reader

from thermodata.errors import FormatError
from thermodata.plugin import Source
from thermodata.reader import claims
from thermodata.schema.flag import Flag
from thermodata.testing.reader import Data, load

S = 1_000_000_000
START = np.datetime64("2026-03-01T08:00:00", "ns").astype(np.int64).item()
SECONDS = START // S + 2_082_844_800
NAMES = "Time\tT1 [degC]\tdZ (µm)\n"


def rows(n: int = 6, form: str = "{t:.6f}\t{a:.3f}\t{b:.3f}\n") -> str:
    return "".join(form.format(t=SECONDS + i / 4, a=20 + i / 8, b=-i / 2) for i in range(n))


def read(tmp_path: Path, text: str, name: str = "log.txt", **options: object) -> Data:
    path = tmp_path / name
    path.write_bytes(text.encode())
    return load(Reader(), path, Source(options=options))


@pytest.mark.parametrize(
    ("head", "names"),
    [("", ["column 2", "column 3"]), (NAMES, ["T1", "dZ"]), ("Warm-up of 2026\n\n" + NAMES, ["T1", "dZ"])],
)
def test_seconds_since_1904_with_and_without_names(tmp_path: Path, head: str, names: list[str]) -> None:
    data = read(tmp_path, head + rows())
    assert [s.name for s in data.recording.signals] == names
    assert data.recording.start_ns == START
    np.testing.assert_array_equal(data.t_ns["data"], START + np.arange(6) * S // 4)
    np.testing.assert_array_equal(data.values["data", names[1]], -np.arange(6) / 2)
    assert list(claims(tmp_path / "log.txt")) == ["crio"]
    assert data.losses == ()


def test_units_below_the_names_decimal_commas_and_a_time_in_the_last_column(tmp_path: Path) -> None:
    body = rows(form="{a:.3f}\t{b:.3f}\t{t:.6f}\n").replace(".", ",")
    data = read(tmp_path, "T1\tdZ\tTimestamp\ndegC\tµm\t\n" + body)
    assert [(s.name, s.unit) for s in data.recording.signals] == [("T1", "degC"), ("dZ", "µm")]
    np.testing.assert_array_equal(data.t_ns["data"], START + np.arange(6) * S // 4)
    np.testing.assert_array_equal(data.values["data", "T1"], 20 + np.arange(6) / 8)


def test_lvm_rows_without_their_header(tmp_path: Path) -> None:
    text = "0.000000\t1.5\t-2\n1.953125E-5\t1.25\t3\n3.906250E-5\t1\t4\n"
    data = read(tmp_path, text, "cut.lvm")
    assert list(claims(tmp_path / "cut.lvm")) == ["crio"]
    assert data.recording.clock == "relative"
    np.testing.assert_array_equal(data.t_ns["data"], [0, 19531, 39062])
    bare = read(tmp_path, "1.5\t2\n1.25\t3\n1.5\t4\n", "bare.lvm", increment="0.5 s")
    np.testing.assert_array_equal(bare.t_ns["data"], [0, S // 2, S])
    assert "numbered" in bare.recording.notes[0]


def test_what_others_read_better_is_left_to_them(tmp_path: Path) -> None:
    def claimed(text: str, name: str = "x.txt") -> bool:
        (tmp_path / name).write_text(text)
        return "crio" in claims(tmp_path / name)

    assert not claimed("Time [s]\tT1\n" + "".join(f"{i}.5\t{i}.25\n" for i in range(9)))
    assert not claimed("Time\tT1\ns\tdegC\n" + rows(form="{t:.6f}\t{a:.3f}\n"))
    assert not claimed("".join(f"{i}.5\t{i}.25\n" for i in range(9)))
    assert not claimed("".join(f"2026-03-01 08:00:{i:02}\t{i}.25\n" for i in range(9)))
    assert not claimed("time,T1\n" + rows(form="{t:.6f},{a:.3f}\n"), "x.csv")


def test_damage_is_said_and_the_rest_is_kept(tmp_path: Path) -> None:
    lines = (NAMES + rows(8)).splitlines(keepends=True)
    lines[3] = lines[3].replace("20.250", "xx")
    lines[5] = "1.5\t2\n"
    data = read(tmp_path, "".join(lines)[:-4])
    np.testing.assert_array_equal(data.t_ns["data"], START + np.array([0, 1, 2, 3, 5, 6]) * S // 4)
    assert data.flags["data", "T1"][2] == Flag.NOT_MEASURING
    assert {x.reason.split(" ", 1)[1].split(":")[0] for x in data.losses} == {
        "last line has no end",
        "line that is no row of 3 numbers with a time",
        "cell that is no number",
    }


def test_a_session_that_was_appended_with_its_header_is_read_on(tmp_path: Path) -> None:
    data = read(tmp_path, NAMES + rows(6) + NAMES + rows(6))
    assert data.t_ns["data"].size == 12
    assert data.losses == ()


def test_a_comment_column_is_text_and_flags_its_row(tmp_path: Path) -> None:
    text = (
        NAMES.strip()
        + "\tComment\n"
        + "".join(line + ("\tLOST COMMUNICATION\n" if i == 2 else "\t\n") for i, line in enumerate(rows().splitlines()))
    )
    data = read(tmp_path, text)
    assert list(data.values["data", "Comment"]) == ["", "", "LOST COMMUNICATION", "", "", ""]
    assert data.flags["data", "dZ"][2] == Flag.NOT_MEASURING


def test_text_without_rows_of_numbers_is_refused(tmp_path: Path) -> None:
    with pytest.raises(FormatError, match="no rows of numbers"):
        read(tmp_path, "2026-03-01 08:00:00\tspindle on\n" * 5)
