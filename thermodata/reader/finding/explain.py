"""Why a reader claims a file, and why the others do not; what to declare where none or several do."""

from __future__ import annotations

import inspect
import re
from dataclasses import dataclass
from pathlib import Path

from thermodata.archive.members import size_of, standing
from thermodata.archive.packed_by import how_to_unpack, packed, packed_by
from thermodata.errors import FormatError, ThermodataError
from thermodata.plugin import Head, Source
from thermodata.reader.contract.guard import described
from thermodata.reader.finding.foreign_files import foreign_file, foreign_kind
from thermodata.reader.finding.registry import all_claims, claims, failed_readers, failed_sniffs, head, readers
from thermodata.reader.text import decode_head
from thermodata.reader.text.cells.lines.delimiter import BLANKS, find_delimiter
from thermodata.reader.text.cells.lines.named_values import named_values
from thermodata.reader.text.file.foreign_texts import foreign_text

# First bytes of what lies in folders of logs without being one
_MAGIC: tuple[tuple[bytes, str], ...] = (
    (b"TDSm", "TDMS of LabVIEW"),
    (b"TDSh", "the index of a TDMS file, which is never read: it may be stale"),
    (b"\x89MCAP", "MCAP"),
    (b"PAR1", "Parquet"),
    (b"PK\x03\x04", "a ZIP file (XLSX and others are)"),
    (b"MATLAB 5.0", "MAT 5 of MATLAB"),
    (b"MDF     ", "MDF of a measuring system"),
    (b"UnFinMF ", "MDF that was not finished"),
    (b"%PDF", "PDF"),
    (b"\x89PNG", "a PNG picture"),
    (b"\xff\xd8\xff", "a JPEG picture"),
    (b"\xd0\xcf\x11\xe0", "an old Office file (XLS, DOC): save it as XLSX"),
    (b"\x7fELF", "a program"),
    (b"MZ", "a program"),
    (b"#ROSBAG", "a ROS 1 bag: convert it to MCAP"),
    (b"\xff\xfe\0\0", "text in UTF-32: save it as UTF-8"),
    (b"\0\0\xfe\xff", "text in UTF-32: save it as UTF-8"),
)
_ARCHIVE = "a ZIP archive of files"
# The first lines of what is text, and no table whatever is declared
_TEXTS: tuple[tuple[re.Pattern[str], str], ...] = (
    (re.compile(r"(?i)\s*<(?:!doctype\s+html|html|table)\b"), "an HTML page, whatever it is called: save it as XLSX"),
    (
        re.compile(r"\s*\{\s*\"[^\"]*\"\s*:\s*\[\s*\{"),
        "JSON, lists of objects by their names: write an object a line: jq -c 'to_entries[] | .key as $name | "
        ".value[] | {name: $name} + .' FILE > lines.json; or export it as CSV",
    ),
    (
        re.compile(r"\s*\[\s*\{"),
        "JSON, an array of objects: write an object a line: jq -c '.[]' FILE > lines.json (a pack of SenML: jq -c . "
        "FILE > lines.json); or export it as CSV",
    ),
    (re.compile(r"\s*(?:\{\s*\"|\[\s*\[)"), "JSON: export it as CSV"),
)


@dataclass(frozen=True, slots=True)
class Explanation:
    """claims: reader -> reason. others: reader -> why not, or what it looks for. kind: what the first bytes are."""

    file: str
    size_bytes: int
    kind: str
    claims: dict[str, str]
    others: dict[str, str]
    advice: str | None

    @property
    def reader(self) -> str | None:
        """The one reader that claims it."""
        return next(iter(self.claims)) if len(self.claims) == 1 else None


def explain(path: Path) -> Explanation:
    """What every installed reader says of a file. UsageError where it cannot be read."""
    try:
        start = head(path)
    except FormatError as error:
        if not standing(path).is_file():
            raise
        # packed, and not to be unpacked
        said = f"{error.what}: {error.got}" if error.got else error.what
        return Explanation(str(path), size_of(standing(path)), said, {}, {}, error.hint)
    found = claims(path)
    kind = _kind(start)
    others = {name: _why_not(name, path, start, asked=not found) for name in readers() if name not in found}
    first = next(iter(found), "")
    others |= {
        name: f"it would read it as {reason}, but gives way to '{first}'"
        for name, reason in all_claims(path).items()
        if name not in found
    }
    others |= {name: f"failed: {error}" for name, error in failed_sniffs(path).items()}
    others |= {name: f"does not load: {error}" for name, error in failed_readers().items()}
    return Explanation(str(path), start.size_bytes, kind, found, others, _advice(start, found, others))


_TRIED = "made to try, it says: "
_MARKS = {"\t": "tabs", BLANKS: "blanks"}


def kind_of(path: Path) -> str:
    """What the first bytes of a file are, in a few words."""
    return _kind(head(path))


