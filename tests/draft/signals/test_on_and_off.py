"""Words for on and off, in the languages of labs, are those of a switch; two words that nobody knows are asked."""

from __future__ import annotations

from pathlib import Path

import pytest

from thermodata.draft.campaign.parts import DraftChannel
from thermodata.draft.make import draft_files
from thermodata.schema.words.on_off import _OFF, _ON, _bare, on_or_off


def _pump(folder: Path, *words: tuple[str, ...]) -> DraftChannel:
    """The channel of a column of words in files of 200 s; words: of each file, in turn."""
    for k, of_file in enumerate(words):
        rows = (f"2026-03-02T{8 + k:02d}:{i // 6:02d}:{i % 6 * 10:02d}Z;21.{i % 10};{w}" for i, w in enumerate(of_file))
        (folder / f"essai_{k}.csv").write_text("t;T air [degC];Pompe huile\n" + "\n".join(rows) + "\n")
    (found,) = (c for c in draft_files(folder).draft.channels if c.name == "Pompe_huile")
    return found


@pytest.mark.parametrize(
    ("on", "off"),
    [
        *(("MARCHE", "ARRET"), ("Marche", "Arrêt"), ("EIN", "AUS"), ("AN", "AUS"), ("ON", "OFF"), ("ZAP", "VYP")),
        *(("ACCESO", "SPENTO"), ("MARCIA", "ARRESTO"), ("入", "切"), ("運転", "停止"), ("ENCENDIDO", "APAGADO")),
        *(("1", "ARRET"), ("ligado", "desligado"), ("WŁ", "WYŁ"), ("вкл.", "выкл.")),
    ],
)
def test_words_for_on_and_off_are_a_switch(tmp_path: Path, on: str, off: str) -> None:
    said = _pump(tmp_path, (off, on, on, off) * 5, (off,) * 20).said
    assert (said.quantity, said.at) == ("state", "pump")
    assert (on_or_off(on), on_or_off(off)) == (1.0, 0.0)


@pytest.mark.parametrize("other", ["steht", "ON"])
def test_two_words_that_nobody_knows_are_asked(tmp_path: Path, other: str) -> None:
    said = _pump(tmp_path, ("geht", "steht", "geht", "steht") * 5, (other,) * 20).said
    assert (said.quantity, said.sure) == ("label", False)
    assert said.questions[0].startswith("a switch? its words are 'geht' and 'steht', and which is on is not known here")


@pytest.mark.parametrize(
    "words",
    [
        (("geht", "steht", "Störung") * 6,),
        (("T12", "T14") * 10,),  # tools
        (("Alice",) * 20, ("Bob",) * 20),  # who was there
    ],
)
def test_other_words_are_a_label(tmp_path: Path, words: tuple[tuple[str, ...], ...]) -> None:
    said = _pump(tmp_path, *words).said
    assert (said.quantity, said.sure, said.questions) == ("label", True, ())


def test_no_word_is_on_and_off() -> None:
    assert not {*map(_bare, _ON)} & {*map(_bare, _OFF)}
    assert on_or_off("geht") is None
