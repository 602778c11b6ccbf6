"""A jump test as it was logged, for whoever has to say which moves were commanded."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

from thermodata.archive.members import is_there, size_of
from thermodata.calibration.jump.plateaus import Step
from thermodata.draft.files.described_file import sampled_file
from thermodata.draft.probes.jumps import staircase
from thermodata.errors import ThermodataError, UsageError, unknown_name
from thermodata.plugin import Float1D
from thermodata.reader.finding.match import match_signal
from thermodata.schema.strict.lines import read_document

MOST_BYTES = 64 << 20  # a jump test takes minutes


@dataclass(frozen=True, slots=True)
class JumpSeen:
    """t_s, values: shape (n,), n <= 3000, from the file's first sample, in `unit`. steps: found in it, in its order;
    empty where none are seen."""

    calibration: str
    file: str
    signal: str
    unit: str
    t_s: Float1D
    values: Float1D
    steps: tuple[Step, ...]


def jump_seen(campaign: Path, name: str, inside: Callable[[Path], Path]) -> JumpSeen:
    """The jump test of a calibration of a campaign file. inside: refuses a path that leads elsewhere. UsageError where
    there is no such calibration, or its file can't be drawn, with the reason."""
    declared = (read_document(campaign).data or {}).get("calibrations")
    declared = declared if isinstance(declared, dict) else {}
    jumps = {k: v for k, v in declared.items() if isinstance(v, dict) and v.get("kind") == "jump"}
    if name not in jumps:
        raise unknown_name("jump test", name, list(jumps))
    path, wanted = str(jumps[name].get("file", "")), str(jumps[name].get("signal", ""))
    full = inside(campaign.parent / path)
    if not path or not is_there(full):
        raise UsageError(
            "the file of the jump test is not there",
            where=f"{campaign.name}, {name}",
            got=path,
            hint="correct 'file' of the calibration: a path from the campaign file's folder",
        )
    if size_of(full) > MOST_BYTES:
        raise UsageError(
            "the file is too large for a jump test to be drawn",
            where=path,
            hint="cut the jump test out of the log, and name that file in 'file' of the calibration",
        )
    try:
        file = sampled_file(full.parent, PurePosixPath(full.name))
    except ThermodataError as error:
        raise UsageError(
            "the file of the jump test can't be read",
            where=path,
            got=error.what,
            hint="thermodata preview FILE says more",
        ) from error
    if file is None:
        raise UsageError("no one reader claims the file of the jump test", where=path, hint=f"thermodata sniff {path}")
    signal = match_signal(wanted, file.signals)
    course = file.sample.courses.get((signal.stream, signal.name))
    if course is None or len(course.t_ns) < 2:
        raise UsageError(
            "the signal has no values to draw",
            where=path,
            got=wanted,
            hint="correct 'signal' of the calibration, thermodata preview FILE lists those with values",
        )
    found = staircase(course)
    return JumpSeen(
        name,
        path,
        signal.name,
        signal.unit or "",
        (course.t_ns - course.t_ns[0]) / 1e9,
        course.values,
        found[0] if found else (),
    )
