"""A preamble with dates and words, and rows that stand below the units, as measuring programs export them."""

from __future__ import annotations

import pytest

from thermodata.errors import QuestionError
from thermodata.reader.text.page.layout import find_layout

Row = list[str]


def rows(text: str) -> list[Row]:
    return [line.split("\t") for line in text.split("\n")]


def numbers(count: int, width: int) -> str:
    return "\n".join("\t".join(f"{i}.{k:03d}" for k in range(width)) for i in range(count))


@pytest.mark.parametrize("count", [12, 40])
def test_a_date_above_the_names_is_no_row_of_a_table_whose_time_is_in_seconds(count: int) -> None:
    head = "Sensor:\tcapa\nStart:\t05.02.2026 09:00:00\nRate:\t0.25 Hz\n\nTime [s]\tZ [mm]\tX [mm]\n"
    found = find_layout(rows(head + numbers(count, 3)), None, "here")
    assert found.names == ("Time [s]", "Z [mm]", "X [mm]")
    assert found.first == 5


def test_the_first_row_of_a_table_with_dates_is_kept_though_the_next_is_damaged() -> None:
    body = [f"2026-03-02 08:00:{i:02d}\t{20 + i}.5\tok" for i in range(30)]
    body[1] = "garbage"
    found = find_layout(rows("\n".join(["time\tT1\tstate", *body])), None, "here")
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
    found = find_layout(rows("\n".join(head) + "\n" + numbers(30, probes + 1)), None, "here")
    assert found.names[1] == "Wirbelstrom X"
    assert found.units[:2] == ("s", "V")
    assert len(found.names) == probes + 1


CATMAN = """\
catmanAP V5.4.2 ASCII Datenexport
Startzeit:\t12.01.2026 08:00:00
Messrate:\t0,2 Hz

Zeit  1 - Standardmessrate\tMX1609_CH1 Lager A\tMX1609_CH2 Lager B\tMX840_CH1 Weg Z
s\t°C\t°C\tµm
{comments}
"""


@pytest.mark.parametrize(
    "comments",
    [
        "Sensor:\tPt100 4-Leiter\tPt100 4-Leiter\teddyNCDT 3001",
        "Kommentar\tam Flansch\t\tneu",
        "Sensor:\tPt100\tPt100\teddyNCDT\nOrt:\tFlansch\tMotor\tTisch",
        "Kanal\tMX1609_CH1\tMX1609_CH2\tMX840_CH1",
    ],
)
def test_comments_below_the_units_leave_names_and_units_as_they_are(comments: str) -> None:
    found = find_layout(rows(CATMAN.format(comments=comments) + numbers(30, 4)), None, "here")
    assert found.names == (
        "Zeit  1 - Standardmessrate",
        "MX1609_CH1 Lager A",
        "MX1609_CH2 Lager B",
        "MX840_CH1 Weg Z",
    )
    assert found.units == ("s", "°C", "°C", "µm")
    assert found.said_of(1) == {}
    assert any("between header and data is not read" in note for note in found.notes)


def test_comments_below_units_of_names_that_are_merged_with_the_row_above() -> None:
    head = [
        "Zeitstempel\tSpindel\t\tTemperaturen\t",
        "\tDrehzahl\tAuslastung\tSpindelmotor\tRücklauf",
        "\tU/min\t%\t°C\t°C",
        "Kommentar\taus NCU\t\tPt1000 Klixon\t",
    ]
    body = [f"2026-01-12 08:{i:02d}:00\t3000\t12.5\t23.5\t19.{i % 9}" for i in range(40)]
    found = find_layout(rows("\n".join([*head, *body])), None, "here")
    assert found.names == ("Zeitstempel", "Drehzahl", "Auslastung", "Spindelmotor", "Rücklauf")
    assert found.units == (None, "U/min", "%", "°C", "°C")
    assert found.said_of(1) == {"group": "Spindel"}


def test_names_below_units_that_say_the_time_are_names() -> None:
    head = "Time\tA\tB\ns\t°C\t°C\nZeit\tfront\trear\n"
    found = find_layout(rows(head + numbers(30, 3)), {"time": {"unit": "s"}}, "here")
    assert found.names[-2:] == ("front", "rear")


@pytest.mark.parametrize(
    ("between", "proposed"),
    [
        (
            "Faktor;1;1;0,5\nOffset;0;-1,5;0",
            "else: an export that has them, or, of a displacement, a calibration of kind scale",
        ),
        ("Faktor;0,1;0,1;0,01", '; dZ: unit: "0.01 um", instead_of: um'),
        ("Skalierung:;10;10;1", 'T_Bett: unit: "10^1 °C", instead_of: °C'),
    ],
)
def test_factors_between_header_and_data_are_asked(between: str, proposed: str) -> None:
    head = f"Zeit;T_Lager;T_Bett;dZ\n;°C;°C;um\n{between}\n"
    body = "\n".join(f"12.03.2026 08:00:{k:02d};21,{k};20,{k};0,{k}" for k in range(40))
    table = [line.split(";") for line in (head + body).split("\n")]
    with pytest.raises(QuestionError) as refused:
        find_layout(table, None, "here", ";")
    first = head.count("\n")
    assert refused.value.declare == {"header_rows": first}
    assert f"line 3 '{between.splitlines()[0].replace(';', ' ')}'" in refused.value.ask
    assert refused.value.ask.endswith(proposed)
    found = find_layout(table, {"header_rows": first}, "here")
    assert found.names == ("Zeit", "T_Lager", "T_Bett", "dZ")
    assert found.units[1:] == ("°C", "°C", "um")


def test_lines_between_that_change_nothing_are_quoted() -> None:
    head = "Zeit;T_Lager;dZ\n;°C;um\nFaktor;1;1,0\n"
    body = "\n".join(f"12.03.2026 08:00:{k:02d};21,{k};0,{k}" for k in range(40))
    found = find_layout([line.split(";") for line in (head + body).split("\n")], None, "here")
    assert "line 3 between header and data is not read (1 such): 'Faktor 1 1,0'" in found.notes
