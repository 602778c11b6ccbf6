"""MCAP whose messages don't stand in the order of their log times, and JSON that says null."""

from __future__ import annotations

import io
import json
import random
from collections.abc import Callable, Iterable

import numpy as np
import pytest
from mcap.writer import Writer

from .conftest import Lab

T0 = 1_770_000_000_000_000_000
S = 1_000_000_000
X = {"pos": {"signal": "/axis.x", "quantity": "position", "unit": "mm"}}
LOG = {"reader": "mcap"}


SCHEMA = {"type": "object", "properties": {"x": {"type": "integer"}, "on": {"type": "boolean"}}}


def recording(
    messages: Iterable[tuple[int, object]], schema: object = None, publish: Callable[[int], int] = int
) -> bytes:
    buffer = io.BytesIO()
    writer = Writer(buffer, chunk_size=4096)
    writer.start()
    known = 0 if schema is None else writer.register_schema("axis", "jsonschema", json.dumps(schema).encode())
    axis = writer.register_channel("/axis", "json", known)
    for t, message in messages:
        writer.add_message(axis, t, json.dumps(message).encode(), publish(t))
    writer.finish()
    return buffer.getvalue()


def test_messages_are_sorted_by_their_log_time_however_far_they_stand(lab: Lab) -> None:
    order = list(range(2000))
    random.Random(3).shuffle(order)
    lab.write("raw/a.mcap", recording((T0 + k * S // 10, {"x": k / 8}) for k in order))
    said = lab.ingest(X, LOG)
    assert said.code == 0, said.out + said.err
    t_s, values = lab.values("pos")
    np.testing.assert_allclose(t_s, np.arange(2000) / 10)
    np.testing.assert_array_equal(values, np.arange(2000) / 8)
    assert "out of order: sorted" in said.out
    # no doubt about any of them
    assert json.loads(lab("sql", "select max(flag) as f from sample", "--json").out) == [{"f": 0}]
    traced = json.loads(lab("trace", "odd", "one", "pos", "--at", "42.3 s", "--verify", "--json").out)
    assert traced["sample"]["value"] == 423 / 8
    assert traced["sample"]["raw"]["again"]["value"] == 423 / 8


@pytest.mark.parametrize("schema", [None, SCHEMA])
def test_null_in_a_field_of_integers_is_no_value(lab: Lab, schema: object) -> None:
    numbers = [None if k % 7 == 3 and k > 50 else k for k in range(200)]
    lab.write("raw/a.mcap", recording(((T0 + k * S, {"x": n}) for k, n in enumerate(numbers)), schema))
    assert lab.ingest(X, LOG).code == 0
    _, values = lab.values("pos")
    np.testing.assert_array_equal(values, [np.nan if n is None else n for n in numbers])


def test_null_in_a_field_of_integers_that_only_comes_late_is_no_value(lab: Lab) -> None:
    numbers = [None if k % 100 == 77 and 13_000 < k < 14_000 else k for k in range(30_000)]
    messages = ((T0 + k * S, {"x": n, "text": "a" * 600}) for k, n in enumerate(numbers))
    lab.write("raw/a.mcap", recording(messages))
    lab.ingest(X, LOG)
    _, values = lab.values("pos")
    np.testing.assert_array_equal(values, [np.nan if n is None else n for n in numbers])


def test_stamps_of_a_recorder_that_wrote_in_bursts_are_told_and_may_be_the_times(lab: Lab) -> None:
    def stamped(burst: int) -> bytes:
        stamps = [T0 + k * 10 * S for k in range(120)]
        logs = [T0 + (k // burst) * burst * 10 * S + k * 1000 + 5_000_000 for k in range(120)]
        header = [{"stamp": {"sec": t // S, "nanosec": t % S}} for t in stamps]
        return recording((log, {"header": h, "x": k / 8}) for k, (log, h) in enumerate(zip(logs, header, strict=True)))

    lab.write("raw/a.mcap", stamped(30))
    said = lab.ingest(X, LOG)
    assert "header.stamp changes its distance from them by 290 s" in said.out
    assert lab.ingest(X, {**LOG, "options": {"time": "header.stamp"}}).code == 0
    np.testing.assert_allclose(lab.values("pos")[0], np.arange(120) * 10.0)
    lab.write("raw/a.mcap", stamped(1))
    assert "changes its distance" not in lab.ingest(X, LOG).out
    drafted = lab.folder / "new"
    drafted.mkdir()
    (drafted / "b.mcap").write_bytes(stamped(30))
    lab("init", drafted)
    assert "# ? time: topic '/axis'" in (drafted / "campaign.yaml").read_text()


def test_log_times_of_boot_or_of_a_conversion_are_asked_for(lab: Lab) -> None:
    stamps = [T0 + k * 60 * S for k in range(60)]
    headers = [{"stamp": {"sec": t // S, "nanosec": 0}} for t in stamps]
    boot = recording((5 * S + k * 60 * S, {"header": h, "x": k / 8}) for k, h in enumerate(headers))
    lab.write("raw/a.mcap", boot)
    said = lab.ingest(X, {**LOG, "options": {"time": "header.stamp"}})
    assert said.code == 0, said.out
    assert "count from the start" not in said.out
    drafted = lab.folder / "new"
    drafted.mkdir()
    (drafted / "b.mcap").write_bytes(boot)
    lab("init", drafted)
    assert "options: {time: header.stamp}" in (drafted / "campaign.yaml").read_text()
    converted = ((T0 + k * S // 1000, {"x": k / 8}) for k in range(60))
    (drafted / "b.mcap").write_bytes(recording(converted, publish=lambda t: t * 60 - T0 * 59))
    lab("init", drafted, "--force")
    assert "options: {time: publish_time}" in (drafted / "campaign.yaml").read_text()
