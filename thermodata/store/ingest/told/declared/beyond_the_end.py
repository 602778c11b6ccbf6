"""Times of the campaign file that lie behind the end of a test's recording: what they mean is nowhere in it."""

from __future__ import annotations

from thermodata.schema.files.campaign import Test

_MORE = 1.001  # an end that is written as it was planned is not behind the end


def beyond_the_end(test: Test, duration_s: float | None, step_s: float) -> list[str]:
    """Sentences for the summary of an ingest. duration_s: of the test [s]; None where nothing tells it. step_s: from
    one sample to the next, as the last one stands for what follows [s]."""
    if not duration_s:
        return []
    begin = test.window[0] if test.window is not None else 0.0
    end = begin + duration_s
    said = []
    if test.window is not None and test.window[1] - begin > max(_MORE * duration_s, duration_s + 2 * step_s):
        said.append(
            f"{test.id}: the window ends at {_hours(test.window[1])}, and the last sample in it is at {_hours(end)}: "
            "the test is taken to there"
        )
    if "over" in test.zero.model_fields_set and test.zero.over > _MORE * duration_s:
        said.append(
            f"{test.id}: zero is the mean over {_hours(test.zero.over)}, and the test lasts {_hours(duration_s)}: "
            "the mean of all of it"
        )
    for name, (start, stop) in test.phases.items():
        if start >= end:
            said.append(
                f"{test.id}: the phase '{name}' begins at {_hours(start)}, and the recording ends at {_hours(end)}: "
                "it has no sample"
            )
        elif stop > begin + _MORE * duration_s:
            said.append(
                f"{test.id}: the phase '{name}' ends at {_hours(stop)}, and the recording ends at {_hours(end)}: "
                "it is taken to there"
            )
    return said


def phases_of(test: Test, duration_s: float | None) -> dict[str, tuple[float, float]]:
    """name -> (from, to) [s], from the window's start where there is one, and no further than the recording goes; what
    begins behind it stays as it is declared."""
    shift = test.window[0] if test.window is not None else 0.0
    found: dict[str, tuple[float, float]] = {}
    for name, (start, stop) in test.phases.items():
        ends = stop - shift
        if duration_s and start - shift < duration_s and ends > _MORE * duration_s:
            ends = duration_s
        found[name] = (start - shift, ends)
    return found


def _hours(seconds: float) -> str:
    return f"{seconds / 3600:.4g} h"
