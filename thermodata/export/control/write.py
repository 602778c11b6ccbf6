"""A control program as files, in the language that was asked for."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from thermodata.errors import UsageError
from thermodata.export.control.c import c_files
from thermodata.export.control.data import json_text, write_mat
from thermodata.export.control.program import Program
from thermodata.export.control.python import python_module
from thermodata.export.control.st import structured_text
from thermodata.store.base.files import whole_file


@dataclass(frozen=True)
class Target:
    """suffix: of the file; real: of numbers where nothing is asked for; None: nothing can be asked for."""

    suffix: str
    real: str | None
    texts: Callable[[Program, str], dict[str, str]] | None


TARGETS: dict[str, Target] = {
    "st": Target(".st", "real", lambda p, real: {f"{p.name}.st": structured_text(p, real.upper())}),
    "scl": Target(".scl", "real", lambda p, real: {f"{p.name}.scl": structured_text(p, real.upper(), "scl")}),
    "c": Target(".c", "lreal", lambda p, real: c_files(p, real.upper())),
    "python": Target(".py", None, lambda p, real: {f"{p.name}.py": python_module(p)}),
    "json": Target(".json", None, lambda p, real: {f"{p.name}.json": json_text(p)}),
    "mat": Target(".mat", None, None),
}


@dataclass(frozen=True)
class Written:
    """What was written. real: 'real' (32 bits) or 'lreal' (64)."""

    files: tuple[str, ...]
    target: str
    real: str


def files_of(program: Program, target: str) -> list[str]:
    """The names of the files that `write` makes."""
    endings = (".h", ".c") if target == "c" else (TARGETS[target].suffix,)
    return [program.name + ending for ending in endings]


def write(program: Program, target: str, folder: Path, real: str | None = None) -> Written:
    """Write the program into a folder; its files are named by its name. UsageError for numbers that a target has
    not."""
    chosen = TARGETS[target]
    if real is not None and chosen.real is None and real != "lreal":
        raise UsageError(f"{target} computes with 64 bits", got=real, hint="leave --real out")
    width = real or chosen.real or "lreal"
    if chosen.texts is None:
        path = folder / f"{program.name}.mat"
        with whole_file(path, ".mat") as part:
            write_mat(program, part)
        return Written((str(path),), target, width)
    files = []
    for name, text in chosen.texts(program, width).items():
        with whole_file(folder / name) as part:
            part.write_text(text, encoding="utf-8")
        files.append(str(folder / name))
    return Written(tuple(files), target, width)
