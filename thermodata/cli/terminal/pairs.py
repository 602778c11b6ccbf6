"""Options that name something and give it a value: NAME=VALUE."""

from __future__ import annotations

from thermodata.errors import UsageError


def name_and_value(text: str, what: str, expected: str) -> tuple[str, str]:
    """Both parts, without blanks around them. UsageError for a text without a name or '='; what, expected: what it
    should have been, and how that is written, as the message says."""
    name, found, value = text.partition("=")
    if not found or not name.strip():
        raise UsageError(what, expected=expected, got=text)
    return name.strip(), value.strip()
