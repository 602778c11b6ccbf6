"""The versions of a model: what each added to the one before it, and what it leaves."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from thermodata.report.data import Version
from thermodata.report.words import base_role, pooled
from thermodata.schema.model import EffectSpec
from thermodata.schema.result import Score

if TYPE_CHECKING:
    from thermodata.store import Store
    from thermodata.store.catalogue.models import StoredModel


def versions(chain: Sequence[StoredModel], scored: Sequence[list[Score]] | None = None) -> tuple[Version, ...]:
    """The chain as rows, oldest first, with what each version added to the one before it, or removed. scored: the
    scores of each, those that were kept with it where None."""
    from thermodata.modelling.model_file.resolve import term_ids

    made: list[Version] = []
    known: dict[str, str] = {}
    words: dict[str, str] = {}
    for i, m in enumerate(chain):
        ids = term_ids(m.spec.effects)
        fresh = (
            [
                _in_words(spec, name) if name not in known else f"{name} by {_parted_by(spec)}"
                for spec, name in zip(m.spec.effects, ids, strict=True)
                if name not in known or known[name] != _parted_by(spec)
            ]
            if i
            else []
        )
        gone = [words[name] for name in known if name not in ids]
        scores = scored[i] if scored is not None else m.result.scores
        made.append(
            Version(
                m.model,
                m.name,
                ", ".join(fresh) or None,
                pooled(scores, "calibration", "verification"),
                pooled(scores, "calibration"),
                pooled(scores, "verification"),
                m.stale,
                ", ".join(gone) or None,
                any(s.role != base_role(s.role) for s in scores),
            )
        )
        words = {name: _in_words(spec, name) for name, spec in zip(ids, m.spec.effects, strict=True)}
        known = {name: _parted_by(spec) for name, spec in zip(ids, m.spec.effects, strict=True)}
    return tuple(made)


def history_rows(store: Store, ref: str) -> list[dict[str, Any]]:
    """The versions that led to a model, oldest first, as `thermodata history --json` prints them."""
    from thermodata.store.catalogue.models import model_chain

    chain = model_chain(store, ref)
    return [
        {
            "model": v.model,
            "name": v.name,
            "parent": m.parent,
            "added": v.added,
            "rmse_um": v.all_um,
            "calibration_rmse_um": v.calibration_um,
            "verification_rmse_um": v.verification_um,
            "stale": v.stale,
            "removed": v.removed,
            "in_sample": v.in_sample,
        }
        for v, m in zip(versions(chain), chain, strict=True)
    ]


def _parted_by(spec: EffectSpec) -> str:
    """What its gain belongs to, as the model file has it; '' where one gain serves all."""
    return " and ".join([spec.gain_by] if isinstance(spec.gain_by, str) else spec.gain_by or [])


def _in_words(spec: EffectSpec, term: str) -> str:
    """An effect's name says what it is; a plain lag is told by its channel."""
    if spec.effect not in ("lag", "static"):
        return term
    acts = f" in {' and '.join(spec.phases)}" if spec.phases else ""
    return f"{spec.effect}({', '.join(d if isinstance(d, str) else d.at for d in spec.drivers.values())}){acts}"
