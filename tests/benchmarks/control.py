"""What an exported control program is wrong by over 24 h, by cycle, width of numbers and form.

    uv run python tests/benchmarks/control.py            the table (about a minute; needs a C compiler)

Two lags of 20 and 180 min, as in the papers. Inputs: a smooth day; one in steps of 0.1 K, as a control reads it; one
that jumps by 10 K and then stands. Truth: the model's free run in 64 bits. "papers' form" is the difference equation
y(k) = a0 u(k) + ... - b1 y(k-1) - ... in floats.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from into_control.programs import driven, program, readings
from into_control.run_c import COMPILER, run_c

from thermodata.effect.linear import lag_filter
from thermodata.modelling.seen.state_space import system_of
from thermodata.plugin import Float1D

HOURS = 24
CYCLES_S = (0.1, 0.5, 1.0, 2.0, 10.0, 60.0)
GAINS = ((12.0, 20.0), (25.0, 180.0))  # um/K, min

_PAPER = """
#include <stdio.h>
int main(void) {{
    const {real} a[3] = {{{a}}}, b[3] = {{{b}}};
    {real} u0 = 0, u1 = 0, u2 = 0, y1 = 0, y2 = 0;
    double row;
    while (fread(&row, sizeof row, 1, stdin) == 1) {{
        u0 = ({real})row;
        {{
            volatile {real} y = a[0] * u0 + a[1] * u1 + a[2] * u2 - b[1] * y1 - b[2] * y2;
            double out = y;
            fwrite(&out, sizeof out, 1, stdout);
            u2 = u1; u1 = u0; y2 = y1; y1 = y;
        }}
    }}
    return 0;
}}
"""


def inputs(cycle_s: float) -> dict[str, Float1D]:
    """Name -> a day of readings [degC]."""
    smooth = readings([driven("lag")], cycle_s, HOURS)["u_0"]
    late = np.arange(len(smooth)) * cycle_s > 3600.0
    return {"smooth": smooth, "0.1 K": np.round(smooth, 1), "jump": np.where(late, 32.0, 22.0)}


def papers_form(cycle_s: float, u: Float1D, real: str, digits: int | None, folder: Path) -> Float1D:
    """The difference equation as printed, in C."""
    by = lag_filter(GAINS[0][1] * 60).scaled(GAINS[0][0]) + lag_filter(GAINS[1][1] * 60).scaled(GAINS[1][0])
    system = system_of(by, cycle_s)
    shown = (lambda v: f"{v!r}") if digits is None else (lambda v: f"{v:.{digits}f}")
    source = folder / "paper.c"
    source.write_text(
        _PAPER.format(real=real, a=", ".join(map(shown, system.a.tolist())), b=", ".join(map(shown, system.b.tolist())))
    )
    subprocess.run([str(COMPILER), "-O1", "-o", folder / "paper", source], check=True, capture_output=True)
    done = subprocess.run([folder / "paper"], input=(u - u[0]).tobytes(), capture_output=True, check=True)
    return np.frombuffer(done.stdout, np.float64)


def main() -> None:
    if COMPILER is None:
        raise SystemExit("no C compiler (gcc, cc, clang)")
    terms = [driven("lag", gain, tau=tau) for gain, tau in GAINS]
    print(f"largest error over {HOURS} h [um]; lags of 20 and 180 min, gains 12 and 25 um/K")
    heads = ("cycle", "input", "range", "export REAL", "export LREAL", "papers' form REAL", "papers' form, 9 decimals")
    print("  ".join(h.rjust(w) for h, w in zip(heads, WIDTHS, strict=True)))
    for cycle_s in CYCLES_S:
        for name, u in inputs(cycle_s).items():
            t = np.arange(len(u)) * cycle_s
            truth = np.sum([one.free_run(t, {"u_0": u}) for one in terms], axis=0)
            row = [f"{cycle_s:g} s", name, f"{np.ptp(truth):.0f}"]
            for real in ("REAL", "LREAL"):
                with tempfile.TemporaryDirectory() as folder:
                    made = run_c(program(terms, cycle_s), real, {"u_0": u}, Path(folder))[:, 0]
                row.append(f"{np.abs(made - truth).max():.2g}")
            for real, digits in (("float", None), ("double", 9)):
                with tempfile.TemporaryDirectory() as folder:
                    made = papers_form(cycle_s, u, real, digits, Path(folder))
                worst = np.abs(made - truth).max()
                row.append(f"{worst:.2g}" if np.isfinite(worst) and worst < 1e6 else "grows")
            print("  ".join(c.rjust(w) for c, w in zip(row, WIDTHS, strict=True)), flush=True)


WIDTHS = (6, 7, 5, 11, 12, 17, 24)

if __name__ == "__main__":
    main()
