"""One recording under the names of two tests, said with every ingest (store/ingest/told/same_content.py)."""

from __future__ import annotations

import shutil
from pathlib import Path

from store_fakes import write_campaign

from thermodata.store import Store
from thermodata.store.ingest.run import ingest
from thermodata.store.ingest.told.same_content import same_content


def test_two_tests_with_the_same_file_are_named_with_it(store: Store, tmp_path: Path) -> None:
    path = write_campaign(tmp_path / "lab")
    raw = path.parent / "raw"
    shutil.copy(raw / "one_a.npz", raw / "two_a.npz")
    for _ in range(2):
        said = [n for n in ingest(store, path).notes if "hold the same recording" in n]
        assert len(said) == 1
        assert "tests 'one' and 'two'" in said[0]
        assert "raw/two_a.npz is raw/one_a.npz" in said[0]


def test_a_file_that_is_shared_on_purpose_is_no_copy() -> None:
    assert (
        same_content({"one": ["hall.csv", "a"], "two": ["hall.csv", "b"]}, {"hall.csv": "0", "a": "1", "b": "2"}) == []
    )
    assert same_content({"one": ["a", "b"]}, {"a": "1", "b": "1"}) == [], "parts of one test"
