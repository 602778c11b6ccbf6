"""Which encoding a text is in: declared, marked, UTF-8, one of East Asia by its words, or cp1250/cp1252 by the letters
that stand beside those that differ.

Nothing is ever dropped: `errors="ignore"` turns "µm" into "m", a factor of a million.
"""

from __future__ import annotations

import codecs
import re

from thermodata.errors import FormatError
from thermodata.reader.text.file.east_asia import ENCODINGS, east_asian
from thermodata.reader.text.file.letters import western_not_central

_PART = 4 * 1024 * 1024
_BOMS = ((codecs.BOM_UTF8, "utf-8-sig"), (codecs.BOM_UTF16_LE, "utf-16"), (codecs.BOM_UTF16_BE, "utf-16"))


def _single_byte(data: bytes) -> tuple[str, bytes | None]:
    """(cp1250 or cp1252, a word that either could write where nothing tells which). µ ° ± § ä ö ü ß é á í š ž are the
    same in both."""
    undefined_1250 = any(b in data for b in (b"\x83", b"\x88", b"\x98"))
    undefined_1252 = any(b in data for b in (b"\x8d", b"\x8f", b"\x9d"))
    if undefined_1250 != undefined_1252:
        return ("cp1252" if undefined_1250 else "cp1250"), None
    if data.decode("cp1250", "replace") == data.decode("cp1252", "replace"):
        return "cp1252", None  # German, or nothing but degrees: nobody is told of Central Europe
    western, word = western_not_central(data)
    return ("cp1252" if western > 0 else "cp1250"), (word if western == 0 else None)


def _refuse_unproven(word: bytes | None) -> None:
    """FormatError for a word that has other letters in cp1250 than in cp1252 and may be of either."""
    if word is not None:
        raise FormatError(
            "text in an encoding that the file does not name",
            where=f"the word {word.decode('cp1252', 'replace')!r}",
            expected="UTF-8, or an encoding that is declared",
            got=f"cp1252: {word.decode('cp1252', 'replace')!r}; cp1250: {word.decode('cp1250', 'replace')!r}",
            hint="declare the source's encoding: cp1252 (Western Europe) or cp1250 (Central Europe)",
        )


_RUN = re.compile(rb"[\x80-\xff]{4,}")
_KANA = re.compile(rb"[\x82\x83][\x40-\xf1]")
_DECLARE = (
    "declare the source's encoding: cp932 or euc-jp (Japanese), gb18030 or big5 (Chinese), cp949 (Korean), cp1251 "
    "(Cyrillic)"
)
# narrower names of the same encodings, and what programs of Windows write under them
_WIDER = {"shift_jis": "cp932", "euc_kr": "cp949", "gb2312": "gb18030", "gbk": "gb18030", "big5": "cp950"}


def _other_script(data: bytes) -> re.Match[bytes] | None:
    """Where text of several bytes a character or of another script begins: no word of a Western or Central European
    language has four letters with diacritics in a row."""
    found = next((m for m in _RUN.finditer(data) if len(set(m[0])) > 1), None)
    if found is None and len(kana := _KANA.findall(data)) >= 3 and len(set(kana)) >= 3:
        found = _KANA.search(data)
    return found


def _refuse_other_scripts(data: bytes) -> None:
    """FormatError for text of another script: words did not tell which encoding it is in."""
    found = _other_script(data)
    if found is None:
        return
    at = found.start()
    line = data[data.rfind(b"\n", 0, at) + 1 :].split(b"\n", 1)[0][:200]
    seen = []
    for name in (*ENCODINGS, "cp1251"):
        try:
            seen.append(f"{name}: {line.decode(name).strip()[:24]!r}")
        except UnicodeDecodeError:
            continue
    raise FormatError(
        "text in an encoding that the file does not name",
        where=f"byte {at}",
        expected="UTF-8, or an encoding that is declared",
        hint=_DECLARE,
        got="; ".join(seen) or found[0][:8].hex(" "),
    )


