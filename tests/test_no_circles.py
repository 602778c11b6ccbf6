"""No circle of imports anywhere: not between modules and not between packages, in the core and in every plugin.

Imports inside functions and under TYPE_CHECKING count: what needs them to be so has its parts in the wrong order.
import-linter holds the core's packages too; it knows nothing of a package's own `__init__`, nor of the plugins.
"""

from __future__ import annotations

from collections.abc import Mapping, Set
from importlib.metadata import entry_points

import grimp
import pytest

GROUPS = ("thermodata.reader", "thermodata.effect")
PACKAGES = sorted(
    {"thermodata"}
    | {
        point.value.partition(":")[0].partition(".")[0]
        for group in GROUPS
        for point in entry_points(group=group)
        if point.value.startswith(("thermodata_reader_", "thermodata_effects_"))
    }
)


def circles(imports: Mapping[str, Set[str]]) -> list[list[str]]:
    """Groups of names that import each other, directly or round about (strongly connected, two at least)."""
    reached: dict[str, set[str]] = {}
    for name in imports:
        seen: set[str] = set()
        ahead = [*imports[name]]
        while ahead:
            step = ahead.pop()
            if step not in seen:
                seen.add(step)
                ahead += imports[step]
        reached[name] = seen
    groups = {frozenset(b for b in reached[a] if a in reached[b]) | {a} for a in imports if a in reached[a]}
    return sorted(sorted(group) for group in groups)


def between(graph: grimp.ImportGraph, package: str) -> dict[str, set[str]]:
    """What the children of a package import of each other, each with all that is below it."""
    children = graph.find_children(package)
    below = {module: child for child in children for module in {child, *graph.find_descendants(child)}}
    found: dict[str, set[str]] = {child: set() for child in children}
    for module, child in below.items():
        found[child] |= {below[m] for m in graph.find_modules_directly_imported_by(module) if m in below} - {child}
    return found


def test_circles_are_found() -> None:
    assert circles({"a": {"b"}, "b": {"c"}, "c": set()}) == []
    assert circles({"a": {"b"}, "b": {"c"}, "c": {"b"}, "d": {"e"}, "e": {"f"}, "f": {"d", "a"}}) == [
        ["b", "c"],
        ["d", "e", "f"],
    ]


def test_circles_between_packages_are_found_where_modules_have_none() -> None:
    graph = grimp.ImportGraph()
    for module in ("p", "p.left", "p.left.a", "p.left.b", "p.right", "p.right.c", "p.right.d"):
        graph.add_module(module)
    graph.add_import(importer="p.left.a", imported="p.right.c")
    assert circles(between(graph, "p")) == []
    graph.add_import(importer="p.right.d", imported="p.left.b")
    assert circles(between(graph, "p")) == [["p.left", "p.right"]]


def test_all_of_ours_are_looked_at() -> None:
    assert len(PACKAGES) >= 6, PACKAGES


@pytest.mark.parametrize("package", PACKAGES)
def test_no_modules_import_each_other(package: str) -> None:
    graph = grimp.build_graph(package)
    assert circles({m: graph.find_modules_directly_imported_by(m) for m in graph.modules}) == []


@pytest.mark.parametrize("package", PACKAGES)
def test_no_packages_import_each_other(package: str) -> None:
    graph = grimp.build_graph(package)
    assert [group for each in sorted(graph.modules) for group in circles(between(graph, each))] == []
