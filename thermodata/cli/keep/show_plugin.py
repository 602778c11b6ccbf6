"""`plugins show`: an effect's equation, drivers, places, bounds and source; a reader's formats and version."""

from __future__ import annotations

import inspect
from collections.abc import Mapping, Sequence
from typing import Any

from thermodata.cli.terminal.common import Session
from thermodata.errors import UsageError, unknown_name
from thermodata.report.text.table import table

# an effect's own account; null for a reader
_OF_EFFECTS = (
    "family",
    "meaning",
    "equation",
    "telltale",
    "source",
    "refines",
    "told_by",
    "closed_by",
    "asked",
    "roles",
    "parameters",
    "gains",
)
WIDEST = 200
OF_EVERY_MODEL = {
    "prediction": "{effect: prediction, file: FILE.csv}",
    "transfer_function": "{effect: transfer_function, drivers: {u: CHANNEL}}",
    "model": "{effect: model, name: NAME, gain: K}",
}


def show(session: Session, name: str | None, rows: Sequence[Mapping[str, Any]]) -> None:
    """Answer with one plugin. rows: what is installed (`plugins.installed`). UsageError names the nearest name."""
    row = _plugin_named(name, rows)
    answer: dict[str, Any] = {**row, "formats": None, **dict.fromkeys(_OF_EFFECTS), "text": None}
    if row["error"] is None:
        answer |= _effect(row["name"]) if row["kind"] == "effect" else _reader(row["name"])
    session.answer(answer, lambda: _text(answer))


def _plugin_named(name: str | None, rows: Sequence[Mapping[str, Any]]) -> Mapping[str, Any]:
    if not name:
        raise UsageError("which plugin?", expected="plugins show NAME", hint="thermodata plugins lists them")
    fitting = [r for r in rows if name in (r["name"], f"{r['kind']}-{r['name']}")]
    if not fitting:
        unknown = unknown_name("plugin", name, [str(r["name"]) for r in rows])
        if name in OF_EVERY_MODEL:
            unknown.hint = f"it belongs to every model and needs no plugin: {OF_EVERY_MODEL[name]} (docs/model.md)"
        raise unknown
    if len(fitting) > 1:
        raise UsageError(
            f"a reader and an effect are named '{name}'",
            expected=" or ".join(f"{r['kind']}-{r['name']}" for r in fitting),
            got=name,
        )
    return fitting[0]


def _effect(name: str) -> dict[str, Any]:
    from dataclasses import asdict

    from thermodata.effect import effect
    from thermodata.effect.describe import describe

    return asdict(describe(effect(name)))


def _reader(name: str) -> dict[str, Any]:
    from thermodata.reader import reader

    found = reader(name)
    formats = getattr(found, "formats", None)
    own = getattr(found, "version", None)  # stands in the raw data's key in place of the distribution's
    return {
        "formats": list(formats) if formats else None,
        "text": inspect.getdoc(type(found)),
        **({"version": own} if isinstance(own, str) else {}),
    }


# what stands for several in a place or a family -> what it is (docs/effects.md)
_PLACEHOLDERS = {
    "{a}": "{a}: one axis letter, the same throughout",
    "{s}": "{s}spindle: any spindle, such as spindle or counter_spindle",
    "?": "spindle.bearing?: the part, or the whole where the part has no sensor",
}


def _text(answer: Mapping[str, Any]) -> str:
    origin = f"{answer['distribution'] or 'no distribution'} {answer['version'] or ''}".rstrip()
    head = f"{answer['kind']} {answer['name']}  ({origin})"
    if answer["error"] is not None:
        return f"{head}\ndoes not load: {answer['error']}"
    if answer["kind"] == "reader":
        formats = "".join(f"\n  {one}" for one in answer["formats"] or ["not stated"])
        return f"{head}\n{answer['text'] or ''}\n\nformats{formats}"
    facts = [
        ("equation", answer["equation"]),
        ("family", answer["family"]),
        ("refines", ", ".join(answer["refines"])),
        ("tell-tale", answer["telltale"]),
        ("source", answer["source"]),
    ]
    listed = "\n".join(f"{what:<10} {value}" for what, value in facts if value)
    roles = [
        {
            **role,
            "unit": role["unit"] or "any",
            "places": ", ".join(role["places"]) or "any",
            "needed": "no" if role["optional"] else "yes",
        }
        for role in answer["roles"]
    ]
    from thermodata.effect.describe import bounds_text

    numbers = [
        {**p, "bounds": bounds_text(p["lower"], p["upper"], p["start"], p["reach"]), "how": "searched"}
        for p in answer["parameters"]
    ] + [
        {
            **g,
            "bounds": "any size" if g["largest"] is None else f"{g['smallest']:g} to {g['largest']:g} in size",
            "how": "solved" if g["sign"] == "any" else f"solved, {g['sign']}",
        }
        for g in answer["gains"]
    ]
    driven = table(
        roles,
        [("role", "driver"), ("quantity", "quantity"), ("unit", "unit"), ("needed", "needed"), ("places", "places")],
        widest=WIDEST,
    )
    words = [said for part, said in _PLACEHOLDERS.items() if part in f"{driven} {answer['family']}"]
    driven = "\n".join([driven, *([f"\n{'; '.join(words)}"] if words else [])])
    columns = [("name", "parameter"), ("how", "how"), ("unit", "unit"), ("bounds", "bounds"), ("meaning", "meaning")]
    searched = table(numbers, columns, widest=WIDEST)
    return "\n\n".join([f"{head}\n{answer['meaning']}", listed, *([driven] if roles else []), searched])
