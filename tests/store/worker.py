"""A process of its own for the store's tests: `worker.py ingest STORE CAMPAIGN`, `worker.py read STORE CAMPAIGNS`."""

from __future__ import annotations

import sys
from pathlib import Path

import store_fakes

from thermodata.store import Store
from thermodata.store.ingest.run import ingest


def main(what: str, store: str, argument: str) -> None:
    store_fakes.install()
    if what == "ingest":
        opened = Store(store, create=True)
        print("ready", flush=True)
        print(ingest(opened, Path(argument), lambda text: print(text, flush=True)).changed, flush=True)
        return
    opened = Store(store)
    campaigns = 0
    while campaigns < int(argument):
        # the tables and the views of a reader are always of one commit
        with opened.reader() as con:
            (campaigns,) = con.execute("select count(*) from campaign").fetchone() or (0,)
            tests = con.execute("select count(*) from test").fetchone()
            rows = con.execute("select count(distinct (campaign, test)) from sample").fetchone()
            assert tests == rows, (tests, rows)
    print("read", flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
