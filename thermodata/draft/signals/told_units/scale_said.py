"""A scale that a file states beside a signal and nobody applies, `Scale = 0.1`: asked, for values may have it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace

from thermodata.draft.signals.quantity.guessed import Guess
from thermodata.draft.signals.values import Values
from thermodata.plugin import Signal
from thermodata.reader.text import split_unit
from thermodata.reader.text.preamble.stated_scale import line_that_applies, stated_scales, stated_unit
from thermodata.schema.words.sentences import with_count

_FILES = 3  # that are shown


def with_scale_asked(found: Guess, signals: Mapping[str, Signal]) -> Guess:
    """With a question where properties of a signal say a factor, an offset or a turned sign that nobody applies, in all
    files or in some. signals: file -> the signal as it has it."""
    if found.quantity in (None, "state", "label"):
        return found
    files: dict[str, list[str]] = {}
    for file, signal in signals.items():
        files.setdefault("; ".join(_asked(signal, found.unit)), []).append(file)
    several = len(files) > 1
    asked = [f"in {with_count(of, _FILES)} {told}" if several else told for told, of in files.items() if told]
    return replace(found, sure=False, questions=(*found.questions, "; ".join(asked))) if asked else found


def as_scaled(values: Values | None, signals: Iterable[Signal]) -> Values | None:
    """A sample in the scale that all files state alike; None where they state none."""
    scales = {_scale(s) for s in signals}
    if values is None or len(scales) != 1 or (scale := scales.pop()) in (None, (1.0, 0.0)):
        return None
    factor, offset = scale
    ends = [x * factor + offset for x in (values.low, values.high)]
    median, first, second = (x * factor + offset for x in (values.median, values.first, values.second))
    return replace(
        values,
        low=min(ends),
        high=max(ends),
        median=median,
        step=values.step * abs(factor),
        whole=False,
        first=first,
        second=second,
        counts=False,
    )


def _scale(signal: Signal) -> tuple[float, float] | None:
    """Factor and offset; None where several are stated."""
    stated = stated_scales(signal)
    factors, offsets = ([s.number for s in stated if s.kind == kind] for kind in ("factor", "offset"))
    if len(factors) > 1 or len(offsets) > 1:
        return None
    return (*factors, 1.0)[0], (*offsets, 0.0)[0]


def _asked(signal: Signal, unit: str | None) -> Iterator[str]:
    stated = stated_scales(signal)
    numbers = [s for s in stated if s.kind != "sign"]
    if numbers:
        said, is_that = " and ".join(map(str, numbers)), "are these" if len(numbers) > 1 else "is that"
        scaled = stated_unit(signal)
        way = line_that_applies(numbers, split_unit(signal.name)[0], unit, scaled[1] if scaled else None)
        if scaled:
            said += f", and '{scaled[0]} = {scaled[1]}'"
        yield f"the file says {said}: {is_that} in the values? then scaled: true; where they still need it: {way}"
    if any(s.kind == "factor" and s.number < 0 for s in numbers):
        yield "it turns the sign, which is kept as it stands in the file"
    for turned in (s for s in stated if s.kind == "sign"):
        yield f"the file says {turned}: is that in the values? their sign is kept as it stands in the file"
