"""Texts of a state: words for on and off are numbers, and of others the loss says what to write."""

from __future__ import annotations

from pathlib import Path

import pytest

from thermodata.store import Store
from thermodata.store.ingest.run import ingest

pytestmark = pytest.mark.usefixtures("installed_readers")


def _losses(store: Store, folder: Path, words: tuple[str, ...], quantity: str) -> list[str]:
    """Of a log whose pump says these words in turn."""
    rows = (f"2026-03-02 08:{i:02d}:00,21.{i % 10},{words[i % len(words)]}" for i in range(30))
    (folder / "one.csv").write_text("time,T1 [degC],pump\n" + "\n".join(rows) + "\n")
    (folder / "campaign.yaml").write_text(
        "schema: thermodata/campaign/1\nid: lab\nsources:\n"
        '  log: {reader: table, files: "{test}.csv"}\nchannels:\n'
        "  T1: {source: log, signal: T1, quantity: temperature}\n"
        f"  pump: {{source: log, signal: pump, quantity: {quantity}}}\n"
        "tests:\n  - {id: one, kind: mixed, role: none}\n"
    )
    return [str(x["reason"]) for x in ingest(store, folder / "campaign.yaml").losses]


@pytest.mark.parametrize("words", [("MARCHE", "ARRET"), ("入", "切"), ("1", "Éteint")])
def test_words_for_on_and_off_are_numbers(store: Store, tmp_path: Path, words: tuple[str, str]) -> None:
    assert _losses(store, tmp_path, words, "state") == []


@pytest.mark.parametrize(("quantity", "told"), [("state", True), ("rotational_speed, unit: rpm", False)])
def test_what_to_write_for_words_that_no_number_stands_for(
    store: Store, tmp_path: Path, quantity: str, told: bool
) -> None:
    (reason, *_) = _losses(store, tmp_path, ("geht", "steht"), quantity)
    assert "text where numbers are expected, such as 'geht'" in reason
    assert ("try: write 1 and 0 into the file, or words for on and off" in reason) is told
