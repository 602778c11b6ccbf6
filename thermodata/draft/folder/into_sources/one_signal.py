"""One signal that the files of a source call by its name in two units: '101 <Front bearing> (C)' and, in a test of
another setting, '101 <Front bearing> (F)', or without one. It is one channel, whose signal is written without the
unit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.signals.guess import guess_of
from thermodata.draft.signals.units import converts, quantities_of
from thermodata.draft.signals.values import Values
from thermodata.draft.words.naming import parts_of
from thermodata.plugin import Signal
from thermodata.reader.text import split_unit


@dataclass(frozen=True, slots=True)
class OneSignal:
    """spellings: as files have it, the first of them first; files: that have it in any spelling."""

    spellings: tuple[Signal, ...]
    files: tuple[RawFile, ...]

    @property
    def signal(self) -> Signal:
        """As the first file has it."""
        return self.spellings[0]

    @property
    def written(self) -> str:
        """Its name in a campaign file, by which every one of its files is read."""
        names = {s.name for s in self.spellings}
        if len(names) == 1:
            return self.signal.name
        bare = {split_unit(n)[0] for n in names}
        return bare.pop() if len(bare) == 1 else _last(self.signal.name)

    def of(self, file: RawFile) -> Signal | None:
        """The signal as this file has it."""
        keys = {(s.stream, s.name) for s in self.spellings}
        return next((s for s in file.signals if (s.stream, s.name) in keys), None)

    def seen(self) -> list[tuple[Signal, Values | None]]:
        """The signal as each of its files has it, with its values there."""
        own = [(f, self.of(f) or self.signal) for f in self.files]
        return [(s, f.sample.values.get((s.stream, s.name))) for f, s in own]


def joined_over_units(found: Sequence[tuple[Signal, Sequence[RawFile]]]) -> list[OneSignal]:
    """The signals of a source, those in one that differ in their unit only, or whether the name has one: it says the
    same quantity with both, and no file has both. In the order of their first appearance."""
    made: list[OneSignal] = []
    by_name: dict[tuple[str, str], list[int]] = {}
    for signal, files in found:
        name = split_unit(signal.name)[0]
        own = OneSignal((signal,), tuple(files))
        homes = by_name.setdefault((signal.stream, name), []) if name else []
        home = next((i for i in homes if _are_one(made[i], own)), None)
        if home is not None:
            spellings = (*made[home].spellings, signal)
            # what it is, that one tells whose name or unit leaves no doubt
            surest = sorted(spellings, key=lambda s: (s.unit is None, _on_its_unit(s)))
            made[home] = OneSignal(tuple(surest), (*made[home].files, *files))
            continue
        homes.append(len(made))
        made.append(own)
    return made


def joined_over_heads(found: Sequence[OneSignal], of_tests: Sequence[RawFile]) -> list[OneSignal]:
    """The same, those in one whose files call them alike but for the groups above or the stream: 'data/rpm' and, in a
    file of another kind, 'rpm'. A campaign file's name fits both; as two channels both would be read twice. Signals of
    jump tests, which no file of tests has, stay as they are."""
    made: list[OneSignal] = []
    by_name: dict[str, list[int]] = {}
    own_files = {id(f) for f in of_tests}
    for own in found:
        if not all(id(f) in own_files for f in own.files):
            made.append(own)
            continue
        homes = by_name.setdefault(_last(own.signal.name), [])
        alike = (i for i in homes if _are_one(made[i], own) and _heads_agree(made[i], own))
        home = next((i for i in alike if not (_ambiguous(made[i]) or _ambiguous(own))), None)
        if home is not None:
            one = made[home]
            made[home] = OneSignal((*one.spellings, *own.spellings), (*one.files, *own.files))
            continue
        homes.append(len(made))
        made.append(own)
    return made


def _last(name: str) -> str:
    return parts_of(split_unit(name)[0])[-1]


def _heads_agree(one: OneSignal, other: OneSignal) -> bool:
    """Whether what stands above the one name ends what stands above the other. 'spindle/T' is not 'column/T'."""
    names = [f"/{split_unit(s.name)[0]}" for s in (*one.spellings, *other.spellings)]
    longest = max(names, key=len)
    return all(longest.endswith(name) for name in names)


def _ambiguous(one: OneSignal) -> bool:
    """Whether a file of it has more signals whose names end so: the last part would not tell them apart."""
    name = _last(one.signal.name)
    return any(sum(_last(s.name) == name for s in f.signals) > 1 for f in one.files)


def _on_its_unit(signal: Signal) -> bool:
    """Whether its unit alone says what it is, and several quantities have it: a length in mm."""
    found = guess_of(signal)
    return found.basis == ("unit",) and len(quantities_of(found.unit or "")) > 1


def _one_length(one: Signal, other: Signal) -> bool:
    """Whether two units of a length part them alone: 'Probe Z [mm]' is what 'Probe Z [um]' is in another test."""
    lengths = [s.unit is not None and converts(s.unit, "displacement") for s in (one, other)]
    return all(lengths) and (_on_its_unit(one) or _on_its_unit(other))


def _without_unit(one: OneSignal, other: OneSignal, said: str | None, other_said: str | None) -> bool:
    """Whether one of two has no unit, and its name and values say what the other's unit does, or nothing."""
    bare, with_unit = (one, other_said) if one.signal.unit is None else (other, said)
    if with_unit is None or (one.signal.unit is None) is (other.signal.unit is None):
        return False
    return {guess_of(*seen).quantity for seen in bare.seen()} <= {None, with_unit}


def _are_one(one: OneSignal, other: OneSignal) -> bool:
    said, other_said = guess_of(one.signal).quantity, guess_of(other.signal).quantity
    paths = {(f.path, f.part) for f in one.files}
    if any((f.path, f.part) in paths for f in other.files):
        return False
    alike = said is not None and (said == other_said or _one_length(one.signal, other.signal))
    return alike or _without_unit(one, other, said, other_said)
