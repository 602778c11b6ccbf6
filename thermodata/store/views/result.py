"""The views over tests' phases and quality, and over models: residuals, scores, findings, history."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from thermodata.store.base.connection import literal
from thermodata.store.base.files import is_whole
from thermodata.store.views.identifiers import identified
from thermodata.store.views.wide import file_list, prefix

if TYPE_CHECKING:
    import duckdb

PHASE = """create view phase as
select p.campaign, p.test, p.entry.key as phase, p.entry.value[1] as from_s, p.entry.value[2] as to_s
from (select campaign, test, unnest(map_entries(cast(phases as map(varchar, double[])))) as entry
      from test where phases is not null and json_type(phases) = 'OBJECT') p
order by all"""

# what came before a window is no sample of the test: of one recording it would be told in each of its tests
OF_ITS_TEST = """not exists (select 1 from test t where t.campaign = e.campaign and t.test = e.test
    and t.window_s is not null and t.history = 'recording' and e.to_s < 0)"""
QUALITY = f"""create view quality as
select campaign, test, source, channel, lower(flag) as flag, from_s, to_s, n, detail from quality_event e
where {OF_ITS_TEST}"""

GAP = f"""create view gap as
select campaign, test, source, channel, from_s, to_s, to_s - from_s as duration_s, detail
from quality_event e where lower(flag) = 'gap' and {OF_ITS_TEST}"""

_STALE = "coalesce((select m.stale from model m where m.model = {}.model), false)"
SCORE = f"""create view score as
select campaign, test, model, role, response, phase, fit, rmse_um, ptp_um, ptp_residual_um, max_um, n,
       {_STALE.format("score_row")} as stale
from score_row"""

# a model may have several responses; a diagnosis is of one of them
_ASKED = "(select max(d.payload->>'$.response') from finding d where d.kind = 'diagnosis' and d.model = finding.model)"

WEAK_SPOT = f"""create view weak_spot as
select coalesce(nullif(campaign, ''), payload->>'$.campaign') as campaign,
       coalesce(nullif(test, ''), payload->>'$.test') as test, model, rank,
       cast(payload->>'$.from_s' as double) as from_s, cast(payload->>'$.to_s' as double) as to_s,
       cast(payload->>'$.rmse_um' as double) as rmse_um, payload->>'$.state' as state,
       {_ASKED} as response
from finding where kind = 'weak_spot'"""

_NUMBERS = (
    "p_value",
    "rmse_um_before",
    "rmse_um_after",
    "fit_before",
    "fit_after",
    "locked_rmse_um_before",
    "locked_rmse_um_after",
)
# what is of a whole model belongs to its campaign, where that is one; a row a campaign would count it several times
_CAMPAIGNS = "(select m.campaigns from model m where m.model = finding.model)"
_OWN = f"""coalesce(nullif(campaign, ''), case when len({_CAMPAIGNS}) = 1 then {_CAMPAIGNS}[1] end) as campaign,
       nullif(test, '') as test, model"""
CANDIDATE = f"""create view candidate as
select {_OWN}, coalesce(rank, cast(payload->>'$.rank' as integer)) as rank, payload->>'$.id' as id,
       payload->>'$.effect' as effect, payload->>'$.family' as family,
       cast(payload->'$.drivers' as varchar[]) as drivers, cast(payload->>'$.claimed' as boolean) as claimed,
       {", ".join(f"cast(payload->>'$.{name}' as double) as {name}" for name in _NUMBERS)},
       cast(payload->'$.beside' as varchar[]) as beside,
       payload->'$.parameters' as parameters, cast(payload->'$.equivalent' as varchar[]) as equivalent,
       payload->>'$.why' as why, {_ASKED} as response, {_CAMPAIGNS} as campaigns,
       {_STALE.format("finding")} as stale,
       cast(payload->>'$.locked_rmse_um_fitted' as double) as locked_rmse_um_fitted
from finding where kind = 'candidate'"""

ARTEFACT = f"""create view artefact as
select coalesce(nullif(campaign, ''), payload->>'$.campaign') as campaign,
       coalesce(nullif(test, ''), nullif(payload->>'$.test', '')) as test, model, payload->>'$.kind' as kind,
       cast(payload->>'$.at_s' as double) as at_s, cast(payload->>'$.size_um' as double) as size_um,
       payload->>'$.why' as why, {_ASKED} as response
