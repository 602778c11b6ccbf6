"""What a workbench was started with: its store, the folders that it may look into, and whether it may write."""

from __future__ import annotations

import hmac
import secrets
import threading
from dataclasses import dataclass, field
from pathlib import Path

from thermodata.errors import UsageError
from thermodata.store import Store
from thermodata.store.catalogue.format.create import CATALOGUE

DEFAULT_STORE = "thermodata.store"


class Keys:
    """What lets a browser in. ticket: of the opened address, once. session: of the cookie. form: of every write.

    All are random of 256 bits and live as long as the process.
    """

    def __init__(self) -> None:
        self.ticket, self.session, self.form = (secrets.token_urlsafe(32) for _ in range(3))
        self._spent = False
        self._guard = threading.Lock()

    def spend(self, ticket: str) -> bool:
        """Whether this is the ticket, for the first time."""
        with self._guard:
            right = same(ticket, self.ticket) and not self._spent
            self._spent = self._spent or right
            return right


def same(given: str, right: str) -> bool:
    """Compares without telling how much was right."""
    return hmac.compare_digest(given.encode("utf-8", "replace"), right.encode())


@dataclass(frozen=True, slots=True)
class Desk:
    """store_path: absolute; there may be no store yet. folders: resolved; nothing outside of them is read or written.
    port: of 127.0.0.1."""

    store_path: Path
    folders: tuple[Path, ...]
    write: bool
    port: int
    keys: Keys = field(default_factory=Keys, repr=False)
    _opened: list[Store] = field(default_factory=list, repr=False)  # at most one

    @property
    def host(self) -> str:
        """As the Host header must say it."""
        return f"127.0.0.1:{self.port}"

    @property
    def address(self) -> str:
        return f"http://{self.host}"

    @property
    def has_store(self) -> bool:
        return (self.store_path / CATALOGUE).exists()

    def store(self) -> Store:
        """One for all pages: its copy of the catalogue is made anew after a commit only. UsageError where there is
        none yet, or none any more."""
        if not (self._opened and self.has_store):
            self._opened[:] = [Store(self.store_path)]
        return self._opened[0]

    def inside(self, name: str | Path) -> Path:
        """A path of the user's, resolved: relative ones from the first folder, links followed. UsageError where it
        leads out of the chosen folders."""
        text = str(name)
        if "\0" in text:
            raise UsageError(
                "a path holds no zero byte",
                where=repr(text),
                hint="type the path anew: something invisible was pasted with it",
            )
        given = Path(text).expanduser()
        real = (given if given.is_absolute() else self.folders[0] / given).resolve()
        if not any(real == folder or folder in real.parents for folder in self.folders):
            raise UsageError(
                "this path is outside of the chosen folders",
                where=text,
                expected=" or ".join(f"below {folder}" for folder in self.folders),
                got=str(real),
                hint="thermodata workbench FOLDER opens another one",
            )
        return real


def desk_of(given: Path | None, store: Path | None, *, write: bool, port: int, otherwise: Path | None = None) -> Desk:
    """given: a store, or a folder of raw logs with or without a store in it; None is the working folder.
    store: named beside it. otherwise: the store where neither leads to one. UsageError where the folder is none, and
    where it is a store and another one is named."""
    folder = Path.cwd() if given is None else given.absolute()
    if given is not None and not folder.is_dir():
        raise UsageError(
            "no such folder", where=str(folder), expected="a store or a folder of raw logs", hint="thermodata demo DIR"
        )
    is_store = (folder / CATALOGUE).exists()
    if given is not None and is_store and store is not None and store.resolve() != folder.resolve():
        raise UsageError(
            "two stores are named",
            where="workbench",
            expected=f"one of {given} and --store {store}",
            got="both",
            hint=f"thermodata workbench {given}",
        )
    if store is None and is_store and (given is not None or otherwise is None):
        # a campaign and its raw files stand beside their store
        return Desk(folder, _resolved(folder.parent, folder), write, port)
    inside = folder / DEFAULT_STORE
    if store is None and otherwise is not None and not (given is not None and (inside / CATALOGUE).exists()):
        store = otherwise
    path = (inside if store is None else store).absolute()
    return Desk(path, _resolved(folder, path), write, port)


def _resolved(*folders: Path) -> tuple[Path, ...]:
    return tuple(dict.fromkeys(folder.resolve() for folder in folders))
