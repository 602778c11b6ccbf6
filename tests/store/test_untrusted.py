"""What a stranger's files and campaign files may hold: a clear error or a correct result, in bounded time."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from store_fakes import START_NS, daq, times, write_log

from thermodata.errors import SpecError, ThermodataError
from thermodata.plugin import Block, Head, Recording, Signal, Source
from thermodata.store import Store
from thermodata.store.ingest.run import ingest
from thermodata.store.ingest.summary import IngestSummary

NAMES = [
    "x'; drop table file; --",
    'double "quoted"',
    "line\nbreak\ttab",
    "温度 主轴 °C",
    "Ä/ö\\ü",
    "case",
    "CASE",
    "t_ns",
    "Z__flag",
    " ",
    "%s {0} $1 ?",
    "\u202eright to left",
    "emoji 🌡",
    "a" * 1_000_000,
]


class GivenReader:
    """Yields what the test gives."""

    name, version = "given", "1"
    signals: tuple[Signal, ...] = ()
    made: list[Block] = []

    def sniff(self, head: Head) -> str | None:
        return None

    def describe(self, path: Path, source: Source) -> Recording:
        return Recording(type(self).signals, "absolute", 0)

    def blocks(self, path: Path, source: Source) -> Iterator[Block]:
        yield from type(self).made


@pytest.fixture
def given(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    """given(signals: name -> values, t_ns, channels: channel -> signal) -> summary and store."""
    from thermodata.store.ingest.reading import campaign_files

    monkeypatch.setattr(campaign_files, "find_reader", lambda name: GivenReader())

    def ingested(
        values: dict[str, Any], t_ns: Any, channels: dict[str, str], test: str = "one"
    ) -> tuple[IngestSummary, Store]:
        monkeypatch.setattr(GivenReader, "signals", tuple(Signal(n, "main", None, "float64") for n in values))
        monkeypatch.setattr(
            GivenReader,
            "made",
            [Block("main", np.asarray(t_ns, np.int64), {n: np.asarray(v, np.float64) for n, v in values.items()})],
        )
        import yaml

        (tmp_path / "lab/raw").mkdir(parents=True, exist_ok=True)
        (tmp_path / "lab/raw/x.dat").write_bytes(b"x")
        campaign = {
            "schema": "thermodata/campaign/1",
            "id": "c",
            "sources": {"s": {"reader": "given", "files": "raw/x.dat"}},
            "tests": [{"id": test}],
            "channels": {
                c: {"source": "s", "signal": s, "quantity": "temperature", "unit": "degC"} for c, s in channels.items()
            },
        }
        path = tmp_path / "lab/campaign.yaml"
        path.write_text(yaml.safe_dump(campaign, allow_unicode=True), encoding="utf-8")
        store = Store(tmp_path / "store", create=True)
        return ingest(store, path), store

    return ingested


def sampled(store: Store, channel: str) -> list[tuple[Any, ...]]:
    with store.reader() as con:
        return con.execute("select t_s, value from sample where channel = ? order by t_s", [channel]).fetchall()


def test_names_of_any_kind_are_kept_and_found(given: Any) -> None:
    values = {name: np.arange(5.0) + i for i, name in enumerate(NAMES)}
    channels = {f"c{i}": name for i, name in enumerate(NAMES)}
    summary, store = given(values, times(5), channels)
    assert summary.losses == []
    for i in range(len(NAMES)):
        assert [v for _, v in sampled(store, f"c{i}")] == [i + k for k in range(5)]
    with store.reader() as con:
        kept = {r[0] for r in con.execute("select signal from channel").fetchall()}
    assert kept == set(NAMES)


def test_a_missing_name_beside_monsters_is_a_short_message(given: Any) -> None:
    summary, _ = given({name: np.arange(3.0) for name in NAMES}, times(3), {"c0": "emoji"})
    assert len(str(summary.losses)) < 20_000


def test_nan_and_infinity_stay_in_the_raw_layer_and_are_no_number_in_the_tidy_one(given: Any) -> None:
    import pyarrow.parquet as pq

    values = [1.0, np.nan, np.inf, -np.inf, 1.7e308, -1.7e308, 5e-324, -0.0]
    summary, store = given({"v": values}, times(len(values)), {"T_a": "v"})
    assert summary.losses == []
    found = sampled(store, "T_a")
    assert [v for _, v in found] == [1.0, None, None, None, 1.7e308, -1.7e308, 5e-324, -0.0]
    with store.reader() as con:
        path = con.execute("select path from file where layer = 'raw'").fetchall()[0][0]
    np.testing.assert_array_equal(pq.read_table(store.path / path)["v"].to_numpy(), values)


@pytest.mark.parametrize(
    "t_ns",
    [
        [-(2**63) + 2, 0, 2**63 - 2],  # the limits of what 64 bits tell
        [-9_214_560_000_000_000_000, -9_214_560_000_000_000_000 + 10**9],  # 1678
        [9_214_646_400_000_000_000, 9_214_646_400_000_000_000 + 10**9],  # 2262
        [0, 1],
        [START_NS, START_NS + 9 * 10**18 - START_NS],
    ],
)
def test_times_at_the_limits_are_right_or_refused(given: Any, t_ns: list[int]) -> None:
    try:
        summary, store = given({"v": np.arange(float(len(t_ns)))}, t_ns, {"T_a": "v"})
    except ThermodataError:
        return
    if summary.losses:
        return
    found = sampled(store, "T_a")
    assert [v for _, v in found] == list(range(len(t_ns)))
    assert [t for t, _ in found] == [(t - t_ns[0]) / 1e9 for t in t_ns]
    with store.reader() as con:
        stored = con.execute("select epoch_ns(t) from sample order by t").fetchall()
    assert [t for (t,) in stored] == t_ns


@pytest.mark.parametrize("test", ["x'; drop table test; --", "Zkouška 23 °C 日本", 'a"b', "sp 9000, 1.5 $x"])
def test_ids_of_tests_are_only_names(given: Any, test: str) -> None:
    summary, store = given({"v": [1.0, 2.0]}, times(2), {"T_a": "v"}, test)
    assert summary.losses == []
    with store.reader() as con:
        assert con.execute("select count(*) from signal('c', ?, 'T_a')", [test]).fetchone() == (2,)
        assert con.execute("select test from test").fetchall() == [(test,)]


@pytest.mark.parametrize("test", ["../x", "a/b", "..", "c:\\x", "a*", "{x}"])
def test_ids_that_could_be_paths_or_patterns_are_refused(given: Any, test: str) -> None:
    with pytest.raises(SpecError):
        given({"v": [1.0]}, times(1), {"T_a": "v"}, test)


def test_many_channels_of_which_few_are_wanted(given: Any) -> None:
    """5,000 here; `tests/hardening/wide.py` takes 100,000."""
    n = 5_000
    values = {f"group {i // 100}/signal {i}": [float(i), i + 1.0] for i in range(n)}
    summary, store = given(values, times(2), {f"c{k}": f"group {k}/signal {100 * k}" for k in range(10)})
    assert summary.losses == []
    assert sampled(store, "c7") == [(0.0, 700.0), (1.0, 701.0)]


@pytest.mark.parametrize(
    "bomb",
    [
        "a: &a [x, x, x, x, x, x, x, x, x]\n"
        + "".join(f"{chr(98 + i)}: &{chr(98 + i)} [{', '.join(['*' + chr(97 + i)] * 9)}]\n" for i in range(12)),
        "notes: " + "[" * 5000,
        "notes: " + "{a: " * 200 + "1" + "}" * 200,
        "notes: !!python/object/apply:os.system [id]",
        "<<: &x {<<: *x}",
    ],
)
def test_a_campaign_file_that_is_a_bomb_is_refused(store: Store, campaign: Path, bomb: str) -> None:
    campaign.write_text(campaign.read_text() + "\n" + bomb)
    with pytest.raises(SpecError):
        ingest(store, campaign)
    assert store.generation == 0


def test_a_pattern_that_fits_thousands_of_files(store: Store, campaign: Path) -> None:
    """None is silently left out, and the time grows with their number, not with its square."""
    raw = campaign.parent / "raw"
    for i in range(3000):
        (raw / f"one_{i:05d}.npz").write_bytes(b"no log")
    summary = ingest(store, campaign)
    told = {loss["file"] for loss in summary.losses} | {note.split(":")[0] for note in summary.notes}
    assert {f"raw/one_{i:05d}.npz" for i in range(3000)} <= told
    assert summary.samples == 2 * (3 * 1200 + 2 * 130)


def test_a_deep_folder_of_links_in_a_circle_ends(store: Store, campaign: Path) -> None:
    (campaign.parent / "raw/again").symlink_to(campaign.parent / "raw", target_is_directory=True)
    campaign.write_text(campaign.read_text().replace("raw/{test}_*.npz", "raw/**/{test}_*.npz"))
    summary = ingest(store, campaign)
    assert summary.samples == 2 * (3 * 1200 + 2 * 130)
    write_log(campaign.parent / "raw/one_b.npz", daq(5, start_s=5000))
    assert ingest(store, campaign).changed
