"""How the effects of a model are called in its answers."""

from __future__ import annotations

from collections.abc import Iterable

from thermodata.errors import SpecError


def ids_of(effects: Iterable[tuple[str, str | None]]) -> list[str]:
    """Of each (effect, given id): the given id, else the effect's name, numbered from the second on. SpecError where
    two are given one id."""
    listed, ids = list(effects), list[str]()
    taken = {given for _, given in listed if given}
    for effect, given in listed:
        name, k = given or effect, 1
        if given and name in ids:
            raise SpecError(f"two effects have the id '{name}'", hint="give each its own id")
        while not given and (name in ids or name in taken):
            k += 1
            name = f"{effect}_{k}"
        ids.append(name)
    return ids
