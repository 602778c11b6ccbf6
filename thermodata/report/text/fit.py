"""A fit and a comparison as text for a person: in the terminal and in a notebook."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from thermodata.report.collected.lost import lost_of_chain, results_gone_of_chain
from thermodata.report.text.table import prose, table
from thermodata.report.words.glossary import IN_SAMPLE, LEVEL, SEEN_SINCE, explained
from thermodata.report.words.numbers import base_role, duration, in_sample, number

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from thermodata.modelling.compare.differences import TestDifference
    from thermodata.report.collected.data import ReportData
    from thermodata.schema.answers.diagnosis import WeakSpot
    from thermodata.schema.answers.result import Check, FitResult, Score
    from thermodata.view.curves.contributions import Contributions, Peak

_WHOLE = 400  # characters of a state: what the machine did is not cut within a number


def fit_text(result: FitResult, *, scores: bool = True) -> str:
    """A fit for a person: id, scores of whole tests, parameters, checks that failed."""
    parent = f", from {result.parent}" if result.parent else ""
    parts = [f"{result.name}  {result.model}{parent}"]
    if scores:
        parts.append(scores_text(result.scores))
    parameters = [
        {"parameter": k, "value": p.value, "unit": p.unit, "range": span(result, k)} for k, p in result.readable.items()
    ]
    if parameters:
        parts.append(
            table(parameters, [("parameter", "parameter"), ("value", "value"), ("unit", "unit"), ("range", "95 %")])
        )
    failed = [c for c in result.checks if not c.passed]
    if failed:
        parts.append("worth a look\n" + "\n".join(f"  ! {check_text(c)}" for c in failed))
    return "\n\n".join(parts)


def check_text(check: Check) -> str:
    """'at_bound:lag.tau = 600: ...': what was looked at with its number, and then a sentence of its own."""
    value = "" if check.value is None else f" = {number(check.value)}"
    limit = "" if check.threshold is None else f" (limit {number(check.threshold)})"
    return f"{check.name}{value}{limit}: {check.advice}"


def span(result: FitResult | ReportData, name: str) -> str:
    """The interval of a parameter: '0.9 … 1.2', '0.9 …' where these tests set no upper end, 'not determined' where they
    set none within its bounds, '-' where it is held or its uncertainty is not known, or that it changes nothing."""
    if _changes_nothing(result, name):
        return "changes nothing: gain 0"
    ends = (result.parameters[name].low, result.parameters[name].high)
    if ends == (None, None):
        # with several responses the name begins with that of one
        names = {f"not_determined:{known}" for known in (name, name.partition("/")[2])}
        return "not determined" if any(c.name in names for c in result.checks) else "-"
    return " … ".join("" if end is None else number(end) for end in ends).strip()


def _changes_nothing(result: FitResult | ReportData, name: str) -> bool:
    """Whether all gains of a parameter's effect are 0, as one is that its bound or the model file holds there."""
    effect, _, own = name.rpartition(".")
    gains = [p.value for n, p in result.parameters.items() if n.startswith(f"{effect}.gain")]
    return bool(gains) and not any(gains) and not own.startswith("gain")


def scores_text(scores: list[Score], phases: bool = False) -> str:
    """Scores as a table, whole tests only unless phases are asked for."""
    shown = [s for s in scores if phases or s.phase == "all"]
    many = len({s.response for s in shown}) > 1
    columns = [("campaign", "campaign"), ("test", "test"), ("role", "role")]
    columns += [("response", "response")] if many else []
    columns += [("phase", "phase")] if phases else []
    columns += [
        ("fit", "FIT [%]"),
        ("rmse_um", "RMSE [um]"),
        ("max_um", "max [um]"),
        ("ptp_um", "PTP measured [um]"),
        ("ptp_residual_um", "PTP left [um]"),
        ("n", "n"),
    ]
    return leveled(table([s.model_dump() for s in shown], columns))


