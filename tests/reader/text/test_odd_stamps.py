"""Formats that are guessed: the one that fits, and none where two do, or a part is not understood."""

from __future__ import annotations

from datetime import datetime, timedelta

import pytest

from thermodata.reader.text.times.odd_stamps import guess_format

FIRST = datetime(2026, 3, 2, 8)


def stamps(form: str, step: timedelta) -> list[str]:
    return [f"{FIRST + i * step:{form}}" for i in range(100)]


@pytest.mark.parametrize("step", [timedelta(seconds=10), timedelta(hours=10)])
@pytest.mark.parametrize(
    "form",
    [
        "%d-%b-%Y %H:%M:%S",
        "%d. %B %Y %H:%M:%S",
        "%b %d, %Y %H:%M:%S",
        "%a %b %d %H:%M:%S %Y",
        "%a %d.%m.%Y %H:%M:%S",
        "%Y%m%d%H%M%S",
        "%Y%m%d_%H%M",
        "%Y%m%d",
        "%Y_%m_%d_%H_%M_%S",
        "%Y-%m-%d %H-%M-%S",
        "%d.%m.%Y %H.%M.%S,%f",
        "%d-%b-%y %I.%M.%S.%f %p",
        "%Y %m %d %H:%M",
    ],
)
def test_the_format_that_fits_all_stamps(form: str, step: timedelta) -> None:
    assert guess_format(stamps(form, step)) == form


@pytest.mark.parametrize(
    "form",
    ["%Y-%m-%d %H:%M:%S CEST", "%d. Monat %Y %H:%M", "%Y-%m-%d %H:%M:%S+01:00", "%Y-%j", "%H%M%S", "%S:%M", "x%d"],
)
def test_none_where_a_part_is_not_understood(form: str) -> None:
    assert guess_format(stamps(form, timedelta(hours=1))) is None


def test_day_and_month_are_told_by_the_numbers_or_not_at_all() -> None:
    assert guess_format(stamps("%d/%m/%Y %H-%M", timedelta(seconds=10))) is None
    assert guess_format(stamps("%d/%m/%Y %H-%M", timedelta(days=1))) == "%d/%m/%Y %H-%M"
    assert guess_format(stamps("%m/%d/%Y %H-%M", timedelta(days=1))) == "%m/%d/%Y %H-%M"


def test_one_that_fits_too_few_is_none() -> None:
    some = stamps("%d-%b-%Y %H:%M:%S", timedelta(hours=1))
    assert guess_format([*some[:80], *["---"] * 20]) is None
    assert guess_format([]) is None
