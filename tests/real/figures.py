"""Prints what the diagnosis does on measured data: `uv run --no-sync python tests/real/figures.py`.

left-out tests: cross-validated over the open tests. locked tests: nobody saw them while the model was chosen.
`--pictures FOLDER` draws the spindle's responses, too; `--cuts` asks the spindle once more with its recording cut
otherwise. docs/real_spindle.md and docs/figures.md hold what this prints; tests/real/by_hand.py stands beside it.
"""

from __future__ import annotations

import argparse
import itertools
import sys
import tempfile
from collections.abc import Sequence
from functools import partial
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
import picture
from story import RECORDINGS, Bench, Round, row

SPINDLE = RECORDINGS[0]
# [h] where the open tests begin and the last one ends, where the locked one begins
CUTS = (
    ((0, 16.1, 32.1), "locked from 32.1 h, before the spindle starts"),
    ((0, 8.1, 16.1, 24.1, 32.1), "four open tests, too"),
)
HEAD = ("recording", "response", "round", "verdict", "claimed", "left-out tests", "locked tests", "can't be told from")


def draw(bench: Bench, rounds: Sequence[Round], folder: Path) -> None:
    """The first claim of a response, where there is one."""
    first = rounds[0]
    if first.claimed and first.better:
        picture.write(
            folder, bench, first.diagnosis["response"], first.model, first.better["model"], first.claimed["drivers"][0]
        )


def cut(campaign: Path, hours: Sequence[float]) -> None:
    """Write the tests of the spindle's campaign anew: open ones from hour to hour, and the rest is locked."""
    open_tests = (
        f"  - {{id: open{k}, kind: spindle, role: calibration, window: [{a} h, {b} h], history: recording}}\n"
        for k, (a, b) in enumerate(itertools.pairwise(hours))
    )
    rest = f"  - {{id: rest, kind: spectrum, role: locked, window: [{hours[-1]} h, 46.4 h], history: recording}}\n"
    kept = campaign.read_text("utf-8").split("tests:")[0]
    campaign.write_text(kept + "tests:\n" + "".join(open_tests) + rest, "utf-8")


def main() -> None:
    wanted = argparse.ArgumentParser(description="What the diagnosis does on measured data.")
    wanted.add_argument("--pictures", type=Path, metavar="FOLDER", help="draw the spindle's responses into FOLDER")
    wanted.add_argument("--cuts", action="store_true", help="ask the spindle once more, cut otherwise")
    asked = wanted.parse_args()
    print("| " + " | ".join(HEAD) + " |\n|" + "---|" * len(HEAD))
    for recording in RECORDINGS:
        if not recording.file.exists():
            print(f"| {recording.folder} | | | no {recording.file.name} | | | | |")
            continue
        with tempfile.TemporaryDirectory() as folder:
            bench = Bench(recording, Path(folder))
            for model in recording.models:
                rounds = []
                for number, one in enumerate(bench.rounds(model), 1):
                    rounds.append(one)
                    print(row(recording.folder, number, one), flush=True)
                if asked.pictures and recording is SPINDLE:
                    draw(bench, rounds, asked.pictures)
    for hours, told in CUTS if asked.cuts and SPINDLE.file.exists() else ():
        with tempfile.TemporaryDirectory() as folder:
            bench = Bench(SPINDLE, Path(folder), partial(cut, hours=hours))
            for model in SPINDLE.models:
                print(row(told, 1, next(bench.rounds(model))), flush=True)


if __name__ == "__main__":
    main()
