"""Which recordings of a folder are jump tests, and why one that is there is not used."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from thermodata.draft.campaign.jumps.orientation import why_idle
from thermodata.draft.campaign.parts import DraftJump
from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.folder.into_sources.sources import Group
from thermodata.draft.probes.jumps import JumpTest, jumps_in
from thermodata.draft.probes.twin_probes import each_its_own


def jumps_of(logs: Sequence[RawFile]) -> list[JumpTest]:
    """The jump tests among recordings: those that are called so, and those that are far shorter than the tests."""
    found = [j for f in logs for j in jumps_in(f) if j.named or _short(j, logs)]
    return each_its_own(found)


def idle_jumps(
    jumps: Sequence[JumpTest],
    of_probes: Mapping[str, Sequence[JumpTest]],
    used: Sequence[DraftJump],
    logs: Sequence[RawFile],
    groups: Sequence[Group],
) -> list[tuple[str, str]]:
    """(path, why) of jump tests that are not used. of_probes: source -> the jump tests of its probes."""
    taken = {j.file for j in used}
    known = [j for of_source in of_probes.values() for j in of_source]
    idle = [path for j in jumps if (path := str(j.file.path)) not in taken]
    return [(path, why_idle(path, known, used, _behind(path, used, logs, groups))) for path in idle]


def _behind(path: str, used: Sequence[DraftJump], logs: Sequence[RawFile], groups: Sequence[Group]) -> list[str]:
    """The tests that were recorded after a jump test, where those that are used were before it."""
    began = {str(f.path): f.start_ns for f in logs}
    own, others = began.get(path), [began.get(j.file) for j in used]
    if own is None or any(o is None or o >= own for o in others):
        return []
    tests = {t: [f.start_ns for f in fs if f.start_ns is not None] for g in groups for t, fs in g.tests.items()}
    return [t for t, starts in tests.items() if starts and min(starts) > own]


def _short(jump: JumpTest, files: Sequence[RawFile]) -> bool:
    """Whether a recording that nobody calls a jump test is far shorter than the tests, as one is."""
    spans = sorted((f.sample.last_ns or 0) - (f.sample.first_ns or 0) for f in files if f is not jump.file)
    own = (jump.file.sample.last_ns or 0) - (jump.file.sample.first_ns or 0)
    return bool(spans) and own * 3 < spans[len(spans) // 2]
