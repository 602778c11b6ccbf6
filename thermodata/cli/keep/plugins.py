"""`plugins`: what is installed, and what failed to load; `plugins show`: all about one; `plugins new`: one more."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from thermodata.cli.terminal import completing
from thermodata.cli.terminal.common import Session, WithActions, command
from thermodata.report.text.table import table

_SHOW = """Print all about the installed plugin NAME.

Of an effect its equation, drivers, places, bounds and source; of a reader its formats."""
_NEW = """Write a small plugin that works and passes its kit: NAME is reader-NAME or effect-NAME.

With tests and comments to go on from: in a checkout of thermodata as plugins/reader-NAME, registered for `uv run`;
elsewhere as a package in the current folder."""


@command("plugins", cls=WithActions, actions={"show": _SHOW, "new": _NEW})
@click.argument("action", required=False, type=click.Choice(["show", "new"]))
@click.argument("name", required=False, shell_complete=completing.plugins)
def plugins_command(session: Session, action: str | None, name: str | None) -> None:
    """List the installed readers and effects; 'show' one, or write a 'new' one.

    With the distribution of each; failed ones with their error.

    'plugins show NAME' prints an effect's equation, drivers, places, bounds and source, or a reader's formats.

    'plugins new reader-NAME' (or effect-NAME) writes a small plugin that works and passes its kit, with tests and
    comments to go on from: in a checkout of thermodata as plugins/reader-NAME, registered for `uv run`; elsewhere as a
    package in the current folder.
    """
    if action == "new":
        _write_new(session, name)
        return
    if action == "show":
        from thermodata.cli.keep.show_plugin import show

        show(session, name, installed())
        return
    rows = installed()
    session.answer(
        rows,
        lambda: table(
            rows,
            [
                ("kind", "kind"),
                ("name", "name"),
                ("distribution", "distribution"),
                ("version", "version"),
                ("about", "about"),
                ("error", "error"),
            ],
        ),
    )


def _write_new(session: Session, name: str | None) -> None:
    from thermodata.cli.keep.new_plugin import write_plugin

    made = write_plugin(name, Path.cwd())

    def text() -> str:
        files = "\n".join(f"  {made.folder / file}" for file in made.files)
        edited = f"\nregistered in {made.edited}" if made.edited else ""
        return f"{made.distribution}, a plugin that works and passes its kit:\n{files}{edited}"

    session.answer(made, text)
    session.say("now: " + "\n     ".join(made.run))


def installed() -> list[dict[str, Any]]:
    """One row a plugin: kind, name, distribution, version, about, error (None where it loads)."""
    from importlib.metadata import entry_points

    from thermodata.effect import all_effects, failed_effects
    from thermodata.reader import failed_readers, readers

    loaded: dict[str, dict[str, Any]] = {"reader": dict(readers()), "effect": dict(all_effects())}
    failed = {"reader": dict(failed_readers()), "effect": dict(failed_effects())}
    origin = {(kind, point.name): point.dist for kind in loaded for point in entry_points(group=f"thermodata.{kind}")}
    rows = []
    for kind, plugins in loaded.items():
        names = sorted(set(plugins) | {name for k, name in origin if k == kind and name in failed[kind]})
        for name in names:
            # an entry point may stand for several effects; those carry their module's distribution
            dist = origin.get((kind, name)) or _distribution(plugins.get(name))
            rows.append(
                {
                    "kind": kind,
                    "name": name,
                    "distribution": dist.name if dist else None,
                    "version": dist.version if dist else None,
                    "about": _about(plugins.get(name)),
                    "error": failed[kind].get(name),
                }
            )
    return rows


def _about(plugin: Any) -> str | None:
    text = getattr(plugin, "meaning", None) or getattr(plugin, "__doc__", None)
    return str(text).strip().splitlines()[0] if text else None


def _distribution(plugin: Any) -> Any:
    from importlib.metadata import distribution, packages_distributions

    if plugin is None:
        return None
    module = getattr(plugin, "__module__", None) or type(plugin).__module__
    names = packages_distributions().get(module.split(".")[0], [])
    return distribution(names[0]) if names else None
