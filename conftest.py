"""How the whole run goes: side by side, each worker with one thread of its own.

Only plain `pytest` is spread over workers; a run that names what it wants stays in one process, unless `-n` asks for
more. `pytest -n 0` and `pytest -p no:xdist` run everything in one process.
"""

from __future__ import annotations

import gc
import os
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from filelock import FileLock

Once = Callable[[str, Callable[[Path], object]], Path]

# threads of the linear algebra libraries would wait for those of the other workers; set before numpy is imported,
# and inherited by every process that a test starts
for _name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ.setdefault(_name, "1")


def _is_whole(config: pytest.Config) -> bool:
    return config.args_source is pytest.Config.ArgsSource.TESTPATHS


def _is_to_be_watched(config: pytest.Config) -> bool:
    option = config.option
    return bool(option.usepdb or option.collectonly or option.capture == "no")


@pytest.hookimpl(tryfirst=True)
def pytest_cmdline_main(config: pytest.Config) -> None:
    if not config.pluginmanager.hasplugin("xdist") or hasattr(config, "workerinput"):
        return
    option = config.option
    if option.numprocesses is None and option.dist == "no" and _is_whole(config) and not _is_to_be_watched(config):
        # tests take from a millisecond to ten seconds: who is done early takes over from the others
        option.numprocesses, option.dist = "logical", "worksteal"


def pytest_collection_finish() -> None:
    # the modules that are imported by now are no garbage; many tests collect, and need not look at them again
    gc.collect()
    gc.freeze()


def pytest_unconfigure() -> None:
    gc.unfreeze()  # at the end of the process they are


@pytest.fixture(scope="session")
def once(tmp_path_factory: pytest.TempPathFactory) -> Once:
    """once(name, make): the folder that make(folder) filled, made by the first worker of the run that asks for it.

    It belongs to all workers: read what is in it, or change a copy.
    """
    base = tmp_path_factory.getbasetemp()
    shared = base.parent if "PYTEST_XDIST_WORKER" in os.environ else base

    def made(name: str, make: Callable[[Path], object]) -> Path:
        folder, whole = shared / f"once-{name}", shared / f"once-{name}.whole"
        with FileLock(shared / f"once-{name}.lock"):
            if not whole.exists():
                shutil.rmtree(folder, ignore_errors=True)
                folder.mkdir()
                make(folder)
                whole.touch()
        return folder

    return made


@pytest.fixture(scope="session", autouse=True)
def make_catalogue(once: Once) -> Iterator[Callable[[Path], None]]:
    """What makes the catalogue of a new store. In this process a new store's is a copy of the one that it made once in
    the run, but for tests of `stores_made_anew`; and nothing waits until the disk has what was written, which tells
    only where the power fails. Processes that tests start do both as those of users do.
    """
    from thermodata.store.catalogue import store
    from thermodata.store.catalogue.format import create

    right = create.create_catalogue

    def copied(folder: Path) -> None:
        shutil.copytree(once("empty-store", right), folder, dirs_exist_ok=True)
        (folder / create.MARK).write_text(create.new_mark())

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(store, "create_catalogue", copied)
        patch.setattr(os, "fsync", lambda fd: None)
        yield right


@pytest.fixture
def stores_made_anew(make_catalogue: Callable[[Path], None], monkeypatch: pytest.MonkeyPatch) -> None:
    """New stores are made as a user's are: for tests of what happens meanwhile."""
    monkeypatch.setattr("thermodata.store.catalogue.store.create_catalogue", make_catalogue)
