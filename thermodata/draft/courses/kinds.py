"""What kind of test a recording is, by its name and by what moved in it; and the conditions that its name states."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from datetime import UTC, datetime
from types import MappingProxyType

from thermodata.draft.courses.moved import Moved, moved_in
from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.times.named_days import named_start
from thermodata.draft.words.axis import axis_of
from thermodata.draft.words.listed import holds_word
from thermodata.draft.words.naming import words
from thermodata.draft.words.roles import said_by_name
from thermodata.draft.words.said_by_names import SaidByNames, said_by

_KINDS: tuple[tuple[str, str], ...] = (
    (
        "etve",
        "reposo. parado. repos. riposo. fermo. repouso. spoczynek postoj. stilstand. stillastaende "
        "etve. idle. ambient ^amb. klid. klidov ruhe. umgebung okoli stillstand standstill leerlauf~aus 环境 "
        "静止 待机 evt.",
    ),
    ("spectrum", "spectrum spektrum spec. spektr espectro spectre. spettro 谱 转速谱 drehzahlspektrum stufenprogramm"),
    (
        "cutting",
        "^cut. cutting ^fras ^fraes ^frez ^milling zerspan obrabeni obrab. bearbeit 切削 加工 铣 mecaniz fresado "
        "usinag coupe. fraisage lavorazion taglio. fresatura corte. fresagem skrawani obrobk verspan bearbetning "
        "skarande fresning talasli frezeleme kesme. resanie",
    ),
    (
        "rotary_axis",
        "rotary table. ^tafel tabla. tisch. ^stul. drehtisch rundachse otocn 转台 [bc]~axis achse~[bc] osa~[bc]",
    ),
    (
        "linear_axis",
        "feed. linear axis. ^vorschub ^posuv feedaxis linearachse achse. osa. osy. ^avanc ^avanz matning "
        "aanzet ^voeding besleme. ^posuw ilerleme 进给 直线 丝杠 screw. kgt.",
    ),
    (
        "spindle",
        "spindle spindel ^vreten sp. speed. rpm. ^otac drehzahl warmup. warm~up aufwarm zahriv 主轴 转速 "
        "预热 const. "
        "heat. heating heating. heizen n. husillo broche. mandrino wrzecion fuso. spil.",
    ),
    (
        "mixed",
        "mixed. mix. mixto mixte. misto. gemischt blandad work~day working~day workday arbeitstag pracovni~den "
        "shift. schicht smena. "
        "kombin combin gemengd karma. mieszan production produktion 混合 综合",
    ),
)
# a day is a date, unless the data show the loads of a working day
_DAYS = "day. tag. ^den. dny."
# a test of these is none of the environment, also where nobody logs their switches
_FLUIDS = (
    "fluid. fluids. fluide. fluides. fluidi. ^kuhl ^kuehl kss. coolant. cooling. ^pump. pumps. ^pumpe pompa. pompe. "
    "^hydraul ^idraul emuls ^refriger arrosage. ^lubri ^schmier ^chlaz ^chlad ^cerpadl kapalin 冷却 液压 taladrina "
    "^enfria "
    "nebenaggregat hilfsaggregat ausiliari. auxiliar auxiliaires. auxiliares. aux. "
    "chiller chillers ^refroid ^raffredd chlodz koelvloei koeling kylvatska kylare skarvatsk sogut fluido~de~corte "
    "kesme~sivisi kesme~yag kesme~yagi oleo~de~corte snijolie "
    "liquide~de~coupe fluide~de~coupe fluido~da~taglio fluido~di~taglio liquido~de~corte cutting~fluid"
)
# what lets other air to the machine: somebody did it on purpose
_DRAUGHTS = (
    "tor. hallentor gate. door. doors. open~door open~gate tur. tuer. abluft zuluft exhaust. draught draughts "
    "zugluft luftzug durchzug portail. courant~d~air porton. puerta. corriente~de~aire portone corrente~d~aria portao. "
    "vrata. pruvan brama. przeciag tochtlucht blow. blower"
)
_AGREE = {
    "spindle": {"spindle", "spectrum"},
    "spectrum": {"spindle", "spectrum"},
    "cutting": {"mixed", "cutting", "spindle"},
    "mixed": {"mixed", "spindle", "spectrum", "linear_axis", "cutting"},
    "etve": {"etve"},
    "linear_axis": {"linear_axis", "mixed"},
    "rotary_axis": {"rotary_axis", "mixed"},
}


_NOTHING: Mapping[str, str] = MappingProxyType({})
# what a pump shows by where it runs and where it rests

_LINEAR = re.compile(r"(?<!\S)[xyz]\d*(?!\S)")
_TURNS = "rotary drehtisch rundtisch rundachse otocn 转台 [bc]~axis achse~[bc] osa~[bc]"


@dataclass(frozen=True, slots=True)
class Kind:
    """kind: as in a campaign file; comment: how sure; question: what to look at, or None; conditions: condition ->
    value with unit; doubts: of the conditions; role_hint: what role_by says of the role, which is never taken;
    start: date and time by the name, where no recording has its own."""

    kind: str
    comment: str
    question: str | None = None
    conditions: dict[str, str] = field(default_factory=dict)
    doubts: tuple[str, ...] = ()
    role_hint: str | None = None
    start: str | None = None
    role_by: str = "the name"


def kind_of(test: str, files: Sequence[RawFile], listed: Mapping[str, str] = _NOTHING) -> Kind:
    """The kind of a test, and its conditions. files: all its recordings, of all sources; listed: the conditions that a
    table says, whose speed tells where neither name nor data do."""
    text, moved = words(test), moved_in(files)
    folders = [part for f in files for part in reversed(f.path.parts[:-1])]
    said = said_by(list(dict.fromkeys([test, *(f.path.stem for f in files), *folders])))
    by_name = next((kind for kind, listed in _KINDS if holds_word(listed, text)), None)
    if by_name == "cutting" and holds_word(_FLUIDS, text) and not (moved.speeds or moved.axes):
        by_name = None  # 'cutting fluid': what the fluid does, without a cut
    if by_name == "rotary_axis" and _LINEAR.search(text) and not holds_word(_TURNS, text):
        by_name = "linear_axis"  # 'tisch_Z': the table travels
    conditions, comments, doubts = _conditions(said, moved, files)
    if by_name is None and ({"speed", "schedule"} & conditions.keys() or said.speeds):
        by_name = "spectrum" if conditions.get("schedule", "").count(",") >= 2 else "spindle"
    elif by_name is None and ("feed" in conditions or _LINEAR.search(text)):
        by_name = "linear_axis"
    elif by_name is None and "air" in conditions:
        by_name = "etve"
    by_data, by = _by_data(moved), "name"
    if by_name is None and _turns(listed.get("speed", "")):
        by_name, by = "spindle", "table"
    if by_name is None and by_data == "mixed" and holds_word(_DAYS, text):
        by_name = "mixed"
    hint = said_by_name(text)
    kind, comment, question = _decided(by_name, by_data, moved, by)
    if by_name is None and by_data == "etve" and holds_word(_FLUIDS, text):
        kind, comment = "other", ""
        question = "kind: the name speaks of pumps or fluids, whose switches are not logged; nothing else moves: etve?"
    elif by_name is None and by_data == "etve" and holds_word(_DRAUGHTS, text):
        kind, comment = "other", ""
        question = "kind: the name speaks of a door or a draught; nothing moves: etve?"
    if kind == "linear_axis" and "axis" not in conditions:
        letter = axis_of(text) or (next(iter(moved.axes)) if len(moved.axes) == 1 else None)
        if letter:
            conditions["axis"] = letter.upper()
    if kind == "spindle" and "speed" not in conditions and len(moved.speeds) == 1 and moved.whole:
        conditions["speed"] = f"{moved.speeds[0]:g} rpm"
        comments.append("speed guess: data, in rpm by its values" if moved.implied else "speed sure: data")
    undated = [f.path.stem for f in files if f.start_ns is None]
    # beside recordings that date themselves, it is the names of the others that say when these began
    start = said.start if len(undated) == len(files) else said_by(undated).start if undated else None
    if start is not None:
        doubts.append("start: as the name says? it is that of the first row, in the timezone of its source")
    elif (start := named_start(files)) is not None:
        comments.append("start guess: the date by the name, the time of day by the first row")
    elif undated and len(undated) == len(files) and (day := _day_said(said)):
        doubts.append(day)
    comment = "; ".join(filter(None, (comment, *comments)))
    return Kind(kind, comment, question, conditions, tuple(doubts), hint, start)


def _day_said(said: SaidByNames) -> str:
    """What to ask of the start of a test whose name says its day; '' where it says none."""
    days = said.days or tuple(filter(None, [said.conditions.get("date")]))
    if not days:
        return ""
    return f"start: '{days[0]} 08:00'? the name says {' or '.join(days)}; the time of day is that of the first row"


def _turns(speed: str) -> bool:
    """Whether a condition such as '8000 1/min' is a speed above 0."""
    number = re.match(r"\d+(?:\.\d+)?(?![^\s])", speed)
    return number is not None and float(number[0]) > 0


def _decided(by_name: str | None, by_data: str | None, moved: Moved, by: str) -> tuple[str, str, str | None]:
    """by: who says by_name, the name or the table."""
    if by_name and by_data and by_data != "other":
        if by_data in _AGREE.get(by_name, {by_name}):
            kind = "spectrum" if (by_name, by_data) == ("spindle", "spectrum") else by_name
            return kind, f"sure: {by} and data", None
        return by_name, "", f"kind: the {by} says {by_name}, the data {by_data} ({moved})"
    if by_data == "mixed" and moved.with_spindle and moved.loaded is None:
        asked = "mixed, or cutting? the axes feed only while the spindle turns, whose power is not logged"
        return by_data, "", f"kind: {asked} ({moved})"
    if by_name == "etve" and moved.turning:
        return "other", "", f"kind: the name says etve, the data that something turns ({moved})"
    if by_data == "linear_axis" and not by_name and not moved.axes:
        return by_data, "", f"kind: linear_axis? {moved}"
    if by_data == "other" and not by_name:
        return by_data, "", f"kind: other? {moved}"
    if by_data and by_data != "other":
        return by_data, f"guess: data only, {moved}", None
    if by_name:
        return by_name, f"guess: {by} only", None
    return "other", "", "kind? e.g. spindle, linear_axis, etve, cutting"


def _by_data(moved: Moved) -> str | None:
    if not moved.seen:
        return None
    if moved.turning:
        # a driven tool alone is none of the kinds: it turns as a spindle, and heats the turret
        return "mixed" if moved.speeds or moved.axes or moved.rotary else "other"
    if moved.speeds and moved.axes:
        return "cutting" if moved.with_spindle and moved.loaded and not moved.rotary else "mixed"
    if moved.speeds:
        return "spectrum" if len(moved.speeds) >= 3 else "spindle"
    if moved.axes and moved.rotary:
        return "mixed"
    if moved.axes:
        return "linear_axis" if len(moved.axes) == 1 else "mixed"
    if moved.rotary:
        return "rotary_axis"
    if moved.fed:
        return "linear_axis"
    if not moved.whole:
        return None
    if moved.switched:
        return "other"
    return "etve"


def _conditions(
    said: SaidByNames, moved: Moved, files: Sequence[RawFile]
) -> tuple[dict[str, str], list[str], list[str]]:
    """(conditions, how sure each is, what to ask), the names held against what the recordings show."""
    found, questions, comments = dict(said.conditions), list(said.questions), []
    told = {k for k in found if k not in said.guessed}
    shown = ", ".join(f"{s:g}" for s in moved.speeds[:3])
    readings = (float(found["speed"].split()[0]),) if "speed" in found else said.speeds
    fitting = [v for v in readings if any(abs(s - v) < 0.05 * v for s in moved.speeds)]
    if len(fitting) == 1:
        found["speed"] = f"{fitting[0]:g} rpm"
        questions = [q for q in questions if not q.startswith("speed: ")]
        comments.append("speed sure: name and data")
    elif "speed" in found and moved.speeds and moved.whole:
        questions.append(f"speed: the name says {found.pop('speed')}, the data {shown}")
    elif "speed" in found:
        comments.append("speed guess: name only")
    if "date" in found and (day := _day_of(files)) is not None:
        if day != found["date"] and "date" in told:
            questions.append(f"date: the name says {found['date']}, the recording {day}")
        del found["date"]  # the recording dates itself
    others = [k for k in found if k not in ("speed", "axis")]
    comments += [f"{', '.join(others)} guess: name only"] if others else []
    return found, comments, questions


def _day_of(files: Sequence[RawFile]) -> str | None:
    """The day on which dated recordings began, as their clock shows it."""
    starts = [f.start_ns for f in files if f.start_ns is not None]
    return datetime.fromtimestamp(min(starts) / 1e9, UTC).strftime("%Y-%m-%d") if starts else None
