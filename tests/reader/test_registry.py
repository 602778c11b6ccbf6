"""Which readers there are, and which one claims a file."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from importlib.metadata import EntryPoint
from pathlib import Path

import pytest

from tests.installed import look_at_readers_again
from thermodata.errors import FormatError, UsageError
from thermodata.plugin import Head
from thermodata.reader.finding import registry
from thermodata.reader.finding.explain import explain


class Fake:
    def __init__(self, name: str, magic: bytes) -> None:
        self.name, self.magic = name, magic

    def sniff(self, head: Head) -> str | None:
        return f"starts with {self.magic!r}" if head.start.startswith(self.magic) else None

    def describe(self, *_: object) -> None: ...

    def blocks(self, *_: object) -> None: ...


class One(Fake):
    def __init__(self) -> None:
        super().__init__("one", b"A")


class Two(Fake):
    def __init__(self) -> None:
        super().__init__("two", b"AB")


class Stumbling(Fake):
    def __init__(self) -> None:
        super().__init__("stumbling", b"")

    def sniff(self, head: Head) -> str | None:
        raise IndexError("too short")


class Lazy(Fake):
    def __init__(self) -> None:
        super().__init__("lazy", b"")

    def sniff(self, head: Head) -> str | None:
        raise ModuleNotFoundError("No module named 'parts'")


class General(Fake):
    gives_way = True

    def __init__(self) -> None:
        super().__init__("general", b"")


CLASSES = {"one": One, "two": Two, "stumbling": Stumbling, "lazy": Lazy, "general": General}


@pytest.fixture
def install(monkeypatch: pytest.MonkeyPatch) -> Iterator[object]:
    """install("one", "missing") as if distributions had these entry points."""

    def put(*names: str) -> None:
        points = [EntryPoint(n, f"module_{n}:Reader", registry.GROUP) for n in names]
        monkeypatch.setattr(registry, "entry_points", lambda group: points)
        look_at_readers_again()

    def load(point: EntryPoint) -> object:
        if point.name not in CLASSES:
            raise ModuleNotFoundError(f"No module named '{point.module}'")
        return CLASSES[point.name]()

    monkeypatch.setattr(registry, "_load", load)
    yield put
    look_at_readers_again()


def write(tmp_path: Path, content: bytes) -> Path:
    path = tmp_path / "x.dat"
    path.write_bytes(content)
    return path


def test_one_claim_is_the_reader(install, tmp_path: Path) -> None:  # type: ignore[no-untyped-def]
    install("one", "two")
    assert registry.sniff(write(tmp_path, b"AC")).name == "one"
    assert registry.claims(write(tmp_path, b"AC")) == {"one": "starts with b'A'"}


def test_two_claims_are_an_error_with_both_reasons(install, tmp_path: Path) -> None:  # type: ignore[no-untyped-def]
    install("one", "two")
    with pytest.raises(FormatError) as caught:
        registry.sniff(write(tmp_path, b"ABC"))
    assert """one ("starts with b'A'") and two ("starts with b'AB'") claim x.dat""" in caught.value.what
    assert "set 'reader'" in str(caught.value)
    assert "such as reader: one: no installed reader is taken before another" in str(caught.value)
    assert "gives_way = True" in str(caught.value)


def test_no_claim_names_the_readers(install, tmp_path: Path) -> None:  # type: ignore[no-untyped-def]
    install("one", "two")
    with pytest.raises(FormatError, match="one, two"):
        registry.sniff(write(tmp_path, b"zzz"))


def test_a_reader_that_would_end_the_process_is_a_warning(
    install,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,  # type: ignore[no-untyped-def]
) -> None:
    def end(*_: object) -> object:
        sys.exit(3)

    monkeypatch.setattr(Stumbling, "sniff", end)
    monkeypatch.setitem(CLASSES, "ending", end)
    install("one", "stumbling", "ending")
    with pytest.warns(UserWarning, match="SystemExit: 3") as told:
        assert registry.claims(write(tmp_path, b"A")) == {"one": "starts with b'A'"}
    assert len(told) == 2
    assert registry.failed_readers() == {"ending": "SystemExit: 3"}


def test_a_sniff_that_fails_claims_nothing(install, tmp_path: Path) -> None:  # type: ignore[no-untyped-def]
    install("one", "stumbling")
    with pytest.warns(UserWarning, match="stumbling"):
        assert registry.claims(write(tmp_path, b"A")) == {"one": "starts with b'A'"}


def test_a_reader_that_does_not_import_is_a_warning(install) -> None:  # type: ignore[no-untyped-def]
    install("one", "missing")
    with pytest.warns(UserWarning, match="reader 'missing'"):
        assert list(registry.readers()) == ["one"]
    assert "No module named" in registry.failed_readers()["missing"]
    with pytest.raises(UsageError, match="does not load"):
        registry.reader("missing")


def test_a_reader_whose_parts_do_not_import_is_told_once_and_loads_for_no_file(install, tmp_path: Path) -> None:  # type: ignore[no-untyped-def]
    install("one", "lazy")
    logs = [write(tmp_path, b"A")] * 3
    with pytest.warns(UserWarning, match="does not load") as told:
        found = [registry.claims(log) for log in logs]
    assert found == [{"one": "starts with b'A'"}] * 3
    assert len(told) == 1
    assert "read by another reader" in str(told[0].message)
    assert list(registry.readers()) == ["one"]
    assert "No module named 'parts'" in registry.failed_readers()["lazy"]


def test_a_sniff_that_fails_is_told_once_a_file(install, tmp_path: Path) -> None:  # type: ignore[no-untyped-def]
    install("one", "stumbling")
    log = write(tmp_path, b"A")
    with pytest.warns(UserWarning, match=r"stumbling.*x\.dat") as told:
        explain(log)  # which asks twice
    assert len(told) == 1


@pytest.mark.filterwarnings("ignore:reader 'stumbling' failed")
@pytest.mark.parametrize("start", [b"A", b"Z"])
def test_why_not_of_a_reader_whose_sniff_fails_is_what_it_raised(install, tmp_path: Path, start: bytes) -> None:  # type: ignore[no-untyped-def]
    install("one", "stumbling")
    assert explain(write(tmp_path, start)).others["stumbling"] == "failed: IndexError: too short"


def test_an_unknown_name_is_answered_with_the_installed_ones(install) -> None:  # type: ignore[no-untyped-def]
    install("one", "two")
    with pytest.raises(UsageError) as caught:
        registry.reader("onee")
    assert "one, two" in str(caught.value)
    assert "did you mean 'one'" in str(caught.value)


def test_none_installed_says_which_command_installs(install) -> None:  # type: ignore[no-untyped-def]
    install()
    with pytest.raises(UsageError, match="pip install thermodata-reader-crio"):
        registry.reader("crio")


def test_an_unreadable_file_is_a_usage_error(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"cannot read nowhere\.tdms"):
        registry.head(tmp_path / "nowhere.tdms")


def test_a_reader_that_gives_way_claims_what_no_other_does(install, tmp_path: Path) -> None:  # type: ignore[no-untyped-def]
    install("general", "one")
    known, unknown = write(tmp_path, b"AC"), tmp_path / "y.dat"
    unknown.write_bytes(b"ZZ")
    assert registry.claims(known) == {"one": "starts with b'A'"}
    assert list(registry.all_claims(known)) == ["general", "one"]
    assert registry.sniff(known).name == "one"
    assert registry.sniff(unknown).name == "general"
    assert explain(known).others == {"general": "it would read it as starts with b'', but gives way to 'one'"}
    assert explain(unknown).reader == "general"


def test_two_readers_that_give_way_do_not_do_so_to_each_other(
    install,  # type: ignore[no-untyped-def]
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    install("general", "one")
    monkeypatch.setattr(One, "gives_way", True, raising=False)
    assert list(registry.claims(write(tmp_path, b"AC"))) == ["general", "one"]
