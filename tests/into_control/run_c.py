"""The exported C, compiled and run over readings."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from thermodata.export.control.c import c_files
from thermodata.export.control.program import Program
from thermodata.plugin import Float1D

COMPILER = shutil.which("gcc") or shutil.which("cc") or shutil.which("clang")
_MAIN = """
#include <stdio.h>
#include <string.h>
#include "{name}.h"

int main(void)
{{
    double row[{count}];
    {name} m;
    {name}_inputs in;
    {name}_init(&m);
    while (fread(row, sizeof(double), {count}, stdin) == {count}) {{
        double out[2];
        memset(&in, 0, sizeof in);
        {set}
        {name}_step(&m, &in);
        out[0] = m.displacement;
        out[1] = m.correction;
        fwrite(out, sizeof(double), 2, stdout);
    }}
    return 0;
}}
"""


def compiled(program: Program, real: str, folder: Path, *flags: str) -> Path:
    """The program as an executable that reads rows of doubles; every warning is an error."""
    assert COMPILER is not None
    for name, text in c_files(program, real).items():
        (folder / name).write_text(text, encoding="utf-8")
    names = [i.name for i in program.inputs]
    settings = "\n        ".join(f"in.{n} = row[{k}]; in.valid_{n} = 1;" for k, n in enumerate(names))
    if real == "REAL":
        settings = settings.replace("= row[", "= (float)row[")
    main = folder / "main.c"
    main.write_text(_MAIN.format(name=program.name, count=max(1, len(names)), set=settings), encoding="utf-8")
    out = folder / "model"
    warnings = ["-Wall", "-Wextra", "-Werror", "-Wconversion", "-Wdouble-promotion"]
    subprocess.run(
        [
            COMPILER,
            "-std=c99",
            "-O2",
            *warnings,
            *flags,
            str(folder / f"{program.name}.c"),
            str(main),
            "-lm",
            "-o",
            out,
        ],
        check=True,
        capture_output=True,
    )
    return out


def run_c(program: Program, real: str, values: Mapping[str, Float1D], folder: Path, *flags: str) -> Float1D:
    """(displacement, correction) of each cycle, shape (n, 2)."""
    rows = np.column_stack([values[i.channel] for i in program.inputs]).astype(np.float64)
    done = subprocess.run(
        [compiled(program, real, folder, *flags)], input=rows.tobytes(), capture_output=True, check=True
    )
    return np.frombuffer(done.stdout, np.float64).reshape(-1, 2)
