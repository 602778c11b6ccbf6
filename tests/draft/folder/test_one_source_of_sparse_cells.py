"""A short file of a recorder whose other files tell how its cells were written is of their source."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from thermodata.draft.make import draft_files


def _write(folder: Path, rows: Sequence[int]) -> None:
    """Files of so many rows of 3 s: a probe in each row, a temperature in some, at no rate, rounded to 0.1 K. In a
    long one cells repeat the one before."""
    for k, n in enumerate(rows):
        draws = np.random.default_rng(k)
        at = set(np.cumsum(draws.integers(8, 13, n // 8)).tolist())
        lines = [
            f"2026-03-{2 + k:02d}T08:{i // 20 % 60:02d}:{i % 20 * 3:02d}Z,{4.8 + draws.normal(0, 0.001):.4f},"
            f"{f'{21 + i / (60 if n < 100 else 900):.1f}' if i in at else ''}"
            for i in range(n)
        ]
        (folder / f"run_{k}.csv").write_text("time,probe_x_V,T_hall [degC]\n" + "\n".join(lines) + "\n")


def _doubted(folder: Path) -> list[bool]:
    """Of each source, whether it is asked how its empty cells stand."""
    sources = draft_files(folder, force=True).draft.sources
    return [any(q.startswith("stands: ") for q in source.questions) for source in sources]


def test_a_short_file_is_read_as_the_others(tmp_path: Path) -> None:
    _write(tmp_path, (900, 60, 900, 900))
    assert _doubted(tmp_path) == [False]


def test_short_files_alone_are_asked_in_one_source(tmp_path: Path) -> None:
    _write(tmp_path, (60, 60, 60))
    assert _doubted(tmp_path) == [True]
