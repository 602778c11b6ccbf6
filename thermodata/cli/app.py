"""The group of commands. A command's module is imported when it is used, so that starting costs nothing."""

from __future__ import annotations

import os
import re
import sys
import traceback
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from importlib import import_module
from typing import Any

import click

from thermodata.cli.terminal.common import known_failure
from thermodata.cli.terminal.interrupting import noticing_interrupts
from thermodata.errors import INTERRUPTED, ThermodataError, nearest, unknown_name
from thermodata.version import __version__

_EXTRA = re.compile(r"Got unexpected extra argument \((\S+)\)")

# Section of the help -> command -> module in its room. The order is the order of the work.
SECTIONS: dict[str, dict[str, str]] = {
    "Start": {
        "demo": "start.demo",
        "init": "start.files",
        "first-model": "start.files",
        "sniff": "start.files",
        "preview": "start.files",
        "ingest": "start.ingest",
    },
    "Look": {
        "campaigns": "look.campaigns",
        "tests": "look.look",
        "channels": "look.look",
        "calibrations": "look.look",
        "quality": "look.quality",
        "trace": "look.look",
        "sql": "look.query",
        "export": "look.take",
        "snapshot": "look.take",
    },
    "Model": {
        "fit": "model.fitting",
        "orders": "model.ordering",
        "profiles": "model.profiling",
        "compare": "model.comparing",
        "add": "model.fitting",
        "remove": "model.fitting",
        "models": "model.models",
        "history": "model.comparing",
        "portability": "model.comparing",
        "show": "model.show",
        "predict": "model.predict",
        "model": "model.control",
        "diagnose": "model.diagnosing",
        "confirm": "model.diagnosing",
        "report": "model.reporting",
        "workbench": "model.reporting",
    },
    "Check": {"simulate": "start.simulating", "benchmark-diagnosis": "start.benchmarking"},
    "Keep": {
        "plugins": "keep.plugins",
        "schema": "keep.schema",
        "check": "keep.remove",
        "forget": "keep.remove",
        "gc": "keep.remove",
    },
}
COMMANDS: dict[str, str] = {name: module for part in SECTIONS.values() for name, module in part.items()}


TWO_WORDS = ("plugins new", "plugins show", "model export")
"""What commands with an action are called, for who looks for these."""


def _nearest_command(word: str, choices: Sequence[str]) -> str | None:
    """The command most like a word, whatever the order of its parts: new-plugin is 'plugins new'."""
    by_parts = {" ".join(sorted(c.replace("-", " ").split())): c for c in choices}
    found = nearest(" ".join(sorted(word.replace("-", " ").replace("_", " ").split())), list(by_parts))
    return nearest(word, choices) if found is None else by_parts[found]


class _UnreadError(Exception):
    """A BrokenPipeError, which click would take for a failure and end the program itself, with 1."""


@contextmanager
def _unread_told_apart() -> Iterator[None]:
    try:
        yield
    except BrokenPipeError as error:
        raise _UnreadError from error


class Commands(click.Group):
    """Finds a command by name in its module; the attribute is the name with '_' for '-'."""

    def make_context(self, *given: Any, **more: Any) -> click.Context:
        with _unread_told_apart():  # of --help
            return super().make_context(*given, **more)

    def invoke(self, ctx: click.Context) -> Any:
        with _unread_told_apart():
            return super().invoke(ctx)

    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        if cmd_name not in COMMANDS:
            return None
        module = import_module(f"thermodata.cli.{COMMANDS[cmd_name]}")
        found: click.Command = getattr(module, cmd_name.replace("-", "_") + "_command")
        return found

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        if args and not args[0].startswith("-") and args[0] not in COMMANDS:
            raise unknown_name("command", args[0], [*COMMANDS, *TWO_WORDS], near=_nearest_command)
        return super().resolve_command(ctx, args)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        for title, names in SECTIONS.items():
            rows = []
            for name in names:
                command = self.get_command(ctx, name)
                rows.append((name, command.get_short_help_str(formatter.width - 18) if command else ""))
            with formatter.section(title):
                formatter.write_dl([(name.ljust(12), text) for name, text in rows], col_max=20)


