"""A lab's folder of odd files, put through the commands as a user would."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

from thermodata.plugin import Source
from thermodata.reader import reader as named
from thermodata.reader import sniff
from thermodata.store import Store
from thermodata.testing.reader import Data, load

from ..commands import Said


@dataclass(frozen=True)
class Lab:
    """A folder with a campaign file and its store."""

    folder: Path
    say: Callable[..., Said]

    def write(self, name: str, content: str | bytes) -> Path:
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    def ingest(
        self,
        channels: Mapping[str, Mapping[str, Any]],
        source: Mapping[str, Any] | None = None,
        tests: list[dict[str, Any]] | None = None,
        **more: Any,
    ) -> Said:
        """One source 'log' of all of raw/*, and one test 'one', unless told otherwise."""
        campaign = {
            "schema": "thermodata/campaign/1",
            "id": "odd",
            "sources": {"log": {"reader": "table", "files": "raw/*", **(source or {})}},
            "channels": {name: {"source": "log", **c} for name, c in channels.items()},
            "tests": tests or [{"id": "one"}],
            **more,
        }
        self.write("campaign.yaml", yaml.safe_dump(campaign, sort_keys=False))
        return self("ingest", self.folder / "campaign.yaml")

    def __call__(self, *words: object) -> Said:
        return self.say("--store", self.folder / "store", *words)

    def values(self, channel: str, test: str = "one") -> tuple[Any, Any]:
        """(t_s, value) of a channel, as `sample` has them."""
        with Store(self.folder / "store").reader() as con:
            rows = con.execute(
                "select t_s, value from sample where test = ? and channel = ? order by t_s", [test, channel]
            ).fetchall()
        return np.array([r[0] for r in rows]), np.array([np.nan if r[1] is None else r[1] for r in rows])


@pytest.fixture
def lab(tmp_path: Path, say: Callable[..., Said]) -> Lab:
    return Lab(tmp_path / "lab", say)


@pytest.fixture
def read(tmp_path: Path) -> Callable[..., Data]:
    """read(content, name, by, **source): a file through the reader that claims it, or the one that is named."""

    def loaded(content: str | bytes, name: str = "a.csv", by: str | None = None, **source: Any) -> Data:
        path = tmp_path / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return load(named(by) if by else sniff(path), path, Source(**source))

    return loaded
