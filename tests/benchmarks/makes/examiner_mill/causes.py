"""Twenty-seven causes that move this machine's tool, what names them rightly, and what a case hides, knows and has."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..truth import Plan, channels


@dataclass(frozen=True)
class Cause:
    """axes: in which it acts (T: the tilt). test: in which it shows. right: candidate ids, the best first. others: of
    the same part or heat, beside plain lags of the right channels."""

    axes: str
    test: str
    right: str
    others: str = ""

    @property
    def best(self) -> str:
        return self.right.split()[0]

    @property
    def drivers(self) -> list[str]:
        """The channels of the right candidates, in their order."""
        return list(dict.fromkeys(c for one in self.right.split() for c in one.split(":")[1].split(",")))

    @property
    def twins(self) -> str:
        told, lags = self.right.split(), [f"lag:{c}" for c in self.drivers]
        return " ".join(one for one in [*self.others.split(), *lags] if one not in told)

    @property
    def gone(self) -> set[str]:
        """Channels that are not there where it is not logged; table, speed and state of measuring always may be."""
        return channels(f"{self.right} {self.others}") - {"T_tab", "meas", "n_S"}


def _screw(axis: str) -> Cause:
    others = f"feed_motor:T_mot_{axis} lag:T_mot_{axis} guideway:T_gd_{axis} lag:T_gd_{axis}"
    return Cause(axis, "axes", f"feed_screw:T_nut_{axis} feed_screw:F_{axis}", others)


def _feed_motor(axis: str, axes: str) -> Cause:
    return Cause(axes, "axes", f"feed_motor:T_mot_{axis}", f"feed_screw:F_{axis} lag:F_{axis}")


def _guide(axis: str, axes: str) -> Cause:
    others = f"feed_screw:F_{axis} lag:F_{axis} feed_screw:T_nut_{axis} lag:T_nut_{axis}"
    return Cause(axes, "axes", f"guideway:T_gd_{axis}", others)


CAUSES: Mapping[str, Cause] = {
    "bearing": Cause(
        "ZYT",
        "steps",
        "spindle_bearing:T_brg_f spindle_bearing:T_brg_r spindle_friction:n_S",
        "spindle_bearing_2:T_brg_f spindle_heating_cooling:T_brg_f,n_S speed_dependent_gain:T_brg_f,n_S "
        "spindle_bearing_2:T_brg_r lag:T_head",
    ),
    "motor": Cause("YTZ", "heavy", "spindle_motor:T_mot_S", "cutting_power:P_S cutting_load:L_S lag:P_S lag:L_S"),
    "gearbox": Cause("YZT", "steps", "spindle_gearbox:T_gear", "spindle_friction:n_S lag:n_S"),
    "belt": Cause("TYZ", "steps", "lag:T_belt spindle_friction:n_S"),
    "chiller": Cause("ZY", "chill", "chiller_temperature:T_chs chiller_temperature:T_chr"),
    "hydraulics": Cause("XYZT", "pump", "hydraulics:T_hyd hydraulics:hyd_on"),
    "screw_X": _screw("X"),
    "screw_Y": _screw("Y"),
    "screw_Z": _screw("Z"),
    "fmot_X": _feed_motor("X", "X"),
    "fmot_Y": _feed_motor("Y", "Y"),
    "fmot_Z": _feed_motor("Z", "ZYT"),
    "guide_X": _guide("X", "XZ"),
    "guide_Y": _guide("Y", "YZT"),
    "guide_Z": _guide("Z", "TYZ"),
    "scale": Cause("Y", "idle", "lag:T_scl_Y scale_growth:T_scl_Y,pos_Y"),
    "rotary": Cause(
        "ZXY", "table", "table_bearing:T_rtb rotary_axis:T_rot rotary_friction:n_A", "lag:T_tab table_bearing:T_tab"
    ),
    "cut": Cause(
        "ZYX",
        "cutting",
        "workpiece:T_part cutting_power:P_S cutting_load:L_S",
        "lag:T_chip lag:T_tool tool_elongation:T_tool",
    ),
    "chips": Cause(
        "ZTY",
        "cutting",
        "lag:T_chip cutting_power:P_S cutting_load:L_S bed_bending:T_bed_t,T_bed_b",
        "lag:T_part workpiece:T_part lag:T_tool tool_elongation:T_tool",
    ),
    "tool": Cause(
        "Z",
        "cutting",
        "tool_elongation:T_tool",
        "cutting_power:P_S cutting_load:L_S lag:P_S lag:L_S lag:T_part workpiece:T_part lag:T_chip",
    ),
    "coolant": Cause(
        "ZXY",
        "flood",
        "coolant_heat:T_kss,cool_on coolant_temperature:T_kss coolant:cool_on coolant:q_cool",
        "lag:T_tab table_bearing:T_tab workpiece:T_part lag:T_part",
    ),
    "hall": Cause(
        "ZYTX",
        "idle",
        "ambient_frame:T_hall ambient_frame:T_top ambient_frame:T_bot ambient_skin:T_hall",
        "ambient_skin:T_top ambient_skin:T_bot",
    ),
    "gradient": Cause(
        "TYZ",
        "idle",
        "vertical_gradient:T_top,T_bot",
        "ambient_frame:T_top ambient_frame:T_bot ambient_skin:T_top ambient_skin:T_bot",
    ),
    "sun": Cause("X", "idle", "sun:I_sun column_bending:T_col_lf,T_col_rt", "lag:T_col_rt"),
    "door": Cause("YT", "idle", "ambient_frame:T_door lag:door_open", "ambient_skin:T_door"),
    "cabinet": Cause("YT", "heavy", "lag:T_cab column_bending:T_col_r,T_col_f", "lag:T_col_r"),
    "centri": Cause("Z", "steps", "centrifugal_shift:n_S", "static:n_S"),
}
ALIKE = (  # never two of one of these
    *("gearbox belt", "cut chips tool", "screw_X fmot_X guide_X", "screw_Y fmot_Y guide_Y", "screw_Z fmot_Z guide_Z"),
    *("hall gradient", "motor cabinet"),
)
USUAL = ("bearing", "hall", "rotary", "hydraulics", "screw_X", "screw_Y")  # what a first model knows before others
KINDS = (
    *("one", "one", "two", "one", "none", "weak", "one", "one", "not_logged", "one", "two", "weak", "one"),
    *("none", "one", "two", "weak", "one", "outside", "two", "one", "not_logged", "none", "fault", "one", "weak"),
)
LACKING = ("none", "outside", "fault")  # kinds that hide nothing
HIDDEN = (
    *("chiller", "chips", "screw_X", "sun", "guide_Z", "hydraulics", "tool", "belt", "rotary", "door", "motor"),
    *("fmot_Z", "coolant", "cabinet", "gradient", "screw_Y", "bearing", "scale", "cut", "gearbox", "hall"),
    *("guide_X", "screw_Z", "centri", "fmot_Y", "guide_Y", "fmot_X"),
)


def plan(case: int, rng: np.random.Generator) -> Plan:
    """Kind, response and hidden causes, so that 26 cases in a row have each kind as often as `KINDS`."""
    kind, first = KINDS[case % len(KINDS)], HIDDEN[case % len(HIDDEN)]
    axis = str(rng.choice([*CAUSES[first].axes]))
    hidden = [first] if kind not in LACKING else []
    if kind == "two":
        hidden.append(str(rng.choice(_free(kind, axis, hidden))))
    return Plan("one" if kind == "weak" else kind, axis, tuple(hidden), kind == "weak")


def known(case: int, rng: np.random.Generator, asked: Plan) -> tuple[list[str], list[str]]:
    """Causes of the first model, and small ones that nobody models; half of the cases have more of the first and none
    of these."""
    base: list[str] = []
    usual = [k for k in USUAL if k in _free(asked.kind, asked.axis, asked.hidden)]
    thick = case % 4 in (0, 3)
    for _ in range(int(rng.integers(3, 6) if thick else rng.integers(1, 3))):
        able = _free(asked.kind, asked.axis, [*asked.hidden, *base])
        likely = [k for k in usual if k in able] if len(base) < 2 else able
        base += [str(rng.choice(likely or able))] if able else []
    rest = _free(asked.kind, asked.axis, [*asked.hidden, *base])
    return base, list(map(str, rng.choice(rest, min(len(rest), 0 if thick else 3), replace=False)))


def _free(kind: str, axis: str, taken: Sequence[str]) -> list[str]:
    """Causes that act in an axis and are like none of these."""
    barred = {*taken}.union(*({*group.split()} for group in ALIKE if {*group.split()} & {*taken}))
    return [k for k, c in CAUSES.items() if axis in c.axes and k not in barred and (kind, k) != ("two", "centri")]
