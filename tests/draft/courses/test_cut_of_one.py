"""One long test: what the draft says of cutting it brings samples into each of the tests that are made of it."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import yaml

from thermodata.cli import main


def test_lines_as_the_draft_says_them_find_their_files(tmp_path: Path) -> None:
    lab = tmp_path / "lab"
    (lab / "raw").mkdir(parents=True)
    t_s = np.arange(480) * 60.0
    for name, columns in (("daq", "dZ [um],T_bearing [degC]"), ("nc", "speed [rpm],T_hall [degC]")):
        rows = np.column_stack([t_s, 10 * np.sin(t_s / 9000), 21 + 0.1 * np.sin(t_s / 4000)])
        head = f"time [s],{columns}"
        np.savetxt(lab / f"raw/day_{name}.csv", rows, fmt="%.4f", delimiter=",", header=head, comments="")
    assert main(["init", str(lab)]) == 0
    path = lab / "campaign.yaml"
    drafted = path.read_text("utf-8")
    said = re.search(r"a line each, cut where all is at rest, as (window: .*)$", drafted, flags=re.MULTILINE)
    assert said is not None
    line = said[1].split(" # ")[0]
    assert "files: {" in line
    keys = yaml.safe_load(f"{{{line}}}")
    assert {*keys["files"].values()} == {"raw/day_daq.csv", "raw/day_nc.csv"}

    head = drafted.partition("\ntests:")[0]
    first, second = line.replace("[0 h, 16 h]", "[0 h, 4 h]"), line.replace("[0 h, 16 h]", "[4 h, 8 h]")
    cut = f"  - {{id: first, kind: mixed, {first}}}\n  - {{id: second, kind: mixed, {second}}}\n"
    path.write_text(f"{head.replace('id: unknown', 'id: M1')}\ntests:\n{cut}", "utf-8")
    store = str(tmp_path / "store")
    assert main(["--store", store, "ingest", str(path)]) == 0

    lost = re.sub(r", files: \{[^}]*\}", "", cut)
    path.write_text(path.read_text("utf-8").replace(cut, lost), "utf-8")
    assert main(["--store", str(tmp_path / "other"), "ingest", str(path)]) == 3, "tests without any sample are told"
