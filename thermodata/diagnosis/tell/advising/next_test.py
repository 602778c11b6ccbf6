"""Which test to run, or which sensor to add, so that the next diagnosis can say more."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from thermodata.diagnosis.candidates.candidate_effect import CandidateEffect
from thermodata.diagnosis.weigh.scored import Scored
from thermodata.schema.words.places import is_around
from thermodata.schema.words.sentences import listed
from thermodata.view.grid.dataset import ChannelInfo

_PROTOCOL = {
    "rotational_speed": "short pulses of speed (5 min on, 10 min off) at two speeds",
    "feed": "{axis} moving alone at two feeds, with heating and cooling",
    "power": "cutting at two loads, and the same path as an air cut",
    "state": "switching it on and off while all else rests",
    "temperature": "a test in which the one is heated and the other is not",
    "flow": "switching it on and off while all else rests",
}

_MOVED = {
    "rotational_speed": "speeds in steps up to the highest, each for an hour, then at rest",
    "feed": "this axis alone for hours, then at rest",
    "temperature": "heated through by its own source while the others rest, then cooling",
    "temperature_difference": "one side heated through by its own source while the others rest, then cooling",
    "state": "on for hours while all else rests, then off",
    "flow": "on for hours while all else rests, then off",
}
# parts that warm together: a motor's heat is of its load, that of all else of the motion
_BY_LOAD = (
    "a motor warms by its load, all else by its motion, so run one test at high load and little motion (starts and "
    "stops, or held against a load), one at a steady high speed, and let each cool to the end"
)
_BY_PART = (
    "they warmed together, so warm one by itself (a heating foil, the machine at rest), or let all cool to the end "
    "twice, after half an hour of motion and after hours of it"
)
# one is driven by a temperature, the other by what warms it
_BY_HEAT_OR_MOTION = (
    "{moves} may be what warms {warm}, so warm that by itself (a heating foil, {moves} at rest), or let all cool to "
    "the end twice, after half an hour of {moves} and after hours of it: one goes with {warm}, the other with {moves}"
)
# what makes no heat, and what holds the probes or the tool, which has no source of its own
_BY_FOIL = "warmed by itself from outside, by a heating foil or a fan heater, the machine at rest, then cooling"
_LOADED = "at a high load for hours, then at rest"
_BY_DAY = "through a day and a night, the machine at rest"


def to_separate(chosen: Scored, twins: Sequence[Scored], channels: Mapping[str, ChannelInfo]) -> str | None:
    """The advice where several candidates explain the same."""
    mine = chosen.candidate
    # the same effect by another driver is no other answer, nor are its channels by another name
    same = [mine, *(t.candidate for t in twins if t.candidate.effect.name == mine.effect.name)]
    own_channels = [set(one.channels) for one in same]
    others = [
        t.candidate
        for t in twins
        if t.candidate.effect.name != mine.effect.name and set(t.candidate.channels) not in own_channels
    ]
    if not others:
        return None
    other = others[0]
    if other.protocol is not None:
        return f"to tell {mine.id} from {other.id}: {other.protocol}"
    moving = [_can_be_driven(one, channels) for one in (mine, other)]
    at_one_place = bool(_places(mine, channels)) and _places(mine, channels) == _places(other, channels)
    if at_one_place and not any(moving):
        return (
            f"{mine.id} and {other.id} have their sensors at the same place: not separable by another test; add a "
            f"sensor nearer to the source of heat"
        )
    own = [c for c in mine.channels if c not in other.channels] or list(mine.channels)
    quantity = channels[own[0]].quantity if own and own[0] in channels else "temperature"
    how = _PROTOCOL.get(quantity, _PROTOCOL["temperature"])
    if quantity == "temperature" and own[0] in channels and other.channels and moving == [False, True]:
        how = _BY_HEAT_OR_MOTION.format(warm=own[0], moves=listed(other.channels))
    elif at_one_place and mine.channels and moving == [True, False]:
        warm = [c for c in other.channels if c not in mine.channels]
        how = _BY_HEAT_OR_MOTION.format(warm=listed(warm or other.channels), moves=listed(mine.channels))
    return f"to tell {mine.id} from {other.id}: {how.format(axis=_axis_in_words(own, channels))}"


def to_tell_apart(chosen: Scored, twins: Sequence[Scored], channels: Mapping[str, ChannelInfo]) -> str | None:
    """The advice where another effect explains the same: which part it is comes first, where temperatures of several
    say it alike, and then what tells it from effects that none of these parts is named for."""
    apart = to_separate(chosen, twins, channels)
    if apart is None:
        return None
    parts = to_tell_parts(chosen.candidate, [t.candidate for t in twins], channels)
    if parts is None:
        return apart
    rest = [t for t in twins if _part_of(t.candidate, channels) is None or t.candidate.protocol is not None]
    return "; and ".join(filter(None, [parts, to_separate(chosen, rest, channels)]))


def _can_be_driven(one: CandidateEffect, channels: Mapping[str, ChannelInfo]) -> bool:
    """Whether it is driven by what heats a part, and by no temperature: nobody heats the one and not the other."""
    return all(c in channels and channels[c].quantity != "temperature" for c in one.channels)


def _axis_in_words(names: Sequence[str], channels: Mapping[str, ChannelInfo]) -> str:
    """'Z', by the place of the first channel; else 'the axis of feed_Z'."""
    at = str(channels[names[0]].at).split(".") if names and names[0] in channels else []
    if len(at) > 1 and at[0] == "axis":
        return at[1].upper()
    return f"the axis of {names[0]}" if names else "one axis"


def to_tell_parts(
    chosen: CandidateEffect, twins: Sequence[CandidateEffect], channels: Mapping[str, ChannelInfo]
) -> str | None:
    """The advice where one effect, or its channels by another name, is said alike by temperatures of several parts;
    None where all are of one place. What a motion drives is of all parts that move, what reads two temperatures is of
    their difference, and the air is one cause at all of its places."""
    parts: dict[str, str] = {}
    for one in (chosen, *twins):
        if (part := _part_of(one, channels)) is not None:
            parts.setdefault(*part)
    if len(parts) < 2:
        return None
    named = [f"{name} ({at})" for at, name in parts.items()]
    of_motor = [at.rpartition(".")[2] in ("motor", "drive") for at in parts]
    how = _BY_LOAD if any(of_motor) and not all(of_motor) else _BY_PART
    return f"{chosen.id} may be heat of {listed(named, 'or')}; to tell them: {how}"


def _part_of(one: CandidateEffect, channels: Mapping[str, ChannelInfo]) -> tuple[str, str] | None:
    """(place, channel) of the one temperature that it reads; None where it reads another number of them, or the air."""
    read = [(c, channels[c]) for c in one.channels if c in channels and channels[c].quantity == "temperature"]
    (name, info) = read[0] if len(read) == 1 else ("", None)
    return None if info is None or info.at is None or is_around(info.at) else (info.at, name)


def to_decide(refused: Sequence[CandidateEffect], channels: Mapping[str, ChannelInfo]) -> str:
    """The advice where the open tests point to causes and the locked ones do not bear them out. refused: at least one,
    the largest first."""
    names = " with ".join(one.id for one in refused)
    them = "it" if len(refused) == 1 else "them"
    return f"the open tests point to {names}, the locked ones do not bear {them} out: {_with_lock(refused, channels)}"


def to_bear_out(claims: Sequence[CandidateEffect], channels: Mapping[str, ChannelInfo]) -> str:
    """The advice where what is claimed acts in none of the locked tests."""
    names = " with ".join(one.id for one in claims)
    them, act = ("it", "acts") if len(claims) == 1 else ("them", "act")
    return f"{names} hardly {act} in the locked tests; to bear {them} out, {_with_lock(claims, channels)}"


def to_exclude(hidden: CandidateEffect, like: str, channels: Mapping[str, ChannelInfo]) -> str:
    """The advice where nothing is missing, but something large could hide. like: the effect of the model behind which
    it would."""
    moved = _how_to_move(hidden, channels)
    return f"to exclude {hidden.id}, which {like} would hide: a test {moved}, while what drives {like} rests"


def after_clocks(tests: Sequence[str], then: str | None) -> str | None:
    """The advice where a clock may be off in some tests: that comes before all others."""
    if not tests or then is None:
        return then
    return f"first try the clock in {listed(tests)} as the artefact says, for all else hangs on it; then {then}"


def _with_lock(some: Sequence[CandidateEffect], channels: Mapping[str, ChannelInfo]) -> str:
    them, they_are = ("it", "it is") if len(some) == 1 else ("them", "they are")
    moved = "; and one ".join(dict.fromkeys(_how_to_move(one, channels) for one in some))
    return (
        f"run a test with the role locked, from a cold start, {moved}. If the error there falls with {them} (diagnose "
        f"again; thermodata confirm tells each test), {they_are} what is missing; if it does not, something else is"
    )


def _how_to_move(one: CandidateEffect, channels: Mapping[str, ChannelInfo]) -> str:
    if one.protocol is not None:
        return f"for {one.id}: {one.protocol}"
    first = next((channels[c] for c in one.channels if c in channels), None)
    if first is not None and is_around(first.at):
        how = _BY_DAY
    elif one.of_holder or one.passive:
        how = _BY_FOIL
    else:
        read = {channels[c].quantity for c in one.channels if c in channels}
        several = len(one.channels) > 1 and read == {"temperature"}
        quantity = "temperature_difference" if several else first.quantity if first is not None else "temperature"
        how = _MOVED.get(quantity, _LOADED)
    verb = "moves" if len(one.channels) == 1 else "move"
    return f"in which {listed(one.channels)} {verb} much ({how})"


def to_repeat(first: CandidateEffect, test: str, channels: Mapping[str, ChannelInfo]) -> str:
    """The advice where what ranks first acts in one test only. test: its name."""
    verb = "acts" if len(first.channels) == 1 else "act"
    return (
        f"{first.id} ranks first, and {listed(first.channels)} {verb} in {test} only, so no other test foretells "
        f"it: run another one {_how_to_move(first, channels)}, and diagnose again"
    )


def to_ask_of_locked(unforetold: CandidateEffect, then: str | None) -> str:
    """The advice where left-out tests can't be asked of something. then: the advice that there is besides."""
    asked = f"{unforetold.id} could not be asked: {unforetold.unforetold}"
    return asked if then is None else f"{asked}; if it is not that, {then}"


def _places(candidate: CandidateEffect, channels: Mapping[str, ChannelInfo]) -> set[str | None]:
    return {channels[c].at for c in candidate.channels if c in channels} - {None}
