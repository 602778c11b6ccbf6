"""`plugins show`: one plugin with all that it states, for people and as JSON."""

from __future__ import annotations

import json
import re
from typing import Any

import pytest

from ..commands import Say


def test_an_effect_is_shown_with_all_that_it_states(say: Say) -> None:
    said = say("plugins", "show", "feed_screw")
    assert said.code == 0
    for part in ("d = k F_tau{dT}", "axis.{a}.nut", "18 to 240", "um/K", "[straka2021]", "follows the feed"):
        assert part in said.out, part
    answer = json.loads(say("plugins", "show", "feed_screw", "--json").out)
    assert answer["kind"] == "effect"
    assert answer["roles"][0]["places"] == ["axis.{a}.nut", "axis.{a}.screw", "axis.{a}.bearing"]
    assert (answer["parameters"][0]["lower"], answer["parameters"][0]["upper"]) == (18.0, 240.0)
    assert answer["formats"] is None


def test_what_stands_for_several_in_a_place_is_explained(say: Say) -> None:
    said = say("plugins", "show", "spindle_friction").out
    assert "{s}spindle: any spindle, such as spindle or counter_spindle" in said
    assert "{a}: one axis letter, the same throughout" in say("plugins", "show", "feed_motor").out
    assert "{" not in say("plugins", "show", "ambient_frame").out.partition("driver  ")[2]


def test_an_effect_of_time_alone_has_no_table_of_drivers(say: Say) -> None:
    out = say("plugins", "show", "drift").out
    assert "d = k t" in out
    assert "driver" not in out


def test_a_reader_is_shown_with_formats_and_version(say: Say) -> None:
    said = say("plugins", "show", "crio")
    assert said.code == 0
    assert re.search(r"crio  \(thermodata-reader-crio \d", said.out)
    assert "LVM" in said.out
    answer = json.loads(say("plugins", "show", "reader-crio", "--json").out)
    assert (answer["kind"], answer["equation"]) == ("reader", None)
    assert any("TDMS" in f for f in answer["formats"])


def test_both_kinds_answer_with_the_same_keys(say: Say) -> None:
    effect, reader = (json.loads(say("plugins", "show", name, "--json").out) for name in ("lag", "mcap"))
    assert effect.keys() == reader.keys()


def test_an_unknown_plugin_is_answered_with_the_nearest(say: Say) -> None:
    said = say("plugins", "show", "spindel_bearing")
    assert said.code == 2
    assert "did you mean 'spindle_bearing'" in said.err
    said = say("plugins", "show")
    assert said.code == 2
    assert "which plugin?" in said.err


def _row(kind: str, error: str | None = None) -> dict[str, Any]:
    return {"kind": kind, "name": "foo", "distribution": "d", "version": "1", "about": None, "error": error}


def test_one_that_does_not_load_is_shown_with_its_error(say: Say, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("thermodata.cli.keep.plugins.installed", lambda: [_row("effect", "ImportError: no bar")])
    said = say("plugins", "show", "foo")
    assert said.code == 0
    assert "does not load: ImportError: no bar" in said.out


def test_a_name_of_two_plugins_asks_which(say: Say, monkeypatch: pytest.MonkeyPatch) -> None:
    rows = [_row("effect", "broken"), _row("reader")]
    monkeypatch.setattr("thermodata.cli.keep.plugins.installed", lambda: rows)
    said = say("plugins", "show", "foo")
    assert said.code == 2
    assert "effect-foo or reader-foo" in said.err
    assert say("plugins", "show", "effect-foo").code == 0


def test_an_effect_of_every_model_is_said_to_need_no_plugin(say: Say) -> None:
    said = say("plugins", "show", "prediction")
    assert said.code == 2
    assert "{effect: prediction, file: FILE.csv}" in said.err
    assert "lubrication" not in said.err.partition("try:")[2]
