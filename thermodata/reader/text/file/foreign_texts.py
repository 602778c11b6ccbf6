"""Texts that programs write, and that hold no table of cells whatever is declared: what they are, and what to do."""

from __future__ import annotations

import re
from collections.abc import Sequence

from thermodata.errors import FormatError

# a measurement with its tags, its fields, and a time in nanoseconds or the like; what begins with a quote is a text and
# nothing else: were there two ways to read it, a line of n of them would be tried in 2^n ways
_WORD, _VALUE = r"(?:[^\s,=\\]|\\.)+", r"(?:\"[^\"]*\"|[^\s,\"][^\s,]*)"
_LINE_PROTOCOL = re.compile(rf"{_WORD}(?:,{_WORD}={_WORD})* {_WORD}={_VALUE}(?:,{_WORD}={_VALUE})*(?: -?\d+)?")
# no part of a time: 'T08:00' behind a date is none
_PAIR = re.compile(r"(?<![\w.:/-])([^\W\d][\w.]{0,30})\s?[=:]\s?[+-]?\d+(?:\.\d+)?(?![\d:/])")
_DECIMAL_COMMA = re.compile(r"([=:]\s?[+-]?\d+),\d+(?![\d.])")  # 'T1=21,97': no cell of its own begins there
_CELL_OF_NUMBERS = re.compile(r"[;\t,|]\s*\"?[+-]?\d+(?:[.,]\d+)?(?:[eE][+-]?\d+)?\"?\s*(?=[;\t,|]|$)")
_MESSAGE = re.compile(r"[^\s{}\"]+(?: [^\s{}\"]+)? +\{\".*\}")
_SCRAPED = re.compile(r"[a-zA-Z_:][\w:]*(?:\{[^{}]*\})? [+-]?(?:\d|NaN|Inf)[^\s]*(?: -?\d+)?")
_OF_CAN = re.compile(
    r"(?:\(\d+\.\d+\)\s+)?v?s?l?can\d+\s+[0-9A-Fa-f]{3,8}(?:##?[0-9A-FaRr.]*|\s+\[\d+\](?:\s+[0-9A-F]{2})*)(?: .*)?"
)
_OF_RRD = re.compile(r"\d{9,10}:(?:\s+(?:[+-]?\d\.\d+e[+-]\d+|-?nan))+", re.IGNORECASE)
# sets of a universal file, as programs of modal analysis write them: a head, units, nodes, functions of time
_SET_OF_UFF = re.compile(r"(?:15|18|55|58b?|82|151|164|1858|2411|2412|2414|2420|2429|2467)(?:\s.*)?")
BY_PYUFF = (
    "export it as CSV from the program that wrote it, or make one with the library pyuff, and declare its start: "
    "python -c \"import pyuff, pandas as p; u = pyuff.UFF('FILE'); s = [d for i in range(u.get_n_sets()) if "
    "(d := u.read_sets(i))['type'] == 58]; p.concat([p.Series(d['data'], d['x'], name=d['id1'] + ' [' + "
    "d['ordinate_axis_units_lab'] + ']') for d in s], axis=1).to_csv('uff.csv', index_label='time [s]')\""
)
# of one channel of EPICS: its name, the time, one value, and an alarm where there is one
_MONITORED = re.compile(
    r"\S*[^\W\d]\S*\s+(?:\d{4}-\d\d-\d\d \d\d:\d\d:\d\d\.\d{6}\s+\S+(?:\s+[A-Z_]+\s+[A-Z_]+)?|\*\*\* .+)\s*"
)
_LOOKED_AT, _NEARLY_ALL = 20, 0.8
_FEWEST = 2


def foreign_text(lines: Sequence[str]) -> tuple[str, str] | None:
    """(what a text is, what to do with it) by its first lines; None where it may hold a table."""
    full = [bare for line in lines[: 2 * _LOOKED_AT] if (bare := line.strip().strip("\ufeff").strip())][:_LOOKED_AT]
    if not full:
        return None
    if full[0].startswith("--") and _is_dump_of_tables(lines):
        return _DUMP_OF_TABLES
    return next(((what, do) for is_one, what, do in _KNOWN if is_one(full)), None)


