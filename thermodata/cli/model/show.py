"""`show`: a model as a system, in numbers and pictures."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from thermodata.cli.terminal import completing
from thermodata.cli.terminal.common import Session, command
from thermodata.cli.terminal.stored_model import resolve
from thermodata.errors import UsageError
from thermodata.report.text.table import table
from thermodata.report.words.numbers import MOST_NAMED, correlation_text, duration, number, probability_text
from thermodata.schema.words.sentences import listed

if TYPE_CHECKING:
    from collections.abc import Sequence

    from thermodata.modelling.seen.as_system import SeenPath, SeenResponse
    from thermodata.modelling.seen.residual_tests import Against
    from thermodata.store.catalogue.models.fits import StoredModel

F = TypeVar("F", bound=Callable[..., object])
DIGITS = 12  # of coefficients: a pole at 0.99998 needs nine


def _picture(kind: str, told: str) -> Callable[[F], F]:
    return click.option(f"--{kind}", type=click.Path(path_type=Path, dir_okay=False), metavar="FILE", help=told)


@command("show")
@click.argument("model", shell_complete=completing.models)
@click.option("--effect", "effects", multiple=True, metavar="EFFECT", help="Only this one; may be repeated.")
@_picture("png", "Draw it all into a picture.")
@_picture("svg", "The same as lines, for a paper.")
@_picture("pdf", "Likewise.")
def show_command(
    session: Session, model: str, effects: tuple[str, ...], png: Path | None, svg: Path | None, pdf: Path | None
) -> None:
    """Show MODEL as a system: coefficients, poles, step response, Bode.

    At the model's step, for inputs that run straight between samples: coefficients a over b, poles and zeros of z, time
    constants, gain at rest, state space; and what the residual of the calibration tests still tells: its
    autocorrelation with Ljung-Box, and how it goes with each state. --json has the curves too.
    """
    from thermodata.modelling.model_file.not_installed import not_installed
    from thermodata.modelling.run import load
    from thermodata.modelling.seen.as_system import see
    from thermodata.store.catalogue.models.fits import find_model
    from thermodata.store.catalogue.models.stale import stale_line

    pictures = _pictures(png=png, svg=svg, pdf=pdf)
    store = session.store()
    stored = find_model(store, resolve(store, model))
    if lacking := not_installed(stored.spec):
        _as_stored(session, stored, lacking)
        return
    loaded = load(store, stored.model)
    seen = [_effects_only(s, effects) for s in see(loaded.fitted, loaded.data)]
    for picture in pictures:
        from thermodata.report.charts.system_png import draw

        draw(seen, picture, f"{loaded.fitted.spec.name} {loaded.identity}")
    payload = {
        "model": loaded.identity,
        "name": loaded.fitted.spec.name,
        "picture": str(pictures[0]) if pictures else None,
        "pictures": [str(p) for p in pictures],
        "responses": [_payload(s) for s in seen],
        "stored": None,
        "stale": stale_line(store, loaded.identity),
    }

    def text() -> str:
        parts = [f"{loaded.fitted.spec.name}  {loaded.identity}", *(_text(s) for s in seen)]
        return "\n\n".join(parts + [str(p) for p in pictures])

    session.answer(payload, text)


def _pictures(**asked: Path | None) -> list[Path]:
    """The files to draw into. UsageError for one whose name says another kind."""
    for kind, path in asked.items():
        if path is not None and path.suffix.lower() != f".{kind}":
            raise UsageError(f"--{kind} writes a {kind.upper()}", expected=f"FILE.{kind}", got=str(path))
    return [path for path in asked.values() if path is not None]


def _as_stored(session: Session, stored: StoredModel, lacking: Sequence[str]) -> None:
    """What the fit stored of a model that can't be run here; it has no system to show."""
    from thermodata.cli.terminal.common import plain
    from thermodata.modelling.model_file.not_installed import as_stored
    from thermodata.report.text.fit import fit_text
    from thermodata.store.catalogue.models.stale import stale_line

    warnings.warn(as_stored(lacking, stored.name), stacklevel=2)
    payload = {
        "model": stored.model,
        "name": stored.name,
        "picture": None,
        "pictures": [],
        "responses": [],
        "stored": plain(stored.result),
        "stale": stale_line(session.store(), stored.model),
    }
    session.answer(payload, lambda: fit_text(stored.result))


def _effects_only(seen: SeenResponse, effects: tuple[str, ...]) -> SeenResponse:
    from dataclasses import replace

    from thermodata.errors import unknown_name

    known = list(dict.fromkeys([p.effect for p in seen.paths] + [e for e, _ in seen.not_shown]))
    for name in effects:
        if name not in known:
            raise unknown_name("effect", name, known)
    if not effects:
        return seen
    return replace(
        seen,
        paths=tuple(p for p in seen.paths if p.effect in effects),
        not_shown=tuple((e, w) for e, w in seen.not_shown if e in effects),
        states=tuple(s for s in seen.states if s.state.partition(":")[0] in effects),
        at_bounds=tuple(c for c in seen.at_bounds if c.name.partition(":")[2].rpartition(".")[0] in effects),
    )


