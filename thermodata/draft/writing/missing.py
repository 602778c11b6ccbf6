"""What a campaign file still lacks for a first model, and which of its lines ask for that."""

from __future__ import annotations

import re

from thermodata.draft.writing.baseline import responses_of
from thermodata.schema.files.campaign import Campaign
from thermodata.schema.words.sentences import with_count

_ASKED = re.compile(r"^  (?:# )?(\w+): \{(?=[^#]*\b(?:source|signal): )(.*?)# \? (.*)$", re.MULTILINE)
_MOST = 6


def missing_for_a_model(text: str, campaign: Campaign) -> str:
    """In words, of a campaign file of which no first model can be drafted. text: of the file. What drafts one once that
    is answered is told with the next steps."""
    if not any(campaign.channels[r].axis and campaign.channels[r].at == "tcp" for r in responses_of(campaign)):
        what, asked = (
            "a displacement of the tool (quantity: displacement, axis:, at: tcp)",
            asked_of_a_displacement(text),
        )
    else:
        what, asked = "a temperature or a speed with its place (at:) that drives a plain effect", asked_of_drivers(text)
    return f"no model.yaml: it needs {what}" + (f"; answer the '# ?' of {asked}, then draft it" if asked else "")


def asked_of_a_displacement(text: str) -> str:
    """The channels whose line asks whether they are a displacement or of what axis; else those that may be anything."""
    asked = _lines(text)
    of_it = [
        n for n, said, why in asked if "displacement" in why or ("quantity: displacement" in said and "axis?" in why)
    ]
    return _named(of_it or [n for n, said, _ in asked if "quantity: ?" in said or "quantity: voltage" in said])


def asked_of_drivers(text: str) -> str:
    """The channels whose line asks where they are, or for their quantity."""
    wanted = ("quantity: temperature", "quantity: rotational_speed", "quantity: ?")
    return _named(
        [n for n, said, why in _lines(text) if any(w in said for w in wanted) and re.search(r"at:|quantity", why)]
    )


def _lines(text: str) -> list[tuple[str, str, str]]:
    """(channel, its keys, what is asked) of each line that asks."""
    return [(m[1], m[2], m[3]) for m in _ASKED.finditer(text)]


def _named(channels: list[str]) -> str:
    return with_count(channels, _MOST)
