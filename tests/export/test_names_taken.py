"""What is called as what stands beside it in a file loses nothing."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from thermodata.export.content import Content, Stream, read_content
from thermodata.export.mat import variables
from thermodata.store import Store
from thermodata.store.ingest.run import ingest
from thermodata.view import StoreView

TIMES = np.arange(3.0)


def content(*streams: Stream, **conditions: float) -> Content:
    return Content("c", "t", {}, conditions, {k: f"{v} rpm" for k, v in conditions.items()}, {}, None, "30 s", streams)


def test_a_channel_called_as_what_describes_the_others_has_a_number() -> None:
    named = ("time", "units", "channels", "flags", "about", "dZ")
    values = {name: np.full(3, float(k)) for k, name in enumerate(named)}
    found = variables(content(Stream("grid", TIMES, values, {})))
    assert found["time"][:, 0].tolist() == TIMES.tolist()
    for k, name in enumerate(named):
        assert found[name if name == "dZ" else f"{name}_2"][0, 0] == k
    assert set(found["units"]) == {"time"}


def test_streams_and_conditions_of_one_name_are_both_there() -> None:
    streams = [Stream(name, TIMES, {"x": np.full(3, float(k))}, {}) for k, name in enumerate(["a-b", "a_b", "about"])]
    found = variables(content(*streams, **{"speed 1": 1.0, "speed-1": 2.0}))
    assert [found[name]["x"][0, 0] for name in ("a_b", "a_b_2", "about_2")] == [0, 1, 2]
    assert found["about"]["conditions"] == {"speed_1": 1.0, "speed_1_2": 2.0}
    assert set(found["about"]["condition_units"]) == {"speed_1", "speed_1_2"}


def test_a_stream_whose_source_and_name_spell_another_is_told_apart(tmp_path: Path) -> None:
    """Groups `c` of source `a_b`, and `b_c` of source `a`."""
    import nptdms

    for file, group in (("one", "c"), ("two", "b_c")):
        with nptdms.TdmsWriter(tmp_path / f"{file}.tdms") as out:
            for name in (group, "other"):
                wave = {"wf_start_time": np.datetime64("2026-03-02T08:00:00"), "wf_increment": 1.0}
                out.write_segment([nptdms.ChannelObject(name, "T", np.arange(50.0), properties=wave)])
    (tmp_path / "c.yaml").write_text(
        "schema: thermodata/campaign/1\nid: c\nsources:\n"
        "  a_b: {reader: crio, files: one.tdms}\n  a: {reader: crio, files: two.tdms}\nchannels:\n"
        "  one: {source: a_b, signal: c/T, quantity: temperature, unit: degC}\n"
        "  two: {source: a, signal: b_c/T, quantity: temperature, unit: degC}\n"
        "tests: [{id: t, files: {a_b: one.tdms, a: two.tdms}}]\n"
    )
    store = Store(tmp_path / "store", create=True)
    ingest(store, tmp_path / "c.yaml")
    streams = read_content(StoreView(store), "c", "t", "logged").streams
    assert sorted(s.name for s in streams) == ["a_b_c", "a_b_c_2"]
