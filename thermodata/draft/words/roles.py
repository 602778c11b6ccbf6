"""What a name, or a list of the tests, says of a test's role. It is offered and never taken: a role decides what a
model is fitted to, and what it is judged by."""

from __future__ import annotations

from collections.abc import Mapping

from thermodata.draft.words.listed import holds_word
from thermodata.draft.words.naming import words

_IN_NAMES: tuple[tuple[str, str], ...] = (
    ("locked", "^locked secret geheim blind. ^zamcen"),
    ("verification", "^verif ^valid ^overe pruf check. 验证"),
    ("calibration", "train. training identif fit. ident. 辨识 建模"),
)
# of a cell; in a name 'calibration' is a jump test's
_IN_LISTS: tuple[tuple[str, str], ...] = (
    (
        "locked",
        "^locked hold~out ^holdout ^reserved ^secret ^gesperrt ^geheim blind. ^zamcen ^bloccat ^verrouill ^bloquead "
        "封存 保留",
    ),
    ("verification", "^verif ^valid ^convalid ^overe ^pruf ^uberpruf check. test~set 验证 検証"),
    (
        "calibration",
        "^calib ^kalib ^taratur ^etalon train. ^training ^identif fit. ident. 标定 辨识 建模 校正",
    ),
)
_NOT = "not. non. nicht. kein. keine. ne. pas. 未 非"  # of a cell; with one it says what a test is not
_MOST_WORDS = 3  # 'checked after calibration of the probes' is a remark


def said_by_name(text: str) -> str | None:
    """The role in a test's name, as words()."""
    return next((role for role, listed in _IN_NAMES if holds_word(listed, text)), None)


def said_by_list(cells: Mapping[str, str]) -> tuple[str, str] | None:
    """(role, column) by the cells of a test's row; None where none says one, or two say different ones."""
    found: dict[str, str] = {}
    for column, cell in cells.items():
        text = words(cell)
        roles = [role for role, listed in _IN_LISTS if holds_word(listed, text)]
        if len(roles) == 1 and len(text.split()) <= _MOST_WORDS and not holds_word(_NOT, text):
            found.setdefault(roles[0], column)
    return next(iter(found.items())) if len(found) == 1 else None
