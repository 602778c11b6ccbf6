"""A report's file lies in the current folder, whatever its model is called."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from thermodata.export.control.names import identifier
from thermodata.report.page.write import page_name

ID = "4521b9f6cc44"


@pytest.mark.parametrize(
    "name", ["/../../../esc", "../../x", "..", "a\\..\\b", "/etc/x", "a\0b", "C:x", "x" * 300, "ž" * 300]
)
def test_a_name_leads_nowhere(tmp_path: Path, name: str) -> None:
    made = page_name(name, ID)
    assert os.path.basename(made) == made
    assert not set(made) & set("\\/:\0")
    assert made.startswith("report-")
    assert made.endswith("-4521b9f6.html")
    (tmp_path / made).write_text("")


@pytest.mark.parametrize("name", ["baseline", "V107-z_2.1", "Základ"])
def test_a_plain_name_stays(name: str) -> None:
    assert page_name(name, ID) == f"report-{name}-4521b9f6.html"


def test_a_program_for_a_control_is_named_by_the_same_rule() -> None:
    assert (identifier("/../../esc"), page_name("/../../esc", ID)) == ("esc", "report-esc-4521b9f6.html")
    assert identifier("V107-ž.1") == "V107_1"