def find_encoding(data: bytes, declared: str | None = None) -> tuple[str, str | None]:
    """(encoding, note or None) of a file's bytes. Order: declared, byte order mark, UTF-8, UTF-16 without a
    mark, one of East Asia whose words it holds, then cp1250 or cp1252 by what stands beside the letters that differ.
    FormatError: the declared one is unknown or fails, the text is of another script and its words don't tell, either of
    the two may be meant, or no single-byte encoding reads it."""
    if declared is not None:
        try:
            name = codecs.lookup(declared).name
        except LookupError:
            raise FormatError(
                f"no encoding '{declared}'",
                expected="utf-8, cp1250, cp1252, utf-16, ...",
                got=declared,
                hint="leave 'encoding' out: it is told by the bytes where these can tell it",
            ) from None
        _try(data, declared)
        return ("utf-8-sig" if name == "utf-8" and data.startswith(codecs.BOM_UTF8) else declared), None
    for mark, name in _BOMS:
        if data.startswith(mark):
            _try(data, name)
            return name, None
    head = data[:4096]
    for start, name in ((1, "utf-16-le"), (0, "utf-16-be")):
        if len(head) >= 4 and head[start::2].count(0) > 0.8 * len(head[start::2]) and not head[1 - start :: 2].count(0):
            return name, f"no byte order mark; read as {name}"
    try:
        data.decode("utf-8")
        return "utf-8", None
    except UnicodeDecodeError as error:
        east = east_asian(data)
        if east is not None:
            name, words = east
            told = ", ".join(words[:4])
            return name, f"not UTF-8 (byte {error.start}); read as {name}, by {told}: declare encoding if that is wrong"
        _refuse_other_scripts(data)
        name, unproven = _single_byte(data)
        _refuse_unproven(unproven)
        _try(data, name)
        return name, f"not UTF-8 (byte {error.start}); read as {name}: declare encoding if that is wrong"


def _try(data: bytes, encoding: str) -> str:
    try:
        return data.decode(encoding)
    except UnicodeDecodeError as error:
        raise FormatError(
            "text does not decode",
            where=f"byte {error.start}",
            expected=encoding,
            got=data[error.start : error.start + 4].hex(" "),
            hint=_hint_of_wider(data, encoding) or "declare the source's encoding",
        ) from None


def _hint_of_wider(data: bytes, encoding: str) -> str | None:
    """What to declare where a narrower name of the same encoding was, as shift_jis for a text with ① or №."""
    wider = _WIDER.get(codecs.lookup(encoding).name)
    if wider is None:
        return None
    try:
        data.decode(wider)
    except UnicodeDecodeError:
        return None
    return f"declare 'encoding: {wider}' for the source: it has signs that {encoding} lacks"


def decode(data: bytes, declared: str | None = None) -> tuple[str, str, str | None]:
    """(text, encoding, note or None); see find_encoding. No byte is ever dropped or replaced."""
    encoding, note = find_encoding(data, declared)
    return _try(data, encoding), encoding, note


def decode_head(start: bytes) -> str | None:
    """The text of a file's first bytes (which may end inside a character), or None where it is binary."""
    if start.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return codecs.getincrementaldecoder("utf-16")("replace").decode(start)
    start = start.rstrip(b"\0") or start  # what a power cut left behind the last line
    if b"\0" in start[:4096]:
        try:
            encoding, _ = find_encoding(start[: len(start) // 2 * 2])
        except FormatError:
            return None
        return start.decode(encoding, "replace") if encoding.startswith("utf-16") else None
    try:
        return codecs.getincrementaldecoder("utf-8-sig")().decode(start)
    except UnicodeDecodeError:
        control = sum(start.count(bytes((b,))) for b in range(1, 32) if b not in (9, 10, 12, 13, 26))
        if control:
            return None
        east = east_asian(start)
        if east is not None:
            return start.decode(east[0], "replace")
        if _other_script(start) is not None:
            return start.decode("ascii", "replace")  # nobody knows the letters: better none than wrong ones
        return start.decode(_single_byte(start)[0], "replace")


def is_wide(encoding: str) -> bool:
    """Whether a line end is no single byte of its own in this encoding, or text may look like ASCII and be none."""
    try:
        plain = codecs.lookup(encoding).name
        return "\n".encode(encoding) != b"\n" or plain.startswith(("iso2022", "hz", "utf-7"))
    except (LookupError, ValueError):
        return False


def bare(encoding: str) -> str:
    """The encoding without the byte order mark that 'utf-8-sig' asks for: of any but a file's first bytes."""
    return "utf-8" if encoding.lower().replace("_", "-") == "utf-8-sig" else encoding
