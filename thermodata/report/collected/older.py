"""What of a page is of other data than the rest of it, in sentences for its top."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from thermodata.schema.answers.diagnosis import Diagnosis
    from thermodata.store.catalogue.models.fits import StoredModel


def is_of_other_data(found: Diagnosis | None, fitted_to: str, now: str) -> bool:
    """Whether an answer was found on other data than there are now. fitted_to: the version of the data that its model
    was fitted to, of which an answer is that doesn't say."""
    return found is not None and (found.data_version or fitted_to) != now


def what_is_older(
    stored: StoredModel, now: str, diagnosis: Diagnosis | None, reason: Diagnosis | None
) -> tuple[str, ...]:
    """now: the version of the data as they are. reason: of an earlier version, why effects were added since."""
    lines, again = [], f"thermodata fit {stored.model} keeps it as a version of its own"
    other = is_of_other_data(diagnosis, stored.data_version, now)
    but = " but the diagnosis" if other else ""
    if stored.stale:
        lines.append(
            f"The data changed after this model was fitted. Everything here{but} is of a fit to the data as they are "
            f"now; {again}, and thermodata diagnose of that says what it misses"
        )
    elif stored.data_version != now:
        lines.append(
            "The tests of the campaign are not those that there were when this model was fitted, though what it was "
            f"fitted to is as it was. Everything here{but} is of a fit to the tests that there are now; {again}"
        )
    if other:
        lines.append(
            "The diagnosis is older than the data: what is missing was asked of them as they were; thermodata diagnose "
            f"{stored.model} asks of them as they are now"
        )
    # an answer that doesn't say of which data it is may be of these
    if reason is not None and reason.data_version is not None and reason.data_version != now:
        lines.append(
            f"What was missing before is told by the diagnosis of an earlier version, {reason.model}, which is older "
            "than the data: it was asked of them as they were"
        )
    return tuple(lines)
