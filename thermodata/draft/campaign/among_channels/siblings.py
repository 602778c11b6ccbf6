"""What a channel's name means beside the names of the others: 'column R' beside 'column F', speeds beside a speed."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace

from thermodata.draft.campaign.parts import DraftChannel
from thermodata.draft.words.naming import parts_of, words
from thermodata.draft.words.place import asked_of
from thermodata.draft.words.vocabulary import places_in
from thermodata.reader.text import split_unit

_END = re.compile(r"(?:.* )?(\S+) ([frl])")
_OF_AXES = ("axis.", "rotary.")
_LETTER = re.compile(r"(?:(.*) )?([xyzuvwabc])")
_WITH_SIDES = ("column", "bed", "ram", "crossbeam")
_KIND = re.compile(r"(?<!\S)([a-z]) (?:sp|spindel|spindle)(?!\S)")  # the S and W of SSp and WSp
_MAIN = "hs"  # main (Haupt-), or that of the grinding wheel (Schleif-)
_ORDER = {2: "second", 3: "third", 4: "fourth"}


def beside_each_other(channels: Sequence[DraftChannel]) -> list[DraftChannel]:
    """The channels, the letters of sides read together, several spindles told apart, the A of an axis
    among those of other axes read as one, and speeds that would all be the spindle's asked."""
    return _speeds(_spindles(_axes(_sides(list(channels)))))


def _own(channel: DraftChannel) -> str:
    return words(parts_of(split_unit(channel.signal)[0])[-1])


def _sides(channels: list[DraftChannel]) -> list[DraftChannel]:
    """R beside F is rear beside front, and right beside L; alone it may be either, and is asked."""
    ends = [(c.source, *m.groups()) if (m := _END.fullmatch(_own(c))) and _has_sides(c) else None for c in channels]
    made = []
    for channel, end in zip(channels, ends, strict=True):
        letters = {e[2] for e in ends if e and end and e[:2] == end[:2]}
        part, _, side = (channel.said.at or "").removesuffix(".right").partition(".")
        part = f"{part}.{side}" if side == "bearing" else part
        if end and letters == {"f", "r"}:
            said = replace(channel.said, at=f"{part}.{'front' if end[2] == 'f' else 'rear'}", sure=False)
            asked = tuple(q for q in said.questions if q != f"at: {part}.front or .rear?")
            channel = replace(channel, said=replace(said, questions=asked))
        elif end and letters == {"r"} and channel.said.at == f"{part}.right" and not channel.said.questions:
            asked = (f"at: {part}.right or .rear?",)
            channel = replace(channel, said=replace(channel.said, sure=False, questions=asked))
        made.append(channel)
    return made


def _axes(channels: list[DraftChannel]) -> list[DraftChannel]:
    """The A of current_a is the axis beside current_x and current_c; alone it is the ampere."""
    placed = {
        (c.source, c.said.quantity, m[1] or ""): c.said.at
        for c in channels
        if (m := _LETTER.fullmatch(_own(c))) and m[2] != "a" and c.said.at and c.said.at.startswith(_OF_AXES)
    }
    made = []
    for channel in channels:
        end = _LETTER.fullmatch(_own(channel))
        other = placed.get((channel.source, channel.said.quantity, end[1] or "")) if end and end[2] == "a" else None
        if other is not None and channel.said.quantity == "current" and channel.said.at is None:
            part = ".".join(("rotary.a", *other.split(".")[2:]))
            asked = tuple(q for q in channel.said.questions if not q.startswith("at: "))
            channel = replace(channel, said=replace(channel.said, at=part, sure=False, questions=asked))
        made.append(channel)
    return made


def _has_sides(channel: DraftChannel) -> bool:
    """Whether a letter behind a name may be a side of its part, and nothing says which."""
    at = channel.said.at
    return at == "spindle.bearing" or (at or "").removesuffix(".right").removesuffix(".left") in _WITH_SIDES


