"""Fuzzing of readers, outside CI: what a format's module hands to the harness.

    .venv/bin/python tests/fuzz/run.py --format tdms [--count 10000] [--seed 0] [--jobs 1]
    .venv/bin/python tests/fuzz/run.py --format tdms --seed 0 --replay 4711      # one file again, with its traceback

A format is a module `tests/fuzz/formats/<format>.py` (or any `--format path/to/module.py`) that starts with

    from tests.fuzz.harness import Mutation, Seed, Source       # run.py puts the root of the checkout on the path

and has
    READER = "crio"                       # an installed reader's name, or a reader's class
    def seeds() -> list[Seed]             # a few kB each, made in code: every dialect and feature of the format
    def mutate(seed: Seed, rng: random.Random) -> Mutation       # one structural mutation that knows the format

`mutations.py` has those that need no knowledge: cuts, flipped bytes, junk, lines dropped, doubled, swapped.
Nothing but `rng` may decide a mutation: file number i of a run is made again from (--seed, i) alone.

A file fails when
  - anything but a ThermodataError is raised by describe or blocks through thermodata.reader.contract.guard, or anything
    at all by sniff (PluginError counts as a failure: it is the plugin's bug);
  - it takes more than the limit (--limit, 5 s of processor time; 12 times that of wall time kills a wait);
  - it needs more memory than the limit (--memory, MiB of address space above what the imports take), or the worker
    dies (the file it was reading is counted, the run goes on behind it);
  - something is left beside the file;
  - it is *silently wrong*: nothing was reported (no Loss, `complete` not False, no note, no flag that the seed's own
    reading does not have) and a delivered (t, value) of a signal is none of the seed's rows of the signal of that
    name, or (unless well_formed) a row of the seed is missing. NaN and absent text count as missing, not as wrong;
    numbers compare by value whatever their dtype; rows of a signal whose name the seed does not have are not judged.
The oracle does not apply where values_touched, nor to a file that is refused with a FormatError or UsageError.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from thermodata.plugin import Source

__all__ = ["Mutation", "Seed", "Source"]


@dataclass(frozen=True)
class Seed:
    """A good file. name: its file name, with the suffix ("german.csv"); data: all its bytes; source: what a
    campaign file would declare. It must be read without a Loss; notes and flags of its own are allowed."""

    name: str
    data: bytes
    source: Source = field(default_factory=Source)


@dataclass(frozen=True)
class Mutation:
    """A file made from a seed. kind: a few words, a row of the table ("segment dropped").
    well_formed: it is itself an honest file of the format, so that what is missing need not be reported.
    values_touched: bytes of values or times were changed, so that values cannot be judged."""

    data: bytes
    kind: str
    well_formed: bool
    values_touched: bool
