"""The README's code runs, and what it names exists."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from thermodata.errors import FormatError
from thermodata.plugin import Block, Loss, Source
from thermodata.schema.files.load import load_campaign, parse_model
from thermodata.schema.strict.lines import parse_document

README = Path(__file__).parents[1].joinpath("README.md").read_text("utf-8")
BLOCKS = re.findall(r"```(\w+)\n(.*?)```", README, flags=re.DOTALL)


def block(language: str, containing: str) -> str:
    return next(text for kind, text in BLOCKS if kind == language and containing in text)


def test_its_reader_reads_and_reports_losses(tmp_path: Path) -> None:
    code = block("python", "class Reader")
    assert len(code.splitlines()) < 50
    names: dict[str, object] = {}
    exec(code, names)
    from thermodata.reader.contract.guard import guarded

    reader = names["Reader"]()  # type: ignore[operator]
    path = tmp_path / "a.foo"
    path.write_text("FOO1 T degC\n0 21.5\nbroken\n0.5 21.6\n")
    found = list(guarded(reader, path, Source()))
    blocks = [b for b in found if isinstance(b, Block)]
    assert [list(b.values["T"]) for b in blocks] == [[21.5, 21.6]]
    assert list(blocks[0].t_ns) == [0, 500_000_000]
    assert [x.where for x in found if isinstance(x, Loss)] == ["line 3"]
    path.write_text("BAR\n")
    with pytest.raises(FormatError):
        reader.describe(path, Source())


def test_its_reader_passes_the_kit_by_its_own_test(tmp_path: Path) -> None:
    (tmp_path / "my_package.py").write_text(block("python", "class Reader"))
    (tmp_path / "test_foo.py").write_text(block("python", "reader_checks"))
    (tmp_path / "sample.foo").write_text("FOO1 T degC\n" + "".join(f"{i / 2} {20 + i / 8}\n" for i in range(12)))
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "test_foo.py"],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(tmp_path)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout
    assert int(re.findall(r"(\d+) passed", done.stdout)[0]) > 20


def test_its_campaign_and_model_load(tmp_path: Path) -> None:
    path = tmp_path / "campaign.yaml"
    path.write_text(block("yaml", "campaign/1"))
    campaign = load_campaign(path)
    model = parse_model(block("yaml", "model/1"))
    assert model.campaign == campaign.id
    assert parse_document(path.read_text(), path).data["id"] == campaign.id


def test_every_command_that_it_names_exists() -> None:
    from click.testing import CliRunner

    from thermodata.cli.app import cli

    listed = CliRunner().invoke(cli, ["--help"]).output
    commands = set(
        re.findall(r"^thermodata (\w[\w-]*)", "\n".join(t for k, t in BLOCKS if k == "sh"), flags=re.MULTILINE)
    )
    assert len(commands) >= 8
    assert all(re.search(rf"^  {name} ", listed, flags=re.MULTILINE) for name in commands)
