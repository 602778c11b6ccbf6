"""One store, two versions of DuckDB: each step checks what the other version left, and writes more.

uv run --isolated --with duckdb==1.5.5 tests/store/two_versions.py make DIR
uv run tests/store/two_versions.py grow DIR
uv run --isolated --with duckdb==1.5.5 tests/store/two_versions.py check DIR
"""

from __future__ import annotations

import sys
from pathlib import Path

import duckdb

sys.path.insert(0, str(Path(__file__).parent))
import store_fakes

from thermodata.store import Store
from thermodata.store.ingest.run import ingest
from thermodata.store.keep.snapshot import snapshot

QUESTIONS = (
    "select channel, count(*), round(sum(value), 6) from sample where test = 'one' group by all order by all",
    "select count(*), round(avg(value), 6) from signal('shop', 'one', 'T_a')",
    "select count(*), round(sum(\"dZ\"), 6) from binned('shop', 'one', '60 s')",
    "select count(*) from aligned('shop', 'one', '60 s')",
)


def answers(store: Store) -> str:
    with store.reader() as con:
        return repr([con.execute(q).fetchall() for q in QUESTIONS])


def main(what: str, folder: Path) -> None:
    store_fakes.install()
    kept = folder / "answers.txt"
    campaign = folder / "lab/campaign.yaml"
    store = Store(folder / "store", create=what == "make")
    if what == "make":
        summary = ingest(store, store_fakes.write_campaign(folder / "lab"))
        assert summary.changed, summary
        kept.write_text(answers(store))
    expected = kept.read_text()
    assert answers(store) == expected, (answers(store), expected)
    if what == "grow":
        assert not ingest(store, campaign).changed
        campaign.write_text(campaign.read_text().replace("id: two, kind: spindle", "id: two, kind: mixed"))
        assert ingest(store, campaign).changed
        assert answers(store) == expected
    with store.reader() as con:
        kinds = con.execute("select kind from test order by test").fetchall()
    assert kinds == [("spindle",), ("spindle" if what == "make" else "mixed",)], kinds
    snapshot(store, folder / f"snapshot-{what}.duckdb")
    for other in sorted(folder.glob("snapshot-*.duckdb")):
        with duckdb.connect(str(other), read_only=True) as con:
            found = repr([con.execute(q).fetchall() for q in QUESTIONS])
        assert found == expected, (other, found)
    print(f"{what}: DuckDB {duckdb.__version__} agrees")


if __name__ == "__main__":
    if len(sys.argv) != 3 or sys.argv[1] not in ("make", "grow", "check"):
        sys.exit(__doc__)
    main(sys.argv[1], Path(sys.argv[2]))