def leveled(text: str) -> str:
    """A table of errors with the line that says from where they count."""
    return f"{text}\n\n{prose(LEVEL)}"


def no_common_test(results: list[FitResult]) -> str:
    """That several models predict no test in common, so that nothing stands beside each other; else ''."""
    tests = [{(s.campaign, s.test, s.response) for s in r.scores} for r in results]
    if len(results) < 2 or set.intersection(*tests):
        return ""
    of = "; ".join(f"{r.name} {r.model[:6]} of {', '.join(r.campaigns)}" for r in results)
    return (
        f"no test in common ({of}): nothing stands beside each other. thermodata portability MODEL --campaign CAMPAIGN "
        "says how a model does on another campaign's tests"
    )


def compare_text(results: list[FitResult]) -> str:
    """One model: its scores by test and phase. Several: RMSE and FIT beside each other, a row a test."""
    if len(results) == 1:
        head = f"{results[0].name}  {results[0].model}"
        return "\n\n".join([head, scores_text(results[0].scores, phases=True)])
    if no_common := no_common_test(results):
        each = [f"{r.name}  {r.model}\n\n{scores_text(r.scores)}" for r in results]
        return "\n\n".join([no_common, *each])
    rows: dict[tuple[str, ...], dict[str, Any]] = {}
    many = len({s.response for r in results for s in r.scores}) > 1
    columns = [("campaign", "campaign"), ("test", "test"), ("role", "role")]
    columns += [("response", "response")] if many else []
    columns += [("phase", "phase")]
    for result in results:
        label = f"{result.name} {result.model[:6]}"
        columns += [(f"rmse {result.model}", f"{label} RMSE [um]"), (f"fit {result.model}", "FIT [%]")]
        for s in result.scores:
            key = (s.campaign, s.test, s.response, s.phase)
            told = {"campaign": s.campaign, "test": s.test, "role": s.role, "response": s.response, "phase": s.phase}
            row = rows.setdefault(key, told)
            if row["role"] != s.role:  # in one model a verification test was fitted, in the other not
                row["role"] = base_role(s.role)
            row[f"rmse {result.model}"], row[f"fit {result.model}"] = s.rmse_um, s.fit
            row[f"role {result.model}"] = "yes" if s.role != base_role(s.role) else ""
    fitted = [r for r in results if any(s.role != base_role(s.role) for s in r.scores)]
    if 0 < len(fitted) < len(results):
        for result in fitted:
            at = next(i for i, (key, _) in enumerate(columns) if key == f"rmse {result.model}") + 2
            columns.insert(at, (f"role {result.model}", "in-sample"))
    below = f"\n{prose(explained('verification'))}" if fitted else ""
    return leveled(table(list(rows.values()), columns)) + below


def history_text(chain: Sequence[Mapping[str, Any]]) -> str:
    """The versions of a model, as rows of `history_rows`."""
    lost = history_lost(chain)
    head = f"{lost}\n\n" if lost else ""
    told = f"\n{prose(f'in-sample: {IN_SAMPLE}; {SEEN_SINCE}')}" if any(row["in_sample"] for row in chain) else ""
    return head + leveled(table(*history_table(chain))) + told


def history_lost(chain: Sequence[Mapping[str, Any]]) -> str:
    """Which tests versions lost, of rows of `history_rows`; '' where all predict the same. Then those
    that were forgotten after a fit: the errors are without them."""
    compared = chain[-1]["common"]["tests"] if chain else 0
    lost = lost_of_chain([(row["model"], row["lost"], row["tests"]) for row in chain], compared)
    return "; ".join(filter(None, [lost, results_gone_of_chain([(row["model"], row["gone"]) for row in chain])]))


