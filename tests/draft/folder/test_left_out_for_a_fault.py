"""An ingest repeats which files of the folder the draft left out because they could not be read."""

from __future__ import annotations

from pathlib import Path

import pytest

from thermodata.draft.make import draft_files
from thermodata.schema.agreed.left_out import left_out, left_out_for_a_fault
from thermodata.store import Store
from thermodata.store.ingest.run import ingest

GOOD = "time;T_bed\n;degC\n" + "".join(f"2026-03-02T08:{i:02d}:00Z;20.{i:02d}\n" for i in range(60))
BAD = GOOD.replace(";degC", "degC")  # a cell short: which unit is whose?


@pytest.mark.parametrize("bad", [True, False])
def test_a_file_that_the_draft_could_not_read_is_told_with_every_ingest(tmp_path: Path, bad: bool) -> None:
    for k in range(3):
        (tmp_path / f"m{k}.csv").write_text(BAD if bad and k == 2 else GOOD.replace("-02T", f"-0{k + 2}T"))
    (tmp_path / "notes.txt").write_text("a remark\n")
    draft_files(tmp_path)
    for _ in range(2):
        notes = ingest(Store(tmp_path / "s", create=True), tmp_path / "campaign.yaml").notes
        said = [n for n in notes if "could not read" in n]
        assert [n.partition(";")[0] for n in said] == (
            ["in no test, for the draft could not read it: m2.csv"] if bad else []
        )


def test_only_what_is_still_in_no_test_is_told() -> None:
    fault = [left_out(f"m{k}.csv", "reader 'cnc' claims it and can't read it: torn") for k in range(2)]
    text = "\n".join(["sources: {}", *fault, left_out("n.txt", "no reader claims it")])
    assert "m0.csv, m1.csv;" in str(left_out_for_a_fault(text, []))
    assert "m0.csv" not in str(left_out_for_a_fault(text, ["m0.csv"]))
    assert left_out_for_a_fault(text, ["m0.csv", "m1.csv"]) is None
