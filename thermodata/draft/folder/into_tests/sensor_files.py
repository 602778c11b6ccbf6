"""Files of one sensor each: 'T1/hall.csv', 'T1/probe_Z.csv', 'T2/hall.csv' are two tests, whose channels are called as
their files are. Loggers that ran through all tests have one file each: 'ibutton_bed.csv', 'ibutton_hall.csv'."""

from __future__ import annotations

import re
from collections import Counter, defaultdict
from collections.abc import Callable, Container, Sequence
from dataclasses import replace
from itertools import combinations
from pathlib import PurePosixPath

from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.files.sheets import at_once
from thermodata.draft.signals.guess import SENSOR, says_nothing
from thermodata.draft.words.axis import axis_of
from thermodata.draft.words.naming import words
from thermodata.draft.words.vocabulary import places_in, quantities_in
from thermodata.plugin import Signal
from thermodata.reader.text import split_unit

_MOST_READINGS = 3  # of one sensor: temperature, humidity and dew point
_STAMP = re.compile(
    r"[_\-. ]*(?<!\d)(?:\d{4}[-_.]?\d{2}[-_.]?\d{2}|\d{6})(?:[-_.T ]?\d{2}[-_.h]?\d{2}(?:[-_.m]?\d{2})?)?(?!\d)"
)
_PIECE = r"[_\-. ]+"
_NEAR_NS = 15 * 60 * 1_000_000_000  # by which a test may begin before the loggers that ran through it
_FEWEST_TESTS = 2
_SENSOR = re.compile(r"[^\W\d]")  # what a sensor is called by has a letter; numbers alone count recordings


def with_their_sensors(files: Sequence[RawFile]) -> tuple[RawFile, ...]:
    """The files; each of one sensor among several of a test says which it is of, as do its signals."""
    alike: dict[tuple[object, ...], list[RawFile]] = defaultdict(list)
    for file in files:
        if file.part is None and 0 < len(_readings(file)) <= _MOST_READINGS:
            shape = tuple(sorted(_but_axis(split_unit(s.name)[0]) for s in file.signals))
            alike[file.reader, file.path.suffix.lower(), shape].append(file)
    found: dict[int, RawFile] = {}
    for group in alike.values():
        for split in (_folder_and_file, _file_and_folder, _first_piece, _last_piece):
            if named := _sensors(group, split):
                sensors = Counter(n for _, n in {(named[id(f)], s.name) for f in group for s in f.signals})
                shared = {name for name, n in sensors.items() if n > 1}
                found |= {id(f): _of_sensor(f, named[id(f)], shared) for f in group}
                break
        else:
            others = [f for f in files if not any(f is own for own in group)]
            if named := _through_all(group, others):
                shared = {s.name for f in group for s in f.signals}
                found |= {id(f): _of_sensor(f, named[id(f)], shared) for f in group}
    return tuple(found.get(id(f), f) for f in files)


def _readings(file: RawFile) -> list[Signal]:
    return [s for s in file.signals if s.dtype != "str"]


def _but_axis(name: str) -> str:
    """The same for 'posuv_X' and 'posuv_Y'."""
    return re.sub(r"(?<![A-Za-z])[XYZxyz](?![A-Za-z])", "@", name)


def _folder_and_file(path: PurePosixPath) -> tuple[str, str]:
    """('prova_A', 'spost_X') of 'prova_A/spost_X_20260203_080003.txt'."""
    stem = _STAMP.sub("", path.stem)
    for home in path.parts[-2:-1]:
        stem = re.sub(rf"^{re.escape(home)}{_PIECE}|{_PIECE}{re.escape(home)}$", "", stem, flags=re.IGNORECASE)
    return str(path.parent), stem


def _file_and_folder(path: PurePosixPath) -> tuple[str, str]:
    """('T1', 'hall') of 'hall/T1.csv'."""
    return path.stem, path.parent.name


def _first_piece(path: PurePosixPath) -> tuple[str, str]:
    """('T1', 'probe_Z') of 'T1_probe_Z.csv'."""
    test, *sensor = re.split(_PIECE, path.stem, maxsplit=1)
    return f"{path.parent}/{test}", "".join(sensor)


def _last_piece(path: PurePosixPath) -> tuple[str, str]:
    """('run_1', 'hall') of 'run_1_hall.csv'."""
    *test, sensor = re.split(rf"{_PIECE}(?=[^_\-. ]+$)", path.stem)
    return f"{path.parent}/{''.join(test)}", sensor


