"""Files of settings beside the logs, which nothing reads: 'sensors.yaml'. What stands in them is for a person."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from thermodata.reader.files.stores import within_stores

_SUFFIXES = (".yaml", ".yml")
_OWN = re.compile(rb"(?m)^schema: ?['\"]?thermodata/")
_HEAD, _SHOWN = 4096, 60


def settings_in(folder: Path) -> Iterator[tuple[str, str]]:
    """(path, why it is not used) of YAML files that are none of thermodata's own."""
    in_store = within_stores(folder)
    for path in sorted(p for p in folder.rglob("*.y*ml") if p.suffix.lower() in _SUFFIXES):
        inside = path.relative_to(folder)
        if any(p.startswith(".") for p in inside.parts) or in_store(path) or path.is_symlink() or not path.is_file():
            continue
        try:
            with path.open("rb") as file:
                head = file.read(_HEAD)
        except OSError:
            continue
        if _OWN.search(head):
            continue
        first = next((line.strip() for line in head.decode("utf-8", "replace").splitlines() if line.strip()), "")
        begins = f" (it begins with '{first[:_SHOWN]}')" if first else ""
        yield (
            inside.as_posix(),
            f"settings, which nothing reads{begins}: what it says of sensors or tests is yours to write",
        )
