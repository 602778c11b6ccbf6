"""What every command shares: the store, --json, and the two ways of answering."""

from __future__ import annotations

import errno
import functools
import os
import re
import sys
from collections.abc import Callable, Mapping
from copy import copy
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import click

from thermodata.cli.terminal.json_text import json_text
from thermodata.cli.terminal.json_text import plain as plain
from thermodata.errors import StoreError, ThermodataError, UsageError

if TYPE_CHECKING:
    from thermodata.store import Store
    from thermodata.view import StoreView


@dataclass(frozen=True, slots=True)
class Session:
    """One call of the program: where the store is and how the answer is written. store_named: by an option, and not by
    default or by the environment; store_by_default: nobody named one."""

    store_path: Path
    as_json: bool
    store_named: bool = False
    store_by_default: bool = False

    def store(self, *, create: bool = False) -> Store:
        """The store; a UsageError names `ingest` where there is none yet."""
        from thermodata.store import Store

        return Store(self.store_path, create=create)

    def view(self) -> StoreView:
        from thermodata.view import StoreView

        return StoreView(self.store_path)

    def say(self, text: str = "") -> None:
        """Talk, on stderr, and none of it where JSON was asked for."""
        if not self.as_json:
            click.echo(text, err=True)

    def answer(self, payload: Any, text: Callable[[], str]) -> None:
        """Data, on stdout: the payload as JSON, or its text."""
        for piece in json_text(payload) if self.as_json else (text(),):
            click.echo(piece, nl=False)
        click.echo()


def known_failure(error: Exception) -> ThermodataError | None:
    """What the user can do something about, in an exception of a library: a full disk, a damaged file of the store,
    a query that fails on a row. None for anything else."""
    if isinstance(error, OSError):
        # Arrow says its file in its text only
        named = error.filename or next(iter(re.findall(r"local file '([^']+)'", str(error))), None)
        # what names no file (a signal, a socket) is no matter of folders
        if named and error.errno in (errno.EACCES, errno.EPERM, errno.EROFS):
            return ThermodataError(
                "no right to read or write there",
                where=str(named),
                got=os.strerror(error.errno),
                hint="name a folder of your own, or give yourself the right",
            )
        from thermodata.store.base.no_room import no_room

        way = no_room(error)
        if way is None:
            return None
        return StoreError(
            way.what,
            where=str(error.filename) if error.filename else None,
            got=error.strerror,
            hint=f"{way.todo}, and run it again",
        )
    # by name: DuckDB is imported in the store and its views only, and only where it is needed
    if not type(error).__module__.lstrip("_").startswith("duckdb"):
        return None
    from thermodata.store.base.connection import damaged_data

    damage = damaged_data(Path("the store"), error)
    return damage or UsageError("the query fails", got=str(error).strip().splitlines()[0])


class WithActions(click.Command):
    """A command whose first argument, `action`, is a word of its own: `plugins show --help` is the help of that one.

    actions: action -> its help; None where it is that of the command."""

    def __init__(self, *given: Any, actions: Mapping[str, str | None], **more: Any) -> None:
        super().__init__(*given, **more)
        self._actions = actions

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        action = next((word for word in args if not word.startswith("-")), "")
        if action in self._actions and not set(args).isdisjoint(ctx.help_option_names):
            shown = copy(self)
            shown.params = [p for p in self.params if p.name != "action"]
            shown.help = self._actions[action] or self.help
            ctx.info_name = f"{ctx.info_name} {action}"
            click.echo(shown.get_help(ctx))
            ctx.exit()
        return super().parse_args(ctx, args)


def in_units_of(session: Session, response: str | list[str], text: str) -> str:
    """A text that says um, in the units of the responses (`report.words.numbers.in_units`), `as_shown`."""
    from thermodata.report.words.numbers import in_units
    from thermodata.view.lists.response_units import response_units

    names = [response] if isinstance(response, str) else response
    return as_shown(in_units(text, response_units(session.store(), names)))


def as_shown(text: str) -> str:
    """At a terminal with its sentences folded, which else would break within words. A file or a pipe has each in one
    line."""
    from thermodata.report.text.table import sentences_folded

    return sentences_folded(text) if sys.stdout.isatty() else text


def command(name: str, **more: Any) -> Callable[[Callable[..., Any]], click.Command]:
    """A click command whose first argument is the Session; --store and --json may stand after its name."""

    def decorate(function: Callable[..., Any]) -> click.Command:
        @functools.wraps(function)
        def call(ctx: click.Context, /, *args: Any, **options: Any) -> Any:
            after, root = options.pop("store_after"), ctx.find_root()
            source, of = root.get_parameter_source("store"), click.core.ParameterSource
            before = root.obj if source is of.COMMANDLINE else None
            if before and after and Path(before).resolve() != Path(after).resolve():
                raise UsageError(
                    "two stores are named", where="--store", expected=f"one of {before} and {after}", got="both"
                )
            store = Path(after or root.obj or "thermodata.store")
            by_default = not after and source in (of.DEFAULT, None)
            session = Session(store, options.pop("as_json"), bool(after or before), by_default)
            return function(session, *args, **options)

        made: Any = click.pass_context(call)
        made = click.option("--json", "as_json", is_flag=True, help="Print JSON.")(made)
        made = click.option("--store", "store_after", metavar="DIR", help="The store's folder.")(made)
        finished: click.Command = cast(Any, click.command(name, **more))(made)
        return finished

    return decorate
