"""The model file: a response and the effects that explain it. Contract `model/1`."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field, PlainSerializer, field_validator, model_validator

from thermodata.schema.campaign import Seconds, Strict

# a model written as JSON is a model file again, and there a time has a unit
_WITH_UNIT = PlainSerializer(lambda s: f"{s:.12g} s", return_type=str, when_used="json")


class Response(Strict):
    """Either a displacement by axis and place, or any channel by name."""

    axis: Literal["X", "Y", "Z", "A", "B", "C"] | None = None
    at: str | None = None
    channel: str | None = None

    @model_validator(mode="after")
    def _one_way(self) -> Response:
        if (self.channel is None) == (self.axis is None):
            raise ValueError("a response is either {axis: Z, at: tcp} or {channel: name}")
        return self


class Place(Strict):
    at: str


Driver = str | Place  # a channel, a difference "T_a - T_b", or a place


class EffectSpec(Strict):
    effect: str
    id: str | None = None  # default: the effect's name, numbered when repeated
    drivers: dict[str, Driver] = {}
    calibrate_on: list[str] | None = None
    tests: list[str] | None = None  # the effect exists in these tests only (a slip)
    method: Literal["oe", "arx", "varpro"] | None = None
    orders: tuple[int, int] | None = None
    gain_by: str | None = None  # "conditions.spindle": one gain for each value
    shared: list[str] = []
    fixed: dict[str, float] = {}
    start: dict[str, float] = {}
    bounds: dict[str, tuple[float, float]] = {}
    file: str | None = None


class Model(Strict):
    schema_: Literal["thermodata/model/1"] = Field(alias="schema")
    name: str
    campaigns: list[str] = []
    campaign: str | None = None
    response: Response | list[Response]
    calibrate_on: list[str] | None = None
    verify_on: list[str] | None = None
    locked: list[str] | None = None
    phases: list[str] | None = None
    step: Annotated[Seconds, Field(gt=0), _WITH_UNIT] = 30.0
    effects: list[EffectSpec] = []
    in_sample: bool = False  # verify_on is fitted too, and its scores say so (set by add)
    notes: str = ""

    @field_validator("response")
    @classmethod
    def _some(cls, value: Any) -> Any:
        if isinstance(value, list) and not value:
            raise ValueError("a model needs at least one response")
        return value

    @model_validator(mode="after")
    def _campaigns(self) -> Model:
        if bool(self.campaigns) == (self.campaign is not None):
            raise ValueError("a model names its data with either 'campaign' or 'campaigns'")
        return self

    @property
    def campaign_ids(self) -> tuple[str, ...]:
        return tuple(self.campaigns) or ((self.campaign,) if self.campaign else ())

    @property
    def responses(self) -> tuple[Response, ...]:
        return tuple(self.response) if isinstance(self.response, list) else (self.response,)
