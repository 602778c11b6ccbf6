"""The installed effects, by name. One that fails to load is a warning, never a crash."""

from __future__ import annotations

import hashlib
import inspect
import sys
import warnings
from collections.abc import Sequence
from difflib import get_close_matches
from functools import lru_cache
from importlib.metadata import EntryPoint, entry_points
from pathlib import Path

from thermodata.errors import FAILED, PluginError, UsageError, unknown_name
from thermodata.plugin import Effect

GROUP = "thermodata.effect"
_A_SLIP = 0.75  # of two names that differ by slips: how alike their letters are
INSTALL = "pip install thermodata-effects-machine-tool"


def effects() -> dict[str, Effect]:
    """The effects that diagnosis asks for, by name, in alphabetical order: all but those that say `asked = False`."""
    return {name: found for name, found in _load()[0].items() if getattr(found, "asked", True)}


def all_effects() -> dict[str, Effect]:
    """Every effect that loads, by name, in alphabetical order: what a model file may name."""
    return dict(_load()[0])


def failed_effects() -> dict[str, str]:
    """Entry points that did not load: name -> reason."""
    return dict(_load()[1])


def effect(name: str) -> Effect:
    """One effect. UsageError names the installed ones and the nearest; with none installed, says what installs them."""
    found, failed = _load()
    if name in found:
        return found[name]
    if name in failed:
        raise PluginError(f"effect '{name}' does not load", got=failed[name], hint="thermodata plugins")
    if not found:
        raise UsageError(f"no effect '{name}': no effects are installed", hint=INSTALL)
    unknown = unknown_name("effect", name, list(found), near=_nearest_effect)
    unknown.hint = (
        f"{unknown.hint} " if unknown.hint else ""
    ) + "if a plugin has it that is not installed here: pip install that plugin; 'thermodata plugins' lists what is"
    raise unknown


def _nearest_effect(word: str, choices: Sequence[str]) -> str | None:
    """The effect that is spelt nearly so, or has the word in its name: one of a plugin that is not installed is no slip
    of another one (ownheat, coolant_heat)."""
    own = word.lower()
    of_word = (name for name in choices if own in name.split("_"))
    return next(iter(get_close_matches(own, choices, n=1, cutoff=_A_SLIP)), None) or next(of_word, None)


def origin(effect: Effect) -> str:
    """Where an effect comes from: 'thermodata-effect-foo 0.1.0 (thermodata_effect_foo:Foo)'; its class where no entry
    point has its name."""
    for entry in entry_points(group=GROUP):
        if entry.name == effect.name:
            return f"{entry.dist.name} {entry.dist.version} ({entry.value})" if entry.dist is not None else entry.value
    return f"{type(effect).__module__}:{type(effect).__qualname__}"


@lru_cache(maxsize=1)
def code() -> str:
    """A hash of the files that the effects are written in: an answer stands for the equations that it was made with."""
    found = all_effects()
    classes = {type(one).__module__ for one in found.values()}
    # an instance may be made with its law, and its class come from another package
    named = {entry.module for entry in entry_points(group=GROUP) if entry.name in found}
    files = {file for module in classes | named for file in _files(module)}
    digests = sorted(hashlib.sha256(file.read_bytes()).hexdigest() for file in files)
    return hashlib.sha256("".join(digests).encode()).hexdigest()


def _files(name: str) -> set[Path]:
    """All of a module's package, for an equation may stand beside its class. None of what was made at run time."""
    try:
        file = Path(inspect.getfile(sys.modules[name]))
    except (KeyError, TypeError, OSError):
        return set()
    module = file.parent if file.name == "__init__.py" else file
    depth = name.count(".")
    within = module.parents[depth - 1] if depth else module
    if within.is_dir():
        return set(within.rglob("*.py"))
    return {within} if within.is_file() else set()


@lru_cache(maxsize=1)
def _load() -> tuple[dict[str, Effect], dict[str, str]]:
    found: dict[str, Effect] = {}
    failed: dict[str, str] = {}
    for entry in sorted(entry_points(group=GROUP), key=lambda e: e.name):
        try:
            loaded = _loaded(entry)
            if loaded.name in found:
                raise PluginError(f"a second effect is named '{loaded.name}'", got=entry.value)
            found[loaded.name] = loaded
        except FAILED as error:
            failed[entry.name] = f"{type(error).__name__}: {error}"
            warnings.warn(f"effect '{entry.name}' ({entry.value}) does not load: {error}", stacklevel=3)
    return found, failed


def _loaded(entry: EntryPoint) -> Effect:
    target = entry.load()
    made = target() if isinstance(target, type) else target
    if not isinstance(made, Effect):
        raise PluginError("not an effect", expected="the attributes of thermodata.plugin.Effect", got=repr(made))
    if made.name != entry.name:
        raise PluginError("entry point and effect differ in name", expected=entry.name, got=made.name)
    return made
