"""One complaint of pydantic as an error: a function for each kind of it, and for each fault that validators raise."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from thermodata.errors import SpecError, nearest
from thermodata.schema.strict.complaint import Complaint
from thermodata.schema.strict.declared import MissingKeyError, WrongKeyError, WrongValueError
from thermodata.schema.strict.explain_types import missed, right_value
from thermodata.schema.strict.lines import at_place, dotted_place
from thermodata.schema.words.sentences import listed


def as_error(complaint: Complaint) -> SpecError:
    """The complaint with its line, and the nearest right word."""
    told = _BY_KIND.get(complaint.kind) or _BY_FAULT.get(type(complaint.fault)) or _wrong_value
    return told(complaint)


def _unknown_key(of: Complaint) -> SpecError:
    name, keys = str(of.name), sorted(of.keys(of.place[:-1]))
    return SpecError(
        f"unknown key '{name}'",
        where=of.where(),
        expected="one of " + ", ".join(keys),
        got=name,
        hint=_did_you_mean(name, keys),
    )


def _missing_key(of: Complaint) -> SpecError:
    above, where = of.place[:-1], of.document.where(of.place[:-1])
    if isinstance(of.name, int):
        return SpecError(
            f"'{dotted_place(above)}': too few values",
            where=where,
            expected=f"{of.name + 1} values",
            got=_short(at_place(of.document.data, above)),
        )
    return SpecError(f"the key '{of.name}' is missing", where=where, expected=f"{dotted_place(of.place)}: ...")


def _tag_missing(of: Complaint) -> SpecError:
    """Of a value whose kind is told by one of its keys."""
    key = _tag_key(of)
    return SpecError(f"the key '{key}' is missing", where=of.where(), expected=f"{dotted_place((*of.place, key))}: ...")


def _tag_unknown(of: Complaint) -> SpecError:
    key, got = _tag_key(of), of.context["tag"]
    choices = [word.strip("' ") for word in str(of.context["expected_tags"]).split(",")]
    return _no_allowed_word(key, got, choices, of.where(key))


def _tag_key(of: Complaint) -> str:
    return str(of.context["discriminator"]).strip("'")


def _word(of: Complaint) -> SpecError:
    choices = [c.strip("' ") for c in str(of.context["expected"]).replace(" or ", ", ").split(",")]
    return _no_allowed_word(of.name, of.value, [c for c in choices if c], of.where())


def _no_allowed_word(key: str | int, got: Any, choices: Sequence[str], where: str) -> SpecError:
    return SpecError(
        f"'{key}' is not one of the allowed words",
        where=where,
        expected=", ".join(choices),
        got=repr(got),
        hint=_did_you_mean(str(got), choices),
    )


def _key_that_is_needed(of: Complaint) -> SpecError:
    assert isinstance(of.fault, MissingKeyError)
    return SpecError(
        str(of.fault),
        where=of.where(),
        expected=f"{dotted_place((*of.place, of.fault.key))}: {listed(of.fault.words, 'or')}",
    )


def _key_that_does_not_fit(of: Complaint) -> SpecError:
    assert isinstance(of.fault, WrongKeyError)
    return SpecError(
        str(of.fault), where=of.where(of.fault.key), expected=of.fault.expected, got=of.fault.key, hint=of.fault.hint
    )


def _wrong_value(of: Complaint) -> SpecError:
    """Of a wrong type, out of bounds, or refused by a validator."""
    message = str(of.detail["msg"]).removeprefix("Value error, ")
    expected: str | None
    hint: str | None = None
    if isinstance(of.fault, WrongValueError):
        expected, hint = of.fault.expected, of.fault.hint
    else:
        of_model = of.kind in ("model_type", "model_attributes_type")
        expected = right_value(of.kind, of.context, of.keys(of.place) if of_model else ())
        message = (missed(of.kind, expected) if expected is not None else None) or message
    what = f"'{of.name}': {message}" if of.name != "" else message
    return SpecError(what, where=of.where(), expected=expected, got=_short(of.value), hint=hint)


_BY_KIND: Mapping[str, Callable[[Complaint], SpecError]] = {
    "extra_forbidden": _unknown_key,
    "missing": _missing_key,
    "union_tag_not_found": _tag_missing,
    "union_tag_invalid": _tag_unknown,
    "literal_error": _word,
}
_BY_FAULT: Mapping[type, Callable[[Complaint], SpecError]] = {
    MissingKeyError: _key_that_is_needed,
    WrongKeyError: _key_that_does_not_fit,
}


def _did_you_mean(word: str, choices: Sequence[str]) -> str | None:
    close = nearest(word, choices)
    return f"did you mean '{close}'?" if close else None


def _short(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 80 else text[:77] + "..."
