"""Logs of two machines in one folder: are these two campaigns? Told by what the heads of the files call the machine, or
by tests in folders, or of names, of their own that have no column in common."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.folder.into_sources.sources import Group
from thermodata.draft.probes.same_probe import own_name
from thermodata.draft.signals.guess import NUMBERED
from thermodata.draft.words.naming import words
from thermodata.reader.text import split_unit
from thermodata.schema.words.sentences import listed, with_dots

_HEAD = 4096
_LONGEST = 60  # letters of a machine's name
_FEWEST = 2  # tests of each, where only their columns tell
_SHOWN = 4
_MACHINE = re.compile(
    r"""^[#;%!*"'\s/]*(?:machine|maschine|masch\.|machine[ _-]?(?:name|id|no\.?|nr\.?|number|type|tool)"""
    r"""|maschinen?[ _-]?(?:nr\.?|nummer|name|typ)|stroj|macchina|máquina|maquina|機械|机床)["']?[ \t]*[:=;,\t]"""
    r"""[ \t]*["']?(?P<name>[^;,\t"'\r\n]*[^;,\t"'\r\n\s])""",
    re.IGNORECASE | re.MULTILINE,
)


@dataclass(frozen=True, slots=True)
class Campaigns:
    """machine: what the heads of all logs that name one call the machine, None where they name none or several. asked:
    whether the folder holds several campaigns; certain: the files name several machines, whose columns are not one
    another's under other names."""

    machine: str | None = None
    asked: str | None = None
    certain: bool = False


def campaigns_in(folder: Path, groups: Sequence[Group]) -> Campaigns:
    tests: dict[str, list[RawFile]] = {}
    for group in groups:
        for test, files in group.tests.items():
            tests.setdefault(test, []).extend(files)
    named = _by_heads(folder, tests)
    if len(named) > 1:
        asked = f"the heads of the logs name {_each(named)}"
        return Campaigns(asked=_question(asked, named, tests), certain=True)
    machine = next(iter(named), None)
    apart = _by_columns(tests) if not named else {}
    if not apart:
        return Campaigns(machine)
    return Campaigns(machine, _question(f"the tests of {_each(apart)} have no column in common", apart, tests))


def _by_heads(folder: Path, tests: Mapping[str, Sequence[RawFile]]) -> dict[str, list[str]]:
    """Machine, as the head of a log calls it -> its tests. Empty where a test has two: they are then one machine's
    loggers."""
    found: dict[str, list[str]] = {}
    spelt: dict[str, str] = {}
    for test, files in tests.items():
        said = {name for path in dict.fromkeys(f.path for f in files) if (name := _machine(folder / path))}
        if len({name.casefold() for name in said}) > 1:
            return {}
        for name in said:
            found.setdefault(spelt.setdefault(name.casefold(), name), []).append(test)
    return found


def _machine(path: Path) -> str | None:
    try:
        with path.open("rb") as file:
            head = file.read(_HEAD)
    except OSError:  # in an archive
        return None
    if b"\0" in head:
        return None
    match = _MACHINE.search(head.decode("utf-8", "replace"))
    return match["name"][:_LONGEST] if match else None


def _by_columns(tests: Mapping[str, Sequence[RawFile]]) -> dict[str, list[str]]:
    """What the tests of each of several kinds are called -> these tests, where no test has a column of another kind's,
    and each kind has a folder, or a word of its names, of its own; empty otherwise."""
    kinds: list[tuple[set[str], list[str]]] = []
    for test, files in tests.items():
        own = {own_name(split_unit(s.name)[0]) for f in files for s in f.signals}
        if any(NUMBERED.fullmatch(name) for name in own):
            return {}  # a column without a name may be any
        same = [k for k in kinds if k[0] & own]
        kinds = [k for k in kinds if k not in same]
        kinds.append((own.union(*(k[0] for k in same)), [t for k in same for t in k[1]] + [test]))
    if len(kinds) < 2 or any(len(of) < _FEWEST for _, of in kinds):
        return {}
    called = [_called(f.path for t in of for f in tests[t]) for _, of in kinds]
    own_words = [
        next((w for w in said if not any(w in other for other in called if other is not said)), None) for said in called
    ]
    if any(word is None for word in own_words):
        return {}
    return {str(word): of for word, (_, of) in sorted(zip(own_words, kinds, strict=True), key=lambda k: str(k[0]))}


def _called(paths: Iterable[PurePosixPath]) -> list[str]:
    """The folders and words that the paths of all of these have."""
    said = [[*map(str, path.parent.parts), *(w for w in words(path.stem).split() if w.isalpha())] for path in paths]
    return [w for w in said[0] if all(w in other for other in said)]


def _each(kinds: Mapping[str, Sequence[str]]) -> str:
    return listed([f"'{name}' ({with_dots(tests, _SHOWN)})" for name, tests in kinds.items()])


def _question(why: str, kinds: Mapping[str, Sequence[str]], tests: Mapping[str, Sequence[RawFile]]) -> str:
    folders = [_folder(f.path for t in of for f in tests[t]) for of in kinds.values()]
    if all(folders) and len(set(folders)) == len(folders):
        commands = listed([f"thermodata init {f}" for f in folders])
        draft = f"then draft each by itself, from within this folder: {commands}"
    else:
        draft = "then put the logs of each into a folder of its own, and draft each: thermodata init SUBFOLDER"
    return f"{len(kinds)} campaigns, of {len(kinds)} machines? {why}: {draft}"


def _folder(paths: Iterable[PurePosixPath]) -> str | None:
    """The folder below this one that all of these lie in; None where they lie in several, or in none."""
    above = {path.parts[0] if len(path.parts) > 1 else None for path in paths}
    return above.pop() if len(above) == 1 else None