def refuse_foreign(lines: Sequence[str], where: str) -> None:
    """FormatError where a text is one of them."""
    known = foreign_text(lines)
    if known is not None:
        what, do = known
        first = next(line for line in lines if line.strip())
        raise FormatError(f"{what}, no table", where=where, expected="a table", got=first.strip()[:60], hint=do)


def _is_scrape(lines: Sequence[str]) -> bool:
    """Whether it is what a server gives to Prometheus: '# TYPE ...', and 'name{label="x"} 21.3 1773298800000'."""
    points = [line for line in lines if not line.startswith("#")]
    told = any(line.startswith(("# TYPE ", "# HELP ")) for line in lines)
    return told and bool(points) and all(map(_SCRAPED.fullmatch, points[:-1] or points))


def _is_line_protocol(lines: Sequence[str]) -> bool:
    points = [line for line in lines if not line.startswith("#")][:-1] or lines  # the last one may be cut
    return len(points) >= _FEWEST and all(map(_LINE_PROTOCOL.fullmatch, points))


def _is_print_of_a_macro(lines: Sequence[str]) -> bool:
    """Whether a control printed it from a program, from % to %, with a letter before each number; a program is none."""
    rows = [line for line in lines[1:] if line != "%"]
    words = [re.findall(r"(?:^|\s)[A-Z]{1,4} ?[+-]?\d[\d.]*", row) for row in rows]
    cut = any(re.search(r"[,;\t|]|^[ON]\d|\b[GM]\d", row) for row in rows)
    return lines[0] == "%" and bool(rows) and not cut and all(words)


def _is_header_of_diadem(lines: Sequence[str]) -> bool:
    return lines[0].startswith("DIAEXTENDED")


def _names_each_value(lines: Sequence[str]) -> bool:
    """Whether nearly all lines, but for some at the start, hold the same names, each with its number: 'T1=21.97 C'; and
    no cell of numbers alone beside them, as a table has whose last column is a block of the program or a message."""
    told = [() if _has_cell_of_numbers(line) else tuple(_PAIR.findall(line)) for line in lines]
    names = max(set(told), key=told.count)
    begins = next(i for i, each in enumerate(told) if each == names)
    return len(names) > 1 and len(lines) - begins > _FEWEST and told.count(names) >= _NEARLY_ALL * (len(told) - begins)


def _has_cell_of_numbers(line: str) -> bool:
    """Whether a number stands for itself in a line, behind its first cell, which is the time."""
    return _CELL_OF_NUMBERS.search(_DECIMAL_COMMA.sub(r"\1", line)) is not None


def _is_messages_of_json(lines: Sequence[str]) -> bool:
    """Whether each line is a topic, or a stamp, and what was sent there, as a broker of MQTT prints it."""
    points = lines[:-1] or lines  # the last one may be cut
    return len(points) >= _FEWEST and all(map(_MESSAGE.fullmatch, points))


def _is_spreadsheet_in_xml(lines: Sequence[str]) -> bool:
    """Whether it is a workbook in one XML: that of Excel 2003 (<Workbook>), or a flat one of LibreOffice."""
    text = " ".join(lines[:6])
    flat = "<office:document" in text and "opendocument.spreadsheet" in text
    return lines[0].startswith("<?xml") and (flat or "urn:schemas-microsoft-com:office:spreadsheet" in text)


def _is_multipart_of_mtconnect(lines: Sequence[str]) -> bool:
    """Whether it is the stream that an agent sends: parts with a boundary and a type before each document."""
    head = [line.casefold() for line in lines[:6]]
    return head[0].startswith("--") and any(h.startswith("content-type:") and "xml" in h for h in head[1:])


def _is_dump_of_can(lines: Sequence[str]) -> bool:
    points = lines[:-1] or lines
    return len(points) >= _FEWEST and all(map(_OF_CAN.fullmatch, points))


