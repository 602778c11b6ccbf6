"""The answer of an ingest: what the store now holds of a campaign, what was lost, and what is worth knowing."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any

from thermodata.archive.cut import cut_archives
from thermodata.calibration.jump.limits import MOVES, with_limits
from thermodata.schema.agreed.left_out import left_out_for_a_fault
from thermodata.store.ingest.known.inventory import Inventory, Row
from thermodata.store.ingest.known.left_alone import TestNote
from thermodata.store.ingest.layers import Layers
from thermodata.store.ingest.told.channels.empty_channels import nothing_brought
from thermodata.store.ingest.told.clocks.how_logs_stand import how_logs_stand
from thermodata.store.ingest.told.declared.bare_conditions import conditions_without_unit
from thermodata.store.ingest.told.declared.spec_lines import with_lines
from thermodata.store.ingest.told.declared.unanswered import unanswered
from thermodata.store.ingest.told.losses import Losses, loss_row, told_once
from thermodata.store.ingest.told.same_content import same_content

NOTHING = "nothing changed: the store holds these files and this campaign file already"


@dataclass(slots=True)
class IngestSummary:
    """What the store now holds of the campaign. losses: what could not be read or made, each with its reason.

    changed: whether anything was written. read: source files that were read; made: streams that were made anew.
    stale: models whose data changed.
    """

    campaign: str
    tests: int = 0
    files: int = 0
    samples: int = 0
    flags: dict[str, int] = field(default_factory=dict)
    losses: list[dict[str, Any]] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    calibrations: list[dict[str, Any]] = field(default_factory=list)
    changed: bool = False
    read: int = 0
    made: int = 0
    stale: list[str] = field(default_factory=list)
    seconds: float = 0.0

    def to_json(self) -> dict[str, Any]:
        """Plain data, one key a field."""
        return asdict(self)

    def again(self) -> IngestSummary:
        """What the same ingest answers once all of it stands in the store."""
        return replace(self, read=0, made=0, notes=[*self.notes, NOTHING])


def summarize(
    layers: Layers,
    inventory: Inventory,
    rows: Mapping[str, Mapping[str, list[Row]]],
    notes: Mapping[str, TestNote],
    path: Path,
    files_of_tests: Mapping[str, Sequence[str]],
) -> IngestSummary:
    """The answer before anything is written. rows: of the layers; notes: of each test; path: of the campaign file;
    files_of_tests: of all tests, those that were left alone too."""
    campaign = layers.files.campaign
    files_of_jumps = {row["source_path"] for row in rows["file"][""]}
    return IngestSummary(
        campaign.id,
        tests=len(campaign.tests),
        files=len(files_of_jumps.union(*(n.files for n in notes.values()))),
        samples=sum(n.samples for n in notes.values()),
        flags=_summed(n.flags for n in notes.values()),
        read=layers.raw.read,
        made=layers.tidy.new_streams,
        calibrations=[
            _calibration_answer(r.row(campaign.id), r.name)
            | {MOVES: getattr(campaign.calibrations[r.name], "move_uncertainty", None)}
            for r in layers.calibrations.values()
        ],
        losses=with_lines([*_losses(layers, notes), *_cut_archives(layers, files_of_tests)], path),
        notes=list(
            dict.fromkeys(
                (
                    *same_content(files_of_tests, layers.files.hashes()),
                    *_how_logs_stand(layers, inventory, rows),
                    *unanswered(campaign),
                    *conditions_without_unit(campaign, path),
                    *_left_out(path, files_of_tests),
                    *layers.raw.said[""].notes,
                    *(text for note in notes.values() for text in note.notes),
                    *layers.tidy.notes,
                )
            )
        ),
    )


def _losses(layers: Layers, notes: Mapping[str, TestNote]) -> Losses:
    return [
        *layers.raw.said[""].losses,
        *told_once(row for note in notes.values() for row in note.losses),  # lines are of this campaign file
        *layers.tidy.losses,
        *layers.raw.empty_sources(list(notes.values())),
        *nothing_brought(layers.files.campaign, notes),
        *(loss_row(problem) for problem in layers.problems),
    ]


def _cut_archives(layers: Layers, files_of_tests: Mapping[str, Sequence[str]]) -> Losses:
    every = dict.fromkeys(path for paths in files_of_tests.values() for path in paths)
    return [loss_row(lost, file=archive) for archive, lost in cut_archives(every, layers.files.full).items()]


def _how_logs_stand(
    layers: Layers, inventory: Inventory, of_layers: Mapping[str, Mapping[str, list[Row]]]
) -> list[str]:
    """of_layers: rows of the layers, of those tests that were not left alone."""
    campaign, left = layers.files.campaign, layers.left.tests

    def of_tests(known: Mapping[str, list[Row]], looked_at: Mapping[str, list[Row]]) -> dict[str, list[Row]]:
        found = {**{name: own for name, own in known.items() if name in left}, **looked_at}
        return {t.id: found.get(t.id, []) for t in campaign.tests}

    return how_logs_stand(
        campaign,
        of_tests(inventory.sources, of_layers["source"]),
        of_tests(inventory.rows["quality_event"], of_layers["quality_event"]),
        of_tests(inventory.rows["file"], of_layers["file"]),
    )


def _left_out(path: Path, files_of_tests: Mapping[str, Sequence[str]]) -> list[str]:
    """A note on files that the draft left out for a fault. path: of the campaign file."""
    text = path.read_text(encoding="utf-8", errors="replace") if path.is_file() else ""
    said = left_out_for_a_fault(text, {file for files in files_of_tests.values() for file in files})
    return [said] if said else []


def _summed(counts: Iterable[Mapping[str, int]]) -> dict[str, int]:
    """Flag -> how many samples, in the order of their names."""
    total: Counter[str] = Counter()
    for some in counts:
        total.update(some)
    return dict(sorted(total.items()))


def _calibration_answer(row: dict[str, Any], name: str) -> dict[str, Any]:
    """A calibration as the answer of an ingest has it."""
    return {**row, "name": name, "checks": with_limits(row["checks"])}
