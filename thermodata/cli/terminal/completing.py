"""What the shell offers after a Tab: names from the store that the line so far names; nothing where there is none.

Bash: eval "$(_THERMODATA_COMPLETE=bash_source thermodata)"; zsh and fish alike.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from click.shell_completion import CompletionItem

if TYPE_CHECKING:
    import click
    from click import Context, Parameter

    from thermodata.store import Store

Complete = Callable[["Context", "Parameter", str], list[CompletionItem]]
_MOST = 500


def _offer(ask: Callable[[Store, dict[str, Any]], Iterable[tuple[str, str]]], *, files: str = "") -> Complete:
    """ask: (store, the words that the line has so far) -> (name, help). files: files are offered too."""

    def complete(ctx: Context, param: Parameter, begun: str) -> list[CompletionItem]:
        found = list[CompletionItem]()
        with _silent():
            store = _store(ctx)
            rows = ask(store, ctx.params) if store is not None else []
            unique = {name: text for name, text in rows if name.startswith(begun)}
            found = [CompletionItem(name, help=text) for name, text in list(unique.items())[:_MOST]]
        return [*found, CompletionItem(begun, type="file")] if files and not found else found

    return complete


def _store(ctx: Context) -> Store | None:
    from thermodata.store import Store

    named = ctx.params.get("store_after") or ctx.find_root().params.get("store") or os.environ.get("THERMODATA_STORE")
    path = Path(named or "thermodata.store")
    return Store(path) if path.is_dir() else None


@contextmanager
def _silent() -> Iterator[None]:
    """A shell that completes shows no traceback: it offers nothing."""
    try:
        yield
    except Exception:
        if os.environ.get("THERMODATA_DEBUG"):
            raise


def _rows(store: Store, query: str, params: list[Any] | None = None) -> list[tuple[str, str]]:
    with store.reader() as con:
        return [(str(a), str(b or "")) for a, b in con.execute(query, params or []).fetchall()]


def _models(store: Store, words: dict[str, Any]) -> list[tuple[str, str]]:
    """Names first, then ids."""
    rows = _rows(store, "select name, model from model order by created_at desc, rowid desc")
    return [*((name, f"newest: {model}") for name, model in rows[::-1]), *((model, name) for name, model in rows)]


def _campaigns(store: Store, words: dict[str, Any]) -> list[tuple[str, str]]:
    return _rows(store, "select campaign, '' from campaign order by campaign")


def _tests(store: Store, words: dict[str, Any]) -> list[tuple[str, str]]:
    of = words.get("campaign") or words.get("what")
    query = "select test, kind || ', ' || role from test where campaign = coalesce(?, campaign) order by rowid"
    return _rows(store, query, [of])


def _channels(store: Store, words: dict[str, Any]) -> list[tuple[str, str]]:
    of, test = words.get("campaign") or words.get("what"), words.get("test")
    query = (
        "select channel, any_value(quantity || coalesce(' at ' || \"at\", '')) from channel "
        "where campaign = coalesce(?, campaign) and test = coalesce(?, test) group by channel order by min(rowid)"
    )
    return _rows(store, query, [of, test])


def _candidates(store: Store, words: dict[str, Any]) -> list[tuple[str, str]]:
    """Ids and ranks of the model's last diagnosis, and the steps that it told."""
    from thermodata.schema.answers.slip_ids import slip_ids
    from thermodata.store.catalogue.models.findings import load_diagnosis
    from thermodata.store.catalogue.models.fits import find_model

    found = load_diagnosis(store, find_model(store, str(words.get("model"))).model)
    if found is None:
        return []
    listed = [(c.id, f"rank {c.rank}") for c in found.candidates] + [(str(c.rank), c.id) for c in found.candidates]
    return listed + [(name, "a step of the probe") for name in slip_ids(found)]


def _effects_of(store: Store, words: dict[str, Any]) -> list[tuple[str, str]]:
    from thermodata.modelling.model_file.resolve import term_ids
    from thermodata.store.catalogue.models.fits import find_model

    effects = find_model(store, str(words.get("model"))).spec.effects
    return [(i, e.effect) for i, e in zip(term_ids(effects), effects, strict=True)]


models = _offer(_models, files="*.yaml")
campaigns = _offer(_campaigns)
tests = _offer(_tests)
channels = _offer(_channels)
candidates = _offer(_candidates)
effects_of_model = _offer(_effects_of)
campaigns_and_models = _offer(lambda store, words: [*_campaigns(store, words), *_models(store, words)])


def plugins(ctx: click.Context, param: click.Parameter, begun: str) -> list[CompletionItem]:
    """Installed effects and readers; they need no store."""
    with _silent():
        from importlib.metadata import entry_points

        found = [(e.name, g.rpartition(".")[2]) for g in _GROUPS for e in entry_points(group=g)]
        return [CompletionItem(n, help=kind) for n, kind in sorted(set(found)) if n.startswith(begun)]
    return []


_GROUPS = ("thermodata.effect", "thermodata.reader")
