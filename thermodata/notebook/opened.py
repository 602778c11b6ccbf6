"""What `thermodata.open` gives: SQL over a store, and the whole work on it."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from thermodata.errors import UsageError
from thermodata.notebook.comparison import Comparison, compared
from thermodata.notebook.courses import Contributions, Predictions
from thermodata.notebook.fitted import Fit, stored_fit
from thermodata.notebook.residuals import ResidualTests
from thermodata.notebook.shown import Listed, html_table
from thermodata.notebook.stale import heed_guess
from thermodata.notebook.verdict import Verdict
from thermodata.view.query.store_view import StoreView

if TYPE_CHECKING:
    from thermodata.schema.files.model import Model

_MODELS = (
    ("name", "name"),
    ("version", "version"),
    ("model", "model"),
    ("effects", "effects"),
    ("calibration_um", "calibration"),
    ("verification_um", "verification"),
    ("unit", "unit"),
    ("verdict", "verdict"),
    ("stale", "stale"),
)


class OpenStore(StoreView):
    """`StoreView`, which only reads, and `fit`, `diagnose` and `add`, which write into the store as the commands do.

    Where a method takes a model and none is named, it is the one fitted last.
    """

    def fit(self, model: str | Path | Model) -> Fit:
        """Fit and keep: a model file, a `Model`, or a model of the store again after its data changed. Errors name the
        line of the file."""
        from thermodata.modelling.named import fit_named
        from thermodata.modelling.run import fit

        if isinstance(model, str | os.PathLike):
            return Fit(self.store, fit_named(self.store, os.fspath(model)))
        return Fit(self.store, fit(self.store, model))

    def model(self, model: str | None = None) -> Fit:
        """A version that the store holds: its id, a unique prefix of it, its name (the newest of that name), or
        'campaign/name'. A `GuessedModelWarning` where models of several campaigns have the name."""
        from thermodata.modelling.named import newest_model

        if model is not None:
            heed_guess(self.store, model)
        return stored_fit(self.store, newest_model(self.store) if model is None else model)

    def _certain(self, model: str | None) -> Fit:
        """The same, of what makes versions or looks at locked tests: UsageError for a name of several campaigns."""
        from thermodata.modelling.named import refuse_several_campaigns

        if model is not None:
            refuse_several_campaigns(self.store, model)
        return self.model(model)

    def models(self) -> Listed:
        """All versions, the newest first."""
        from dataclasses import asdict

        from thermodata.view.lists.models import model_rows

        return Listed((asdict(m) for m in model_rows(self.store)), _MODELS)

    def diagnose(self, model: str | None = None, response: str | None = None) -> Verdict[Fit]:
        """Which effect a model misses. response: of which, where it has several; by name, for what stands first is the
        model."""
        try:
            fitted = self._certain(model)
        except UsageError as error:
            if model is None or not any(model in row["responses"] for row in self.models()):
                raise
            raise UsageError(
                f"'{model}' is a response, and diagnose of a store takes a model first",
                expected="a model, or response=",
                got=model,
                hint=f"diagnose(response='{model}')",
            ) from error
        return fitted.diagnose(response)

    def add(self, candidate: str | int, model: str | None = None, *, plain: bool = False) -> Fit:
        """A new version of a model with an effect more: a rank or id of its diagnosis, or any 'effect:channels'."""
        return self._certain(model).add(candidate, plain=plain)

    def remove(self, effect: str, model: str | None = None) -> Fit:
        """A new version of a model without an effect."""
        return self._certain(model).remove(effect)

    def compare(self, *models: str | Fit) -> Comparison:
        """Models on the data as they are now, test by test."""
        named = [m.id if isinstance(m, Fit) else m for m in models] or [self.model().id]
        return compared(self.store, named)

    def predict(
        self, target: Path | str, model: str | None = None, *, conditions: Mapping[str, str | float] | None = None
    ) -> Predictions:
        """A model on a campaign of the store, a campaign file or a folder of logs. conditions: of all of its tests."""
        return self.model(model).predict(target, conditions=conditions)

    def contributions(
        self, test: str | None = None, model: str | None = None, response: str | None = None
    ) -> Contributions:
        """What each effect of a model gives in a test."""
        return self.model(model).contributions(test, response)

    def residual_tests(self, model: str | None = None) -> ResidualTests:
        """What the residual of a model still tells."""
        return self.model(model).residual_tests()

    def history(self, model: str | None = None) -> Listed:
        """The versions that led to a model."""
        return self.model(model).history()

    def __repr__(self) -> str:
        return f"thermodata.open({str(self.path)!r})"

    def _repr_html_(self) -> str:
        with self.store.reader() as con:
            rows = con.execute(
                "select campaign, count(*) as tests, count(*) filter (role = 'locked') as locked, "
                "sum(duration_s) / 3600 as hours from test group by campaign order by campaign"
            ).fetchall()
        heads = ("campaign", "tests", "locked", "hours")
        held = html_table([dict(zip(heads, r, strict=True)) for r in rows], [(h, h) for h in heads], repr(self))
        models = self.models()
        return held + (models.html() if len(models) else "")
