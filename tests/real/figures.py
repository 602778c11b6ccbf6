"""Prints a table of what the diagnosis does on measured data: `uv run python tests/real/figures.py`.

left-out tests: cross-validated over the open tests. locked tests: nobody saw them while the model was chosen.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
from story import RECORDINGS, Bench


def main() -> None:
    print("| recording | response | round | verdict | claimed | left-out tests | locked tests | can't be told from |")
    print("|---|---|---|---|---|---|---|---|")
    for recording in RECORDINGS:
        if not recording.file.exists():
            print(f"| {recording.folder} | | | no {recording.file.name} | | | | |")
            continue
        with tempfile.TemporaryDirectory() as folder:
            bench = Bench(recording, Path(folder))
            for model in recording.models:
                for number, round_ in enumerate(bench.rounds(model), 1):
                    found, best = round_.diagnosis, round_.claimed
                    cells = [recording.folder, found["response"], str(number), found["verdict"]]
                    if best is None:
                        cells += ["-", "" if found["rmse_um"] is None else f"{found['rmse_um']:.2f}", "", ""]
                    else:
                        cells += [
                            best["id"],
                            f"{best['rmse_um_before']:.2f} -> {best['rmse_um_after']:.2f}",
                            f"{best['locked_rmse_um_before']:.2f} -> {best['locked_rmse_um_after']:.2f}",
                            ", ".join(best["equivalent"]),
                        ]
                    print("| " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main()