from finding where kind = 'artefact'"""

DIAGNOSIS = f"""create view diagnosis as
select {_OWN}, payload->>'$.response' as response, payload->>'$.verdict' as verdict,
       cast(payload->>'$.noise_um' as double) as noise_um, cast(payload->>'$.rmse_um' as double) as rmse_um,
       cast(payload->>'$.explainable' as double) as explainable, payload->>'$.next_test' as next_test,
       payload, created_at, {_CAMPAIGNS} as campaigns
from finding where kind = 'diagnosis'"""

# a model without tests of a role has NULL there; several tests pool by their samples
# verification tests that took part in a fit keep their role, with a label
_IN = "s.role in ('{role}', '{role} (in-sample)')"
_POOLED = ", ".join(
    f"sqrt(sum(s.rmse_um * s.rmse_um * s.n) filter (where {_IN}) / "
    f"nullif(sum(s.n) filter (where {_IN} and s.rmse_um is not null), 0)) as rmse_um_{{role}}, "
    f"avg(s.fit) filter (where {_IN}) as fit_{{role}}".format(role=role)
    for role in ("calibration", "verification", "locked")
)
HISTORY = f"""create view history as
with recursive chain as (
  select model, model as root, 1 as version from model
  where parent is null or parent not in (select model from model)
  union
  select m.model, c.root, c.version + 1 from model m join chain c on m.parent = c.model),
errors as (select s.model, s.response, count(distinct (s.campaign, s.test)) as tests, {_POOLED},
                  coalesce(bool_or(s.role = 'verification (in-sample)'), false) as in_sample
           from score_row s where s.phase = 'all' group by s.model, s.response)
select m.name, c.version, m.model, m.parent, c.root, m.created_at, m.stale, m.campaigns,
       coalesce(e.response, m.response) as response, e.* exclude (model, response)
from model m join chain c on c.model = m.model left join errors e on e.model = m.model
order by c.root, c.version, m.created_at, response"""

_TRANSFER = ("g", "g_end", "fit_n", "fit_c", "ptp_measured", "ptp_n", "ptp_c")
PORTABILITY = f"""create view portability as
select coalesce(nullif(campaign, ''), payload->>'$.campaign') as campaign,
       coalesce(nullif(test, ''), payload->>'$.test') as test, model, payload->>'$.machine' as machine,
       payload->>'$.role' as role, payload->>'$.response' as response,
       {", ".join(f"cast(payload->>'$.{name}' as double) as {name}" for name in _TRANSFER)},
       payload->>'$.verdict' as verdict
