"""Flags that the campaign file overrules: the samples count again, the event stays and says why."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from thermodata.plugin import Float1D
from thermodata.schema.files.campaign import Campaign, Overrule
from thermodata.schema.flag import OVERRULED, Flag
from thermodata.store.tidy.flags.event import Event
from thermodata.store.tidy.values.chunk import Column


def rules_of(campaign: Campaign, test: str) -> list[Overrule]:
    """Those that hold in a test."""
    return [r for r in campaign.overrule if not r.tests or test in r.tests]


def overrule(rules: Sequence[Overrule], t_s: Float1D, columns: Mapping[str, Column]) -> None:
    """Takes flags away. t_s: from the test's start, shape (n,). A sample without a number stays out of range."""
    for rule in rules:
        bit = np.uint16(Flag[rule.flag.upper()])
        for name, column in columns.items():
            if rule.channel not in (None, name) or not column.flags.any():
                continue
            hit = (column.flags & bit) != 0
            if rule.window is not None:
                hit &= (t_s >= rule.window[0]) & (t_s <= rule.window[1])
            if column.values.dtype.kind == "f":
                hit &= np.isfinite(column.values)
            if hit.any():
                column.flags = np.where(hit, column.flags & ~bit, column.flags)


def overruled(rules: Sequence[Overrule], events: Sequence[Event]) -> list[Event]:
    """Events as they are then: one that lies wholly within a rule says its reason, one that lies partly in it both."""
    return [_with_reason(rules, event) for event in events]


def met(rules: Sequence[Overrule], events: Sequence[Event]) -> list[int]:
    """Which rules, counted from 0, find something among the events of a test."""
    return [i for i, rule in enumerate(rules) if any(_covers(rule, e) is not None for e in events)]


def idle(rules: Sequence[Overrule], found: Mapping[str, Sequence[int]]) -> list[str]:
    """What rules find nothing to overrule, in words. found: test -> the rules that are `met` there."""
    said = []
    for i, rule in enumerate(rules):
        tests = rule.tests or list(found)
        if not any(i in found.get(t, ()) for t in tests):
            where = f"test {', '.join(rule.tests)} has no" if rule.tests else "no test has a"
            on = f" on {rule.channel}" if rule.channel else ""
            said.append(f"overrule: {where} flag '{rule.flag}'{on} ({rule.because})")
    return said


def _with_reason(rules: Sequence[Overrule], event: Event) -> Event:
    for rule in rules:
        whole = _covers(rule, event)
        if whole is None:
            continue
        was = f" (was: {event.detail})" if event.detail else ""
        if whole:
            return replace(event, detail=f"{OVERRULED}{rule.because}{was}")
        a, b = rule.window or (0.0, 0.0)
        part = f"from {a:.6g} to {b:.6g} s {OVERRULED}{rule.because}"
        return replace(event, detail=f"{event.detail}; {part}" if event.detail else part)
    return event


def _covers(rule: Overrule, event: Event) -> bool | None:
    """Whether a rule covers an event wholly; None where it does not touch it."""
    if rule.flag != event.flag or rule.channel not in (None, event.channel):
        return None
    if rule.window is None:
        return True
    if event.to_s < rule.window[0] or event.from_s > rule.window[1]:
        return None
    return rule.window[0] <= event.from_s and event.to_s <= rule.window[1]
