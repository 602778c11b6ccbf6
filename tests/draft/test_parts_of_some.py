"""A recording that was started anew in one test only: its parts have numbers, the files of other tests have none."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from thermodata.draft.make import draft_files


def write(folder: Path, name: str, start: str, rows: int) -> None:
    head = [f"T0:\t{start}", "", "Zeit [s]\tWeg Z [um]"]
    values = "\n".join([*head, *(f"{5 * i}.0\t{np.sin(i / 99):.3f}" for i in range(rows)), ""])
    (folder / name).write_text(values)


def test_parts_of_one_test_are_its_files_and_the_others_keep_theirs(tmp_path: Path) -> None:
    write(tmp_path, "V1_Weg.asc", "07.04.2026 08:00:00", 1200)
    write(tmp_path, "V2_Weg_1.asc", "08.04.2026 08:00:00", 600)
    write(tmp_path, "V2_Weg_2.asc", "08.04.2026 08:50:40", 600)
    write(tmp_path, "V3_Weg.asc", "09.04.2026 08:00:00", 1200)
    for test, day in (("V1", 7), ("V2", 8), ("V3", 9)):
        at = np.datetime64(f"2026-04-{day:02d}T08:00") + np.arange(0, 6000, 60).astype("timedelta64[s]")
        rows = "\n".join(["time;Hall air [degC]", *(f"{t};{20 + i / 400:.2f}" for i, t in enumerate(at)), ""])
        (tmp_path / f"{test}_air.csv").write_text(rows)
    draft = draft_files(tmp_path).draft
    assert [t.id for t in draft.tests] == ["V1", "V2", "V3"]
    assert {s.files for s in draft.sources} == {"{test}_Weg*.asc", "{test}_air.csv"}


def test_numbers_of_files_that_ran_at_once_are_none_of_parts(tmp_path: Path) -> None:
    for name in ("V1_Weg", "V2_Weg_1", "V2_Weg_2", "V3_Weg"):
        write(tmp_path, f"{name}.asc", f"0{6 + int(name[1])}.04.2026 08:00:00", 600)
    assert len(draft_files(tmp_path).draft.tests) == 4
