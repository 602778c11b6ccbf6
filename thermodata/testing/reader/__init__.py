"""The conformance kit of readers: the rules that the house applies, as tests for a plugin's author.

    from pathlib import Path
    import pytest
    from my_plugin import Reader
    from thermodata.plugin import Source
    from thermodata.testing.reader import reader_checks

    FILES = [(Path(__file__).with_name("sample.log"), Source(timezone="Europe/Prague"))]

    @pytest.mark.parametrize("check", reader_checks(Reader, FILES), ids=str)
    def test_reader(check):
        check()

Every check is a function with a sentence for a name; one that fails raises AssertionError with what is wrong, in
which file and where, and with what to do ("try: ..."). One that does not bear on a file (no row of a compressed
file can be spoiled) is skipped with the reason, which `pytest -rs` prints.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from unittest import SkipTest

from thermodata.plugin import Reader, Source
from thermodata.reader.contract.rules import sentence
from thermodata.testing.reader.altered import (
    a_cell_without_a_value_gives_no_number,
    a_line_that_is_no_row_is_told,
    a_row_that_is_written_twice_arrives_twice,
    a_word_among_numbers_gives_no_number,
    rows_arrive_in_the_order_of_the_file,
)
from thermodata.testing.reader.case import Case, Data, Mutate, load
from thermodata.testing.reader.claiming import (
    a_sniff_survives_any_head,
    it_claims_its_own_file_and_says_why,
    it_claims_no_file_of_another_format,
    it_is_made_without_arguments_and_has_a_name,
)
from thermodata.testing.reader.contents import (
    a_block_stays_as_it_was_yielded,
    a_relative_recording_starts_at_no_date,
    a_row_of_it_can_be_located_where_the_reader_has_a_way,
    a_whole_file_is_read_without_a_loss,
    an_absolute_recording_starts_when_it_says,
    every_declared_signal_arrives,
    its_data_follow_the_rules,
)
from thermodata.testing.reader.damage import (
    a_cut_file_keeps_its_good_part_and_says_what_is_gone,
    a_file_cut_within_a_record_is_told,
    a_hostile_header_costs_no_memory,
    an_empty_file_is_refused_or_holds_nothing,
    damage_never_escapes_as_a_foreign_error,
    garbage_is_refused_or_holds_nothing,
)
from thermodata.testing.reader.manners import (
    it_leaves_the_process_as_it_was,
    it_prints_nothing,
    the_file_and_its_folder_stay_as_they_were,
    the_file_is_closed_after_use,
)
from thermodata.testing.reader.memory import memory_does_not_grow_with_the_file
from thermodata.testing.reader.repeating import (
    processes_read_the_same,
    reading_again_gives_the_same,
    the_size_of_blocks_changes_nothing,
    threads_read_the_same,
    two_readings_at_once_do_not_mix,
)

Files = Sequence[tuple[Path, Source]]

CASE_CHECKS: tuple[Callable[[Case], None], ...] = (
    it_is_made_without_arguments_and_has_a_name,
    it_claims_no_file_of_another_format,
)
FILE_CHECKS: tuple[Callable[[Case, Path, Source], None], ...] = (
    it_claims_its_own_file_and_says_why,
    a_sniff_survives_any_head,
    its_data_follow_the_rules,
    every_declared_signal_arrives,
    a_whole_file_is_read_without_a_loss,
    an_absolute_recording_starts_when_it_says,
    a_relative_recording_starts_at_no_date,
    a_row_of_it_can_be_located_where_the_reader_has_a_way,
    a_block_stays_as_it_was_yielded,
    reading_again_gives_the_same,
    two_readings_at_once_do_not_mix,
    threads_read_the_same,
    processes_read_the_same,
    the_size_of_blocks_changes_nothing,
    the_file_and_its_folder_stay_as_they_were,
    the_file_is_closed_after_use,
    it_prints_nothing,
    it_leaves_the_process_as_it_was,
    an_empty_file_is_refused_or_holds_nothing,
    garbage_is_refused_or_holds_nothing,
    a_cut_file_keeps_its_good_part_and_says_what_is_gone,
    damage_never_escapes_as_a_foreign_error,
    a_hostile_header_costs_no_memory,
    a_file_cut_within_a_record_is_told,
    a_row_that_is_written_twice_arrives_twice,
    rows_arrive_in_the_order_of_the_file,
    a_cell_without_a_value_gives_no_number,
    a_word_among_numbers_gives_no_number,
    a_line_that_is_no_row_is_told,
    memory_does_not_grow_with_the_file,
)


@dataclass(frozen=True)
class Check:
    """One check, ready to call."""

    run: Callable[..., None]
    case: Case
    file: tuple[Path, Source] | None = None

    def __call__(self) -> None:
        self.run(self.case, *(self.file or ()))

    def __str__(self) -> str:
        return sentence(self.run) + (f" [{self.file[0].name}]" if self.file else "")


def reader_checks(
    make: Callable[[], Reader],
    good_files: Files,
    *,
    claims: Sequence[str] = (),
    block_rows: str | None = None,
    mutate: Mutate | None = None,
    unordered: bool = False,
) -> list[Check]:
    """All checks of a reader, for pytest.mark.parametrize(..., ids=str).

    make: the reader's class. good_files: complete files of its format, a few kB each (one up to 2 kB is cut at every
    byte), with what a campaign file would declare. claims: names of the kit's impostors that are
    its own: in `impostors.IMPOSTORS`, and in the `heads` of other readers.
    block_rows: the key of `source.options` by which its blocks can be made smaller, where it has one.
    mutate(data, rng): makes a hostile file of a good one (a huge count, a length past the end); called 60 times.
    unordered: the rows of these files are sorted by design, of a reader that does not say so of all that it reads.
    """
    case = Case(make, tuple((Path(p), s) for p, s in good_files), tuple(claims), block_rows, mutate, unordered)
    return [Check(run, case) for run in CASE_CHECKS] + [
        Check(run, case, file) for file in case.files for run in FILE_CHECKS
    ]


def check_reader(
    make: Callable[[], Reader],
    good_files: Files,
    *,
    claims: Sequence[str] = (),
    block_rows: str | None = None,
    mutate: Mutate | None = None,
    unordered: bool = False,
) -> None:
    """Runs all checks that bear on the files; AssertionError with every one that failed. The arguments are those of
    reader_checks."""
    failed = []
    for check in reader_checks(
        make, good_files, claims=claims, block_rows=block_rows, mutate=mutate, unordered=unordered
    ):
        try:
            check()
        except SkipTest:
            continue
        except Exception as error:
            failed.append(f"{check}: {error if isinstance(error, AssertionError) else repr(error)}")
    assert not failed, "\n".join(failed)


__all__ = [
    "CASE_CHECKS",
    "FILE_CHECKS",
    "Case",
    "Check",
    "Data",
    "check_reader",
    "load",
    "reader_checks",
    *(check.__name__ for check in (*CASE_CHECKS, *FILE_CHECKS)),
]
