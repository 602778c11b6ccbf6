"""What is said of a test that a model was fitted to, where an earlier version noted how it was then."""

from __future__ import annotations

from thermodata.store import Store
from thermodata.store.base.files import key_of
from thermodata.store.ingest.known.inventory import comparable, read_inventory
from thermodata.store.ingest.known.state import states, what_differs

ANEW = ("gains", "logs", "readers")  # what states have since format 2


def test_a_state_of_before_differs_by_what_differs(filled: Store) -> None:
    with filled.reader() as con:
        held = read_inventory(con, filled.path, "shop")
    now = states(held.rows, held.calibrations, ["one"])["one"]
    assert now is not None
    before = {word: digest for word, digest in now.items() if word not in ANEW} | {"data": "other", "version": "other"}
    assert before["calibration"].endswith(key_of(*comparable(held.calibrations))), "as it was noted then"
    assert what_differs(before, now) == ["data"]


def test_words_about_a_calibration_make_no_difference_to_it(filled: Store) -> None:
    with filled.reader() as con:
        held = read_inventory(con, filled.path, "shop")
    told = [{**row, "detail": '{"told": "otherwise"}'} for row in held.calibrations]
    then, now = (states(held.rows, rows, ["one"])["one"] for rows in (held.calibrations, told))
    assert then is not None
    assert "calibration" not in what_differs(then, now)
