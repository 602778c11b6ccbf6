"""The model file: a response and the effects that explain it. Contract `model/1`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import Field, PlainSerializer, field_validator, model_validator

from thermodata.schema.files.campaign import Seconds, Strict
from thermodata.schema.strict.declared import NOT_TYPED, WrongKeyError, WrongValueError
from thermodata.schema.strict.printed import NumberOrUnit, PrintedNumber

# a model written as JSON is a model file again, and there a time has a unit
_WITH_UNIT = PlainSerializer(lambda s: f"{s:.12g} s", return_type=str, when_used="json")


class Response(Strict):
    """`response`: what is modelled: a displacement by axis and place, or any channel by name.

    axis: of the displacement
    at: its place: tcp
    channel: name of a channel, in place of axis and place
    """

    axis: Literal["X", "Y", "Z", "A", "B", "C"] | None = None
    at: str | None = None
    channel: str | None = None

    @model_validator(mode="after")
    def _one_way(self) -> Response:
        if (self.channel is None) == (self.axis is None):
            raise WrongValueError(
                "neither a displacement nor a channel", expected="{axis: Z, at: tcp} or {channel: name}"
            )
        return self


class Place(Strict):
    """A driver by its place: `{at: axis.z.nut}`. SpecError where no channel, or more than one, fits.

    at: dotted place
    """

    at: str


Driver = str | Place  # a channel, a difference "T_a - T_b", or a place


class EffectSpec(Strict):
    """`effects[]`: one effect of the model, with what is fixed of it.

    effect: name of an installed effect, or transfer_function, prediction, or model
    id: its name in the answers; by default the effect's, numbered where it repeats
    drivers: role -> channel, difference of channels (T_a - T_b), or {at: place}; found by place where left out
    calibrate_on: tests that identify this effect first, before the others; all of their phases count
    response: the effect is identified on this response first, and used as found
    acts_on: the responses that it acts on; by default all
    phases: the effect acts in these phases only, and is identified from them; between them it keeps what it had
        reached. heating is all the time that the machine works, unless the tests declare phases
    tests: the tests that it exists in (a slip); by default all
    method: of a transfer function: oe, arx, or varpro (a sum of lags)
    orders: of a transfer function: numbers of numerator and denominator coefficients; chosen where left out
    delay: of method arx: steps of the model by which its driver comes late; chosen on left-out data where left out
    also: what its drivers go through first, as parameters beside its own: dead_time [s], sensor_lag [s]
    gain_by: one gain for each value of a condition: conditions.spindle, or D; or test, machine, campaign, tool, or
        place (of the response: time constants are then shared by the places); or a list of them
    groups: values of gain_by that have one gain: {[D25, D63]: k1, D100: k2}
    one_gain: one factor g for each value of gain_by, over all gains of the effect
    shared: parameters that all groups of gain_by share; by default all; none: a function of its own for each
    fixed: parameter or gain -> value, in the effect's unit or with one: {tau: 18 min}; of a transfer function its
        coefficients as printed, and sample_s
    start: parameter -> where its search starts
    bounds: parameter -> [lower, upper], in the effect's unit
    file: of a prediction: CSV with the columns test, t_s [s], predicted, or as `predict --out` writes it
    name: of a model: its name or id in the store, or its file; what it predicts is the driver
    gain: of a model: a number holds the factor on its output; a word, or nothing, leaves it free (under that name)
    parts: of a model: ids of the effects whose sum is taken; by default all
    inside: set by fit: the model that `name` was, as it was then
    """

    effect: str
    id: str | None = None
    drivers: dict[str, Driver] = {}
    calibrate_on: list[str] | None = None
    response: Response | None = None
    acts_on: list[Response] | None = None
    phases: list[str] | None = None
    tests: list[str] | None = None
    method: Literal["oe", "arx", "varpro"] | None = None
    orders: tuple[int, int] | None = None
    delay: int | None = Field(default=None, ge=0)
    also: list[str] = []
    gain_by: str | list[str] | None = None
    groups: dict[str, str] = {}
    one_gain: bool = False
    shared: list[str] | Literal["none"] = []
    fixed: dict[str, PrintedNumber] = {}
    start: dict[str, NumberOrUnit] = {}
    bounds: dict[str, tuple[NumberOrUnit, NumberOrUnit]] = {}
    file: str | None = None
    name: str | None = None
    gain: float | str | None = None
    parts: list[str] | None = None
    inside: dict[str, Any] | None = Field(default=None, json_schema_extra=NOT_TYPED)

    @field_validator("groups", mode="before")
    @classmethod
    def _key_for_each_value(cls, value: Any) -> Any:
        """{"[D25, D63]": k1} -> {D25: k1, D63: k1}: a list as a key means each of its values."""
        if not isinstance(value, dict):
            return value
        named: dict[str, str] = {}
        for key, label in value.items():
            for one in str(key).strip().removeprefix("[").removesuffix("]").split(","):
                if one.strip() in named:
                    raise ValueError(f"'{one.strip()}' is in two groups")
                named[one.strip()] = str(label)
        return named

    @model_validator(mode="after")
    def _belongs_to_gain_by(self) -> EffectSpec:
        if self.gain_by is None and (self.groups or self.one_gain):
            raise ValueError(f"'{'groups' if self.groups else 'one_gain'}' needs 'gain_by'")
        return self

    def shares(self, parameter: str) -> bool:
        """Whether all groups of gain_by have one value of a parameter."""
        return not self.shared or (self.shared != "none" and parameter in self.shared)

    @property
    def gains_by(self) -> tuple[str, ...]:
        """What each gain belongs to, without 'conditions.'; empty where one gain serves all."""
        names = [self.gain_by] if isinstance(self.gain_by, str) else self.gain_by or []
        return tuple(name.removeprefix("conditions.") for name in names)


class Model(Strict):
    """A model file: a response and the sum of effects that explains it.

    schema: thermodata/model/1
    name: of the model; its id is a hash of this file and the data
    campaigns: several campaigns; their tests are campaign/test
    campaign: the one campaign
    response: what is modelled, or a list
    calibrate_on: tests that are fitted; by default those with the role calibration
    verify_on: tests that are scored; by default those with the role verification
    locked: tests that are opened to confirm a cause only; by default those with the role locked
    phases: the phases that count: [heating]; by default all
    weights: test or phase -> weight of its samples in the fit: {etve: 0.2}; by default 1
    step: of the grid of fit and simulation [s]
    effects: the sum
    in_sample: set by add: verification tests are fitted too, and their scores say so
    in_sample_on: set where such a model is fitted again: those that took part in the choice; null: all
    taken_back: set by remove: id of the version that an effect was taken out of
    notes: free text
    """

    schema_: Literal["thermodata/model/1"] = Field(alias="schema")
    name: str
    campaigns: list[str] = []
    campaign: str | None = None
    response: Response | list[Response]
    calibrate_on: list[str] | None = None
    verify_on: list[str] | None = None
    locked: list[str] | None = None
    phases: list[str] | None = None
    weights: dict[str, Annotated[float, Field(ge=0)]] = {}
    step: Annotated[Seconds, Field(gt=0), _WITH_UNIT] = 30.0
    effects: list[EffectSpec] = []
    in_sample: bool = Field(default=False, json_schema_extra=NOT_TYPED)
    in_sample_on: list[str] | None = Field(default=None, json_schema_extra=NOT_TYPED)
    taken_back: str | None = Field(default=None, json_schema_extra=NOT_TYPED)
    notes: str = ""

    @field_validator("campaign", mode="before")
    @classmethod
    def _one_campaign(cls, value: Any) -> Any:
        if isinstance(value, list):
            raise WrongValueError(
                "several campaigns stand under 'campaigns'",
                expected="campaign: ID, or campaigns: [ID, ID]",
                hint=f"campaigns: [{', '.join(map(str, value))}]",
            )
        return value

    @field_validator("response", mode="before")
    @classmethod
    def _by_mappings(cls, value: Any) -> Any:
        listed = value if isinstance(value, list) else [value]
        known = all(isinstance(one, str | Mapping) for one in listed)  # of anything else the next check says what it is
        if known and any(isinstance(one, str) for one in listed):
            whole = [{"channel": one} if isinstance(one, str) else one for one in listed]
            meant = ", ".join("{" + ", ".join(f"{k}: {v}" for k, v in dict(one).items()) + "}" for one in whole)
            raise WrongValueError(
                "a response is said by its place or as a channel, not by a name alone",
                expected="{axis: Z, at: tcp} or {channel: name}, or a list of such",
                hint=f"response: [{meant}]" if isinstance(value, list) else f"response: {meant}",
            )
        return value

    @field_validator("response")
    @classmethod
    def _at_least_one(cls, value: Any) -> Any:
        if isinstance(value, list) and not value:
            raise WrongValueError("no response", expected="at least one: {axis: Z, at: tcp}")
        return value

    @model_validator(mode="after")
    def _campaigns(self) -> Model:
        if bool(self.campaigns) == (self.campaign is not None):
            raise WrongKeyError(
                "campaigns" if self.campaign is not None or "campaigns" in self.model_fields_set else "campaign",
                "a model names its data with either 'campaign' or 'campaigns'",
                expected="campaign: ID, or of several campaigns: [ID, ID]",
                hint="'thermodata tests' lists the campaigns of a store",
            )
        return self

    @property
    def campaign_ids(self) -> tuple[str, ...]:
        """The campaigns, however many and however named."""
        return tuple(self.campaigns) or ((self.campaign,) if self.campaign else ())

    @property
    def responses(self) -> tuple[Response, ...]:
        """The responses, however many and however named."""
        return tuple(self.response) if isinstance(self.response, list) else (self.response,)
