"""The kit of readers against a good reader of thirty lines, and against readers that are broken on purpose."""

from __future__ import annotations

import os
import random
import struct
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import BinaryIO

import numpy as np
import pytest

from tests.conformance.broken_texts import BROKEN as TEXTS
from thermodata.errors import FormatError
from thermodata.plugin import Block, Head, Loss, Recording, Signal, Source
from thermodata.testing import reader as kit

MAGIC = b"PAIRLOG1"
PAIR = struct.Struct("<qd")


class Good:
    """A third party's reader: a magic word, a count, then pairs of time [ns] and value."""

    name = "pairs"

    def sniff(self, head: Head) -> str | None:
        return "starts with PAIRLOG1" if head.start.startswith(MAGIC) else None

    def describe(self, path: Path, source: Source) -> Recording:
        with path.open("rb") as file:
            count, pairs = self.count(file), 0
            while some := self.pairs(file, 1000):
                pairs += len(some)
        return Recording((Signal("T", "main", "degC"),), "relative", None, pairs == count)

    def blocks(self, path: Path, source: Source) -> Iterator[Block | Loss]:
        last, pairs = None, 0
        with path.open("rb") as file:
            count = self.count(file)
            while some := self.pairs(file, int(source.options.get("block_rows", 100))):
                t, v = zip(*some, strict=True)
                last, pairs = t[-1], pairs + len(some)
                yield Block("main", np.array(t, np.int64), {"T": np.array(v)})
        if pairs < count:
            yield Loss("end of file", last, None, 1 - pairs / count, "cut")

    def count(self, file: BinaryIO) -> int:
        head = file.read(12)
        if not head.startswith(MAGIC) or len(head) < 12:
            raise FormatError("no pair log", where=Path(file.name).name)
        return int.from_bytes(head[8:], "little")

    def pairs(self, file: BinaryIO, size: int) -> list[tuple[int, float]]:
        """At most so many whole pairs of which the times are times."""
        while data := file.read(PAIR.size * size):
            good = [p for p in PAIR.iter_unpack(data[: len(data) // PAIR.size * PAIR.size]) if abs(p[0]) < 2**62]
            if good:
                return good
        return []


class Whole(Good):
    """The same, all of it at once: what is broken on purpose below changes the pairs on their way."""

    def describe(self, path: Path, source: Source) -> Recording:
        pairs, count = self.read(path)
        return Recording((Signal("T", "main", "degC"),), "relative", None, len(pairs) == count)

    def blocks(self, path: Path, source: Source) -> Iterator[Block | Loss]:
        pairs, count = self.read(path)
        size = int(source.options.get("block_rows", 100))
        for i in range(0, len(pairs), size):
            t, v = zip(*pairs[i : i + size], strict=True)
            yield Block("main", np.array(t, np.int64), {"T": np.array(v)})
        if len(pairs) < count:
            yield Loss("end of file", pairs[-1][0] if pairs else None, None, 1 - len(pairs) / count, "cut")

    def read(self, path: Path) -> tuple[list[tuple[int, float]], int]:
        with path.open("rb") as file:
            count = self.count(file)
            return self.pairs(file, 2**20), count


class ClaimsAll(Good):
    def sniff(self, head: Head) -> str | None:
        return "looks like a log"


class ClaimsNothing(Good):
    def sniff(self, head: Head) -> str | None:
        return None


class SniffStumbles(Good):
    def sniff(self, head: Head) -> str | None:
        struct.unpack("<8sI", head.start[:12])
        return super().sniff(head)


class WantsArguments(Good):
    def __init__(self, folder: str) -> None:
        pass


class FloatTime(Good):
    def blocks(self, path: Path, source: Source) -> Iterator[Block | Loss]:
        for b in super().blocks(path, source):
            yield replace(b, t_ns=b.t_ns.astype(float)) if isinstance(b, Block) else b


class NeverDelivers(Good):
    def describe(self, path: Path, source: Source) -> Recording:
        said = super().describe(path, source)
        return replace(said, signals=(*said.signals, Signal("speed", "other", "rpm")))


class StartsElsewhere(Good):
    def describe(self, path: Path, source: Source) -> Recording:
        return replace(super().describe(path, source), clock="absolute", start_ns=10**18)


class CountsFrom1970(Good):
    def describe(self, path: Path, source: Source) -> Recording:
        return replace(super().describe(path, source), start_ns=0)


class Remembers(Good):
    """Keeps its place between calls."""

    def __init__(self) -> None:
        self.reads = 0

    def blocks(self, path: Path, source: Source) -> Iterator[Block | Loss]:
        self.reads += 1
        for b in super().blocks(path, source):
            yield replace(b, values={"T": b.values["T"] + self.reads}) if isinstance(b, Block) else b


class Shares(Good):
    """Two threads share one buffer."""

    def __init__(self) -> None:
        self.users = 0
        self.lock = threading.Lock()
        self.met = threading.Barrier(2)

    def blocks(self, path: Path, source: Source) -> Iterator[Block | Loss]:
        with self.lock:
            self.users += 1
        try:
            self.met.wait(0.3)
        except threading.BrokenBarrierError:
            self.met.reset()
        crowded = self.users > 1
        for b in super().blocks(path, source):
            yield replace(b, values={"T": b.values["T"] * 0}) if isinstance(b, Block) and crowded else b
        with self.lock:
            self.users -= 1


class SeamLosesARow(Good):
    def blocks(self, path: Path, source: Source) -> Iterator[Block | Loss]:
        for i, b in enumerate(super().blocks(path, source)):
            cut = isinstance(b, Block) and i > 0
            yield Block(b.stream, b.t_ns[1:], {"T": b.values["T"][1:]}) if cut else b


class LeavesAnIndex(Good):
    def describe(self, path: Path, source: Source) -> Recording:
        path.with_suffix(".idx").write_bytes(b"index")
        return super().describe(path, source)


class InventsOutOfNothing(Whole):
    def read(self, path: Path) -> tuple[list[tuple[int, float]], int]:
        return ([(0, 0.0)], 1) if path.stat().st_size == 0 else super().read(path)


class CrashesOnGarbage(Whole):
    def read(self, path: Path) -> tuple[list[tuple[int, float]], int]:
        assert path.read_bytes()[:8] == MAGIC
        return super().read(path)


class SilentAboutCuts(Good):
    def blocks(self, path: Path, source: Source) -> Iterator[Block | Loss]:
        return (b for b in super().blocks(path, source) if isinstance(b, Block))


class TakesHalfAValue(Whole):
    """Fills the last, cut pair up with zeros."""

    def read(self, path: Path) -> tuple[list[tuple[int, float]], int]:
        pairs, count = super().read(path)
        rest = path.read_bytes()[12:][len(pairs) * PAIR.size :]
        return ([*pairs, PAIR.unpack(rest.ljust(PAIR.size, b"\0"))] if len(rest) > 9 else pairs), count


class CrashesOnDamage(Whole):
    def read(self, path: Path) -> tuple[list[tuple[int, float]], int]:
        pairs, count = super().read(path)
        return pairs, [0] * 50 and count if count <= len(pairs) + 50 else [][count]


class CriesWolf(Good):
    def blocks(self, path: Path, source: Source) -> Iterator[Block | Loss]:
        yield from super().blocks(path, source)
        yield Loss("end of file", reason="no end mark")


class FillsOneBuffer(Good):
    """Yields views of an array that it fills again."""

    def blocks(self, path: Path, source: Source) -> Iterator[Block | Loss]:
        buffer = np.zeros(1000)
        for b in super().blocks(path, source):
            if isinstance(b, Block):
                buffer[: b.t_ns.size] = b.values["T"]
                b = replace(b, values={"T": buffer[: b.t_ns.size]})
            yield b


class OnePlaceForAll(Whole):
    """Keeps how far it has come on itself."""

    def blocks(self, path: Path, source: Source) -> Iterator[Block | Loss]:
        self.row = 0
        pairs, _ = self.read(path)
        while self.row < len(pairs):
            t, v = pairs[self.row]
            self.row += 1
            yield Block("main", np.array([t], np.int64), {"T": np.array([v])})


class OneScratchFileForAll(Whole):
    """Unpacks into a fixed place, which another process empties.

    Where it is read by another process than this one, the first to come waits once for the second: that they meet
    must not depend on how the machine shares its time.
    """

    home = os.getpid()
    met = False

    def describe(self, path: Path, source: Source) -> Recording:
        return Good().describe(path, source)

    def read(self, path: Path) -> tuple[list[tuple[int, float]], int]:
        scratch, kind = path.with_name("pairs.scratch"), type(self)
        try:
            with scratch.open("xb") as file:
                file.write(path.read_bytes())
        except FileExistsError:
            kind.met = True
        end = time.monotonic() + 180.0
        while os.getpid() != self.home and not kind.met and time.monotonic() < end:
            kind.met = not scratch.exists()
            time.sleep(0.001)
        try:
            return super().read(scratch)
        except OSError:
            return [], 12
        finally:
            scratch.unlink(missing_ok=True)


class KeepsTheFileOpen(Good):
    def describe(self, path: Path, source: Source) -> Recording:
        self.file = path.open("rb")
        return super().describe(path, source)


class ClosesAtTheEndOnly(Good):
    """Where the reading is given up, the file stays open."""

    def __init__(self) -> None:
        self.files: list[object] = []

    def blocks(self, path: Path, source: Source) -> Iterator[Block | Loss]:
        self.files.append(path.open("rb"))
        yield from super().blocks(path, source)
        self.files.clear()


class KeepsAMapping(Whole):
    def read(self, path: Path) -> tuple[list[tuple[int, float]], int]:
        if path.stat().st_size:
            self.values = np.memmap(path, mode="r")
        return super().read(path)


class TalksAlways(Good):
    def describe(self, path: Path, source: Source) -> Recording:
        print("reading", path)
        return super().describe(path, source)


class SetsTheErrorState(Good):
    def describe(self, path: Path, source: Source) -> Recording:
        np.seterr(all="ignore")
        return super().describe(path, source)


class ChangesFolder(Good):
    def describe(self, path: Path, source: Source) -> Recording:
        os.chdir(path.parent)
        return super().describe(path, source)


class TrustsTheCount(Whole):
    """Makes room for as many pairs as the header promises."""

    def read(self, path: Path) -> tuple[list[tuple[int, float]], int]:
        pairs, count = super().read(path)
        np.zeros((count, 2))
        return pairs, count


class TurnsOverOften(Good):
    def blocks(self, path: Path, source: Source) -> Iterator[Block | Loss]:
        for b in super().blocks(path, source):
            yield replace(b, values={"T": b.values["T"] + self.rng.random()}) if isinstance(b, Block) else b

    rng = np.random.default_rng()


class LocatesNoLastRow(Good):
    def locate(self, path: Path, source: Source, stream: str, row: int) -> str:
        return f"pair {[1, 2, 3][row]}"


class PlacesNowhere(Good):
    """Under the name that the method had first."""

    def place(self, path: Path, source: Source, stream: str, row: int) -> str:
        return ""


BROKEN: dict[type, Callable[..., None]] = {
    ClaimsAll: kit.it_claims_no_file_of_another_format,
    ClaimsNothing: kit.it_claims_its_own_file_and_says_why,
    SniffStumbles: kit.a_sniff_survives_any_head,
    FloatTime: kit.its_data_follow_the_rules,
    LocatesNoLastRow: kit.a_row_of_it_can_be_located_where_the_reader_has_a_way,
    PlacesNowhere: kit.a_row_of_it_can_be_located_where_the_reader_has_a_way,
    NeverDelivers: kit.every_declared_signal_arrives,
    StartsElsewhere: kit.an_absolute_recording_starts_when_it_says,
    CountsFrom1970: kit.a_relative_recording_starts_at_no_date,
    Remembers: kit.reading_again_gives_the_same,
    Shares: kit.threads_read_the_same,
    SeamLosesARow: kit.the_size_of_blocks_changes_nothing,
    LeavesAnIndex: kit.the_file_and_its_folder_stay_as_they_were,
    InventsOutOfNothing: kit.an_empty_file_is_refused_or_holds_nothing,
    CrashesOnGarbage: kit.garbage_is_refused_or_holds_nothing,
    SilentAboutCuts: kit.a_cut_file_keeps_its_good_part_and_says_what_is_gone,
    TakesHalfAValue: kit.a_cut_file_keeps_its_good_part_and_says_what_is_gone,
    CrashesOnDamage: kit.damage_never_escapes_as_a_foreign_error,
    CriesWolf: kit.a_whole_file_is_read_without_a_loss,
    FillsOneBuffer: kit.a_block_stays_as_it_was_yielded,
    TurnsOverOften: kit.reading_again_gives_the_same,
    OnePlaceForAll: kit.two_readings_at_once_do_not_mix,
    OneScratchFileForAll: kit.processes_read_the_same,
    KeepsTheFileOpen: kit.the_file_is_closed_after_use,
    ClosesAtTheEndOnly: kit.the_file_is_closed_after_use,
    KeepsAMapping: kit.the_file_is_closed_after_use,
    TalksAlways: kit.it_prints_nothing,
    SetsTheErrorState: kit.it_leaves_the_process_as_it_was,
    ChangesFolder: kit.it_leaves_the_process_as_it_was,
    TrustsTheCount: kit.a_hostile_header_costs_no_memory,
}


@pytest.fixture
def file(tmp_path: Path) -> tuple[Path, Source]:
    path = tmp_path / "a.pairs"
    pairs = [PAIR.pack(i * 1_000_000_000, 20 + i / 3) for i in range(12)]
    path.write_bytes(MAGIC + len(pairs).to_bytes(4, "little") + b"".join(pairs))
    return path, Source()


def test_a_good_reader_passes_everything(file: tuple[Path, Source]) -> None:
    kit.check_reader(Good, [file], block_rows="block_rows")


@pytest.mark.parametrize("method", ["locate", "place"])
def test_a_reader_may_locate_its_rows_by_either_name(method: str, file: tuple[Path, Source]) -> None:
    def words(self: Good, path: Path, source: Source, stream: str, row: int) -> str:
        return f"pair {row + 1}"

    kit.check_reader(type("Locates", (Good,), {method: words}), [file], block_rows="block_rows")


@pytest.mark.parametrize("broken", BROKEN, ids=lambda c: c.__name__)
def test_a_broken_reader_is_caught_by_the_check_for_it(broken: type, file: tuple[Path, Source]) -> None:
    case = kit.Case(broken, (file,), (), "block_rows")
    check = BROKEN[broken]
    with pytest.raises(AssertionError, match="\ntry: "):
        kit.Check(check, case, file if check in kit.FILE_CHECKS else None)()


def test_a_reader_that_wants_arguments_is_caught(file: tuple[Path, Source]) -> None:
    with pytest.raises(AssertionError, match="without arguments"):
        kit.it_is_made_without_arguments_and_has_a_name(kit.Case(WantsArguments, (file,)))


def test_what_the_author_says_is_hostile_is_tried(file: tuple[Path, Source]) -> None:
    def mutate(data: bytes, rng: random.Random) -> bytes:
        return data[:8] + rng.randrange(2**16).to_bytes(4, "little") + data[12:]

    class StumblesOverOddCounts(Whole):
        def read(self, path: Path) -> tuple[list[tuple[int, float]], int]:
            pairs, count = super().read(path)
            return pairs, count if count % 2 == 0 or count > 2**16 else [][count]

    kit.a_hostile_header_costs_no_memory(kit.Case(Good, (file,), mutate=mutate), *file)
    with pytest.raises(AssertionError, match=r"as mutate\(\.\.\., random\.Random\(\d+\)\) makes it"):
        kit.a_hostile_header_costs_no_memory(kit.Case(StumblesOverOddCounts, (file,), mutate=mutate), *file)


def test_small_files_are_cut_at_every_byte() -> None:
    from thermodata.testing.reader.damage import EVERY_CUT_BYTES, cuts

    assert cuts(EVERY_CUT_BYTES) == list(range(1, EVERY_CUT_BYTES))
    many = cuts(1_000_000)
    assert {1, 2, 3, 999_999, 999_998} < set(many)
    assert 100 < len(many) < 200


def test_every_check_has_a_broken_twin() -> None:
    covered = {*BROKEN.values(), *TEXTS.values(), kit.it_is_made_without_arguments_and_has_a_name}
    assert covered == {*kit.CASE_CHECKS, *kit.FILE_CHECKS}


def test_check_reader_lists_all_that_failed(file: tuple[Path, Source]) -> None:
    with pytest.raises(AssertionError) as caught:
        kit.check_reader(ClaimsAll, [file])
    assert "it claims no file of another format: claims a file of TDMS" in str(caught.value)


class Known(Good):
    """Another installed reader, with a format of its own."""

    name = "known"
    heads = {"PAIRS": MAGIC + bytes(8)}


class General(Good):
    """Reads any text; with `gives_way` it claims what no other does."""

    name = "general"

    def sniff(self, head: Head) -> str | None:
        return "text of any kind" if head.start.startswith(MAGIC) else None


class GivesWay(General):
    gives_way = True


@pytest.fixture
def installed(monkeypatch: pytest.MonkeyPatch) -> Callable[..., None]:
    from thermodata.testing import impostors
    from thermodata.testing.reader import claiming

    def put(*readers: Good) -> None:
        for module in (impostors, claiming):
            monkeypatch.setattr(module, "readers", lambda: {each.name: each for each in readers})

    return put


def test_heads_of_other_readers_are_impostors_and_those_of_its_own_formats_are_none(
    installed: Callable[..., None],
) -> None:
    from thermodata.testing.impostors import IMPOSTORS, impostors

    installed(Known(), General())
    assert impostors(General()) == IMPOSTORS | Known.heads
    assert impostors(Known()) == IMPOSTORS
    with pytest.raises(AssertionError, match=r"claims a file of PAIRS.*\n.*claims=\('PAIRS',\).*gives_way = True"):
        kit.it_claims_no_file_of_another_format(kit.Case(General, ()))
    kit.it_claims_no_file_of_another_format(kit.Case(General, (), claims=("PAIRS",)))


def test_one_that_gives_way_may_claim_what_another_claims_and_nothing_else(installed: Callable[..., None]) -> None:
    installed(Known(), GivesWay())
    kit.it_claims_no_file_of_another_format(kit.Case(GivesWay, ()))

    class ClaimsPictures(GivesWay):
        def sniff(self, head: Head) -> str | None:
            return "any file at all"

    with pytest.raises(AssertionError, match="claims a file of TDMS"):
        kit.it_claims_no_file_of_another_format(kit.Case(ClaimsPictures, ()))