def _is_camonitor(lines: Sequence[str]) -> bool:
    points = lines[:-1] or lines
    return len(points) >= _FEWEST and all(map(_MONITORED.fullmatch, points))


def _is_dump_of_rrd(lines: Sequence[str]) -> bool:
    """Whether `rrdtool fetch` printed it: names, then '1773129600: 2.11e+01 2.15e+01'."""
    points = lines[1:-1]
    return len(points) >= _FEWEST and all(map(_OF_RRD.fullmatch, points))


def _is_spool_of_sqlplus(lines: Sequence[str]) -> bool:
    """Whether SQL*Plus wrote what its screen showed: the statement behind its prompt, and pages of fixed width."""
    return any(line.startswith("SQL> ") for line in lines[:5])


def _is_universal_file(lines: Sequence[str]) -> bool:
    """Whether it is a file of sets between lines of -1, each with its number; a column of numbers is none."""
    told = len(lines) > _FEWEST and lines[0] == "-1" and _SET_OF_UFF.fullmatch(lines[1]) is not None
    return told and re.fullmatch(r"[+-]?\d+(?:[.,]\d+)?", lines[2]) is None


def _is_rows_apart(lines: Sequence[str]) -> bool:
    """Whether a client of a database printed each row as a list of its columns: MySQL's \\G, PostgreSQL's \\x."""
    return re.match(r"\*{10,} 1\. row \*{10,}|-\[ RECORD 1 \]-", lines[0]) is not None


def _is_split_json(lines: Sequence[str]) -> bool:
    """Whether it is a table of pandas as JSON in one line, its columns, its index and its rows apart."""
    return len(lines) == 1 and re.match(r'\{"(?:columns|index|data)":\s?\[', lines[0]) is not None


def _is_json_by_columns(lines: Sequence[str]) -> bool:
    """Whether it is one in which each column holds its values by the times or numbers of their rows."""
    return len(lines) == 1 and re.match(r'\{"[^"]+":\s?\{"[\d:TZ. +-]+":', lines[0]) is not None


def _is_json_of_rows(lines: Sequence[str]) -> bool:
    return len(lines) == 1 and re.match(r'\[\s*\{\s*"', lines[0]) is not None


def _is_json(lines: Sequence[str]) -> bool:
    """Whether it is any other JSON in one line."""
    return len(lines) == 1 and re.match(r'(?:\{\s*"|\[\s*[\[{])', lines[0]) is not None


def _is_dump_of_mysql(lines: Sequence[str]) -> bool:
    return re.match(r"-- (?:MySQL|MariaDB) dump ", lines[0]) is not None


def _is_dump_of_tables(lines: Sequence[str]) -> bool:
    """Whether it is a dump of PostgreSQL with several tables: one has the names and units of another's rows."""
    return sum(line.startswith("COPY ") and _COPY.match(line) is not None for line in lines) > 1