from finding where kind = 'portability'"""

_OF_RESPONSE = "in the response's unit: [um] of a displacement, [K] of a temperature"
_CAMPAIGN = "of the model; NULL where it has several: these stand in campaigns"
_EACH = "all of the model: join test t on list_contains(campaigns, t.campaign)"
_TEST = "NULL: it is of all open tests of the model together"
_CHANGED = "whether the data of the model changed since it was fitted"
SCORE_COMMENTS = {
    "role": "of the test in this model; verification (in-sample) where it was fitted too, as by add: "
    "role like 'verification%' takes both",
    "fit": "[%] free run, not clipped",
    "rmse_um": _OF_RESPONSE,
    "ptp_um": f"{_OF_RESPONSE}; peak to peak, measured",
    "ptp_residual_um": f"{_OF_RESPONSE}; peak to peak of the residual",
    "max_um": _OF_RESPONSE,
}
_COMMENTS = {
    "phase": {"from_s": "[s] from the start of the test", "to_s": "[s] from the start of the test"},
    "gap": {"from_s": "[s] from the start of the test", "to_s": "[s] from the start of the test", "duration_s": "[s]"},
    "quality": {"from_s": "[s] from the start of the test", "to_s": "[s] from the start of the test"},
    "score": {**SCORE_COMMENTS, "stale": _CHANGED},
    "candidate": {
        "stale": _CHANGED,
        "campaign": _CAMPAIGN,
        "test": _TEST,
        "campaigns": _EACH,
        "p_value": "[1]",
        "beside": "ids of what stands in the model too where errors are told; empty: in the user's own model",
        "rmse_um_before": _OF_RESPONSE,
        "rmse_um_after": _OF_RESPONSE,
        "fit_before": "[%]",
        "fit_after": "[%]",
        "locked_rmse_um_fitted": f"{_OF_RESPONSE}; the model as it is fitted; NULL where its refit leaves as much",
        "locked_rmse_um_before": f"{_OF_RESPONSE}; the model refitted to all open tests",
        "locked_rmse_um_after": _OF_RESPONSE,
    },
    "artefact": {"at_s": "[s] from the start of the test", "size_um": _OF_RESPONSE},
    "diagnosis": {
        "campaign": _CAMPAIGN,
        "test": _TEST,
        "campaigns": _EACH,
        "noise_um": _OF_RESPONSE,
        "rmse_um": _OF_RESPONSE,
        "explainable": "[1] largest fall of the squared error that a candidate gives",
    },
    "residual": {
        "t_s": "[s] from the start of the test",
        "measured": "in channel.unit",
        "predicted": "in channel.unit",
        "residual": f"{_OF_RESPONSE}; measured - predicted",
        "stale": _CHANGED,
    },
    "portability": {
        "g": "[1] gain of the largest FIT, through the zero of the first samples",
        "g_end": "[1] from the end of heating",
        "fit_n": "[%] as it is",
        "fit_c": "[%] with the gain",
        "ptp_measured": f"{_OF_RESPONSE}; |max| + |min|, measured",
        "ptp_n": f"{_OF_RESPONSE}; residual as it is",
        "ptp_c": f"{_OF_RESPONSE}; residual with the gain",
    },
    "weak_spot": {
        "from_s": "[s] from the start of the test",
        "to_s": "[s] from the start of the test",
        "rmse_um": _OF_RESPONSE,
    },
    "history": {
        "rmse_um_calibration": _OF_RESPONSE,
        "rmse_um_verification": _OF_RESPONSE,
        "rmse_um_locked": _OF_RESPONSE,
        "in_sample": "whether verification tests were fitted too, for they helped to choose an effect",
        "fit_calibration": "[%]",
        "fit_verification": "[%]",
        "fit_locked": "[%]",
    },
}

_OF_MODEL = ("campaign", "test", "model", "response")
_IDENTIFIED = {
    "phase": ("campaign", "test"),
    **dict.fromkeys(("gap", "quality"), ("campaign", "test", "source", "channel")),
    **dict.fromkeys(("score", "weak_spot", "candidate", "artefact", "diagnosis", "residual"), _OF_MODEL),
    "portability": (*_OF_MODEL, "machine"),
    "history": ("model", "parent", "root", "response"),
}


def result_views(con: duckdb.DuckDBPyConnection, folder: Path | None) -> Iterator[str]:
    """The statements that make the views over tables, and `residual` over the prediction files."""
    yield from (PHASE, QUALITY, GAP, SCORE, WEAK_SPOT, CANDIDATE, ARTEFACT, DIAGNOSIS, HISTORY, PORTABILITY)
    paths = [path for (path,) in con.execute("select distinct path from prediction order by path").fetchall()]
    gone = [p for p in paths if folder is not None and not is_whole(folder / p)]
    yield _residual(paths, gone[0] if gone else None)
    for view, ids in _IDENTIFIED.items():
        own = _COMMENTS.get(view, {})
        yield from identified(view, (name for name in ids if name not in own))
    for view, columns in _COMMENTS.items():
        for column, comment in columns.items():
            yield f"comment on column {view}.{column} is {literal(comment)}"


def _residual(paths: list[str], gone: str | None) -> str:
    head = "create view residual as select p.campaign, p.test, p.model, p.response, "
    names = ("t_s double", "measured double", "predicted double", "residual double", "valid boolean")
    stale = _STALE.format("p")
    if not paths or gone:
        empty = ", ".join(f"null::{n.split()[1]} as {n.split()[0]}" for n in names)
        text = f"damaged store: {gone} is gone or cut; try: fit the model again, or forget it"
        return f"{head}{empty}, {stale} as stale from prediction p " + (
            f"where cast(error({literal(text)}) as boolean)" if gone else "limit 0"
        )
    columns = ", ".join(f"r.{n.split()[0]}" for n in names)
    listed = f"select q.*, {_STALE.format('q')} as stale, p.prefix || q.path as filename"
    return (
        f"{head}{columns}, p.stale from read_parquet({file_list(paths)}, filename = true, hive_partitioning = false) r "
        f"join ({listed} from prediction q cross join {prefix(paths[0])}) p "
        f"on p.filename = r.filename"
    )
