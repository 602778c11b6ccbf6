"""Where a switch acts: a pump, a door, a spindle that is on."""

from __future__ import annotations

MEASURES = (
    "probe. probing measuring measures. measure. in~position in~pos inpos. messen messung. misst. messpos messposition "
    "antasten taster. mereni meri. v~poloze sonda. misura. misurazione in~posizione medicion midiendo en~posicion "
    "mesure. mesurage en~position medicao pomiar pomiaru 测量 測量 測定 측정 到位 измерен"
)
"""Of a state that holds while the probes are where they measure."""
_WHICH_SWITCH = "at: what does it switch? e.g. coolant, hydraulics, lubrication, hall.door; nothing that warms: no 'at'"
_ASKED_OF_SWITCHES = {
    "mist": "at: coolant, or lubrication, where the mist is the bearings'?",
    "pump": "at: whose pump? coolant, hydraulics, lubrication or chiller",
}


def place_of_switch(said: set[str], axis: str | None) -> tuple[str | None, bool, str | None]:
    """(place, whether that is sure, what to ask). said: the keys of the vocabulary that the name mentions."""
    if "door" in said:
        told = said & {"enclosure", "hall", "gate"}
        asked = None if told else "at: hall.door, or enclosure, where it is the machine's own door?"
        return "enclosure" if "enclosure" in said else "hall.door", False, asked
    for key in ("coolant", "hydraulics"):
        if key in said:
            return key, True, None
    for key in ("lubrication", "mist", "spindle", "table", "chiller", "pneumatics", "pump", "fan"):
        if key in said:
            return "coolant" if key == "mist" else key, False, _ASKED_OF_SWITCHES.get(key)
    if axis and axis in "xyz":
        return f"axis.{axis}", False, None
    return None, False, None if "control" in said else _WHICH_SWITCH
