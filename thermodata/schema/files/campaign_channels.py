"""`channels` and `calibrations` of a campaign file: what was measured, and how raw values become calibrated ones."""

from __future__ import annotations

from typing import Annotated, Any, Literal, get_args

from pydantic import ConfigDict, Field, model_validator

from thermodata.schema.strict.declared import (
    NOT_NEGATIVE,
    POSITIVE,
    Amount,
    At,
    Attributed,
    Direction,
    MissingKeyError,
    Seconds,
    Strict,
    Um,
    Value,
)
from thermodata.schema.units.quantity import MEASURED, Quantity
from thermodata.schema.units.quantity_of import quantities_of


class Sensor(Attributed):
    """`channels.*.sensor`: the sensor behind a channel. Free attributes are kept.

    serial: its number
    range: lowest and highest reading, in the unit of the raw signal or with units; outside of it a sample is
        flagged
    resolution: its smallest step; shows as ripple in a prediction. A temperature read in 0.45 K and more is drawn
        smoothly through its steps as a driver
    """

    serial: str | None = None
    range: tuple[Amount, Amount] | None = None
    resolution: Annotated[Amount, NOT_NEGATIVE] | None = None


class Channel(Strict):
    """`channels.*`: one measured quantity: where it comes from, and what it is. Exactly one of signal (with
    source), derive and schedule.

    source: key of `sources`
    signal: its name in the file; a unit in brackets behind the name may be left out
    derive: an expression over other channels: (dY_high - dY_low) / 100 mm; rate(x_pos) is that of a logged position
    schedule: [[time, value], ...] for what nobody logged but everybody knows; held between
    quantity: what it is; its canonical unit follows. Left out, it is what `unit` leaves no choice of (degC, rpm, kW,
        m/min), and of a length a displacement with `axis` or at tcp, a position at axis.*
    unit: of the raw values, where the file does not say it
    instead_of: the unit that the file states, where that is wrong and `unit` is right
    scaled: true: the values have the factor and the offset that the file states beside them
    axis: of a displacement: the machine's axis
    at: dotted place on the machine: spindle.bearing.front
    relative_to: place that a displacement is measured against
    calibration: key of `calibrations`, or a list applied in order
    sensor: what measured it
    only_in: the tests whose files have the signal, where others lack it; in these it is read where it stands
    missing_in: the tests whose files lack it, the other way round
    held: whether each value stands until the next row, as where it was written on change (true), or runs on between
        them (false); for what is set, `ingest` tells it from the rows
    notes: free text
    """

    model_config = ConfigDict(json_schema_extra=lambda schema: _may_lack_quantity(schema))

    source: str | None = None
    signal: str | None = None
    derive: str | None = None
    schedule: list[tuple[Value, Value]] | None = None
    quantity: Quantity
    unit: str | None = None
    instead_of: str | None = None
    scaled: bool | None = Field(default=None, exclude_if=lambda scaled: scaled is None)
    axis: Literal["X", "Y", "Z", "A", "B", "C"] | None = None
    at: At | None = None
    relative_to: At | None = None
    calibration: str | list[str] | None = None
    sensor: Sensor | None = None
    only_in: list[str] = Field(default=[], exclude_if=lambda tests: not tests)
    missing_in: list[str] = Field(default=[], exclude_if=lambda tests: not tests)
    held: bool | None = Field(default=None, exclude_if=lambda held: held is None)
    notes: str = ""

    def may_lack(self, test: str) -> bool:
        """Whether the files of a test need not have the signal."""
        return test in self.missing_in or (bool(self.only_in) and test not in self.only_in)

    @model_validator(mode="before")
    @classmethod
    def _quantity_by_its_unit(cls, value: Any) -> Any:
        if not isinstance(value, dict) or "quantity" in value or not value.keys() <= cls.model_fields.keys():
            return value  # a misspelt key may be the quantity
        texts = {key: v if isinstance(v := value.get(key), str) else None for key in ("unit", "axis", "at")}
        unit = str(value["unit"]) if value.get("unit") is not None else ""
        words = quantities_of(unit, texts["axis"], texts["at"]) if unit else ()
        if len(words) == 1 and value.get("calibration") is None:  # which may change the unit
            return {**value, "quantity": words[0]}
        raise MissingKeyError("quantity", words or get_args(Quantity))

    @model_validator(mode="after")
    def _one_origin(self) -> Channel:
        origins = [k for k in ("signal", "derive", "schedule") if getattr(self, k) is not None]
        if len(origins) != 1:
            raise ValueError(f"a channel has exactly one of 'signal', 'derive' and 'schedule'; got {origins or 'none'}")
        if self.signal is not None and self.source is None:
            raise ValueError("a channel with 'signal' needs 'source'")
        if self.instead_of is not None and self.unit is None:
            raise ValueError("'instead_of' names the file's unit that 'unit' replaces: write both")
        if self.held is not None and (self.signal is None or self.quantity in MEASURED):
            raise ValueError(
                "'held' is for a logged channel ('signal') that drives something: what a model explains is never held"
            )
        if self.only_in and self.missing_in:
            raise ValueError(
                "'only_in' and 'missing_in' say the same, one of the tests and one of the others: write one"
            )
        return self


