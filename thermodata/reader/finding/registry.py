"""Which readers are installed, and which of them claims a file. Ours register exactly as anybody's."""

from __future__ import annotations

import warnings
from contextlib import AbstractContextManager, nullcontext
from functools import lru_cache
from importlib.metadata import EntryPoint, entry_points
from pathlib import Path

from thermodata.archive.members import each_in
from thermodata.archive.regular import opened
from thermodata.archive.unpacked import PACKED, held
from thermodata.errors import FAILED, FormatError, UsageError, unknown_name
from thermodata.plugin import HEAD_BYTES, Head, Reader
from thermodata.reader.contract.guard import takes_packed

GROUP = "thermodata.reader"
INSTALL = "pip install thermodata-reader-crio thermodata-reader-cnc thermodata-reader-mcap thermodata-reader-table"

_told: set[str] = set()  # warnings of files, which are asked more than once


def installed() -> dict[str, EntryPoint]:
    """Entry points by name, without importing any of them; UsageError where two share a name."""
    found: dict[str, EntryPoint] = {}
    for point in entry_points(group=GROUP):
        other = found.get(point.name)
        if other is not None and other.value != point.value:
            raise UsageError(
                f"two readers are called '{point.name}'",
                expected="one",
                got=f"{other.value} and {point.value}",
                hint="uninstall one of their distributions",
            )
        found[point.name] = point
    return dict(sorted(found.items()))


def _load(point: EntryPoint) -> Reader:
    made = point.load()
    candidate = made() if isinstance(made, type) else made
    if not isinstance(candidate, Reader):
        raise TypeError(f"{point.value} has no name, sniff, describe and blocks")
    if candidate.name != point.name:
        raise TypeError(f"{point.value} calls itself '{candidate.name}'")
    return candidate


@lru_cache(maxsize=1)
def _readers_and_failures() -> tuple[dict[str, Reader], dict[str, str]]:
    good: dict[str, Reader] = {}
    bad: dict[str, str] = {}
    for name, point in installed().items():
        try:
            good[name] = _load(point)
        except FAILED as error:  # a plugin may fail in any way; it must not take the house with it
            bad[name] = f"{type(error).__name__}: {error}"
            _warn_of(name, point.value, bad[name])
    return good, bad


def _warn_of(name: str, where: str, error: str) -> None:
    warnings.warn(
        f"reader '{name}' ({where}) does not load: {error}; its files are left unread, or read by another reader: "
        "install it anew before you trust what is read",
        stacklevel=4,
    )


def readers() -> dict[str, Reader]:
    """The readers that load, by name. One that fails to import is a warning, and stands in failed_readers()."""
    return dict(_readers_and_failures()[0])


def failed_readers() -> dict[str, str]:
    """Name -> error of the readers that are installed and do not load."""
    return dict(_readers_and_failures()[1])


@lru_cache(maxsize=1)
def _versions() -> dict[str, str]:
    return {name: point.dist.version for name, point in installed().items() if point.dist is not None}


def distribution_version(name: str) -> str:
    """The version of the distribution that brought a reader; '' where it can't be told. Looked up once a process:
    it takes as long as reading a small log, and every file asks."""
    return _versions().get(name, "")


def reader(name: str) -> Reader:
    """The reader of this name. UsageError names the installed ones, or the command that installs some."""
    good, bad = _readers_and_failures()
    if name in good:
        return good[name]
    if name in bad:
        raise UsageError(
            f"reader '{name}' is installed but does not load",
            got=bad[name],
            hint="install it anew, with what it needs; thermodata plugins shows how it fails",
        )
    if not good and not bad:
        raise UsageError(f"no reader '{name}': none is installed", hint=INSTALL)
    raise unknown_name("reader", name, list(good))


def head(path: Path) -> Head:
    """A file's first 64 KiB, of a packed one as it was before that; UsageError where it cannot be read, or is none: a
    pipe, a device. FormatError for one that cannot be unpacked."""
    try:
        with _path_to_sniff(path) as real, opened(real) as file:
            start = file.read(HEAD_BYTES)
            return Head(real.name, real.stat().st_size, start)
    except OSError as error:
        raise UsageError(
            f"cannot read {path.name}",
            where=str(path),
            got=error.strerror or str(error),
            hint="see that the file is there, and that you may read it",
        ) from None


def files_in(path: Path) -> list[Path]:
    """The files in an archive; any other file alone, and an archive that a reader takes as it is, or that can't be
    read."""
    return [path] if _taken_as_it_is(path) else each_in(path)


def _path_to_sniff(path: Path) -> AbstractContextManager[Path]:
    return nullcontext(path) if _taken_as_it_is(path) else held(path)


def _taken_as_it_is(path: Path) -> bool:
    """Whether the format of a packed file is a reader's own."""
    return path.suffix.lower() in PACKED and path.is_file() and any(takes_packed(r, path) for r in readers().values())


def all_claims(path: Path | str) -> dict[str, str]:
    """Reader -> its reason for claiming the file, those that give way too."""
    return _sniffed(Path(path))[0]


def failed_sniffs(path: Path | str) -> dict[str, str]:
    """Reader -> what it raised when it was shown the file."""
    return _sniffed(Path(path))[1]


def _sniffed(path: Path) -> tuple[dict[str, str], dict[str, str]]:
    """Reasons for claiming the file, and what was raised instead of an answer."""
    start = head(path)
    found: dict[str, str] = {}
    failed: dict[str, str] = {}
    for name, each in readers().items():
        try:
            reason = each.sniff(start)
        except ImportError as error:  # what it imports when it is first asked is missing: it loads for no file
            good, bad = _readers_and_failures()
            del good[name]
            bad[name] = f"{type(error).__name__}: {error}"
            _warn_of(name, installed()[name].value if name in installed() else "", bad[name])
            continue
        except FAILED as error:  # a sniff that stumbles over a foreign file claims nothing
            failed[name] = f"{type(error).__name__}: {error}"
            said = f"reader '{name}' failed to sniff {start.name}: {failed[name]}"
            if said not in _told:
                _told.add(said)
                warnings.warn(said, stacklevel=2)
            continue
        if reason is not None:
            found[name] = reason
    return found, failed


def gives_way(name: str) -> bool:
    """Whether a reader claims a file only where no other reader does."""
    return bool(getattr(readers()[name], "gives_way", False))


def claims(path: Path | str) -> dict[str, str]:
    """Reader -> its reason for claiming the file. A reader that gives way claims nothing beside one that does not."""
    found = all_claims(path)
    firm = {name: reason for name, reason in found.items() if not gives_way(name)}
    return firm or found


def sniff(path: Path | str) -> Reader:
    """The one reader that claims the file. FormatError for none, or for several with the reason of each."""
    path = Path(path)
    found = claims(path)
    if len(found) == 1:
        return reader(next(iter(found)))
    if not found:
        names = ", ".join(readers())
        raise FormatError(
            f"no reader claims {path.name}",
            where=str(path),
            expected=f"a file of one of: {names}" if names else "a reader; none is installed",
            hint=None if names else INSTALL,
        )
    reasons = " and ".join(f'{name} ("{why}")' for name, why in found.items())
    raise FormatError(
        f"{reasons} claim {path.name}",
        where=str(path),
        expected="one reader",
        hint=f"set 'reader' in the campaign file's source, such as reader: {next(iter(found))}: no installed reader is "
        "taken before another; one of your own claims less in `sniff`, or has `gives_way = True` (CONTRIBUTING.md)",
    )
