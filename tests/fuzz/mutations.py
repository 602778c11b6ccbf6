"""Mutations that need no knowledge of a format: pieces for a format's own `mutate`."""

from __future__ import annotations

import random

JUNK = (b"\0" * 16, b"\xff" * 7, b"\n\n\n", b";;;,,,\t\t", b"NaN", b"1e999", "µ°č中".encode(), b'"', b"\r", b"\x1a")


def cut(data: bytes, rng: random.Random) -> bytes:
    """The first part of a file, cut anywhere."""
    return data[: rng.randrange(len(data) + 1)]


def flip(data: bytes, rng: random.Random, start: int = 0, stop: int | None = None, most: int = 4) -> bytes:
    """Up to `most` bytes between start and stop overwritten."""
    changed = bytearray(data)
    end = len(data) if stop is None else min(stop, len(data))
    for _ in range(rng.randint(1, most) if start < end else 0):
        changed[rng.randrange(start, end)] = rng.randrange(256)
    return bytes(changed)


def insert(data: bytes, rng: random.Random, at: int | None = None) -> bytes:
    """Junk put between two bytes, anywhere or at a place."""
    where = rng.randrange(len(data) + 1) if at is None else at
    junk = rng.choice((*JUNK, rng.randbytes(rng.randint(1, 64))))
    return data[:where] + junk + data[where:]


def drop(data: bytes, start: int, stop: int) -> bytes:
    """Without the bytes from start to stop."""
    return data[:start] + data[stop:]


def edit_parts(parts: list[bytes], rng: random.Random, first: int = 0) -> tuple[list[bytes], str]:
    """(parts, what was done): one of lines, records or segments dropped, doubled, or swapped with another.

    first: the first part that may be touched (behind a header)."""
    done, many = list(parts), len(parts)
    if many - first < 2:
        return done, "nothing"
    i, j = rng.sample(range(first, many), 2)
    what = rng.choice(("dropped", "doubled", "swapped"))
    if what == "dropped":
        del done[i]
    elif what == "doubled":
        done.insert(i, done[i])
    else:
        done[i], done[j] = done[j], done[i]
    return done, what