def _payload(seen: SeenResponse) -> dict[str, Any]:
    return {
        "response": seen.response,
        "unit": seen.unit,
        "step_s": seen.step_s,
        "paths": [_path(p) for p in seen.paths],
        "not_shown": [{"effect": e, "why": w} for e, w in seen.not_shown],
        "residual": {
            "n": seen.count,
            "lags_s": [k * seen.step_s for k in range(len(seen.correlation))],
            "autocorrelation": seen.correlation,
            "ljung_box": seen.ljung_box,
        },
        "states": seen.states,
        "at_bounds": [
            {"name": c.name, "value": c.value, "bound": c.threshold, "why": c.advice} for c in seen.at_bounds
        ],
    }


def _path(p: SeenPath) -> dict[str, Any]:
    s = p.system
    return {
        "effect": p.effect,
        "group": p.group or None,
        "drive": p.drive,
        "times": p.times,
        "while": p.holds,
        "gain_at_rest": s.at_rest,
        "unit": p.unit,
        "a": s.a,
        "b": s.b,
        "poles": [[z.real, z.imag] for z in s.poles.tolist()],
        "zeros": [[z.real, z.imag] for z in s.zeros.tolist()],
        "time_constants_min": [t / 60.0 for t in s.taus_s],
        "state_space": {"A": s.A, "B": s.B, "C": s.C, "D": s.D},
        "step_response": {"t_s": p.step[0], "y": p.step[1]},
        "bode": {"hz": p.bode[0], "magnitude": p.bode[1], "phase_deg": p.bode[2]},
    }


def _text(seen: SeenResponse) -> str:
    parts = [f"{seen.response} [{seen.unit}], at its step of {seen.step_s:g} s"]
    rows = [
        {
            "path": p.name,
            "drive": p.drive + (f", times {p.times}" if p.times else ""),
            "rest": f"{number(p.system.at_rest)} {p.unit}",
            "tau": ", ".join(f"{t / 60:.4g} min" for t in p.system.taus_s) or "at once",
            "poles": _complexes(p.system.poles.tolist()),
            "zeros": _complexes(p.system.zeros.tolist()),
        }
        for p in seen.paths
    ]
    columns = [("path", "effect"), ("drive", "driven by"), ("rest", "gain at rest"), ("tau", "time constants")]
    if rows:
        parts.append(table(rows, [*columns, ("poles", "poles z"), ("zeros", "zeros z")]))
    for p in seen.paths:
        if len(p.system.poles):
            parts.append(_coefficients(p))
    if seen.at_bounds:
        from thermodata.report.text.fit import check_text

        parts.append("\n".join(f"! {check_text(c)}" for c in seen.at_bounds))
    if seen.not_shown:
        parts.append("not shown\n" + "\n".join(f"  {e}: {w}" for e, w in seen.not_shown))
    parts.append(_residual(seen))
    return "\n\n".join(parts)


def _coefficients(p: SeenPath) -> str:
    s = p.system
    lines = [p.name, f"  a  {_numbers(s.a)}", f"  b  {_numbers(s.b)}"]
    for name, matrix in (("A", s.A), ("B", s.B.T), ("C", s.C), ("D", s.D)):
        rows = "; ".join(_numbers(row) for row in matrix)
        lines.append(f"  {name}{chr(39) if name == 'B' else ' '} [{rows}]")
    return "\n".join(lines)


def _residual(seen: SeenResponse) -> str:
    from thermodata.modelling.seen.residual_tests import BY_THE_FIT, WHY_BY_THE_FIT

    step = seen.step_s
    marks = [
        k for k in (1, round(600 / step), round(3600 / step), round(4 * 3600 / step)) if 0 < k < len(seen.correlation)
    ]
    remembered = ", ".join(f"{seen.correlation[k]:.2f} after {duration(k * step)}" for k in dict.fromkeys(marks))
    named = f" ({listed(seen.tests)})" if 0 < len(seen.tests) <= MOST_NAMED else ""
    lines = [f"residual of the calibration tests{named}: {seen.count} samples; autocorrelation {remembered or '-'}"]
    for one in seen.ljung_box:
        white = "white" if one.p_value > 0.05 else "not white"
        lines.append(f"  Ljung-Box over {one.lags} lags: Q {number(one.q)}, {probability_text(one.p_value)}: {white}")
    if seen.states:
        rows = [{"state": s.state, "r": correlation_text(s.correlation), "slope": _slope(seen, s)} for s in seen.states]
        lines += ["", table(rows, [("state", "residual against"), ("r", "correlation"), ("slope", "slope")], widest=80)]
        if any(float(row["r"]) == 0.0 for row in rows):
            lines.append(f"{BY_THE_FIT}: {WHY_BY_THE_FIT}")
    return "\n".join(lines)


def _slope(seen: SeenResponse, state: Against) -> str:
    """Of what hangs together not at all, none: what rounding leaves of it is no number to read."""
    from thermodata.modelling.seen.residual_tests import BY_THE_FIT

    if float(correlation_text(state.correlation)) == 0.0:
        return BY_THE_FIT
    return f"{number(state.slope)} {_unit_per(seen.unit, state.unit)}"


def _unit_per(unit: str, over: str) -> str:
    if over in ("1", ""):
        return unit
    return f"{unit}/({over})" if " " in over else f"{unit}/{over}"


def _numbers(values: Any) -> str:
    return ", ".join(f"{v:.{DIGITS}g}" for v in values)


def _complexes(values: list[complex]) -> str:
    shown = [v for v in values if v.imag >= 0]
    return ", ".join(f"{v.real:.9g}" if v.imag == 0 else f"{v.real:.6g} ± {v.imag:.6g}j" for v in shown) or "-"