def history_table(chain: Sequence[Mapping[str, Any]]) -> tuple[list[dict[str, Any]], list[tuple[str, str]]]:
    """(rows, columns) that show rows of `history_rows`: one a version and response, with its errors over the tests that
    all versions predict."""
    rows = [{**row, **one, **one["common"]} for row in chain for one in row["responses"]]
    several = {key for key in ("response", "unit") if len({row[key] for row in rows}) > 1}
    unit = "" if "unit" in several or not rows else f" [{rows[0]['unit']}]"
    columns = [("name", "name"), ("model", "model"), ("added", "added"), ("removed", "removed")]
    columns += [(key, key) for key in ("response", "unit") if key in several]
    columns += [("rmse_um", f"RMSE{unit}"), ("calibration_rmse_um", f"calibration{unit}")]
    columns += [("verification_rmse_um", f"verification{unit}"), ("in_sample", "in-sample"), ("stale", "stale")]
    return rows, columns


def differences_text(found: Sequence[TestDifference], results: Sequence[FitResult]) -> str:
    """Each model's error less that of the first; what is sure has a mark."""
    names = {r.model: f"{r.name} {r.model[:6]}" for r in results}
    many = len({d.response for d in found}) > 1
    seen = {r.model: in_sample(r.scores) for r in results}

    def alike(d: TestDifference) -> bool:
        """Whether both models are fitted to the test, or neither: else a difference says nothing of the effects."""
        return ((d.campaign, d.test) in seen[d.model]) == ((d.campaign, d.test) in seen[d.against])

    rows = [
        {
            **d.to_json(),
            "model": names[d.model],
            "range": "too short to say" if d.low is None else f"{number(d.low)} … {number(d.high)}",
            "sure": ("yes" if alike(d) else "one was fitted to it")
            if d.low is not None and d.high is not None and (d.low > 0 or d.high < 0)
            else "",
        }
        for d in found
    ]
    columns = [("campaign", "campaign"), ("test", "test"), *([("response", "response")] if many else [])]
    columns += [("model", "model"), ("difference_um", "difference [um]"), ("range", "95 %"), ("sure", "sure")]
    return f"difference to {names[found[0].against]}\n{table(rows, columns)}"


def contributions_text(found: Contributions, names: Mapping[str, str]) -> str:
    """What each effect gives at most in each model, and how far that is from the first. names: model -> its label."""

    def told(peak: Peak | None) -> str:
        if peak is None:
            return "not in it"
        return number(peak.value) + ("" if peak.low is None else f" ({number(peak.low)} … {number(peak.high)})")

    rows = []
    for e in found.effects:
        row: dict[str, Any] = {"effect": e.effect, "differs": "yes" if e.differs else ""}
        row |= {f"at most {m}": told(peak) for m, peak in zip(found.models, e.peaks, strict=True)}
        for m, apart in zip(found.models[1:], e.apart, strict=True):
            row[f"apart {m}"] = told(apart.peak)
            row[f"for {m}"] = None if apart.apart_s is None else duration(apart.apart_s) if apart.apart_s else ""
        rows.append(row)
    columns = [("effect", "effect"), *((f"at most {m}", f"{names[m]} at most [um] (95 %)") for m in found.models)]
    for m in found.models[1:]:
        columns += [(f"apart {m}", f"{names[m]} less the first [um]"), (f"for {m}", "bands apart for")]
    columns += [("differs", "differs")] if len(found.models) > 1 else []
    title = f"what each effect gives to {found.response} in {found.test}"
    return f"{title}\n{table(rows, columns)}"


def spots_text(spots: list[WeakSpot], response: str = "", most: int = 8) -> str:
    """Weak spots as a table: where, when, how much, and what the machine did."""
    rows = [{**w.model_dump(), "span": f"{duration(w.from_s)} – {duration(w.to_s)}"} for w in spots[:most]]
    title = f"where the model of {response} fails" if response else "where the model fails"
    return f"{title}, the most squared error first\n" + table(
        rows,
        [("campaign", "campaign"), ("test", "test"), ("span", "when"), ("rmse_um", "RMSE [um]"), ("state", "state")],
        widest=_WHOLE,
    )
