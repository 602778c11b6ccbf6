"""docs/verdicts.md has what `tests/benchmarks/ten_verdicts.py` prints into it, whole, and is read below each answer."""

from __future__ import annotations

import importlib
import re
from pathlib import Path
from typing import Any

import pytest

BENCHMARKS = Path(__file__).parents[1] / "benchmarks"


@pytest.fixture
def ten(monkeypatch: pytest.MonkeyPatch) -> Any:
    monkeypatch.syspath_prepend(str(BENCHMARKS))
    return importlib.import_module("ten_verdicts")


def answer(ten: Any, printed: str) -> Any:
    return ten.Answer(ten.Truth([]), printed, {"verdict": "none", "candidates": [], "artefacts": []}, None)


def test_every_answer_stands_in_the_page_and_is_read(ten: Any) -> None:
    page = ten.PAGE.read_text("utf-8")
    sections = re.split(r"^## ", page, flags=re.MULTILINE)[1 : 1 + len(ten.CASES)]
    for (number, case), section in zip(ten.CASES.items(), sections, strict=True):
        assert section.startswith(f"{number}. ")
        assert (
            f"<!-- answer {number} -->\n```sh\n{case.commands}\n```\n\n```text\nof the model fitted last: " in section
        )
        assert re.search(r"\n(left-out|fitted): ", section)  # its last paragraph: nothing was cut
        told = section.split(f"<!-- end of answer {number} -->")[1]
        assert told.strip().startswith("**Read.** ")
        assert "*Truth:*" in told
        assert f"\n| {number} | " in page


def test_what_is_read_below_names_no_id_of_a_model(ten: Any) -> None:
    """It hangs on the bytes of the logs, so that an answer that is renewed would have another one."""
    page = ten.PAGE.read_text("utf-8")
    for number in ten.CASES:
        begin, end = f"<!-- answer {number} -->", f"<!-- end of answer {number} -->"
        page = page[: page.index(begin)] + page[page.index(end) :]
    assert ten.ID.findall(page) == []


def test_a_block_is_renewed_and_one_that_differs_is_known(ten: Any) -> None:
    page = ten.PAGE.read_text("utf-8")
    new = ten.with_block(page, "answer 3", "```text\nanother\n```")
    assert "<!-- answer 3 -->\n```text\nanother\n```\n<!-- end of answer 3 -->" in new
    assert ten.with_block(new, "answer 3", "```text\nanother\n```") == new
    assert ten.without_ids(new) != ten.without_ids(page)
    with pytest.raises(ValueError, match="no marks of 'answer 11'"):
        ten.with_block(page, "answer 11", "")


def test_lines_are_folded_as_at_a_terminal_and_ids_of_models_do_not_count(ten: Any) -> None:
    line = " ".join(["lag:T_motor_of_the_axis"] * 9)
    told = ten.folded(line)
    assert max(map(len, told.splitlines())) <= ten.WIDTH
    assert all(more.startswith("  ") for more in told.splitlines()[1:])
    assert set(told.split()) <= {"lag:T_motor_of_the_axis", "lag:", "T_motor_of_the_axis"}, "no name is broken"
    assert "".join(told.split()) == "".join(line.split())
    assert ten.folded("a\n\n  ! b").splitlines() == ["a", "", "  ! b"]
    assert ten.without_ids("add 52a1ae3ec0bf 1") == ten.without_ids("add 014ff139 1")


def test_what_is_kept_is_not_asked_again(ten: Any, tmp_path: Path) -> None:
    (tmp_path / "5.json").write_text(ten.json.dumps(ten.asdict(answer(ten, "of the model"))), "utf-8")
    assert ten.answer(5, tmp_path) == answer(ten, "of the model")


@pytest.mark.parametrize(
    ("hidden", "claimed", "told"),
    [
        ([{"cause": "oil", "um": 3.0, "right": ["oil:T"], "twins": ["lag:T"]}], "oil:T", "right"),
        ([{"cause": "oil", "um": 3.0, "right": ["oil:T"], "twins": ["lag:T"]}], "lag:T", "twin"),
        ([{"cause": "oil", "um": 3.0, "right": ["oil:T"], "twins": []}], None, "silent"),
        ([{"cause": "oil", "um": 3.0, "right": [], "twins": []}], None, "right"),
        ([], None, "right"),
        (None, "oil:T", "not known"),
    ],
)
def test_an_answer_is_marked_by_what_is_hidden(ten: Any, hidden: Any, claimed: str | None, told: str) -> None:
    claims = [{"id": claimed, "equivalent": [], "probability": 0.9}] if claimed else []
    assert ten.outcome(ten.Truth(hidden), claims) == told
