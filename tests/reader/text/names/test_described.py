"""What loggers write above their columns: comments, and lists of channels with what the user called them."""

from __future__ import annotations

import csv

import pytest

from thermodata.reader.text.page.layout import Layout, find_layout

GRAPHTEC = """\
"Vendor","GRAPHTEC Corporation"
"Start time","2026-06-15 20:00:00"
"AMP settings"
"CH","Signal name","Input","Range","Filter","Span"
"CH1","{one}","TEMP","TC_T","Off","100.0","0.0","degC"
"CH2","{two}","DC","10V","Off","+10.000","-10.000","V"
"CH3","CH3","DC","10V","Off","+10.000","-10.000","V"
"Logic/Pulse","Logic"
"Data"
"Number","Date&Time","ms","CH1","CH2","CH3","Alarm 12"
"""
UNITS = '"NO.","Time","ms","degC","V","V","12"\n'
HIOKI = """\
"HIOKI LR8450","Ver 2.10"
"Title","Warmlauf"
"Comment",{comments}
"Time","U1-1[°C]","U1-2[°C]","U1-3[°C]"
"""


def table(head: str, row: str) -> Layout:
    rows = [row.format(i=i, at=f"{i // 60:02d}:{i % 60:02d}") for i in range(40)]
    return find_layout(list(csv.reader([*head.splitlines(), *rows])), None, "here")


def said(found: Layout) -> dict[str, str]:
    every = {name: found.said_of(i) for i, name in enumerate(found.names)}
    return {name: properties["description"] for name, properties in every.items() if "description" in properties}


GRAPHTEC_ROW = '"{i}","2026/06/15 20:{at}","0","+   27.2","-  1.99","+  0.00","LL"'
HIOKI_ROW = '"2026-02-09 21:{at}",2.25E+01,2.29E+01,2.22E+01'


@pytest.mark.parametrize(("one", "two"), [("主軸前軸受", "変位Z"), ("Spindle front", "Disp Z")])
def test_a_list_of_channels_says_what_the_columns_are_called(one: str, two: str) -> None:
    found = table(GRAPHTEC.format(one=one, two=two) + UNITS, GRAPHTEC_ROW)
    assert found.names == ("Number", "Date&Time", "ms", "CH1", "CH2", "CH3", "Alarm 12")
    assert said(found) == {"CH1": one, "CH2": two}


def test_a_list_of_channels_says_units_where_no_row_of_units_does() -> None:
    found = table(GRAPHTEC.format(one="front", two="probe"), GRAPHTEC_ROW)
    assert found.units[3:6] == ("degC", "V", "V")


def test_a_list_without_a_header_whose_second_cells_repeat_says_how_channels_are_wired() -> None:
    head = "CH1,TEMP,TC_T\nCH2,TEMP,TC_K\nDate&Time,CH1,CH2\n"
    found = table(head, "2026/06/15 20:{at},27.25,26.50")
    assert said(found) == {}
    named = table(head.replace("CH1,TEMP", "CH1,front").replace("CH2,TEMP", "CH2,rear"), "2026/06/15 20:{at},27.2,26.5")
    assert said(named) == {"CH1": "front", "CH2": "rear"}


def test_a_row_of_comments_above_the_names_describes_the_columns() -> None:
    found = table(HIOKI.format(comments='"Lager vorne","","Raumluft"'), HIOKI_ROW)
    assert found.names == ("Time", "U1-1[°C]", "U1-2[°C]", "U1-3[°C]")
    assert said(found) == {"U1-1[°C]": "Lager vorne", "U1-3[°C]": "Raumluft"}


def test_a_comment_on_the_whole_file_describes_no_column() -> None:
    assert said(table(HIOKI.format(comments='"Warmlauf mit 3000"'), HIOKI_ROW)) == {}
    assert said(table("Comment,warm-up\nTime,T1\n", "2026-02-09 21:{at},22.5")) == {}


@pytest.mark.parametrize("word", ["コメント", "注释", "Commentaire", "Kommentar"])
def test_a_row_of_comments_is_known_in_other_languages(word: str) -> None:
    head = HIOKI.replace('"Comment",{comments}', f'"{word}","主軸前軸受","モータ","変位Z"')
    assert said(table(head, HIOKI_ROW)) == {
        "U1-1[°C]": "主軸前軸受",
        "U1-2[°C]": "モータ",
        "U1-3[°C]": "変位Z",
    }


@pytest.mark.parametrize(
    ("first", "second", "described"),
    [
        ("1;AI 1;Palier avant;°C", "2;AI 2;Capteur Z;µm", {"AI 1 (°C)": "Palier avant", "AI 2 (µm)": "Capteur Z"}),
        ("a;AI 1;Palier avant;°C", "b;AI 2;Capteur Z;µm", {}),  # what the first cells say is not known
        ("1;AI 1;Palier avant;°C", "2;AI 9;Capteur Z;µm", {}),  # of one, it may be anything
    ],
)
def test_a_list_of_channels_that_numbers_them(first: str, second: str, described: dict[str, str]) -> None:
    names = "Temps (s);AI 1 (°C);AI 2 (µm);AI 3 (°C);AI 4 (°C);AI 5 (°C)"
    head = ["Fichier;E1.dxd", "N°;Nom;Description;Unité", first, second, names]
    rows = [f"{i}.0;21.{i:02d};{i}.5;21.5;22.5;23.5" for i in range(40)]
    assert said(find_layout(list(csv.reader([*head, *rows], delimiter=";")), None, "here")) == described


@pytest.mark.parametrize("called", ["Description", "Beschreibung:", "Popis"])
@pytest.mark.parametrize("units", ["", "Unit,degC,degC,um\n"])
def test_a_row_of_descriptions_below_names_is_not_that_of_names(called: str, units: str) -> None:
    """Not even where the rows count from a start, and the time is told by its name alone."""
    head = f"Time [s],T1,T2,dZ\n{called},front bearing,bed left,probe Z\n{units}"
    found = table(head, "{i}.0,27.25,26.50,0.125")
    assert found.names == ("Time [s]", "T1", "T2", "dZ")
    assert said(found) == {"T1": "front bearing", "T2": "bed left", "dZ": "probe Z"}
    assert not any("is not read" in note for note in found.notes)
    assert found.units[1:] == (("degC", "degC", "um") if units else (None, None, None))


def test_a_row_called_names_below_numbers_of_channels_is_that_of_names() -> None:
    found = table("Time [s],CH1,CH2,CH3\nName,front bearing,bed left,probe Z\n", "2026/06/15 20:{at},27.25,26.50,0.125")
    assert found.names[1:] == ("front bearing", "bed left", "probe Z")
