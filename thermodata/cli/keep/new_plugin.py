"""Writes a new plugin: a member of the checkout's workspace, or a package of its own outside a checkout."""

from __future__ import annotations

import keyword
import re
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from string import Template
from typing import Any

from thermodata.errors import UsageError

TEMPLATES = Path(__file__).with_name("plugin_templates")
RULE = (
    "reader-NAME or effect-NAME; NAME of at most 24 small letters, digits and single hyphens, a letter first, "
    "such as reader-hbm2"
)
_NAME = re.compile(r"(reader|effect)-([a-z][a-z0-9]*(?:-[a-z0-9]+)*)")


@dataclass(frozen=True)
class NewPlugin:
    """folder: where the plugin is. edited: the checkout's pyproject.toml, None outside one. run: what to do next."""

    name: str
    kind: str
    distribution: str
    package: str
    folder: Path
    files: tuple[str, ...]
    edited: Path | None
    run: tuple[str, ...]


def write_plugin(name: str | None, here: Path) -> NewPlugin:
    """Writes the plugin `name` as seen from the folder `here`.

    UsageError: a bad name (with the rule), a plugin or folder that exists, a pyproject.toml that can't be edited.
    Nothing is written unless all of it can be.
    """
    match = _NAME.fullmatch(name or "")
    if name is None or match is None or len(match[2]) > 24:
        raise UsageError(
            "a new plugin needs a name" if name is None else f"'{name}' is no name for a plugin",
            expected=RULE,
            got=name,
            hint=f"thermodata plugins new {_suggested(name)}",
        )
    kind, bare = match[1], match[2].replace("-", "_")
    class_name = bare.title().replace("_", "")
    class_name += "Effect" * keyword.iskeyword(class_name)  # effect-none
    _refuse_installed(kind, bare)
    root = checkout(here)
    folder = (root / "plugins" if root else here) / name
    if folder.exists():
        raise UsageError(f"{folder.name} exists", where=str(folder), hint="take another name, or remove the folder")
    distribution, package = f"thermodata-{name}", f"thermodata_{kind}_{bare}"
    pyproject = root / "pyproject.toml" if root else None
    text = with_member(pyproject.read_text("utf-8"), distribution, str(pyproject)) if pyproject else ""
    # with `uv run` the plugin is there at once; a package of its own is installed once
    run = (
        ("uv run thermodata plugins", f"uv run pytest plugins/{name}")
        if root
        else (f"pip install -e {name}", "thermodata plugins", f"pytest {name}")
    )
    words = {
        "name": bare,
        "folder": name,
        "distribution": distribution,
        "package": package,
        "magic": bare.upper(),
        "title": bare.upper(),
        "class_name": class_name,
        "pytest": run[-1],
    }
    files = _files(kind, words)
    if root:
        files["pyproject.toml"] += "\n[tool.uv.sources]\nthermodata = { workspace = true }\n"
    for relative, content in files.items():
        path = folder / relative
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(content, encoding="utf-8", newline="\n")
    if pyproject:
        pyproject.write_text(text, encoding="utf-8", newline="")
    return NewPlugin(name, kind, distribution, package, folder, tuple(files), pyproject, run)


def checkout(here: Path) -> Path | None:
    """The checkout of thermodata that a folder is in: the nearest pyproject.toml above of the project thermodata
    with a workspace."""
    for folder in (here.resolve(), *here.resolve().parents):
        path = folder / "pyproject.toml"
        if not path.is_file():
            continue
        try:
            read = tomllib.loads(path.read_text("utf-8"))
        except (tomllib.TOMLDecodeError, UnicodeDecodeError):
            continue
        if read.get("project", {}).get("name") == "thermodata" and "workspace" in read.get("tool", {}).get("uv", {}):
            return folder
    return None


