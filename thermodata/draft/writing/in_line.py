"""One line of a campaign file: the keys of its mapping, and its comment."""

from __future__ import annotations

import re
from collections.abc import Iterator

from thermodata.errors import UsageError
from thermodata.schema.strict.lines import Place


def parted(line: str) -> tuple[str, str]:
    """(what YAML reads of a line, its comment from '#' on), '' for a comment that is not there. Both make the line."""
    for i, letter in _outside_quotes(line, 0):
        if letter == "#" and (i == 0 or line[i - 1].isspace()):
            return line[:i], line[i:]
    return line, ""


def set_in_line(line: str, key: str, value: str, place: Place) -> str:
    """The line of a place with one key of its flow mapping (or its own plain value) set. value: as YAML."""
    start = line.find("{")
    comment = line.find("#")
    if start < 0 or (0 <= comment < start):
        made = re.sub(
            rf"^(\s*(?:- )?{re.escape(str(place[-1]))}:\s*)[^#]*?(\s*(?:#.*)?)$", lambda m: m[1] + value + m[2], line
        )
    else:
        stop = _closing(line, start)
        entries = [e for e in _entries(line[start + 1 : stop]) if e]
        at = next((i for i, e in enumerate(entries) if re.match(rf"[\"']?{re.escape(key)}[\"']?\s*:", e)), None)
        if at is None:
            entries.append(f"{key}: {value}")
        else:
            entries[at] = f"{key}: {value}"
        made = line[: start + 1] + ", ".join(entries) + line[stop:]
    return made


def _closing(line: str, start: int) -> int:
    depth = 0
    for i, letter in _outside_quotes(line, start):
        depth += (letter in "{[") - (letter in "}]")
        if depth == 0:
            return i
    raise UsageError(
        "this line can't be filled in",
        where=line.strip()[:200],
        expected="a mapping on one line",
        hint="edit the file by hand there",
    )


def _entries(body: str) -> list[str]:
    parts, depth, last = [], 0, 0
    for i, letter in _outside_quotes(body, 0):
        depth += (letter in "{[") - (letter in "}]")
        if letter == "," and depth == 0:
            parts.append(body[last:i].strip())
            last = i + 1
    return [*parts, body[last:].strip()]


def _outside_quotes(text: str, start: int) -> Iterator[tuple[int, str]]:
    """(place, letter) of what stands in no quotes, from a place on. In the middle of a word a quote is a letter, as
    YAML has it: notes: it's warm."""
    quote, before = "", ""
    i = start
    while i < len(text):
        letter = text[i]
        if quote:
            if (letter == "\\" and quote == '"') or text[i : i + 2] == quote * 2 == "''":
                i += 1
            elif letter == quote:
                quote = ""
        elif letter in "\"'" and (before in ("", *"{[,:") or (before == "-" and text[i - 1].isspace())):
            quote = letter
        else:
            yield i, letter
        before = before if letter.isspace() else letter
        i += 1