def _may_lack_quantity(schema: dict[str, Any]) -> None:
    """Of the published schema: a channel is complete without, where its unit says it."""
    schema["required"] = [key for key in schema["required"] if key != "quantity"]
    if not schema["required"]:
        del schema["required"]


class JumpCalibration(Strict):
    """`calibrations.*` of kind jump: the axis moves a probe by known steps, which gives a signed sensitivity.
    Refused where `facing` contradicts its sign.

    kind: jump
    axis: the axis that moved
    source: key of `sources`
    file: path of the log of the jump test, below this file
    signal: the probe's name in it
    moves: commanded moves [um], in machine coordinates and with units: [100 um, -100 um]; unknown: nothing is
        calibrated until they are written
    dwell: time at each position [s]
    move_uncertainty: of one commanded move [um]; goes into the sensitivity's uncertainty
    facing: the way a probe that stands on the table looks, and the opposite of where one in the spindle does; for a
        check of the sign
    increases_with: what makes the reading grow: gap (eddy current) or approach (many contact probes)
    gain: of the data sheet, for a check: 250 um/V
    """

    kind: Literal["jump"]
    axis: Literal["X", "Y", "Z", "A", "B", "C"]
    source: str
    file: str
    signal: str
    moves: list[Um] | Literal["unknown"]
    dwell: Annotated[Seconds, POSITIVE] = 10.0
    move_uncertainty: Annotated[Um, NOT_NEGATIVE] = 1.0
    facing: Direction | None = None
    increases_with: Literal["gap", "approach"] | None = None
    gain: Amount | None = None


class ScaleCalibration(Strict):
    """`calibrations.*` of kind scale: a data sheet's gain and the way the probe looks, where there is no jump
    test.

    kind: scale
    axis: the axis that it measures
    gain: with a unit: 250 um/V
    offset: added after the gain, in the unit of the result
    facing: the way a probe that stands on the table looks, and the opposite of where one in the spindle does; gives
        the sign
    increases_with: what makes the reading grow: gap or approach
    uncertainty: of the gain: 2 %
    """

    kind: Literal["scale"]
    axis: Literal["X", "Y", "Z", "A", "B", "C"] | None = None
    gain: Amount
    offset: Amount = 0
    facing: Direction | None = None
    increases_with: Literal["gap", "approach"] = "gap"
    uncertainty: Annotated[Amount, NOT_NEGATIVE] | None = None


class LinearCalibration(Strict):
    """`calibrations.*` of kind linear: value = gain * raw + offset, with units.

    kind: linear
    gain: factor, with a unit where it changes the unit
    offset: added after the gain: -0.12 K
    """

    kind: Literal["linear"]
    gain: Amount = 1
    offset: Amount = 0


class PlatinumCalibration(Strict):
    """`calibrations.*` of a platinum thermometer that is logged in ohm: the curve of IEC 60751. Leads are taken away
    before it, by a linear calibration: calibration: [leads, pt].

    kind: by its resistance at 0 degC: pt100, pt200, pt500, pt1000
    """

    kind: Literal["pt100", "pt200", "pt500", "pt1000"]


Calibration = Annotated[
    JumpCalibration | ScaleCalibration | LinearCalibration | PlatinumCalibration, Field(discriminator="kind")
]
