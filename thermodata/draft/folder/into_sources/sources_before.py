"""What the sources of a campaign file are in a draft made anew: of the same files by another name, or none of it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from thermodata.schema.files.tests_from import pattern_of


def files_of_sources(data: Mapping[str, Any]) -> dict[str, tuple[str, ...]]:
    """Source -> its patterns, and those of its tests. data: of a campaign file, which need not be finished."""
    sources = data.get("sources")
    found: dict[str, tuple[str, ...]] = {}
    for name, spec in (sources if isinstance(sources, dict) else {}).items():
        if isinstance(spec, dict):
            own = [*_listed(spec.get("files"))]
            for test in _listed(data.get("tests")):
                files = test.get("files") if isinstance(test, dict) else None
                own += _listed(files.get(name)) if isinstance(files, dict) else []
            found[str(name)] = tuple(str(p) for p in own)
    return found


def names_in_draft(own: Mapping[str, Any], base: Mapping[str, Any]) -> dict[str, str]:
    """Source of a campaign file -> what the draft calls it, where it has the same files by another name."""
    before, now = files_of_sources(own), files_of_sources(base)
    found: dict[str, str] = {}
    for name, files in before.items():
        same = [n for n, f in now.items() if n not in before and files and set(f) == set(files)]
        if name not in now and len(same) == 1:
            found[name] = same[0]
    return found


def added_sources(
    own: Mapping[str, Any], base: Mapping[str, Any], names: Mapping[str, str]
) -> Iterator[tuple[str, Mapping[str, Any]]]:
    """(name, entry) of the sources that the draft does not have. names: those that it calls otherwise."""
    now = files_of_sources(base)
    yield from (
        (n, own["sources"][n]) for n, files in files_of_sources(own).items() if files and n not in {*now, *names}
    )


def who_reads(entry: Mapping[str, Any], draft: Mapping[str, Any]) -> str | None:
    """The source of a draft that has files of a source."""
    drafted = [(name, path) for name, paths in files_of_sources(draft).items() for path in paths]
    return next((name for name, a in drafted for b in _listed(entry.get("files")) if _meet(a, str(b))), None)


def with_sources_called(value: Any, names: Mapping[str, str]) -> Any:
    """A part of a campaign file with other names for its sources. names: as they are -> as they shall be."""
    if isinstance(value, list):
        return [with_sources_called(one, names) for one in value]
    if not isinstance(value, dict):
        return value
    made = {k: with_sources_called(v, names) for k, v in value.items()}
    if isinstance(made.get("source"), str):
        made["source"] = names.get(made["source"], made["source"])
    if isinstance(made.get("files"), dict):
        made["files"] = {names.get(k, k): v for k, v in made["files"].items()}
    return made


def sources_in(value: Any) -> Iterator[str]:
    """The sources that a part of a campaign file names."""
    if isinstance(value, dict):
        yield from ([value["source"]] if isinstance(value.get("source"), str) else [])
        yield from (str(k) for k in value["files"]) if isinstance(value.get("files"), dict) else ()
    for one in value.values() if isinstance(value, dict) else value if isinstance(value, list) else ():
        yield from sources_in(one)


def _meet(a: str, b: str) -> bool:
    """Whether two patterns may be of one file."""
    return a == b or pattern_of(a).fullmatch(b) is not None or pattern_of(b).fullmatch(a) is not None


def _listed(value: Any) -> list[Any]:
    return [] if value is None else list(value) if isinstance(value, list) else [value]


__all__ = ["added_sources", "files_of_sources", "names_in_draft", "sources_in", "who_reads", "with_sources_called"]
