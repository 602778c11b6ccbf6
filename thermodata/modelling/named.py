"""What a user names a model by: nothing for the newest one, an id, a prefix or a name, or the path of a model file."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

from thermodata.errors import ThermodataError, UsageError
from thermodata.modelling.run import fit, fit_once, load_data
from thermodata.modelling.versions.came_since import as_chosen, came_since
from thermodata.modelling.versions.result import model_id
from thermodata.schema.files.load import load_model
from thermodata.schema.files.locate import located
from thermodata.schema.words.sentences import listed
from thermodata.store.catalogue.data_version import again_where_data_changed

if TYPE_CHECKING:
    from thermodata.schema.answers.result import FitResult
    from thermodata.store import Store


def is_file(ref: str) -> bool:
    """Whether a model is named by its file."""
    return ref.endswith((".yaml", ".yml")) or Path(ref).is_file()


def fit_file(store: Store, path: Path) -> FitResult:
    """Fit and save the model of a file. Errors name its line, those too that only the data show."""
    spec = load_model(path)
    try:
        return fit(store, spec, base=path.parent)
    except ThermodataError as error:
        raise located(error, path) from error


@again_where_data_changed
def fit_named(store: Store, ref: str) -> FitResult:
    """Fit and save: a model file, or a model of the store again after its data changed."""
    from thermodata.store.catalogue.models.fits import find_model

    if is_file(ref):
        return fit_file(store, Path(ref))
    from thermodata.store.catalogue.models.renamed import renamings

    refuse_several_campaigns(store, ref)
    stored = find_model(store, ref)
    data = load_data(store, stored.spec)
    spec = as_chosen(stored, data)
    notes = [renamings(stored.renamed)] if stored.renamed else []
    return fit_once(store, spec, read=data, parent=stored.parent, notes=[*notes, *came_since(spec, data)])


def model_named(store: Store, ref: str) -> str:
    """As the store knows it: a path is fitted (or found, where that fit exists), a name stays one."""
    from thermodata.store.catalogue.models.fits import find_model

    if not is_file(ref):
        return ref
    path = Path(ref)
    spec = load_model(path)
    if not any(e.file or e.name for e in spec.effects):  # what these are now is known to the fit only
        with suppress(UsageError):  # this fit was not made yet
            return find_model(store, model_id(spec, load_data(store, spec).data_version)).model
    return fit_file(store, path).model


def newest_model(store: Store) -> str:
    """The id of the version that was fitted last, for the first time or again; UsageError where the store holds
    none."""
    with store.reader() as con:
        # a fit writes its row anew, and keeps in it when the version was made
        row = con.execute("select model from model order by rowid desc limit 1").fetchone()
    if row is None:
        raise UsageError("no model was fitted yet", where=str(store.path), hint="thermodata fit MODEL.yaml")
    return str(row[0])


def of_which_version(store: Store, ref: str) -> str | None:
    """Where a name leads to one of several versions that are as far from the first and differ, in effects or in the
    tests that they were fitted to (and their data are as they were): which it is, and the others; else None."""
    from thermodata.store.catalogue.models.fits import find_model
    from thermodata.view.lists.models import model_rows

    rows = model_rows(store)
    if ref in {m.model for m in rows} or ref.rpartition("/")[2] not in {m.name for m in rows}:
        return None
    own = find_model(store, ref)
    row = next(m for m in rows if m.model == own.model)
    beside = [
        m
        for m in rows
        if (m.name, m.version, m.campaigns) == (row.name, row.version, row.campaigns)
        and m.model != row.model
        and (m.effects != row.effects or not m.stale)
    ]
    if not beside:
        return None
    others = listed([m.model for m in beside])
    are = f"{others} {'is' if len(beside) == 1 else 'are'} version {row.version} too"
    if any(m.effects != row.effects for m in beside):
        return f"'{ref}': {own.model}, the newest of that name; {are}, with other effects"
    counts = listed([str(m.tests) for m in beside])
    return f"'{ref}': {own.model}, the newest of that name; {are}, of {counts} tests, where it is of {row.tests}"


def name_taken_over(store: Store, model: str) -> str | None:
    """Where a name leads to this model now, and a longer chain of versions has it too: what each of them is; else
    None."""
    from thermodata.store.catalogue.models.fits import find_model
    from thermodata.view.lists.models import model_rows

    rows = model_rows(store)
    own = next(m for m in rows if m.model == model)
    longer = [m for m in rows if (m.name, m.campaigns) == (own.name, own.campaigns) and m.version > own.version]
    if not longer or find_model(store, own.name).model != own.model:
        return None
    other = longer[0]
    more = [name for name in other.effects if name not in own.effects]
    return (
        f"'{own.name}' is {own.model} now, version {own.version}, the newest of that name; the chain that was made of "
        f"it before is left at {other.model}, version {other.version}" + (f" with {listed(more)}" if more else "")
    )


def of_which_campaign(store: Store, ref: str) -> str | None:
    """Where models of several campaigns have a name: which it leads to, and the newest of the others; else None."""
    if len(rows := _by_campaigns(store, ref)) < 2:
        return None
    (own, model), *others = rows
    beside = "; ".join(f"{', '.join(campaigns)}: {other}" for campaigns, other in others)
    return f"'{ref}' of {', '.join(own)}: {model}, the newest of that name; there are others, of {beside}"


def refuse_several_campaigns(store: Store, ref: str) -> None:
    """UsageError where models of several campaigns have a name: what writes, or looks at locked tests, guesses none."""
    if len(rows := _by_campaigns(store, ref)) < 2:
        return
    ways = [f"{','.join(campaigns)}/{ref} ({model})" for campaigns, model in rows]
    raise UsageError(
        f"models of several campaigns are called '{ref}'",
        expected=f"one of them: {listed(ways, 'or')}",
        got=ref,
        hint=f"write {','.join(rows[0][0])}/{ref}, or its id",
    )


def _by_campaigns(store: Store, ref: str) -> list[tuple[list[str], str]]:
    """The campaigns of models of a name, with the newest model of each; of an id none."""
    with store.reader() as con:
        rows = con.execute(
            "select campaigns, arg_max(model, (created_at, rowid)) from model where name = $1 "
            "and not exists (select 1 from model where model = $1) group by campaigns "
            "order by max((created_at, rowid)) desc",
            [ref],
        ).fetchall()
    return [(list(campaigns), str(model)) for campaigns, model in rows]
