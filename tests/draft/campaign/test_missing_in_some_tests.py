"""A signal that some tests lack: the draft says which, and its folder is ingested without a loss."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.commands import Said, Say

_HEADER = ("Zeit", "T_Lager_vorn [°C]", "T_Lager_hinten [°C]")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Tests a, b and c, of which b lacks the rear bearing."""
    (tmp_path / "raw").mkdir()
    for test in "abc":
        width = 2 if test == "b" else 3
        rows = [(f"12.06.2025 07:{k // 60:02d}:{k % 60:02d}", f"2{k % 9},0", "22,1")[:width] for k in range(240)]
        text = "\n".join(";".join(row) for row in (_HEADER[:width], *rows))
        (tmp_path / "raw" / f"{test}.csv").write_text(text + "\n", encoding="utf-8")
    return tmp_path


def _ingest(folder: Path, say: Say, old: str = "", new: str = "") -> Said:
    file = folder / "campaign.yaml"
    text = file.read_text(encoding="utf-8")
    assert old in text
    file.write_text(text.replace(old, new), encoding="utf-8")
    return say("--store", folder / "store", "ingest", file)


def test_what_the_draft_knows_to_be_missing_is_no_loss(folder: Path, say: Say) -> None:
    assert say("init", folder).code == 0
    assert "missing_in: [b]" in (folder / "campaign.yaml").read_text(encoding="utf-8")
    said = _ingest(folder, say)
    assert (said.code, "losses" in said.out) == (0, False)


def test_what_few_tests_have_is_drafted_as_only_in_them(folder: Path, say: Say) -> None:
    (folder / "raw" / "c.csv").write_bytes((folder / "raw" / "b.csv").read_bytes())
    say("init", folder)
    assert "only_in: [a]" in (folder / "campaign.yaml").read_text(encoding="utf-8")
    assert _ingest(folder, say).code == 0


def test_a_test_that_has_to_have_it_still_loses_it(folder: Path, say: Say) -> None:
    say("init", folder)
    said = _ingest(folder, say, "missing_in: [b]", "missing_in: [a]")
    assert said.code == 3
    assert "'missing_in: [b]' in the channel where the test's files lack it" in " ".join(said.out.split())


def test_a_typo_in_the_signal_is_a_loss_of_the_tests_that_have_it(folder: Path, say: Say) -> None:
    say("init", folder)
    said = _ingest(folder, say, "T_Lager_hinten [°C]", "T_Lager_hintn [°C]")
    assert said.code == 3
    assert "did you mean 'T_Lager_hinten [°C]'?" in " ".join(said.out.split())


@pytest.mark.parametrize(("new", "why"), [("[bb]", "no test 'bb'"), ("[b], only_in: [a]", "write one")])
def test_a_name_of_no_test_is_refused(folder: Path, say: Say, new: str, why: str) -> None:
    say("init", folder)
    said = _ingest(folder, say, "missing_in: [b]", f"missing_in: {new}")
    assert said.code == 2
    assert why in said.err
