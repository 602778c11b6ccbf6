"""How the rows of an LVM packet lie: the decimal mark, and how many cells a row has."""

from __future__ import annotations

from thermodata.errors import FormatError
from thermodata.reader.text.cells.values.number import decimal_mark
from thermodata.reader.text.rows.grid import Grid, Rows
from thermodata.reader.text.rows.typed import parse
from thermodata_reader_crio.lvm.header import Header, Packet

_FIRST_BYTES = 16 * 1024


def decimal_of(data: bytes, header: Header, packet: Packet) -> tuple[str, str | None]:
    """(the decimal mark that the data show, or where they show none what the header says; a note where both differ)."""
    lines = data[:_FIRST_BYTES].decode("utf-8", "replace").splitlines()[:200]
    cells = (c for line in lines for c in line.split(header.separator)[: packet.width])
    try:
        found = decimal_mark(cells)
    except FormatError:
        found = None
    if found is not None and header.decimal is not None and found != header.decimal:
        return found, f"the header says that '{header.decimal}' is the decimal mark, the data have '{found}'"
    return found or header.decimal or ".", None


def grid_of(header: Header, packet: Packet, decimal: str, least: int | None = None) -> Grid:
    """A row has all its cells but the free text, and fewer where the heading says that channels have fewer samples
    than others. least: the fewest cells, where they are known otherwise."""
    if least is None:
        counts = {packet.samples(i) for i in range(len(packet.names))}
        least = packet.width if len(counts) == 1 else 2
    kinds = ("float64",) * packet.width + ("str",) * packet.comment
    return Grid(header.separator, decimal, kinds, least=least, blank_rows=True)


def first_rows(data: bytes, header: Header, packet: Packet) -> Rows:
    """The first rows of a packet, for what only the data tell."""
    end = data.rfind(b"\n", 0, _FIRST_BYTES) + 1 or len(data)
    return parse(data[:end], 0, grid_of(header, packet, decimal_of(data, header, packet)[0], least=2))
