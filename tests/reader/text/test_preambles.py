"""A preamble with dates and words, and rows that stand below the units, as measuring programs export them."""

from __future__ import annotations

import pytest

from thermodata.reader.text.layout import find

Row = list[str]


def rows(text: str) -> list[Row]:
    return [line.split("\t") for line in text.split("\n")]


def numbers(count: int, width: int) -> str:
    return "\n".join("\t".join(f"{i}.{k:03d}" for k in range(width)) for i in range(count))


@pytest.mark.parametrize("count", [12, 40])
def test_a_date_above_the_names_is_no_row_of_a_table_whose_time_is_in_seconds(count: int) -> None:
    head = "Sensor:\tcapa\nStart:\t05.02.2026 09:00:00\nRate:\t0.25 Hz\n\nTime [s]\tZ [mm]\tX [mm]\n"
    found = find(rows(head + numbers(count, 3)), None, "here")
    assert found.names == ("Time [s]", "Z [mm]", "X [mm]")
    assert found.first == 5


def test_the_first_row_of_a_table_with_dates_is_kept_though_the_next_is_damaged() -> None:
    body = [f"2026-03-02 08:00:{i:02d}\t{20 + i}.5\tok" for i in range(30)]
    body[1] = "garbage"
    found = find(rows("\n".join(["time\tT1\tstate", *body])), None, "here")
    assert found.first == 1


@pytest.mark.parametrize("probes", [1, 3])
def test_names_stand_above_units_and_the_channels_of_the_amplifier_below(probes: int) -> None:
    head = [
        "Operator\tKL",
        "Date\t06.07.2026",
        "T0 = 06.07.2026 07:30:40",
        "",
        "\t".join(["Time  1 - default sample rate", *[f"Wirbelstrom {a}" for a in "XYZ"[:probes]]]),
        "\t".join(["s", *["V"] * probes]),
        "\t".join(["", *[f"MX840B_0_CH {k + 1}" for k in range(probes)]]),
    ]
    found = find(rows("\n".join(head) + "\n" + numbers(30, probes + 1)), None, "here")
    assert found.names[1] == "Wirbelstrom X"
    assert found.units[:2] == ("s", "V")
    assert len(found.names) == probes + 1
