"""Logs that came after the campaign file was written: they are called as the sources say, and no test has them."""

from __future__ import annotations

import glob
import re
from collections.abc import Callable, Collection, Iterator
from pathlib import Path

from thermodata.archive.members import is_there
from thermodata.archive.patterns import in_archives
from thermodata.schema.files.campaign import Campaign, JumpCalibration
from thermodata.schema.files.tests_from import pattern_of
from thermodata.schema.strict.lines import is_text
from thermodata.schema.words.sentences import with_count

_NAMED = 4
_AROUND = re.compile(r"[\w./-]")
_NO_ID = re.compile(r"[\x00-\x1f\\{}*?\[\]]")


def not_listed(
    folder: Path,
    path: Path,
    campaign: Campaign,
    listed: Collection[str],
    taken_out: Callable[[], Collection[str]] = frozenset,
) -> list[str]:
    """A note with the line that each such test needs in the campaign file; none where there is no such test, or where a
    comment of the campaign file leaves it out. folder: of the logs; path: of the campaign file; listed: the source
    paths of all tests; taken_out: those of tests that the file had, asked for where there are others."""
    of_jumps = {c.file for c in campaign.calibrations.values() if isinstance(c, JumpCalibration)}
    known = {t.id.lower() for t in campaign.tests}
    tests: dict[str, list[str]] = {}
    for file, test in _files_by_test(folder, campaign):
        if file not in of_jumps and file not in listed and test.lower() not in known:
            tests.setdefault(test, []).append(file)
    meant = taken_out() if tests else ()
    tests = {t: own for t, files in tests.items() if (own := [f for f in files if f not in meant])}
    comments = _comments(path) if tests else ""
    out = {found.strip() for found in re.findall(r"\bid: *['\"]?([^'\",}\n]+)", comments)}
    new = {t: files for t, files in tests.items() if t not in out and not _is_left_out(files, comments)}
    if not new:
        return []
    files = with_count([f for own in new.values() for f in own], _NAMED)
    lines = with_count(map(_line, new), _NAMED)
    return [
        f"in no test, though called as the sources say: {files}; a test is a line of the campaign file, under tests: "
        f"{lines}, with its role{_conditions(campaign)}"
    ]


def _files_by_test(folder: Path, campaign: Campaign) -> Iterator[tuple[str, str]]:
    """(source path, test) of the files that fit a pattern with {test}; where several do, that which says most."""
    patterns = [
        p
        for spec in campaign.sources.values()
        for p in ([spec.files] if isinstance(spec.files, str) else spec.files or [])
        if "{test}" in p
    ]
    found: dict[str, str] = {}
    for pattern in sorted(dict.fromkeys(patterns), key=_letters, reverse=True):
        reads = pattern_of(pattern)
        every = pattern.replace("{test}", "*")
        for name in sorted((*glob.glob(every, root_dir=folder, recursive=True), *in_archives(folder, every))):
            file = Path(name).as_posix()
            fits = reads.fullmatch(file)
            if fits and is_text(file) and not _NO_ID.search(fits["test"]) and is_there(folder / name):
                found.setdefault(file, fits["test"])
    yield from found.items()


def _letters(pattern: str) -> int:
    """How much of a name a pattern says."""
    return len(re.sub(r"\{test\}|\*", "", pattern))


def _comments(path: Path) -> str:
    """What a campaign file leaves out."""
    text = path.read_text(encoding="utf-8", errors="replace") if path.is_file() else ""
    return "\n".join(line for line in text.splitlines() if line.lstrip().startswith("#"))


def _is_left_out(files: Collection[str], comments: str) -> bool:
    """Whether the comments name one of the files."""
    return any(_stands_in(f, comments) for f in files)


def _stands_in(name: str, text: str) -> bool:
    """Whether it does as a word of its own."""
    at = text.find(name)
    while at >= 0:
        before, after = text[max(at - 1, 0) : at], text[at + len(name) : at + len(name) + 1]
        if not _AROUND.search(before) and not re.match(r"\w", after):
            return True
        at = text.find(name, at + 1)
    return False


def _line(test: str) -> str:
    quoted = test if re.fullmatch(r"[A-Za-z_][\w-]+", test) else f'"{test}"'
    return f"- {{id: {quoted}, role: none}}"


def _conditions(campaign: Campaign) -> str:
    """What only the user knows of a new test, and all others say."""
    tests = campaign.tests
    asked = [c for c in tests[0].conditions if all(c in t.conditions for t in tests)] if tests else []
    return f" and the conditions that all others have ({', '.join(asked)})" if asked else ""
