"""Samples of which a log itself says that nothing was measured: an empty cell, a comment, a status."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from thermodata.schema.flag import Flag

if TYPE_CHECKING:
    from thermodata.store import Store

SAID_BY_LOG = "the log has no value there, leaps to 0 in all channels, or says in a comment or a status that it is none"
OUTSIDE = "outside of the test's measuring"

_TESTS = """
select distinct f.campaign, f.test from file f join test t on t.campaign = f.campaign and t.test = f.test
where f.layer = 'tidy' and t.measuring is null
  and coalesce(try_cast(f."columns"->>'$.flags.not_measuring' as bigint), 0) > 0
  and ($campaign is null or f.campaign = $campaign) and ($test is null or f.test = $test) order by all"""
_STRETCHES = """
with told as (
    select source, channel, t_s, t_s - lag(t_s) over own > $apart * coalesce(step_s, 0) as begins
    from sample left join (select source, max(step_s) as step_s from source
                           where campaign = $campaign and test = $test group by all) using (source)
    where campaign = $campaign and test = $test and flag & $flag <> 0
    window own as (partition by source, channel order by t_s)),
numbered as (
    select source, channel, t_s, count(*) filter (begins) over (partition by source, channel order by t_s) as stretch,
           count(*) filter (begins) over (partition by source, channel) < $most as few from told)
select source, channel, min(t_s) as from_s, max(t_s) as to_s, count(*) as n from numbered
group by source, channel, case when few then stretch end order by from_s, source, channel"""
_APART = 1.5  # steps between two samples of one stretch
_MOST = 50  # stretches of a channel; of more the first and the last sample are told


def not_measured(store: Store, campaign: str | None = None, test: str | None = None) -> list[dict[str, Any]]:
    """Rows as those of `quality_event`, one a stretch of a channel, of the tests that declare no `measuring`: in the
    others such samples can't be told from those outside of it."""
    with store.reader() as con:
        return [
            {
                "campaign": of_campaign,
                "test": of_test,
                "source": source,
                "stream": None,
                "channel": channel,
                "flag": Flag.NOT_MEASURING.word,
                "from_s": from_s,
                "to_s": to_s,
                "n": n,
                "detail": SAID_BY_LOG,
            }
            for of_campaign, of_test in con.execute(_TESTS, {"campaign": campaign, "test": test}).fetchall()
            for source, channel, from_s, to_s, n in con.execute(
                _STRETCHES,
                {
                    "campaign": of_campaign,
                    "test": of_test,
                    "flag": int(Flag.NOT_MEASURING),
                    "apart": _APART,
                    "most": _MOST,
                },
            ).fetchall()
        ]
