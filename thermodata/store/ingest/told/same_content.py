"""One recording under the names of two tests: what is fitted to one foretells the other, whatever it is."""

from __future__ import annotations

from collections.abc import Mapping, Sequence


def same_content(files: Mapping[str, Sequence[str]], hashes: Mapping[str, str]) -> list[str]:
    """Sentences for the summary of an ingest. files: test -> source paths; hashes: source path -> SHA-256. A file that
    several tests name is shared on purpose."""
    found: dict[tuple[str, str], list[str]] = {}
    first: dict[str, tuple[str, str]] = {}
    for test, paths in files.items():
        for path in paths:
            if path not in hashes:
                continue
            before, there = first.setdefault(hashes[path], (test, path))
            if before != test and there != path:
                found.setdefault((before, test), []).append(f"{path} is {there}")
    return [
        f"tests '{one}' and '{other}' hold the same recording: {', '.join(same)} (equal to the last byte); neither "
        "confirms what was fitted to the other: take one of them away, or put the right file in its place"
        for (one, other), same in found.items()
    ]