def _spindles(channels: list[DraftChannel]) -> list[DraftChannel]:
    """Each spindle by its name, where a machine has several: the milling spindle of a machine that has a counter
    spindle, a main one, or the speed of another one, and those that the control counts, S1 and S2, where it counts two
    speeds."""
    said = [places_in(_own(c)) for c in channels]
    several = any(s & {"counter spindle", "main spindle"} for s in said) or _mills_beside_a_spindle(channels, said)
    counted = {n for c in channels if c.said.quantity == "rotational_speed" and (n := _count(c)) is not None}
    # 'S3 counter spindle' tells whose number 3 is
    names = dict(_ORDER) | {
        number: name
        for channel, words_ in zip(channels, said, strict=True)
        for name in ("counter", "milling")
        if f"{name} spindle" in words_ and (number := _count(channel)) is not None
    }
    made = []
    for channel, words_ in zip(channels, said, strict=True):
        number, name = _count(channel), None
        if "milling spindle" in words_:
            name = "milling" if several else None
        elif not words_ & {"counter spindle", "main spindle"} and len(counted) > 1 and number is not None:
            name = names.get(number)
        made.append(channel if name is None else _of_spindle(channel, name))
    return made


def _mills_beside_a_spindle(channels: Sequence[DraftChannel], said: Sequence[frozenset[str]]) -> bool:
    """Whether one speed is a milling spindle's, and another one that of a spindle of no such name."""
    turning = [s for c, s in zip(channels, said, strict=True) if c.said.quantity == "rotational_speed"]
    return any("milling spindle" in s for s in turning) and any(
        "spindle" in s and "milling spindle" not in s for s in turning
    )


def _of_spindle(channel: DraftChannel, name: str) -> DraftChannel:
    """name: of a spindle beside the first one."""
    at = channel.said.at or ""
    if at.partition(".")[0] != "spindle":
        return channel
    asked = tuple(asked_of(q, name) for q in channel.said.questions)
    return replace(channel, said=replace(channel.said, at=f"{name}_{at}", questions=asked))


def _count(channel: DraftChannel) -> int | None:
    """2 of 'S2 speed' and of 'Spindle2 load'."""
    found = re.search(r"(?<!\S)(?:s|sp|spindle|spindel|mandrino|broche|husillo|vreteno) ?([1-4])(?!\S)", _own(channel))
    return int(found[1]) if found else None


def _speeds(channels: list[DraftChannel]) -> list[DraftChannel]:
    """A speed whose name does not say spindle is asked where another one of its source stands there; so is one that
    does beside the speed of a grinding wheel, whose spindle is the machine's, and one of several spindles that a letter
    tells apart: WSp beside SSp."""
    turning = [c for c in channels if c.said.quantity == "rotational_speed" and c.said.at == "spindle"]
    wheels = [c for c in turning if "grinding wheel" in places_in(_own(c))]
    kinds = {c.name: m[1] for c in turning if (m := _KIND.search(_own(c)))}
    made = []
    for channel in channels:
        others = [c.name for c in turning if c is not channel and c.source == channel.source]
        wheel = [c.name for c in wheels if c is not channel] if channel not in wheels else []
        another = kinds.get(channel.name, "s") not in _MAIN and bool(set(kinds.values()) & set(_MAIN))
        of_spindle = channel in wheels or ("spindle" in places_in(_own(channel)) and not wheel and not another)
        if channel in turning and (others or wheel) and not of_spindle and not channel.said.questions:
            where = "counter_spindle or rotary.c, as a workhead, or spindle"
            of_part = wheel or another or "workpiece" in places_in(_own(channel))
            asked = f"at: {where if of_part else 'spindle, rotary.c or table'}? "
            asked += f"{', '.join((wheel or others)[:3])} is drafted at the spindle, too"
            channel = replace(channel, said=replace(channel.said, sure=False, questions=(asked,)))
        made.append(channel)
    return made
