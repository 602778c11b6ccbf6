"""Files that appear whole or not at all: temporary name, fsync, rename."""

from __future__ import annotations

import hashlib
import os
import re
import secrets
from pathlib import Path

TEMPORARY = re.compile(r"^\..*\.tmp(\.wal)?$")          # DuckDB puts a .wal beside a database in the making


def temporary(target: Path) -> Path:
    """A name beside the target that nobody reads."""
    return target.with_name(f".{target.name}.{secrets.token_hex(4)}.tmp")


def publish(part: Path, target: Path) -> None:
    """Makes a finished temporary file appear under its name, on the disk and not only in its cache."""
    fd = os.open(part, os.O_RDWR)
    try:
        os.fsync(fd)
    finally:
        os.close(fd)
    part.replace(target)
    fsync_folder(target.parent)


def fsync_folder(folder: Path) -> None:
    """Writes a folder's entries to the disk, where the system knows that."""
    if os.name != "posix":
        return
    fd = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(fd)
    finally:
        os.close(fd)


def write_text(target: Path, text: str) -> None:
    """A small text file, replaced at once."""
    part = temporary(target)
    part.write_text(text, encoding="utf-8")
    publish(part, target)


def sha256_of(path: Path) -> str:
    """The SHA-256 of a file's bytes, in hexadecimal."""
    with path.open("rb") as handle:
        return hashlib.file_digest(handle, "sha256").hexdigest()


def key_of(*parts: str) -> str:
    """A content key of texts: 32 hexadecimal digits."""
    digest = hashlib.sha256()
    for part in parts:
        data = part.encode()
        digest.update(f"{len(data)}:".encode())
        digest.update(data)
    return digest.hexdigest()[:32]


def safe_name(text: str, limit: int = 60) -> str:
    """A file name part of any text: what is not a plain letter becomes '-', and a digest keeps it unique."""
    plain = re.sub(r"[^A-Za-z0-9._-]+", "-", text).strip(".-")[:limit]
    return plain if plain == text else f"{plain or 'x'}-{hashlib.sha256(text.encode()).hexdigest()[:8]}"