def why_no_table(path: Path) -> str | None:
    """Why a text with cells that no reader claims is not read as a table; None where it has none."""
    start = head(path)
    text = decode_head(start.start)
    if text is None or "table" not in readers() or find_delimiter(text.splitlines()) is None:
        return None
    if _no_table(text) is not None:
        return None  # what it is says already what to do
    _, tried, why = _why_not("table", path, start, asked=True).partition(_TRIED)
    return why if tried else None


def looks_for(name: str) -> str:
    """What a reader looks for, in its own words: its `looks_for`, else the first sentence of its docstring."""
    reader = readers()[name]
    own = getattr(reader, "looks_for", None)
    if isinstance(own, str) and own:
        return own
    for thing in (type(reader), inspect.getmodule(type(reader))):
        text = (thing.__doc__ or "").strip() if thing is not None else ""
        if text:
            return " ".join(text.split("\n\n")[0].split()).split(". ")[0].rstrip(".")
    return "it does not say"


def _kind(start: Head) -> str:
    if not start.size_bytes:
        return "an empty file"
    if (inside := packed(start.start)) is not None:
        return f"{_ARCHIVE} ({inside}, ...): unpack it first: {how_to_unpack('ZIP', start.name)}"
    if (packer := packed_by(start.start)) is not None:
        return f"{packer}: unpack it first: {how_to_unpack(packer, start.name)}"
    if (known := foreign_kind(start)) is not None:
        return known
    for magic, what in _MAGIC:
        if start.start.startswith(magic):
            return what
    if (foreign := foreign_file(start)) is not None:
        return foreign
    text = decode_head(start.start)
    if text is None:
        return f"binary; it starts with {start.start[:8].hex(' ')}"
    if not text.strip():
        return "blanks only"
    if (known := _no_table(text)) is not None:
        return known
    lines = text.splitlines()
    first = next(line for line in lines if line.strip()).strip()
    # as the readers find it: in a decimal comma's file there are more commas than ';'
    delimiter = find_delimiter(lines)
    between = f", {_MARKS.get(delimiter, repr(delimiter))} between cells" if delimiter is not None else ""
    if "\ufffd" in first:
        return f"text{between}, in an encoding that it does not name"
    return f"text{between}; it starts with '{first[:50]}{'...' if len(first) > 50 else ''}'{_encoded_twice(first)}"


def _encoded_twice(line: str) -> str:
    """What is told of letters that were written in UTF-8, read as another encoding and written in UTF-8 again."""
    try:
        meant = line.encode("cp1252").decode("utf-8")
    except UnicodeError:
        return ""
    return "" if meant == line else f", meant '{meant[:50]}': its letters were encoded twice; export it anew as UTF-8"


def _no_table(text: str) -> str | None:
    """What a text is that holds no table of cells. A line of JSON may stand above one that does."""
    lines = text.splitlines()
    if not named_values(lines) and (foreign := foreign_text(lines)) is not None:
        return ": ".join(foreign)
    known = next((what for start, what in _TEXTS if start.match(text)), None)
    last = next((line for line in reversed(lines[-20:]) if line.strip()), "").strip()
    return known if last.startswith(tuple('<{}[]"')) else None


def _why_not(name: str, path: Path, start: Head, asked: bool) -> str:
    """What the reader says when it is made to try, where no other claims the file; else what it looks for."""
    if asked and start.size_bytes and decode_head(start.start) is not None:
        try:
            described(readers()[name], path, Source())
        except (ThermodataError, OSError) as error:
            what = getattr(error, "what", str(error))
            hint = getattr(error, "hint", None)
            if not what.startswith("reader '"):
                return f"{_TRIED}{what}" + (f"; {hint}" if hint else "")
        else:
            return "it does not claim it, but can read it where a source declares it"
    return f"no; it reads: {looks_for(name)}"


def _advice(start: Head, found: dict[str, str], others: dict[str, str]) -> str | None:
    if len(found) == 1:
        return None
    if found:
        first = next(iter(found))
        return f"declare one of them: sources: {{log: {{reader: {first}, files: ...}}}}"
    if not others:
        return "no reader is installed"
    kind = _kind(start)
    text = decode_head(start.start)
    if kind == foreign_file(start):
        return None
    says = tuple(what for _, what in (*_MAGIC, *_TEXTS) if ": " in what)
    if packed_by(start.start) is not None or kind.startswith((_ARCHIVE, *says)) or kind == _no_table(text or ""):
        return None  # it says already what to do
    able = next((name for name, why in others.items() if "can read it" in why), None)
    if able:
        return f"declare it: sources: {{log: {{reader: {able}, files: ...}}}}"
    if any("declare" in why for why in others.values()):
        return "declare reader: table with table: {header_rows: ..., time: {column: ..., unit: ...}} in its source"
    return None if start.size_bytes else "was it closed?"


__all__ = ["Explanation", "explain", "looks_for", "why_no_table"]