def with_member(text: str, distribution: str, where: str) -> str:
    """pyproject.toml's text with the member in the group `plugins` and in tool.uv.sources, and all else as it was:
    a line in each, where it stands in alphabetical order. UsageError where the text is laid out otherwise."""
    before = tomllib.loads(text)
    edited = _line_in(text, r"(?m)^plugins\s*=\s*\[[^\S\n]*(?:#.*)?\r?$", r"\s*\]", f'    "{distribution}",')
    edited = _line_in(
        edited, r"(?m)^\[tool\.uv\.sources\][^\S\n]*(?:#.*)?\r?$", r"\s*\[", f"{distribution} = {{ workspace = true }}"
    )
    try:
        after = tomllib.loads(edited)
    except tomllib.TOMLDecodeError:
        after = {}
    if not _differs_by(before, after, distribution):
        raise UsageError(
            "pyproject.toml is laid out in a way that is not edited here",
            where=where,
            hint=f"add \"{distribution}\" to the dependency group 'plugins' and "
            f"'{distribution} = {{ workspace = true }}' to [tool.uv.sources] by hand, "
            "then run this again",
        )
    return edited


def _line_in(text: str, opening: str, closing: str, new: str) -> str:
    """The text with a line put among those between an opening and a closing one, unless it is there."""
    found = re.search(opening, text)
    if found is None:
        return text
    lines = text[found.end() + 1 :].splitlines(keepends=True)
    end = next((i for i, line in enumerate(lines) if re.match(closing, line)), len(lines))
    while end and not lines[end - 1].strip():
        end -= 1  # blank lines before the next table stay behind it
    if any(line.strip().rstrip(",") == new.strip().rstrip(",") for line in lines[:end]):
        return text
    at = next(
        (
            i
            for i, line in enumerate(lines[:end])
            if line.strip() and not line.strip().startswith("#") and line.strip() > new.strip()
        ),
        end,
    )
    new_line = new + ("\r\n" if found[0].endswith("\r") else "\n")
    if at and not lines[at - 1].endswith("\n"):
        lines[at - 1] += "\n"
    if at and new.endswith(",") and re.search(r"[\"']\s*$", lines[at - 1]):
        lines[at - 1] = re.sub(r"([\"'])(\s*)$", r"\1,\2", lines[at - 1])  # a last item without its comma
    lines.insert(at, new_line)
    return text[: found.end() + 1] + "".join(lines)


def _differs_by(before: Mapping[str, Any], after: Mapping[str, Any], distribution: str) -> bool:
    """Whether the one difference of two documents is the member."""
    try:
        group = [*before["dependency-groups"]["plugins"]]
        sources = {**before["tool"]["uv"]["sources"], distribution: {"workspace": True}}
        wanted_group = group if distribution in group else [*group, distribution]
        same = {
            **after,
            "dependency-groups": {**after["dependency-groups"], "plugins": group},
            "tool": {**after["tool"], "uv": {**after["tool"]["uv"], "sources": before["tool"]["uv"]["sources"]}},
        }
        return (
            same == before
            and after["tool"]["uv"]["sources"] == sources
            and sorted(map(str, after["dependency-groups"]["plugins"])) == sorted(map(str, wanted_group))
        )
    except KeyError:
        return False


def _files(kind: str, words: Mapping[str, str]) -> dict[str, str]:
    places = {
        "pyproject.toml.txt": "pyproject.toml",
        "README.md.txt": "README.md",
        "sample.txt": "tests/sample.txt",
        "package.py.txt": f"src/{words['package']}/__init__.py",
        "test.py.txt": f"tests/test_{words['name']}.py",
    }
    return {
        places[path.name]: Template(path.read_text("utf-8")).substitute(words)
        for path in sorted((TEMPLATES / kind).iterdir())
    } | {f"src/{words['package']}/py.typed": ""}


def _suggested(name: str | None) -> str:
    kind = "effect" if (name or "").lower().startswith("effect") else "reader"
    bare = re.sub(r"^(thermodata[-_])?(readers?|effects?)[-_ ]?", "", (name or "").lower())
    bare = re.sub(r"[^a-z0-9]+", "-", bare).strip("-0123456789")[:24].rstrip("-")
    return f"{kind}-{bare or 'foo'}"


def _refuse_installed(kind: str, bare: str) -> None:
    from importlib.metadata import entry_points

    taken = {point.name: point.value for point in entry_points(group=f"thermodata.{kind}")}
    if bare in taken:
        raise UsageError(
            f"a {kind} '{bare}' is installed",
            got=taken[bare],
            expected="a name that is free",
            hint="take another name; taken: " + ", ".join(sorted(taken)),
        )
