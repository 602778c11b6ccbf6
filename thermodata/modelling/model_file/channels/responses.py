"""Which channel a response of a model is, in each campaign."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TypeVar

from thermodata.effect.places import holds
from thermodata.errors import SpecError, ThermodataError, unknown_channel
from thermodata.schema.agreed.effect_ids import ids_of
from thermodata.schema.files.model import Model, Response
from thermodata.schema.units.quantity import PROBED
from thermodata.schema.words.sentences import counted
from thermodata.view.grid.dataset import ChannelInfo

Found = TypeVar("Found")


class MissingChannelError(SpecError):
    """A campaign has no channel for something: another campaign may have it."""


def known_responses(spec: Model, by_campaign: Mapping[str, Mapping[str, ChannelInfo]]) -> None:
    """SpecError where an effect acts on what is no response of the model, or on nothing."""
    modelled = first_names(spec.responses, by_campaign)
    for name, effect in zip(ids_of((e.effect, e.id) for e in spec.effects), spec.effects, strict=True):
        acted_on = modelled if effect.acts_on is None else first_names(effect.acts_on, by_campaign)
        if not acted_on or set(acted_on) - set(modelled):
            raise SpecError(
                "an effect acts on responses of its model",
                where=f"effect '{name}': acts_on",
                expected=f"some of {', '.join(modelled)}",
                got=", ".join(acted_on) or "none",
                hint="leave 'acts_on' out where it acts on all of them",
            )


def first_names(responses: Sequence[Response], by_campaign: Mapping[str, Mapping[str, ChannelInfo]]) -> list[str]:
    """The channel that each response is in the first campaign that has it."""
    return [next(iter(response_by_campaign(r, by_campaign).values())) for r in responses]


def response_by_campaign(response: Response, by_campaign: Mapping[str, Mapping[str, ChannelInfo]]) -> dict[str, str]:
    """campaign -> channel. A campaign without the response can't be predicted, and is no error while another has it."""
    return where_it_is(by_campaign, lambda campaign, channels: find_response(response, channels, campaign))


def where_it_is(
    by_campaign: Mapping[str, Mapping[str, ChannelInfo]], find: Callable[[str, Mapping[str, ChannelInfo]], Found]
) -> dict[str, Found]:
    found: dict[str, Found] = {}
    missing: list[ThermodataError] = []
    for campaign, channels in by_campaign.items():
        try:
            found[campaign] = find(campaign, channels)
        except MissingChannelError as error:
            missing.append(error)
    if not found:
        raise missing[0]
    return found


def find_response(response: Response, channels: Mapping[str, ChannelInfo], campaign: str) -> str:
    """The channel that a response means. Ambiguity is an error that lists the choices."""
    if response.channel is not None:
        if response.channel not in channels:
            raise no_channel(response.channel, channels, f"response, campaign {campaign}")
        return response.channel
    moving = {n: i for n, i in channels.items() if i.quantity in PROBED}
    hits = [
        n
        for n, i in moving.items()
        if i.axis == response.axis and (response.at is None or i.at == response.at or holds(response.at, i.at))
    ]
    exact = [n for n in hits if response.at is not None and moving[n].at == response.at]
    hits = exact or hits
    wanted = f"{{axis: {response.axis}{f', at: {response.at}' if response.at else ''}}}"
    if not hits:
        raise MissingChannelError(
            f"no displacement is {wanted}",
            where=f"response, campaign {campaign}",
            expected=", ".join(f"{n} (axis {i.axis}, at {i.at})" for n, i in moving.items())
            or "a displacement channel",
            got=None if moving else f"no displacement among {counted(len(channels), 'channel')} with data",
            hint=None if moving else "ingest again: its losses tell which source had no file or no calibration",
        )
    if len(hits) > 1:
        raise SpecError(
            f"several displacements are {wanted}",
            where=f"response, campaign {campaign}",
            expected="one of them",
            got=", ".join(f"{n} (at {moving[n].at})" for n in hits),
            hint=f"name one: response: {{channel: {hits[0]}}}",
        )
    return hits[0]


def no_channel(name: str, channels: Mapping[str, ChannelInfo], where: str) -> MissingChannelError:
    said = unknown_channel(name, list(channels), where=where)
    return MissingChannelError(said.what, where=said.where, expected=said.expected, got=name, hint=said.hint)
