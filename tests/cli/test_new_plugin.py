"""`plugins new`: what it writes works at once, and is written nowhere where it should not be."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from thermodata.cli.keep.new_plugin import checkout, with_member
from thermodata.errors import UsageError

from ..commands import Say

ROOT = Path(__file__).parents[2]


@pytest.fixture
def copy(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """What of a checkout says that it is one; the current folder is inside it."""
    folder = tmp_path / "checkout"
    (folder / "plugins").mkdir(parents=True)
    (folder / "thermodata").symlink_to(ROOT / "thermodata")  # by which imports are sorted
    shutil.copy(ROOT / "pyproject.toml", folder)
    monkeypatch.chdir(folder / "plugins")
    return folder


def installed(plugin: Path) -> dict[str, str]:
    """The environment of a process in which the plugin is installed: its sources, and its entry point as an
    installer writes it."""
    project = tomllib.loads((plugin / "pyproject.toml").read_text())["project"]
    info = plugin / "src" / f"{project['name'].replace('-', '_')}-{project['version']}.dist-info"
    info.mkdir()
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {project['name']}\nVersion: {project['version']}\n")
    (info / "entry_points.txt").write_text(
        "".join(
            f"[{group}]\n" + "".join(f"{name} = {value}\n" for name, value in points.items())
            for group, points in project["entry-points"].items()
        )
    )
    return {**os.environ, "PYTHONPATH": str(plugin / "src"), "PYTHONDONTWRITEBYTECODE": "1"}


def run(plugin: Path, *words: str) -> subprocess.CompletedProcess[str]:
    environment = {**os.environ, "PYTHONPATH": str(plugin / "src"), "PYTHONDONTWRITEBYTECODE": "1"}
    return subprocess.run(
        [sys.executable, *words], capture_output=True, text=True, env=environment, cwd=plugin, check=False
    )


@pytest.mark.parametrize(
    ("name", "bare", "kind"),
    [
        ("reader-foo", "foo", "reader"),
        ("reader-hbm-2x-of-a-long-name-x", "hbm_2x_of_a_long_name_x", "reader"),
        ("effect-none", "none", "effect"),
    ],
)
def test_a_member_passes_its_kit_at_once(copy: Path, say: Say, name: str, bare: str, kind: str) -> None:
    before = (ROOT / "pyproject.toml").read_text().splitlines()
    said = say("plugins", "new", name, "--json")
    assert said.code == 0, said.err
    made = json.loads(said.out)
    plugin = copy / "plugins" / name
    assert Path(made["folder"]) == plugin
    assert all((plugin / file).is_file() for file in made["files"])

    after = (copy / "pyproject.toml").read_text().splitlines()
    assert [line for line in after if line not in before] == [
        f'    "thermodata-{name}",',
        f"thermodata-{name} = {{ workspace = true }}",
    ]
    assert [line for line in after if line in before] == before
    project = tomllib.loads((plugin / "pyproject.toml").read_text())
    assert project["tool"]["uv"]["sources"] == {"thermodata": {"workspace": True}}

    listed = subprocess.run(
        [sys.executable, "-m", "thermodata", "plugins", "--json"],
        env=installed(plugin),
        capture_output=True,
        text=True,
        check=True,
    )
    row = next(r for r in json.loads(listed.stdout) if r["name"] == bare and r["kind"] == kind)
    assert (row["distribution"], row["error"]) == (f"thermodata-{name}", None)

    tests = run(plugin, "-m", "pytest", "-q", "-p", "no:cacheprovider", "tests")
    assert tests.returncode == 0, tests.stdout
    lint = subprocess.run(
        [sys.executable, "-m", "ruff", "check", "--no-cache", f"plugins/{name}"],
        cwd=copy,
        capture_output=True,
        text=True,
        check=False,
    )
    assert lint.returncode == 0, lint.stdout
    # from the root, as the checks of the house do
    types = subprocess.run(
        [sys.executable, "-m", "mypy", "--follow-imports", "silent", str(plugin / "src" / made["package"])],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    assert types.returncode == 0, types.stdout


def test_outside_a_checkout_it_is_a_package_of_its_own(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, say: Say
) -> None:
    (tmp_path / "pyproject.toml").write_text('[project]\nname = "ours"\n')
    monkeypatch.chdir(tmp_path)
    said = say("plugins", "new", "reader-foo")
    assert said.code == 0
    assert "pip install -e reader-foo" in said.err
    project = tomllib.loads((tmp_path / "reader-foo" / "pyproject.toml").read_text())
    assert "tool" not in project or "uv" not in project["tool"]
    assert (tmp_path / "pyproject.toml").read_text() == '[project]\nname = "ours"\n'


@pytest.mark.parametrize(
    "name",
    [
        "foo",
        "Reader-foo",
        "reader-",
        "reader-Foo",
        "reader-2x",
        "reader-a--b",
        "reader-a_b",
        "../reader-foo",
        "reader-é",
        "effects-foo",
        "reader-" + 9 * "abc",
        "",
    ],
)
def test_a_bad_name_is_refused_with_the_rule(copy: Path, say: Say, name: str) -> None:
    said = say("plugins", "new", name)
    assert said.code == 2
    assert "small letters, digits and single hyphens, a letter first" in said.err
    suggested = said.err.split("thermodata plugins new ")[1].strip()
    assert say("plugins", "new", suggested).code == 0  # what it suggests is right
    assert [p.name for p in (copy / "plugins").iterdir()] == [suggested]


def test_what_is_there_stays(copy: Path, say: Say) -> None:
    assert say("plugins", "new", "reader-foo").code == 0
    pyproject = (copy / "pyproject.toml").read_text()
    readme = copy / "plugins" / "reader-foo" / "README.md"
    readme.write_text("mine")
    said = say("plugins", "new", "reader-foo")
    assert said.code == 2
    assert "reader-foo exists" in said.err
    assert readme.read_text() == "mine"
    assert (copy / "pyproject.toml").read_text() == pyproject
    taken = say("plugins", "new", "reader-table")
    assert taken.code == 2
    assert "is installed" in taken.err


def test_comments_line_ends_and_layout_of_the_project_file_stay() -> None:
    head = (
        '[project]\nname = "thermodata"\n[dependency-groups]\nplugins = [ # ours\n    "thermodata-a", # first\n'
        '    # a comment\n    "thermodata-z"\n]\n[tool.uv.workspace]\nmembers = ["plugins/*"]\n'
    )
    text = head + "\n[tool.uv.sources]   # where from\nthermodata-a = { workspace = true }\n\n[tool.x]\ny = 1\n"
    for ends in ("\n", "\r\n"):
        edited = with_member(text.replace("\n", ends), "thermodata-reader-foo", "p")
        assert edited.count(ends) == edited.count("\n") == text.count("\n") + 2
        assert [line for line in edited.split(ends) if "reader-foo" not in line] == text.split("\n")
        assert with_member(edited, "thermodata-reader-foo", "p") == edited
    last = with_member(text, "thermodata-zz", "p")
    assert tomllib.loads(last)["dependency-groups"]["plugins"] == ["thermodata-a", "thermodata-z", "thermodata-zz"]


@pytest.mark.parametrize(
    "text",
    [
        'dependency-groups = {plugins = ["thermodata-a"]}\n[tool.uv.sources]\na = 1\n',
        '[dependency-groups]\nplugins = ["thermodata-a"]\n[tool.uv.sources]\na = 1\n',
        "[dependency-groups]\nplugins = [\n]\n[tool.uv]\nsources = {a = 1}\n",
        "[tool.uv]\n",
    ],
)
def test_a_project_file_of_another_layout_is_left_alone_and_said(text: str) -> None:
    with pytest.raises(UsageError, match="by hand"):
        with_member(text, "thermodata-reader-foo", "p")


def test_the_checkout_is_found_from_below(copy: Path, tmp_path: Path) -> None:
    deep = copy / "plugins" / "x" / "y"
    deep.mkdir(parents=True)
    (copy / "plugins" / "x" / "pyproject.toml").write_text("not toml [")
    assert checkout(deep) == copy
    assert checkout(tmp_path) is None