@click.group(cls=Commands, context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 110})
@click.option(
    "--store",
    envvar="THERMODATA_STORE",
    default="thermodata.store",
    metavar="DIR",
    help="The store's folder (or THERMODATA_STORE; default ./thermodata.store).",
)
@click.version_option(__version__, prog_name="thermodata")
@click.pass_context
def cli(ctx: click.Context, store: str) -> None:
    """Thermal test logs of machine tools: one store, SQL, models, and the physical effect that is missing.

    Results go to stdout, talk to stderr; every command takes --json. Try: thermodata demo
    """
    ctx.obj = store
    ctx.color = _colour()


def run(argv: Sequence[str] | None = None) -> int:
    """Run, and turn what went wrong into 'error: ...' on stderr and an exit code."""
    warnings.showwarning = _warn
    if sys.stdout is None:
        sys.stdout = open(os.devnull, "w")  # noqa: SIM115 - to the end of the program
        return _fail("stdout is closed: there is nowhere to answer to\ntry: > /dev/null where no answer is wanted", 1)
    for stream in (sys.stdout, sys.stderr):
        # a letter that the terminal's encoding lacks is shown by its number
        if hasattr(stream, "reconfigure") and (stream.encoding or "").lower().replace("-", "") != "utf8":
            stream.reconfigure(errors="backslashreplace")
    with noticing_interrupts() as interrupted:
        try:
            code = cli.main(args=None if argv is None else list(argv), prog_name="thermodata", standalone_mode=False)
            sys.stdout.flush()
            return code if isinstance(code, int) else 0
        except (KeyboardInterrupt, click.Abort):
            return _fail("interrupted", INTERRUPTED)
        except Exception as error:
            return _fail("interrupted", INTERRUPTED) if interrupted() else _failed(error)


def _failed(error: Exception) -> int:
    """Says what went wrong; the exit code."""
    if isinstance(error, ThermodataError):
        return _fail(str(error), error.exit_code)
    if isinstance(error, click.UsageError):
        where = f"\ntry: {_instead(error.ctx, error.format_message())}" if error.ctx else ""
        return _fail(error.format_message() + where, 2)
    if isinstance(error, click.ClickException):
        return _fail(error.format_message(), 1)
    if isinstance(error, BrokenPipeError | _UnreadError):
        # the reader of stdout has gone (| head): that's its right; the interpreter must not flush again
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    known = known_failure(error)
    if known is not None:
        return _fail(str(known), known.exit_code)
    if isinstance(error, OSError):
        return _fail(f"{error.strerror or error}" + (f"\nwhere: {error.filename}" if error.filename else ""), 1)
    if os.environ.get("THERMODATA_DEBUG"):
        raise error
    last = traceback.extract_tb(error.__traceback__)[-1]
    return _fail(
        f"a defect in thermodata: {type(error).__name__}: {error}\n"
        f"where: {last.filename}:{last.lineno} in {last.name}\n"
        "try: THERMODATA_DEBUG=1 shows the whole traceback",
        1,
    )


def _instead(context: click.Context, said: str) -> str:
    """What to type where a word stands too many: a campaign is named by its option."""
    word = _EXTRA.fullmatch(said)
    takes = any("--campaign" in p.opts for p in context.command.params)
    return f"{context.command_path} --campaign {word[1]}" if word and takes else f"{context.command_path} --help"


def _warn(message: Warning | str, category: type[Warning], *where: object, **more: object) -> None:
    """A warning as one line of talk; what third parties deprecate is none of the user's business."""
    if category is UserWarning:
        click.echo(click.style("warning: ", fg="yellow") + str(message), err=True, color=_colour())


def _fail(message: str, code: int) -> int:
    click.echo(click.style("error: ", fg="red", bold=True) + message, err=True, color=_colour())
    return code


def _colour() -> bool | None:
    """None: as the terminal is; NO_COLOR (no-color.org) says no."""
    return False if os.environ.get("NO_COLOR") else None
