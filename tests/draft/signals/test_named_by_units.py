"""A header of units alone: the units are read as such, and what is measured where is asked."""

from __future__ import annotations

from pathlib import Path

import pytest

from thermodata.draft.make import draft_files
from thermodata.draft.signals.named_by_units import with_names_as_units
from thermodata.plugin import Signal

# as the manual of Fluke's NetDAQ has it: file, date, comment, number of columns, units of the channels, scans
NETDAQ = '"C:\\NETDAQ\\DATA01.TXT"\n"Sun Mar 15 08:00:00 2026"\n"heat up"\n5\n"","C","C","VDC","VDC"\n'


def signals(*names: str, unit: str | None = None) -> list[Signal]:
    return [Signal(name, "s", unit, "float64", None, {}) for name in names]


@pytest.mark.parametrize(
    "head", [NETDAQ, "Date Time,C,C,V,V\n", "Date Time,°C,°C,VDC,VDC\n", "Date Time,degC,degC,mV,V\n"]
)
def test_a_volt_is_no_temperature_where_the_header_has_units_alone(tmp_path: Path, head: str) -> None:
    rows = (
        f"03/15/2026 {8 + i // 60:02d}:{i % 60:02d}:00,{21 + i / 100:.2f},{22 + i / 50:.2f},{5 + i / 1000:.3f},"
        f"{4 + i / 500:.3f}\n"
        for i in range(120)
    )
    (tmp_path / "t1.csv").write_text(head + "".join(rows), "utf-8")
    text = draft_files(tmp_path).campaign.read_text("utf-8")
    channels = [line for line in text.splitlines() if "signal:" in line]
    assert ["quantity: temperature" in line for line in channels] == [True, True, False, False]
    assert ["quantity: voltage" in line for line in channels] == [False, False, True, True]
    assert text.count("its header has units where names stand elsewhere") == 1


@pytest.mark.parametrize(
    ("names", "units"),
    [
        (("V", "V#2", "C"), ["V", "V", "C"]),
        (("rpm", "kW", "bar"), ["rpm", "kW", "bar"]),
        (("5", "C", "C#2"), [None, "C", "C"]),  # NetDAQ's number of columns over its times
        (("A", "C"), [None, None]),  # two rotary axes
        (("A", "rpm"), [None, None]),
        (("V", "V#2", "T_bed"), [None] * 3),
        (("C",), [None]),
    ],
)
def test_letters_of_axes_are_no_units(names: tuple[str, ...], units: list[str | None]) -> None:
    found, asked = with_names_as_units(signals(*names))
    assert [s.unit for s in found] == units
    assert (asked is None) == (not any(units))


def test_what_has_units_beside_its_names_is_called_by_them() -> None:
    assert with_names_as_units(signals("C", "C#2", unit="degC"))[1] is None
