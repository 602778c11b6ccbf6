"""Which of a control's formats a file is, by its first bytes.

Of delimited text this reader claims what has absolute dates and times in its rows and ';' or a tab between its
cells; comma-separated text, and text with relative or no time, is left to readers of general tables.
"""

from __future__ import annotations

from thermodata.errors import FormatError
from thermodata.plugin import Head
from thermodata.reader.text import decode_head
from thermodata_reader_cnc import mtconnect, opcua, sco, shdr, tracecsv, tracexml, twincat
from thermodata_reader_cnc.layout import find_layout

NAMES = {";": "';'", "\t": "tabs"}


def claim(head: Head) -> tuple[str, str] | None:
    """(format, reason) of a file that is ours, or None."""
    text = decode_head(head.start)
    if text is None or not text.strip():
        return None
    if text.lstrip("\ufeff \r\n").startswith("<"):
        for form, claims_text in (("mtconnect", mtconnect.claims), ("tracexml", tracexml.claims)):
            if (reason := claims_text(text)) is not None:
                return form, reason
        return None
    lines = [line.rstrip("\r") for line in text.lstrip("\ufeff").split("\n")]
    if head.size_bytes > len(head.start) and len(lines) > 1:
        lines.pop()  # the head ends inside a line
    if lines[0].startswith("LabVIEW"):
        return None
    for form, claims in (
        ("shdr", shdr.claims),
        ("twincat", twincat.claims),
        ("sco", sco.claims),
        ("opcua", opcua.claims),
        ("tracecsv", tracecsv.claims),
    ):
        if (reason := claims(lines)) is not None:
            return form, reason
    return _plain(lines, head.name)


def _plain(lines: list[str], name: str) -> tuple[str, str] | None:
    try:
        layout = find_layout([line for line in lines if line.strip()], [], None, name)
    except FormatError as error:
        # a file of ours whose day and month nothing tells apart is still ours: reading it asks for the order
        if error.what.startswith("day and month") and any(";" in line or "\t" in line for line in lines[-3:]):
            return "plain", "rows of a date and time between ';' or tabs"
        return None
    if layout.delimiter not in NAMES or not layout.absolute:
        return None
    forms = " and ".join(form.text for _, form in layout.time)
    return "plain", f"rows between {NAMES[layout.delimiter]} with a time {forms} in column {layout.time[0][0] + 1}"
