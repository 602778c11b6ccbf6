"""Which refinements are advised: those with which tests that took no part are foretold better."""

from __future__ import annotations

from thermodata.diagnosis.tell.listing.errors_told import beside_the_model, fall
from thermodata.diagnosis.verdict.investigate import Investigation
from thermodata.diagnosis.weigh.figures import from_to
from thermodata.diagnosis.weigh.foretold import Foretold
from thermodata.diagnosis.weigh.scored import Scored


def lets_an_error_fall(scored: Scored, investigation: Investigation) -> bool:
    """Whether left-out tests are foretold better with it, over all or where it acts, and locked ones that were opened
    for it no worse: nothing else is advised."""
    added = as_added(scored)
    if added is not None and added.after >= added.before:
        return False
    return scored.drop > 0 or fall(beside_the_model(scored, investigation)[0]) > 0


def against_adding(scored: Scored, investigation: Investigation) -> str:
    """Why a refinement is not advised, with what the locked tests say, where they were opened for it; '' where it
    is."""
    if lets_an_error_fall(scored, investigation):
        return ""
    added, unit = as_added(scored), investigation.problem.unit
    figures = "" if added is None else f" ({from_to(added.before, added.after, unit)} about each one's mean)"
    if added is not None and added.after >= added.before:
        return f"locked tests are foretold no better with it{figures}"
    though = f", though locked ones are{figures}" if added is not None else ""
    return f"left-out tests are foretold no better with it{though}"


def as_added(scored: Scored) -> Foretold | None:
    """What locked tests say of it, added to the model as it stands; None where they were not opened, or say nothing."""
    added = scored.looked.added if scored.looked is not None else None
    return added if added is not None and scored.looked is not None and added in scored.looked.saying else None
