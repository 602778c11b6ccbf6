"""Models: fit, compare, add an effect, the chain of versions, transfer to other machines."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from thermodata.cli.common import Session, command, in_units_of, plain
from thermodata.cli.table import table
from thermodata.errors import UsageError
from thermodata.report.glossary import explained
from thermodata.report.words import base_role, change, duration, number, pooled

if TYPE_CHECKING:
    from thermodata.schema.result import FitResult, Parameter, Score, WeakSpot
    from thermodata.store import Store


def resolve(store: Store, ref: str) -> str:
    """MODEL as the store knows it: a path is fitted (or found, where that fit exists), a name stays one."""
    if not (ref.endswith((".yaml", ".yml")) or Path(ref).is_file()):
        return ref
    from thermodata.modelling.result import model_id
    from thermodata.modelling.run import fit, load_data
    from thermodata.schema.load import load_model
    from thermodata.store.catalogue.models import find_model

    spec = load_model(Path(ref))
    if not any(e.file or e.name for e in spec.effects):  # what these are now is known to the fit only
        try:
            return find_model(store, model_id(spec, load_data(store, spec).data_version)).model
        except UsageError:
            pass
    return fit(store, spec, base=Path(ref).parent).model


_RISES = 1.005  # an error that rises by less is the same


@command("fit")
@click.argument("model")
def fit_command(session: Session, model: str) -> None:
    """Fit MODEL and print its id.

    MODEL is a model file, or a fitted model that is fitted again after its data changed.
    """
    from thermodata.cli.progress import counting_line
    from thermodata.modelling.run import fit
    from thermodata.schema.load import load_model
    from thermodata.store.base.counting import watched
    from thermodata.store.catalogue.models import find_model

    store = session.store()
    if model.endswith((".yaml", ".yml")) or Path(model).is_file():
        spec, parent, base = load_model(Path(model)), None, Path(model).parent
    else:
        stored = find_model(store, model)
        spec, parent, base = stored.spec, stored.parent, None
    with counting_line() as tell, watched(tell):
        result = fit(store, spec, parent=parent, base=base)
    session.answer(result, lambda: in_units_of(session, result.response, fit_text(result)))


@command("compare")
@click.argument("models", nargs=-1, required=True, metavar="MODEL...")
@click.option("--against", metavar="MODEL", help="Print what papers print: each model's rest against this one's.")
@click.option(
    "--layout",
    type=click.Choice(["text", "markdown", "csv", "latex"]),
    default="text",
    help="Of the table that --against prints.",
)
@click.option("--test", "tests", multiple=True, metavar="TEST", help="With --against: only this test; may be repeated.")
def compare_command(
    session: Session, models: tuple[str, ...], against: str | None, layout: str, tests: tuple[str, ...]
) -> None:
    """Score models against the measurements.

    By test and phase, each MODEL beside the others, and where the first fails.

    With several models the JSON is that of the first, with the scores of all, and all of them in "models";
    "weak_spots" has those of the first, by response.

    With --against: peak to valley at first and left, both ways (max - min, |max| + |min|), range, how many times less,
    percent less than the reference, and the mean row (over the tests that all of them predict, or over each --test);
    the JSON is a list of these rows.
    """
    if against is not None:
        from thermodata.cli.besides import answer_against

        store = session.store()
        answer_against(session, store, [resolve(store, m) for m in models], resolve(store, against), layout, tests)
        return
    if tests:
        raise UsageError("--test chooses rows of the table that --against prints", hint="add --against MODEL")
    from thermodata.modelling.run import compare, load
    from thermodata.report.spots import weak_spots_of
    from thermodata.store.catalogue.models import load_diagnosis

    store = session.store()
    results = compare(store, [resolve(store, ref) for ref in models])
    loaded = load(store, results[0].model)
    weak = weak_spots_of(loaded, (load_diagnosis(store, m) for m in (loaded.parent, loaded.identity) if m))
    payload: dict[str, Any] = {**plain(results[0]), "weak_spots": weak}
    if len(results) > 1:
        payload |= {"scores": [s for r in results for s in r.scores], "models": results}
    session.answer(
        payload,
        lambda: in_units_of(
            session,
            results[0].response,
            "\n\n".join(
                [compare_text(results), *(spots_text(found, response) for response, found in weak.items() if found)]
            ),
        ),
    )


@command("add")
@click.argument("model")
@click.argument("candidate")
@click.option("--plain", is_flag=True, help="Add that one effect, with one time constant, and no more.")
def add_command(session: Session, model: str, candidate: str, plain: bool) -> None:
    """Make a new version of MODEL with an effect more.

    CANDIDATE is its rank or id, as diagnose printed them; gain_by:EFFECT,CONDITION gives an effect of MODEL a gain for
    each value of a condition, and phases:EFFECT,heating,cooling parts it into one for each phase. Where tests that are
    left out of the fit want it, the effect and those that MODEL has get a second lag, for a part of a machine answers
    heat by a quick share and a slow one.
    Prints the errors before and after.
    """
    from thermodata.cli.progress import counting_line
    from thermodata.modelling.run import add
    from thermodata.store.base.counting import watched

    store = session.store()
    with counting_line() as tell, watched(tell):
        result = add(store, resolve(store, model), candidate, plain=plain)
    session.answer(
        result,
        lambda: in_units_of(
            session, result.response, "\n\n".join([before_after_text(result), fit_text(result, scores=False)])
        ),
    )
    for note in result.notes:
        session.say(note)
    worse = made_worse(result)
    if worse is not None:
        session.say(worse)


@command("remove")
@click.argument("model")
@click.argument("effect")
def remove_command(session: Session, model: str, effect: str) -> None:
    """Make a new version of MODEL without an effect.

    EFFECT is its id in the model, as fit printed it, or its name where that is one effect only. Its second lag goes
    with it. Prints the errors before and after; the version before stays.
    """
    from thermodata.cli.progress import counting_line
    from thermodata.modelling.run import remove
    from thermodata.store.base.counting import watched

    store = session.store()
    with counting_line() as tell, watched(tell):
        result = remove(store, resolve(store, model), effect)
    session.answer(
        result,
        lambda: in_units_of(
            session, result.response, "\n\n".join([before_after_text(result), fit_text(result, scores=False)])
        ),
    )
    for note in result.notes:
        session.say(note)


def made_worse(result: FitResult) -> str | None:
    """A warning where an added effect raised the error of a role; None where it did not."""
    found = []
    for role in ("verification", "calibration"):
        before, after = pooled(result.before or [], role), pooled(result.scores, role)
        if before is not None and after is not None and after > before * _RISES:
            found.append(f"{role} {before:.3g} -> {after:.3g} um")
    if not found:
        return None
    return (
        f"warning: the model is worse with it: {', '.join(found)}; thermodata diagnose says whether the effect is "
        "claimed, and the version before is still there"
    )


@command("history")
@click.argument("model")
def history_command(session: Session, model: str) -> None:
    """Show the versions that led to MODEL, and their errors."""
    from thermodata.report.collect import versions
    from thermodata.store.catalogue.models import model_chain

    store = session.store()
    stored = model_chain(store, resolve(store, model))
    chain = [
        {
            "model": v.model,
            "name": v.name,
            "parent": m.parent,
            "added": v.added,
            "rmse_um": v.all_um,
            "calibration_rmse_um": v.calibration_um,
            "verification_rmse_um": v.verification_um,
            "stale": v.stale,
        }
        for v, m in zip(versions(stored), stored, strict=True)
    ]
    session.answer(
        chain,
        lambda: table(
            chain,
            [
                ("name", "name"),
                ("model", "model"),
                ("added", "added"),
                ("rmse_um", "RMSE [um]"),
                ("calibration_rmse_um", "calibration [um]"),
                ("verification_rmse_um", "verification [um]"),
                ("stale", "stale"),
            ],
        ),
    )


@command("portability")
@click.argument("model")
@click.option("--test", "tests", multiple=True, metavar="TEST", help="Only this test; may be repeated.")
def portability_command(session: Session, model: str, tests: tuple[str, ...]) -> None:
    """Say how MODEL transfers to other tests and machines.

    The gain g that fits the model to each, the error without (n) and with (c) it, and the class: portable,
    with_correction, not_portable.
    """
    from thermodata.modelling.run import transfer

    store = session.store()
    rows = [plain(row) for row in transfer(store, resolve(store, model), tests)]
    several = len({row["response"] for row in rows}) > 1
    session.answer(
        rows,
        lambda: table(
            rows,
            [
                *([("response", "response")] if several else []),
                ("campaign", "campaign"),
                ("test", "test"),
                ("machine", "machine"),
                ("role", "role"),
                ("g", "g"),
                ("g_end", "g at end of heating"),
                ("fit_n", "FIT n [%]"),
                ("fit_c", "FIT c [%]"),
                ("ptp_measured", "PTP measured [um]"),
                ("ptp_n", "PTP n [um]"),
                ("ptp_c", "PTP c [um]"),
                ("verdict", "class"),
                ("why", "x for"),
            ],
        ),
    )


def fit_text(result: FitResult, *, scores: bool = True) -> str:
    """A fit for a person: id, scores of whole tests, parameters, checks that failed."""
    parent = f", from {result.parent}" if result.parent else ""
    parts = [f"{result.name}  {result.model}{parent}"]
    if scores:
        parts.append(scores_text(result.scores))
    parameters = [
        {"parameter": k, "value": p.value, "unit": p.unit, "range": span(p)} for k, p in result.parameters.items()
    ]
    if parameters:
        parts.append(
            table(parameters, [("parameter", "parameter"), ("value", "value"), ("unit", "unit"), ("range", "95 %")])
        )
    failed = [c for c in result.checks if not c.passed]
    if failed:
        parts.append(
            "worth a look\n"
            + "\n".join(f"  ! {c.name}: {number(c.value)} (limit {number(c.threshold)}). {c.advice}" for c in failed)
        )
    return "\n\n".join(parts)


def span(parameter: Parameter) -> str:
    """'0.9 … 1.2', '0.9 …' where these tests set no upper end, or '-' where the uncertainty is not known."""
    low, high = parameter.low, parameter.high
    return "-" if low is None and high is None else f"{number(low)} … {number(high)}".replace("-", "")


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
    return table([s.model_dump() for s in shown], columns)


def compare_text(results: list[FitResult]) -> str:
    """One model: its scores by test and phase. Several: RMSE and FIT beside each other, a row a test."""
    if len(results) == 1:
        head = f"{results[0].name}  {results[0].model}"
        return "\n\n".join([head, scores_text(results[0].scores, phases=True)])
    rows: dict[tuple[str, ...], dict[str, Any]] = {}
    columns = [("campaign", "campaign"), ("test", "test"), ("role", "role"), ("phase", "phase")]
    for result in results:
        label = f"{result.name} {result.model[:6]}"
        columns += [(f"rmse {result.model}", f"{label} RMSE [um]"), (f"fit {result.model}", "FIT [%]")]
        for s in result.scores:
            key = (s.campaign, s.test, s.response, s.phase)
            row = rows.setdefault(key, {"campaign": s.campaign, "test": s.test, "role": s.role, "phase": s.phase})
            row[f"rmse {result.model}"], row[f"fit {result.model}"] = s.rmse_um, s.fit
    return table(list(rows.values()), columns)


def spots_text(spots: list[WeakSpot], response: str = "", most: int = 8) -> str:
    """Weak spots as a table: where, when, how much, and what the machine did."""
    rows = [{**w.model_dump(), "span": f"{duration(w.from_s)} – {duration(w.to_s)}"} for w in spots[:most]]
    title = f"where the model of {response} fails" if response else "where the model fails"
    return f"{title}\n" + table(
        rows,
        [("campaign", "campaign"), ("test", "test"), ("span", "when"), ("rmse_um", "RMSE [um]"), ("state", "state")],
        widest=80,
    )


def before_after_text(result: FitResult) -> str:
    """What an added effect did, a row a test; roles pooled below."""
    before = {(s.campaign, s.test, s.response, s.phase): s for s in result.before or []}
    rows: list[dict[str, Any]] = []
    for s in result.scores:
        old = before.get((s.campaign, s.test, s.response, s.phase))
        if s.phase == "all" and old:
            rows.append({**s.model_dump(), "before": old.rmse_um, "change": change(old.rmse_um, s.rmse_um)})
    for role in dict.fromkeys(base_role(row["role"]) for row in rows):
        a, b = pooled(result.before or [], role), pooled(result.scores, role)
        rows.append({"test": "all", "role": role, "before": a, "rmse_um": b, "change": change(a, b)})
    columns = [
        ("campaign", "campaign"),
        ("test", "test"),
        ("role", "role"),
        ("before", "before [um]"),
        ("rmse_um", "after [um]"),
        ("change", "change"),
    ]
    return f"{table(rows, columns)}\n\n{explained('verification', 'fitted')}"
