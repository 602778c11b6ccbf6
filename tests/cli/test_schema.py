from __future__ import annotations

import json
from pathlib import Path

import jsonschema
import pytest
import yaml

from ..commands import Say

PUBLISHED = Path(__file__).parents[2] / "schemas"

CAMPAIGN = """
schema: thermodata/campaign/1
id: c
sources: {daq: {reader: crio, files: "raw/{test}.tdms"}}
channels: {dZ: {source: daq, signal: Z, quantity: displacement, unit: V, axis: Z, at: tcp, calibration: z}}
calibrations: {z: {kind: jump, axis: Z, source: daq, file: raw/z.tdms, signal: Z, moves: [100 um, -100 um]}}
tests: [{id: a, kind: etve, role: calibration, conditions: {speed: 9000 rpm}, phases: {idle: [0 h, 26 h]}}]
"""


def test_the_published_documents_match_the_code(say: Say) -> None:
    assert say("schema", "--check", PUBLISHED).code == 0


def test_drift_is_named(say: Say, tmp_path: Path) -> None:
    assert say("schema", "--write", tmp_path).code == 0
    (tmp_path / "store.sql").write_text("-- edited")
    (tmp_path / "stray.json").write_text("{}")
    said = say("schema", "--check", tmp_path)
    assert said.code == 1
    assert "store.sql, stray.json differ" in said.err
    assert "schema --write" in said.err


def test_the_generated_pages_match_the_code(say: Say) -> None:
    said = say("schema", "--docs", "--check", PUBLISHED.parent / "docs")
    assert said.code == 0, said.err


def test_drift_of_a_page_is_named_and_pages_by_hand_are_let_be(say: Say, tmp_path: Path) -> None:
    assert say("schema", "--docs", "--write", tmp_path).code == 0
    (tmp_path / "by-hand.md").write_text("# Ours")
    assert say("schema", "--docs", "--check", tmp_path).code == 0
    (tmp_path / "places.md").write_text("# Old")
    said = say("schema", "--docs", "--check", tmp_path)
    assert said.code == 1
    assert "places.md differ" in said.err
    assert "schema --docs --write" in said.err


def test_a_page_is_printed_by_its_name(say: Say) -> None:
    assert say("schema", "--docs").out.split() == ["effects.md", "places.md"]
    assert say("schema", "--docs", "places.md").out.startswith("# Places and quantities")


def test_an_editor_accepts_a_campaign_and_refuses_a_typo(say: Say) -> None:
    schema = json.loads(say("schema", "campaign-1.schema.json").out)
    good = yaml.safe_load(CAMPAIGN)
    jsonschema.validate(good, schema)
    good["channels"]["dZ"]["quantitty"] = good["channels"]["dZ"].pop("quantity")
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(good, schema)


def test_the_documents_are_listed_and_an_unknown_one_refused(say: Say) -> None:
    assert set(say("schema").out.split()) == {p.name for p in PUBLISHED.iterdir()}
    assert set(json.loads(say("schema", "--json").out)) == {p.name for p in PUBLISHED.iterdir()}
    said = say("schema", "model-1.schema.jsn")
    assert said.code == 2
    assert "did you mean 'model-1.schema.json'?" in said.err
