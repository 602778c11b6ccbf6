"""What the store holds of a model's predictions: curves of a test, and residuals of many tests in a few bins each."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from thermodata.plugin import Bool1D, Float1D
from thermodata.store.base.connection import fetch
from thermodata.store.views.wide import file_list
from thermodata.view.grid.floats import floats

if TYPE_CHECKING:
    import duckdb

    from thermodata.store import Store

Key = tuple[str, str]
_CONTRIBUTION, _DEVIATION = "c__", "sd__"


@dataclass(frozen=True, slots=True)
class Prediction:
    """A model in a test, as it was stored with its fit; arrays have shape (n,). residual is measured - predicted, and
    counts where valid. contributions: of each effect, in the response's unit. deviations: standard deviations of
    'predicted' and of contributions, by the uncertainty of the parameters; of those that were known at the fit."""

    campaign: str
    test: str
    response: str
    t_s: Float1D
    measured: Float1D
    predicted: Float1D
    residual: Float1D
    valid: Bool1D
    contributions: Mapping[str, Float1D]
    deviations: Mapping[str, Float1D] = field(default_factory=dict)


def predictions(store: Store, model: str, campaign: str, test: str) -> list[Prediction]:
    """One for each response; none where the model was not predicted: a locked test, a channel that is missing."""
    found = []
    with store.reader() as con:
        for response, path in _paths(con, store.path, model, [(campaign, test)]).get((campaign, test), ()):
            got = con.execute(f"select * from read_parquet({file_list([path])}) order by t_s").fetchnumpy()
            columns = {name: floats(values) for name, values in got.items() if name != "valid"}
            found.append(
                Prediction(
                    campaign,
                    test,
                    response,
                    columns["t_s"],
                    columns["measured"],
                    columns["predicted"],
                    columns["residual"],
                    np.asarray(got["valid"], dtype=bool),
                    _columns_begun(columns, _CONTRIBUTION),
                    _columns_begun(columns, _DEVIATION),
                )
            )
    return found


def _columns_begun(columns: Mapping[str, Float1D], begun: str) -> dict[str, Float1D]:
    return {n.removeprefix(begun): v for n, v in columns.items() if n.startswith(begun)}


def residual_strips(
    store: Store, model: str, keys: Sequence[Key], response: str | None = None, bins: int = 60
) -> dict[Key, Float1D]:
    """(campaign, test) -> the mean residual in each of `bins` even stretches of the prediction, shape (bins,); NaN
    where nothing was measured. Of a test of fewer samples than stretches each has that of the sample next to it. Tests
    without a prediction are absent. response: the first one where None."""
    with store.reader() as con:
        listed = _paths(con, store.path, model, keys)
        paths = {
            key: path
            for key, found in listed.items()
            if (path := next((p for r, p in found if response in (None, r)), None)) is not None
        }
        if not paths:
            return {}
        got = con.execute(
            f"with r as (select file_index as i, t_s, residual, valid from read_parquet({file_list(paths.values())})), "
            "s as (select i, min(t_s) as low, greatest(max(t_s) - min(t_s), 1e-9) as span from r group by 1) "
            "select r.i, least(cast(floor((r.t_s - s.low) / s.span * $bins) as integer), $bins - 1) as k, "
            "avg(r.residual) filter (r.valid and isfinite(r.residual)) as residual, count(*) as n "
            "from r join s on s.i = r.i group by all",
            {"bins": bins},
        ).fetchall()
    strips = {key: np.full(bins, np.nan) for key in paths}
    sampled = {key: np.zeros(bins, np.bool_) for key in paths}
    names = list(paths)
    few = dict.fromkeys(paths, True)
    for i, k, value, n in got:
        sampled[names[i]][k] = True
        few[names[i]] &= n == 1
        if value is not None:
            strips[names[i]][k] = value
    return {
        key: _strip_of_nearer(strip, sampled[key]) if few[key] and sampled[key].any() else strip
        for key, strip in strips.items()
    }


def _strip_of_nearer(strip: Float1D, sampled: Bool1D) -> Float1D:
    """The strip of a short test, whose stretches between two samples have that of the nearer one: they were measured,
    only less often than they are drawn. sampled: shape (bins,), whether a sample lies there."""
    at = np.flatnonzero(sampled)
    middles = (at[1:] + at[:-1] + 1) / 2
    return strip[at[np.searchsorted(middles, np.arange(len(strip)), side="right")]]


def residual_courses(store: Store, model: str, keys: Sequence[Key]) -> dict[tuple[str, str, str], Float1D]:
    """(campaign, test, response) -> the residual over the prediction's own grid, shape (n,); NaN where none counts."""
    with store.reader() as con:
        listed = [(*key, r, p) for key, found in _paths(con, store.path, model, keys).items() for r, p in found]
        if not listed:
            return {}
        got = con.execute(
            "select file_index as i, case when valid then residual end as residual "
            f"from read_parquet({file_list(p for *_, p in listed)}) order by file_index, t_s"
        ).fetchnumpy()
    values, which = floats(got["residual"]), np.asarray(got["i"])
    edges = np.searchsorted(which, np.arange(len(listed) + 1))
    return {(c, t, r): values[edges[i] : edges[i + 1]] for i, (c, t, r, _) in enumerate(listed)}


def _paths(
    con: duckdb.DuckDBPyConnection, folder: Path, model: str, keys: Sequence[Key]
) -> dict[Key, list[tuple[str, str]]]:
    """(response, path) of the files that are there, by test, in the order of the responses."""
    rows = fetch(
        con,
        "select campaign, test, response, path from prediction p where model = ? and list_contains(?, test) "
        "order by (select list_position(string_split(m.response, ', '), p.response) "
        "from model m where m.model = p.model), response",
        [model, sorted({test for _, test in keys})],
    )
    found: dict[Key, list[tuple[str, str]]] = {}
    for row in rows:
        key = (row["campaign"], row["test"])
        if key in set(keys) and (folder / row["path"]).is_file():
            found.setdefault(key, []).append((row["response"], row["path"]))
    return found


@dataclass(frozen=True, slots=True)
class RangeFigures:
    """What a stretch of a test does to its error [of the response]. n: samples that count, in all and inside. rmse_*:
    None where none counts."""

    n: int
    n_inside: int
    rmse: float | None
    rmse_inside: float | None
    rmse_without: float | None


def range_figures(found: Prediction, from_s: float, to_s: float) -> RangeFigures:
    """The error in a stretch, and of the test without it, by the model as it was fitted: nothing is fitted again."""
    counts = found.valid & np.isfinite(found.residual)
    inside = counts & (found.t_s >= from_s) & (found.t_s <= to_s)

    def rmse(mask: Bool1D) -> float | None:
        return float(np.sqrt(np.mean(found.residual[mask] ** 2))) if mask.any() else None

    return RangeFigures(int(counts.sum()), int(inside.sum()), rmse(counts), rmse(inside), rmse(counts & ~inside))
