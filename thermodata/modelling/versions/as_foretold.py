"""What a diagnosis foretold of what is added, beside what the version gives: a second lag was not in its question."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import TYPE_CHECKING

from thermodata.schema.words.sentences import listed

if TYPE_CHECKING:
    from thermodata.modelling.versions.second_lag import SecondLag
    from thermodata.schema.answers.diagnosis import Diagnosis


def beside_foretold(found: Diagnosis | None, names: Collection[str], lags: Sequence[SecondLag]) -> str | None:
    """A sentence with both errors on left-out tests, where the version has second lags and a diagnosis foretold what it
    has without them; else None. found: the diagnosis of the parent, of the response that the lags' errors are of.
    names: ids that are added. lags: in the order of their use."""
    foretold = None if found is None or not lags else _foretold(found, names)
    if foretold is None:
        return None
    before, after = foretold
    first, last = lags[0], lags[-1]
    return (
        f"diagnose foretold {before:.3g} -> {after:.3g} {last.unit} on left-out tests with one lag for each effect, "
        f"free to act faster and slower than by it. With {listed([lag.id for lag in lags])} beside them these tests, "
        f"refitted as the model is, have {first.before:.3g} -> {last.after:.3g} {last.unit}: another measure of "
        "another model. --plain adds what was foretold"
    )


def _foretold(found: Diagnosis, names: Collection[str]) -> tuple[float, float] | None:
    """Errors before and after of what is added, as the diagnosis has them: of one candidate, or of all claims."""
    own = [c for c in found.candidates if c.id in names]
    if len(own) < len(names):
        return None
    if len(own) == 1:
        before, after = own[0].rmse_um_before, own[0].rmse_um_after
    else:
        all_claims = {c.id for c in own} == {c.id for c in found.candidates if c.claimed}
        before, after = (found.rmse_um, found.named_rmse_um) if all_claims else (None, None)
    return None if before is None or after is None else (before, after)
