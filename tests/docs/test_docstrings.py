"""What others use says what it is: schema, contracts and effects have docstrings, and files' keys a meaning each."""

from __future__ import annotations

import importlib
import inspect
import json
import pkgutil
from collections.abc import Iterator
from types import ModuleType

import pytest
import thermodata_effects_machine_tool

import thermodata.effect
import thermodata.plugin
import thermodata.schema
from thermodata.schema.publish import described, documents, models


def modules() -> Iterator[ModuleType]:
    yield thermodata.plugin
    for package in (thermodata.schema, thermodata.effect, thermodata_effects_machine_tool):
        for info in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            yield importlib.import_module(info.name)


def public(module: ModuleType) -> Iterator[tuple[str, object]]:
    for name, value in vars(module).items():
        own = getattr(value, "__module__", None) == module.__name__
        if own and not name.startswith("_") and (inspect.isclass(value) or inspect.isfunction(value)):
            yield f"{module.__name__}.{name}", value


def has_words(value: object) -> bool:
    """Whether it has a docstring of its own, and not one that a dataclass or a base class gave it."""
    text = vars(value).get("__doc__") if inspect.isclass(value) else value.__doc__
    return bool(text) and not str(text).startswith(f"{getattr(value, '__name__', '')}(")


@pytest.mark.parametrize("module", list(modules()), ids=lambda m: m.__name__)
def test_public_classes_and_functions_have_docstrings(module: ModuleType) -> None:
    assert module.__doc__ or not list(public(module))
    assert [name for name, value in public(module) if not has_words(value)] == []


def test_a_class_without_a_docstring_is_found() -> None:
    class Bare(dict[str, int]): ...

    assert not has_words(Bare)
    assert not has_words(lambda: None)


@pytest.mark.parametrize("name", sorted(models()))
def test_every_key_of_a_file_has_a_meaning(name: str) -> None:
    kind = models()[name]
    lead, keys = described(kind)
    fields = {info.alias or field for field, info in kind.model_fields.items()}
    assert lead
    assert set(keys) == fields


def test_editors_are_told_each_meaning() -> None:
    schema = json.loads(documents()["campaign-1.schema.json"])
    dwell = schema["$defs"]["JumpCalibration"]["properties"]["dwell"]
    assert "[s]" in dwell["description"]
    assert "title" not in dwell
    assert schema["description"].startswith("A campaign file")
