"""Settings beside the logs are said to be there; our own files are not."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from tests.draft.labs import numbers, text
from thermodata.draft.make import draft_files


def test_a_file_of_settings_is_named_and_our_own_is_not(tmp_path: Path) -> None:
    t = np.arange(400) * 10.0
    text(tmp_path / "V1.csv", ["t [s]", "T_hall [°C]"], [numbers(t, 0), numbers(22 + t / 1000, 2)], mark=",")
    (tmp_path / "sensors.yaml").write_text("# nest on the table\n/nest.gap: {unit: nm}\n", encoding="utf-8")
    (tmp_path / "model.yaml").write_text("schema: thermodata/model/1\nresponse: dZ\n", encoding="utf-8")
    (tmp_path / ".hidden.yml").write_text("a: 1\n", encoding="utf-8")
    draft = draft_files(tmp_path).draft
    (told,) = draft.not_used
    assert told[0] == "sensors.yaml"
    assert "it begins with '# nest on the table'" in told[1]
    assert draft.sources[0].files == "{test}.csv"
