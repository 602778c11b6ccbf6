"""What an error that a user meets says beside what is wrong, read off the code."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from inspect import isclass
from pathlib import Path

import pytest

from thermodata import errors
from thermodata.errors import EffectError, PluginError, ThermodataError

ROOT = Path(__file__).resolve().parents[1]
SAY_IT = {"expected", "hint"}
OF_PLUGINS = {PluginError.__name__, EffectError.__name__}  # these say whom to tell
NOBODY_MEETS = {  # caught where they are raised, or a programmer's
    "another commit came meanwhile",
    "what a scaling makes of it is not known here",
    "{self.name} as a part of the model is asked by tests, not by drivers",
    "a model inside of a model is not fitted here",
    "'{name}' is missing",
}
KINDS = {n for n, one in vars(errors).items() if isclass(one) and issubclass(one, ThermodataError)} - OF_PLUGINS


def raised(text: str) -> Iterator[tuple[int, str, set[str | None]]]:
    """(line, what is said first, by which names it goes on) of each error of ours that is raised with its own words."""
    for node in ast.walk(ast.parse(text)):
        call = node.exc if isinstance(node, ast.Raise) else None
        if not (isinstance(call, ast.Call) and isinstance(call.func, ast.Name) and call.func.id in KINDS):
            continue
        if call.args and isinstance(call.args[0], ast.Constant | ast.JoinedStr):
            words = ast.unparse(call.args[0]).removeprefix("f")[1:-1]
            yield node.lineno, words, {keyword.arg for keyword in call.keywords}


@pytest.mark.parametrize("folder", ["thermodata", *(str(p.relative_to(ROOT)) for p in ROOT.glob("plugins/*/src"))])
def test_an_error_says_what_is_expected_or_what_to_try(folder: str) -> None:
    bare = [
        f"{path.relative_to(ROOT)}:{line}: {words}"
        for path in sorted((ROOT / folder).rglob("*.py"))
        for line, words, said in raised(path.read_text("utf-8"))
        if not said & SAY_IT and None not in said and words not in NOBODY_MEETS
    ]
    assert bare == []


def test_an_error_without_both_is_seen() -> None:
    assert list(raised('raise UsageError(f"no {name}", got=name)')) == [(1, "no {name}", {"got"})]


def test_a_fault_of_a_plugin_says_whose_it_is_unless_it_knows_better() -> None:
    assert "tell its author" in str(PluginError("reader 'foo' broke the rule"))
    assert "tell its author" not in str(PluginError("effect 'foo' does not load", hint="thermodata plugins"))
