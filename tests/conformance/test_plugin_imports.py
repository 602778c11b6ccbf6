"""How the modules of our reader plugins may import each other: in no circle, neither of modules nor of folders."""

from __future__ import annotations

from collections.abc import Iterable
from graphlib import CycleError, TopologicalSorter

import grimp
import pytest

PLUGINS = ["thermodata_reader_crio", "thermodata_reader_mcap", "thermodata_reader_table"]
FLOORS = {"thermodata_reader_mcap": ("signals", "encodings", "container")}  # each imports from those behind it only


def circle(imports: Iterable[tuple[str, str]]) -> list[str]:
    """A circle among these imports (importer, imported); [] where there is none."""
    below: dict[str, set[str]] = {}
    for importer, imported in imports:
        below.setdefault(importer, set()).add(imported)
    try:
        TopologicalSorter(below).prepare()
    except CycleError as error:
        return list(error.args[1])
    return []


def siblings(importer: str, imported: str) -> tuple[str, str] | None:
    """The two parts of one folder that an import joins; None where one module is a folder of the other."""
    a, b = importer.split("."), imported.split(".")
    same = next((k for k, (x, y) in enumerate(zip(a, b, strict=False)) if x != y), None)
    return None if same is None else (".".join(a[: same + 1]), ".".join(b[: same + 1]))


def imports_of(package: str) -> list[tuple[str, str]]:
    """All imports inside of a package, those in functions and under TYPE_CHECKING too."""
    graph = grimp.build_graph(package, cache_dir=None)
    return [(a, b) for a in graph.modules for b in graph.find_modules_directly_imported_by(a)]


@pytest.mark.parametrize("package", PLUGINS)
def test_no_circle_of_modules(package: str) -> None:
    imports = imports_of(package)
    assert len(imports) > 20
    assert circle(imports) == []


@pytest.mark.parametrize("package", PLUGINS)
def test_no_circle_of_folders(package: str) -> None:
    joined = [pair for each in imports_of(package) if (pair := siblings(*each)) is not None]
    assert circle(joined) == []


@pytest.mark.parametrize("package", FLOORS)
def test_folders_import_downward(package: str) -> None:
    floor = {f"{package}.{name}": k for k, name in enumerate(FLOORS[package])}
    for importer, imported in imports_of(package):
        pair = siblings(importer, imported)
        if pair is not None and pair[0] in floor:
            assert floor[pair[0]] <= floor[pair[1]], f"{importer} imports {imported}"


def test_a_circle_is_found() -> None:
    assert circle([("a", "b"), ("b", "c")]) == []
    assert circle([("a", "b"), ("b", "c"), ("c", "a")]) != []
    crossed = [("p.x.one", "p.y.two"), ("p.y.three", "p.x.four")]  # no circle of modules, but one of folders
    assert circle(crossed) == []
    assert circle([pair for each in crossed if (pair := siblings(*each))]) != []