_COPY = re.compile(r"COPY [^\s(]+ \([^()]*\) FROM stdin;")
_DUMP_OF_TABLES = (
    "a dump of PostgreSQL with several tables",
    "make a CSV of each, which are read together: psql DATABASE -c '\\copy TABLE to TABLE.csv csv header'; or out of "
    "the dump: python -c \"import re; N = chr(92); [open(t + '.csv', 'w').write('\\t'.join(c.split(', ')) + "
    "r.split('\\n' + N + '.')[0].replace(N + 'N', '') + '\\n') for t, c, r in re.findall("
    "r'COPY [^ ]*?(\\w+) \\((.*?)\\) FROM stdin;(.*?)(?=\\nCOPY |\\Z)', open('FILE').read(), re.S)]\"",
)
_BY_PANDAS = "make a CSV of it: python -c \"import pandas; pandas.read_json('FILE'{}).to_csv('FILE.csv'{})\""
_KNOWN = (
    (_is_split_json, "a table as JSON (pandas)", _BY_PANDAS.format(", orient='split'", ", index=False")),
    (_is_json_by_columns, "a table as JSON (pandas)", _BY_PANDAS.format("", ", index_label='time'")),
    (_is_json_of_rows, "a list of rows as JSON", _BY_PANDAS.format("", ", index=False")),
    (_is_json, "JSON", "export it as CSV"),
    (
        _is_dump_of_mysql,
        "a dump of MySQL, whose rows stand in its statements",
        "ask for a table: mysql --batch -e 'select * from TABLE' DATABASE > FILE.tsv; or take the rows out, and write "
        "their names above: python -c \"import re; rows = re.findall(r'\\(([^()]*)\\)[,;]', open('FILE').read()); "
        "open('FILE.csv', 'w').write('\\n'.join(rows).replace(chr(39), ''))\"",
    ),
    (
        _is_spreadsheet_in_xml,
        "a workbook in one XML file (of Excel 2003, or a flat one of LibreOffice)",
        "save it as XLSX: open it in Excel or LibreOffice, or soffice --headless --convert-to xlsx FILE",
    ),
    (
        _is_multipart_of_mtconnect,
        "the stream of an agent of MTConnect, with lines of HTTP between its documents",
        "take out the lines that begin with -- and Content-: grep -av -e '^--' -e '^Content-' FILE > stream.xml",
    ),
    (
        _is_dump_of_can,
        "messages of a CAN bus in bytes (candump)",
        "decode them by the DBC file of the bus, as asammdf and cantools do, to MDF or to a CSV of time,name,value",
    ),
    (
        _is_camonitor,
        "what camonitor of EPICS prints, a line a value",
        "make a CSV of it: (echo name,time,value,severity; sed -nE "
        "'s/^(\\S+) +(\\S+ [0-9:.]+) +(\\S+) *\\S* *(\\S*) *$/\\1,\\2,\\3,\\4/p' FILE) > camonitor.csv",
    ),
    (
        _is_dump_of_rrd,
        "what rrdtool fetch prints",
        "make a CSV of it: sed -E '/^ *$/d; 1s/^ */time,/; s/^([0-9]+): */\\1,/; s/ +/,/g' FILE > rrd.csv",
    ),
    (
        _is_spool_of_sqlplus,
        "what SQL*Plus showed on its screen, in pages of fixed width",
        "spool it again as CSV: set markup csv on delimiter ';' quote off, set feedback off, set pagesize 0 and "
        "set trimspool on before spool FILE.csv; or sqlplus -s -m 'csv on' USER @query.sql > FILE.csv",
    ),
    (
        _is_universal_file,
        "a universal file of modal analysis (UFF, UNV), which has a set of its own for each signal",
        BY_PYUFF,
    ),
    (
        _is_rows_apart,
        "rows of a database, each printed as a list of its columns",
        "ask again for a table: mysql --batch (no \\G), or psql --csv (no \\x)",
    ),
    (
        _is_scrape,
        "the text of a scrape of Prometheus",
        "export what is stored as CSV, with a column a series: in Grafana Inspect, Data, Download CSV; or write a CSV "
        "of time,name,value, a row a sample",
    ),
    (
        _is_line_protocol,
        "InfluxDB's line protocol",
        "export it as CSV: influx query --raw, or the data explorer's CSV",
    ),
    (
        _is_print_of_a_macro,
        "the print of a macro (DPRNT)",
        "print a line of names first, and the numbers with commas between them and no letters before them; in what is "
        "printed already, replace the blanks and letters so",
    ),
    (
        _is_header_of_diadem,
        "the header of a DIAdem data set, whose values stand in a binary file beside it (.R64, .I16, ...)",
        "save the data set in DIAdem as TDMS, or export it as CSV",
    ),
    (
        _names_each_value,
        "lines that name each of their values ('T1=21.97 C'), as sketches and logs of messages print them",
        "print a line of names with units first ('time [ms],T1 [degC]'), and below it the numbers alone with commas "
        "between them; in what is printed already, take out the names, the units and the words before them",
    ),
    (
        _is_messages_of_json,
        "messages of a broker (MQTT), each with a topic and JSON",
        "write a CSV with a row a message: time,topic,value,unit",
    ),
)