def _sensors(files: Sequence[RawFile], split: Callable[[PurePosixPath], tuple[str, str]]) -> dict[int, str]:
    """id of a file -> its sensor, where their names make a grid of tests and sensors, and those of a test ran at once;
    empty where they do not."""
    of_test: dict[str, dict[str, RawFile]] = defaultdict(dict)
    tests_of: dict[str, set[str]] = defaultdict(set)
    for file in files:
        test, sensor = split(file.path)
        if not sensor or sensor in of_test[test]:
            return {}
        of_test[test][sensor] = file
        tests_of[sensor].add(test)
    if len(of_test) < 2 or len(tests_of) < 2:
        return {}
    every = min(map(len, tests_of.values())) >= 2 and 2 * min(map(len, of_test.values())) >= len(tests_of)
    if not every or not (_ran_at_once(list(of_test.values())) or _by_names(split, tests_of, of_test)):
        return {}
    return {id(file): sensor for named in of_test.values() for sensor, file in named.items()}


def _through_all(files: Sequence[RawFile], others: Sequence[RawFile]) -> dict[int, str]:
    """id of a file -> its sensor, where each of several ran while the others did, and tests began meanwhile: loggers
    that were left on the machine, called as what is not the same in all of their names. Empty where that is not so."""
    if len(files) < 2 or any(f.start_ns is None or f.sample.last_ns is None for f in files):
        return {}
    if not all(at_once(a.start_ns, a.sample, b.start_ns, b.sample) for a, b in combinations(files, 2)):
        return {}
    begin = max(f.start_ns for f in files if f.start_ns is not None)
    end = min(f.sample.last_ns for f in files if f.sample.last_ns is not None)
    tests = {f.start_ns for f in others if f.start_ns is not None and begin - _NEAR_NS <= f.start_ns <= end}
    names = _but_common([re.split(_PIECE, _STAMP.sub("", f.path.stem)) for f in files])
    if len(tests) < _FEWEST_TESTS or len(set(names)) < len(names) or not all(map(_SENSOR.search, names)):
        return {}
    return {id(file): name for file, name in zip(files, names, strict=True)}


def _but_common(names: Sequence[list[str]]) -> list[str]:
    """Names without the pieces that all of them begin and end with."""
    least = min(map(len, names))
    lead = next((k for k in range(least) if len({n[k].casefold() for n in names}) > 1), least)
    trail = next((k for k in range(least - lead) if len({n[-1 - k].casefold() for n in names}) > 1), 0)
    return [" ".join(n[lead : len(n) - trail]) for n in names]


def _ran_at_once(tests: Sequence[dict[str, RawFile]]) -> bool:
    """Whether clocks with dates say so of every test: loggers that ran one after the other are none of one test."""
    pairs = [p for named in tests for p in combinations(named.values(), 2) if all(f.start_ns is not None for f in p)]
    return bool(pairs) and all(at_once(a.start_ns, a.sample, b.start_ns, b.sample) for a, b in pairs)


def _by_names(
    split: Callable[[PurePosixPath], tuple[str, str]],
    tests_of: dict[str, set[str]],
    of_test: dict[str, dict[str, RawFile]],
) -> bool:
    """Whether files without dates, one reading each, are of sensors: folders whose files are called as a place or a
    quantity, and hold a bare value, or one that is called otherwise in each. Where none is called as a quantity
    ('spindle', 'axis_X') they may be tests of these."""
    own: dict[str, set[str]] = defaultdict(set)
    for sensor, file in (item for named in of_test.values() for item in named.items()):
        own[sensor] |= {s.name for s in _readings(file)}
        if file.start_ns is not None:
            return False
    if split is not _folder_and_file or any(len(names) != 1 for names in own.values()):
        return False
    names = [name for found in own.values() for name in found]
    if len(set(names)) == len(names):
        return True
    measured = any(map(_measured, tests_of))
    return measured and all(map(says_nothing, names)) and all(map(_is_of_a_machine, tests_of))


def _measured(name: str) -> set[str]:
    """The quantities that it names; 'run' is a state, or a test."""
    return {*quantities_in(words(name))} - {"state"}


def _is_of_a_machine(name: str) -> bool:
    said = words(name)
    return bool(places_in(said) or _measured(name) or axis_of(said))


def _of_sensor(file: RawFile, sensor: str, shared: Container[str]) -> RawFile:
    """shared: the signals that files of other sensors have by the same name, which does not tell them apart."""
    signals = [
        replace(s, properties={**s.properties, SENSOR: sensor}) if s.dtype != "str" and s.name in shared else s
        for s in file.signals
    ]
    return replace(file, sensor=sensor, recording=replace(file.recording, signals=tuple(signals)))
