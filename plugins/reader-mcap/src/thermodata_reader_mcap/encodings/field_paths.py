"""Where a field stands in a message: keys and places of arrays, and how far these are followed."""

from __future__ import annotations

MOST_ELEMENTS = 256  # of an array; a longer one is an image or a point cloud, no set of signals
MOST_DEPTH = 32
Path = tuple[str | int, ...]


def path_name(topic: str, path: Path) -> str:
    """'/axis' and ('pos', 0, 'z') give '/axis.pos[0].z'."""
    return topic + "".join(f"[{p}]" if isinstance(p, int) else f".{p}" for p in path)


def any_element(path: Path) -> Path:
    """A path with all elements of an array as one."""
    return tuple(0 if isinstance(part, int) else part for part in path)
