"""Texts that hold no table whatever is declared: each is called by its name, with what to do."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from thermodata.errors import FormatError
from thermodata.plugin import Source
from thermodata.reader.finding.explain import explain
from thermodata.reader.finding.registry import claims
from thermodata.reader.text.file.foreign_texts import foreign_text
from thermodata.reader.text.tables.find_table import open_table

LINES = "\n".join(f"probe,machine=MC5,unit=mm z=0.00014{i},y=-0.0001 178898580{i}000" for i in range(9)) + "\n"
STRINGS = "\n".join(f'log,host=a\\ b text="one, two",n={i}i' for i in range(9)) + "\n"
PRINT = "%\n" + "\n".join(f"26/03/11 09:00:{i:02d} S0{i}000 L045 T026" for i in range(9)) + "\n%\n"
DIADEM = "DIAEXTENDED  {@:ENGLISH\n#BEGINGLOBALHEADER\n1,WINDOWS 32Bit\n101,Spindel\n104,13.04.2026\n" + "".join(
    f"#BEGINCHANNELHEADER\n200,Lager {i}\n202,K\n210,EXPLIZIT\n211,Spindel.R64\n#ENDCHANNELHEADER\n" for i in range(6)
)

SKETCH = "Booting... v1.3\nsensors found: 3\n" + "".join(f"t={10 * i} ms, T1=21.{i} C, dZ=-{i} um\n" for i in range(9))
GERMAN = "".join(f"t={10 * i}; T1=21,{i}0; dZ=-{i},25\n" for i in range(9))
SYSLOG = "".join(f"Dec 31 20:0{i}:00 labpi thermo[412]: bearing=22.0{i} bed=20.48\n" for i in range(9))
LOGGING = "".join(f"2026-03-02 08:00:0{i},123 INFO T1: 21.9{i} T2: -3\n" for i in range(9))
BROKER = "".join(f'lab/bed/temp {{"ts": 177243840{i}, "v": 21.9{i}, "unit": "degC"}}\n' for i in range(9))
XML = '<?xml version="1.0"?>\n'
EXCEL = (
    XML + '<?mso-application progid="Excel.Sheet"?>\n<Workbook xmlns="urn:schemas-microsoft-com:office:spreadsheet">\n'
)
EXCEL += "".join(f'<Row><Cell><Data ss:Type="Number">2{i}.5</Data></Cell></Row>\n' for i in range(9))
FLAT = XML + '<office:document office:mimetype="application/vnd.oasis.opendocument.spreadsheet"><office:body>\n'
AGENT = "--a8f3c1\nContent-type: text/xml\nContent-length: 3314\n\n" + XML + "<MTConnectStreams></MTConnectStreams>\n"
CAN = "".join(f"(17731296{i}0.000000) can0 1A3#00D300D70000000{i}\n" for i in range(9))
CANDUMP = "".join(f"  can0  1A3   [8]  00 D3 00 D7 00 00 00 0{i}\n" for i in range(9))
RRD = "                T_bed               T_air\n\n" + "".join(
    f"177312960{i}: 2.110000000{i}e+01 -nan\n" for i in range(9)
)
MYSQL = "".join(f"{'*' * 27} {i}. row {'*' * 27}\n   ts: 2026-03-10 08:00:0{i}\nT_bed: 21.10\n" for i in range(1, 9))
PSQL = "".join(
    f"-[ RECORD {i} ]----------------\nts    | 2026-03-10 08:00:0{i}+00\nT_bed | 21.1\n" for i in range(1, 9)
)
SPOOL = "SQL> select ts, dz_um, t_loz from mereni\n  2  where zkouska = 'a' order by ts;\n\n"
SPOOL += "TS                       DZ_UM      T_LOZ\n------------------- ---------- ----------\n"
SPOOL += "".join(f"03.02.2026 08:00:0{i}       -0,{i}       21,{i}\n" for i in range(9))
UFF_HEAD = "".join(f"{line:<80}\n" for line in ("dZ", "NONE", "04-May-26 08:00:00", "NONE", "NONE"))
UFF = (
    "    -1\n    58\n" + UFF_HEAD + "    1         0    1         0 dZ                 1   3 NONE               0   0\n"
)
UFF += "".join(f"  1.{i}0000e+00  2.10000e+01  3.0{i}000e+00\n" for i in range(9)) + "    -1\n"
UNV = (
    "    -1\n   164\n         1                  SI         2\n" + "  1.00000e+00  1.00000e+00\n" * 9 + "    -1\n" + UFF
)

SPLIT = '{"columns":["time","dZ_um"],"index":[0,1],"data":[["2026-05-11T06:00:00.000Z",0.0],["2026-05-11",0.1]]}'
COLUMNS = '{"dZ_um":{"2026-05-11T06:00:00.000Z":0.0,"2026-05-11T06:00:10.000Z":0.1}}'
ROWS = '[{"time":1778479200000,"dZ_um":0.0},{"time":1778479210000,"dZ_um":0.1}]'
DUMP = "-- MySQL dump 10.13  Distrib 8.0.36\nINSERT INTO `measurement` VALUES ('2026-05-11 06:00:00.000',-0.1);\n"


@pytest.mark.parametrize(
    ("text", "what", "do"),
    [
        (SPLIT, "a table as JSON", "read_json('FILE', orient='split').to_csv('FILE.csv', index=False)"),
        (COLUMNS, "a table as JSON", "read_json('FILE').to_csv('FILE.csv', index_label='time')"),
        (ROWS, "a list of rows as JSON", "read_json('FILE').to_csv('FILE.csv', index=False)"),
        ('{"d":[[1,2],[3,4]]}', "JSON", "export it as CSV"),
        (DUMP, "a dump of MySQL", "mysql --batch"),
        (EXCEL, "workbook in one XML", "XLSX"),
        (FLAT, "workbook in one XML", "XLSX"),
        (AGENT, "agent of MTConnect", "grep"),
        (CAN, "CAN bus", "DBC"),
        (CANDUMP, "CAN bus", "DBC"),
        (RRD, "rrdtool", "sed"),
        (SPOOL, "SQL*Plus", "set markup csv on"),
        (UFF, "universal file", "pyuff"),
        (UNV, "universal file", "pyuff"),
        (MYSQL, "rows of a database", "mysql --batch"),
        (PSQL, "rows of a database", "psql --csv"),
        (LINES, "line protocol", "CSV"),
        (STRINGS, "line protocol", "CSV"),
        (PRINT, "DPRNT", "commas"),
        (DIADEM, "DIAdem", "TDMS"),
        (SKETCH, "name each of their values", "line of names"),
        (GERMAN, "name each of their values", "line of names"),
        (SYSLOG, "name each of their values", "line of names"),
        (LOGGING, "name each of their values", "line of names"),
        (BROKER, "messages of a broker", "row a message"),
    ],
)
def test_such_a_text_is_refused_with_what_to_do(tmp_path: Path, text: str, what: str, do: str) -> None:
    path = tmp_path / "day.txt"
    path.write_text(text)
    with pytest.raises(FormatError) as error:
        open_table(path, Source(table={"header_rows": 1}))
    assert what in error.value.what
    assert do in (error.value.hint or "")
    said = explain(path)
    assert not said.claims
    assert what in said.kind
    assert said.advice is None


@pytest.mark.parametrize(
    "text",
    [
        "Time,T1\n0,20.5\n1,20.6\n",
        "%\nO1234\nN10 G0 X0\nN20 M3 S3000\n%\n",
        "% made by a script\n0.0 20.5\n1.0 20.6\n",
        "T1=20.5 n=3000\nT1=20.6 n=3000\n",
        "",
    ],
)
def test_other_texts_are_none_of_them(text: str) -> None:
    assert foreign_text(text.splitlines()) is None


def test_a_line_of_quotes_has_one_way_to_be_read() -> None:
    """With two for each of its texts this would take longer than there is time."""
    line = "m " + ",".join('a="x,b=y"' for _ in range(200))
    assert foreign_text([line] * 3) is not None
    assert foreign_text([f"{line} !"] * 3) is None


@pytest.mark.parametrize(
    "text",
    [
        "a=1 b=2\n" + "time,T1\n" + "".join(f"2026-03-02T08:00:0{i},2{i}.5\n" for i in range(9)),  # a preamble
        "".join(f"2026-03-02T08:0{i}:00,T08:0{i},2{i}.5\n" for i in range(9)),  # times
        "".join(f"2026-03-02 08:0{i}:00\tmode=3\t2{i}.5\n" for i in range(9)),  # one name alone is a cell
        "".join(f"a{i}=1 b{i}=2\n" for i in range(9)),  # settings
        # a table, one of whose columns is a block of the program
        "time;T1;block\n" + "".join(f"2026-03-02 08:0{i}:00;2{i}.5;G1 X=10{i} F=200\n" for i in range(9)),
        "".join(f"{i},R1=5 R2={i},2{i}.5\n" for i in range(9)),
        "-1\n58\n57\n" + "".join(f"{i}\n" for i in range(9)),  # a column
        "-1 58 21.5\n" * 9,
        'time;note\n08:00;{"a": 1}\n08:01;\n',
    ],
)
def test_what_may_hold_a_table_is_none_of_them(text: str) -> None:
    assert foreign_text(text.splitlines()) is None


def test_what_camonitor_prints_becomes_a_table_of_names_and_values(tmp_path: Path) -> None:
    lines = [
        f"LAB:T{k}                         2026-03-01 08:00:{i:02}.123456 {20 + i}  " for i in range(9) for k in (1, 2)
    ]
    lines[3] = "LAB:T2                         2026-03-01 08:00:01.123456 99 HIHI MAJOR"
    lines[5] = "LAB:T3                         *** Not connected (PV not found)"
    found = foreign_text(lines)
    assert found is not None
    assert found[0].startswith("what camonitor of EPICS prints")
    (tmp_path / "FILE").write_text("\n".join(lines) + "\n")
    subprocess.run(["bash", "-c", found[1].removeprefix("make a CSV of it: ")], cwd=tmp_path, check=True)
    made = (tmp_path / "camonitor.csv").read_text().splitlines()
    assert made[:2] == ["name,time,value,severity", "LAB:T1,2026-03-01 08:00:00.123456,20,"]
    assert made[4] == "LAB:T2,2026-03-01 08:00:01.123456,99,MAJOR"
    assert len(made) == len(lines)
    # two values in a line are a table
    assert foreign_text([f"T{i} 2026-03-01 08:00:{i:02}.123456 20.5 21.5" for i in range(9)]) is None


def _dump(*tables: str) -> str:
    rows = {
        "sensor": "COPY public.sensor (id, name, unit) FROM stdin;\n1\ttcp_z\tum\n2\tbed\tdegC\n\\.\n",
        "measurement": "COPY public.measurement (id, sensor_id, ts, value) FROM stdin;\n"
        + "".join(f"{k}\t{1 + k % 2}\t2026-05-11 06:{k // 60:02d}:{k % 60:02d}+00\t{k / 9:.3f}\n" for k in range(300))
        + "\\.\n",
    }
    head = "--\n-- PostgreSQL database dump\n--\n\nSET statement_timeout = 0;\n" + "SET x = 1;\n" * 40
    return head + "\n".join(rows[t] for t in tables) + "\n--\n-- PostgreSQL database dump complete\n--\n"


def test_a_dump_of_several_tables_is_refused_with_what_makes_tables_of_it(tmp_path: Path) -> None:
    (tmp_path / "lab.sql").write_text(_dump("sensor", "measurement"))
    assert not claims(tmp_path / "lab.sql")
    what, do = foreign_text(_dump("sensor", "measurement").splitlines()) or ("", "")
    assert what == "a dump of PostgreSQL with several tables"
    script = do.partition('python -c "')[2].removesuffix('"').replace("FILE", "lab.sql")
    subprocess.run([sys.executable, "-c", script], cwd=tmp_path, check=True)
    assert (tmp_path / "sensor.csv").read_text() == "id\tname\tunit\n1\ttcp_z\tum\n2\tbed\tdegC\n"
    measured = (tmp_path / "measurement.csv").read_text().splitlines()
    assert (len(measured), measured[0]) == (301, "id\tsensor_id\tts\tvalue")
    assert list(claims(tmp_path / "measurement.csv")) == ["cnc"]


def test_statements_of_others_and_a_dump_of_one_table_are_no_such_dump() -> None:
    assert foreign_text(_dump("measurement").splitlines()) is None
    assert foreign_text(["time,COPY x (a) FROM stdin;", *("2026-05-11 06:00:00,1",) * 20]) is None
