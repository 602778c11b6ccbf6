"""The axis that a name speaks of."""

from __future__ import annotations

import re

_BESIDE = (
    r"d|e|ed|eddy|wz|pos|feed|nut|ax|axis|achse|osa|mot|motor|tcp|err|error|delta|disp|act|ist|load|cur|curr|"
    r"current|torque|acs|mcs|wcs|bcs|temp|temper|speed|vel|rapid|v|s|i|t|m|p|f"
)
_AFTER = (
    r"jiku|zhou|abs|act|pos|mpos|wpos|load|axis|achse|mot|motor|temp|frt|com|curr|vel|speed|ist|soll|position|feedrate"
)
# 'MX840B' is an amplifier, and no axis
_LINEAR = re.compile(rf"(?<!\S)(?:{_BESIDE})?([xyz])(?!\S)(?! \d{{3}} b)|(?<!\S)([xyz])(?:{_AFTER})(?!\S)")
_ROTARY = re.compile(
    r"(?<!\S)(?:axis|achse|osa|asse|axe|eje|eixo|tengely|eksen|ось|ax|rotary|torquemotor|act|ist|pos|mot|motor|load|"
    r"curr|current|torque|speed|drehzahl|otacky) ?([abc])(?!\S)"
    r"|(?<!\S)([abc])(?: \d)? ?(?:jiku|zhou|axis|achse|osa|act|actm|actw|abs|pos|load|mot|motor|"
    r"speed|drehzahl|otacky|rpm)(?!\S)"
    # 'cn' is the C axis's speed where nothing else is said: 'cn vitesse broche' is of a commande numérique
    r"|(?<!\S)([abc])(?: \d)? n(?!\S)|^([abc])n$"
    r"|(?<!\S)([abc]) ?[轴軸]"
    r"|(?<!\S)(?:motor|mot) (?:temp|temper|temperature|temperatur) ([abc])(?!\S)"
    r"|(?<!\S)(?:temp|temper) (?:motor|mot) ([abc])(?!\S)"
)


def axis_of(text: str) -> str | None:
    """The one axis letter (lower case) that a name (as words()) speaks of; None where none or several."""
    found = {a or b for a, b in _LINEAR.findall(text)}
    found |= {letter for letters in _ROTARY.findall(text) for letter in letters if letter}
    return found.pop() if len(found) == 1 else None
