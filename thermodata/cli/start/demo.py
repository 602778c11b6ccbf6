"""`demo`: the whole story on a simulated machine, from raw logs to the missing effect and back to a smaller error."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from thermodata.cli.terminal.common import Session, command, plain
from thermodata.errors import UsageError
from thermodata.report.text.clauses import in_lines
from thermodata.report.text.table import fields
from thermodata.report.verdict.verdict import claims_of, refinements_of, verdict_sentence
from thermodata.report.words.numbers import change, duration, number, pooled
from thermodata.schema.words.sentences import counted, listed

if TYPE_CHECKING:
    from thermodata.schema.answers.candidate import Candidate
    from thermodata.schema.answers.diagnosis import Diagnosis
    from thermodata.schema.answers.result import FitResult
    from thermodata.store import Store

_MARK = ".thermodata-demo"  # a folder that holds it was made by a demo and may be made anew
_MADE = ("raw", "campaign.yaml", "model.yaml", "truth", "thermodata.store", "report.html")


@dataclass(frozen=True, slots=True)
class Step:
    """Numbers the steps of the story on stderr."""

    session: Session
    began: float

    def title(self, number_: int, text: str) -> None:
        clock = click.style(f"{time.monotonic() - self.began:5.1f} s", dim=True)
        self.session.say(f"{clock}  {click.style(f'{number_}/7', fg='cyan', bold=True)} {click.style(text, bold=True)}")

    def line(self, text: str) -> None:
        for part in text.splitlines():
            self.session.say(f"             {part}")


@command("demo")
@click.argument("folder", default="thermodata-demo", metavar="[DIR]", type=click.Path(path_type=Path, file_okay=False))
@click.option("--hide", metavar="EFFECT", help="The hidden effect (default: the seed picks one); or none.")
@click.option("--seed", default=3, show_default=True, type=click.IntRange(0), help="Another seed, another machine.")
def demo_command(session: Session, folder: Path, hide: str | None, seed: int) -> None:
    """Show the whole story on a simulated machine.

    A thermal effect is hidden from the model; the machine logs TDMS, CNC and MCAP files into DIR (default
    ./thermodata-demo); then: store, model, where it fails, what is missing, add it, the error afterwards, report.
    The store stands in DIR, too, unless --store names another.
    """
    began = time.monotonic()
    hide = prepare(folder, hide, seed)
    result = story(Step(session, began), folder, hide, seed)
    result["seconds"] = round(time.monotonic() - began, 2)
    session.answer(result, lambda: summary_text(result))


def prepare(folder: Path, hide: str | None, seed: int) -> str:
    """An empty folder and the effect to hide; an earlier demo is cleared, anything else refused."""
    import random
    import shutil

    from thermodata.virtual import HIDEABLE

    if hide is None:
        hide = random.Random(seed).choice(sorted(HIDEABLE))
    if folder.is_dir() and any(folder.iterdir()):
        if not (folder / _MARK).is_file():
            raise UsageError(
                "the folder is not empty and was not made by a demo",
                where=str(folder),
                expected="a new or empty folder, or an earlier demo's",
                hint="thermodata demo OTHER_DIR",
            )
        for made in (folder / name for name in _MADE):
            if made.is_dir() and not made.is_symlink():
                shutil.rmtree(made)
            else:
                made.unlink(missing_ok=True)
    folder.mkdir(parents=True, exist_ok=True)
    return hide


def story(step: Step, folder: Path, hide: str, seed: int) -> dict[str, Any]:
    """The seven steps; returns the demo's JSON without the seconds.

    Each imports what it needs below its title: the first line of the story comes at once."""
    # the mark comes first: an interrupted demo is still known as one
    (folder / _MARK).write_text(f"thermodata demo --hide {hide} --seed {seed}\n", encoding="utf-8")
    truth = _simulated(step, folder, hide, seed)
    store = _ingested(step, folder)
    base = _fitted(step, store, folder)
    found = _failing(step, store, base)
    _tell_missing(step, found)
    better = _better_model(step, store, base, found)
    page = _reported(step, store, better.model, folder)
    claims = claims_of(found)
    claimed = claims[0] if claims else None
    return {
        "hidden": None if hide == "none" else truth.get("hidden", hide),
        "found": claimed.effect if claimed else None,
        "verdict": found.verdict,
        "claims": [c.id for c in claims],
        "refinements": [c.id for c in refinements_of(found)],
        "probability": claimed.probability if claimed else None,
        "family": claimed.family if claimed else None,
        "equivalents": claimed.equivalent if claimed else [],
        "rmse_um_before": better.before_um,
        "rmse_um_after": better.after_um,
        "locked_rmse_um_before": claimed.locked_rmse_um_before if claimed else None,
        "locked_rmse_um_after": claimed.locked_rmse_um_after if claimed else None,
        "locked_rmse_um_fitted": claimed.locked_rmse_um_fitted if claimed else None,
        "model": better.model,
        "store": str(store.path),
        "report": str(page),
    }


def _simulated(step: Step, folder: Path, hide: str, seed: int) -> dict[str, Any]:
    """What is true of the machine."""
    step.title(1, "A machine runs its tests and writes raw logs")
    from thermodata.virtual import simulate

    truth: dict[str, Any] = plain(simulate(folder, hide=hide, seed=seed))
    raw = [p for p in (folder / "raw").rglob("*") if p.is_file()]
    kinds = ", ".join(f"{sum(p.suffix == s for p in raw)} {s[1:]}" for s in sorted({p.suffix for p in raw}))
    step.line(
        f"{counted(len(raw), 'file')} ({kinds}), {sum(p.stat().st_size for p in raw) / 1e6:.0f} MB, in "
        f"{folder / 'raw'}; "
        "what the model lacks, if anything, nobody tells it"
    )
    return truth


def _ingested(step: Step, folder: Path) -> Store:
    step.title(2, "ingest: raw and calibrated layers, by the campaign file")
    from thermodata.store import Store
    from thermodata.store.ingest.run import ingest

    store = Store(step.session.store_path if step.session.store_named else folder / "thermodata.store", create=True)
    summary = plain(ingest(store, folder / "campaign.yaml").to_json())
    shares = {name: 100 * n / max(summary["samples"], 1) for name, n in summary["flags"].items() if n}
    flags = ", ".join(f"{name.replace('_', ' ')} {share:.2g} %" for name, share in shares.items()) or "nothing"
    step.line(f"{counted(summary['tests'], 'test')}, {summary['samples'] / 1e6:.1f} million samples; flagged: {flags}")
    for row in summary["calibrations"]:
        name = row.get("calibration") or row.get("name")
        step.line(
            f"jump test {name}: {row.get('sign', '')}{number(abs(row['gain']))} {row.get('gain_unit', '')} "
            f"± {number(row.get('uncertainty_pct'), 2)} %, noise {number(row.get('noise_um'), 2)} um"
            if row.get("kind") == "jump"
            else f"{row.get('kind')} {name}: {number(row['gain'])} {row.get('gain_unit') or ''}"
        )
    return store


def _fitted(step: Step, store: Store, folder: Path) -> FitResult:
    step.title(3, "fit: the baseline model, with the effects that one would expect")
    from thermodata.modelling.run import fit
    from thermodata.schema.files.load import load_model

    base = fit(store, load_model(folder / "model.yaml"), base=folder)
    effects = sorted({key.split(".")[0] for key in base.parameters})
    errors = (pooled(base.scores, role, responses=base.responses) for role in ("calibration", "verification"))
    fitted, kept_out = map(number, errors)
    step.line(f"{', '.join(effects)}; error {fitted} um in calibration, {kept_out} um in verification")
    return base


def _failing(step: Step, store: Store, base: FitResult) -> Diagnosis:
    step.title(4, "compare: where it fails")
    from thermodata.diagnosis.run import diagnose

    found = diagnose(store, base.model)
    for spot in found.weak_spots[:3]:
        step.line(
            f"{spot.test}, {duration(spot.from_s)} to {duration(spot.to_s)}: {number(spot.rmse_um)} um ({spot.state})"
        )
    if not found.weak_spots:
        step.line("nowhere that stands out of the noise")
    return found


def _tell_missing(step: Step, found: Diagnosis) -> None:
    step.title(5, "diagnose: which effect is missing?")
    step.line(in_lines(verdict_sentence(found)))
    claims = claims_of(found)
    for claim in claims:
        of = f"{claim.id}: " if len(claims) > 1 else ""
        step.line(in_lines(f"why {of}{claim.why}"))
        if claim.equivalent:
            step.line(f"{of}these tests can't tell it from {listed(claim.equivalent)}")
    if found.next_test:
        step.line(in_lines(f"next test: {found.next_test}"))


@dataclass(frozen=True, slots=True)
class _Better:
    """The model with all claims: the baseline itself, and no error after, where nothing is claimed."""

    model: str
    before_um: float | None
    after_um: float | None = None


def _better_model(step: Step, store: Store, base: FitResult, found: Diagnosis) -> _Better:
    claims = claims_of(found)
    if claims:
        return _with_claims(step, store, base, claims)
    if found.verdict in ("none", "refine"):
        step.title(6, "add: no cause is missing, so nothing is added")
        for offered in refinements_of(found):
            step.line(f"offered: thermodata --store {store.path} add {base.model[:12]} {offered.id}")
    else:
        step.title(6, "add: nothing is added where the evidence does not suffice")
    return _Better(base.model, pooled(base.scores, responses=base.responses))


def _with_claims(step: Step, store: Store, base: FitResult, claims: Sequence[Candidate]) -> _Better:
    step.title(6, f"add {listed([c.id for c in claims])}, and compare again")
    from thermodata.modelling.add import add
    from thermodata.modelling.compare.common import on_common
    from thermodata.report.verdict.candidate_errors import on_locked

    better = add(store, base.model, *(c.id for c in claims))
    before, after = (pooled(some, responses=base.responses) for some in on_common([base.scores, better.scores]))
    step.line(
        f"open tests, which are all fitted by now {number(before)} -> {number(after)} um ({change(before, after)})"
    )
    a, b = claims[0].locked_rmse_um_before, claims[0].locked_rmse_um_after
    if b is not None:
        a = a if claims[0].locked_rmse_um_fitted is None else claims[0].locked_rmse_um_fitted
        step.line(f"locked tests {on_locked(claims[0])[0]} ({change(a, b)})")
    return _Better(better.model, before, after)


def _reported(step: Step, store: Store, model: str, folder: Path) -> Path:
    step.title(7, "report")
    from thermodata.report import build_report

    page = build_report(store, model, folder / "report.html")
    step.line(str(page))
    return page


def summary_text(result: dict[str, Any]) -> str:
    """The end of the story."""

    def pair(a: Any, b: Any) -> str:
        return f"{number(a)} -> {number(b)} um" if b is not None else f"{number(a)} um"

    rows = [
        ("hidden", result["hidden"] or "nothing"),
        ("found", listed(result["claims"]) or f"nothing claimed ({result['verdict']})"),
    ]
    if result["refinements"]:
        rows.append(("refined by", listed(result["refinements"])))
    if result["equivalents"]:
        rows.append(("not told from", ", ".join(result["equivalents"])))
    rows.append(("open tests", pair(result["rmse_um_before"], result["rmse_um_after"])))
    if result["locked_rmse_um_after"] is not None:
        own, refitted = result["locked_rmse_um_fitted"], result["locked_rmse_um_before"]
        rows.append(("locked tests", pair(refitted if own is None else own, result["locked_rmse_um_after"])))
    rows += [
        ("report", result["report"]),
        ("look around", f"thermodata --store {result['store']} tests"),
        ("took", f"{result['seconds']:.0f} s"),
    ]
    return "\n" + fields(rows)
