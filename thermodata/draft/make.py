"""A folder of raw logs -> campaign.yaml and a first model.yaml beside them; what is there is kept."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from thermodata.draft.campaign.parts import Draft
from thermodata.draft.campaign.plan import plan
from thermodata.draft.campaign.said_before import with_what_was_said
from thermodata.draft.files.letters_of_files import encoding_declared_before
from thermodata.draft.folder.look import Progress
from thermodata.draft.folder.scan import Scan, scan
from thermodata.draft.times.zones_before import zones_before
from thermodata.draft.writing.baseline import left_out_of, model_text_of, responses_of
from thermodata.draft.writing.by_hand import by_hand
from thermodata.draft.writing.deleted import without_deleted
from thermodata.draft.writing.kept import with_answers
from thermodata.draft.writing.missing import asked_of_a_displacement, asked_of_drivers, missing_for_a_model
from thermodata.draft.writing.own_id import NOTHING_HELD, id_of
from thermodata.draft.writing.seal import is_as_sealed
from thermodata.draft.writing.write import questions_in, text_of
from thermodata.errors import ThermodataError, UsageError, unknown_name
from thermodata.schema.files.campaign import Campaign
from thermodata.schema.files.load import load_campaign, load_model, parse_campaign
from thermodata.store.base.files import write_error, write_text


@dataclass(frozen=True, slots=True)
class Drafted:
    """campaign, model: the files that were written; model is None where no sensor allows one, or where one was there.
    no_model: what is missing for one, in words. kept: what was there before -> its new name. files: raw ones that a
    reader reads; seen: with those that none does. questions: lines that hold one. id_taken: the id that it would have,
    and the file of the other campaign that the store holds by it. left_out: channels that drive nothing in the model,
    which says why."""

    campaign: Path
    model: Path | None
    kept: tuple[tuple[Path, Path], ...]
    draft: Draft
    files: int
    seen: int
    questions: int
    no_model: str | None = None
    id_taken: tuple[str, str] | None = None
    left_out: tuple[str, ...] = ()


def draft_files(
    folder: Path, *, force: bool = False, progress: Progress | None = None, held: Mapping[str, str] = NOTHING_HELD
) -> Drafted:
    """force: a campaign file that is there becomes campaign.1.yaml, and the encoding and the zones that it declares
    and what somebody wrote of signals, calibrations and tests are kept; without it that is a UsageError, as is a folder
    without files. One of files that no reader claims is drafted too, with what would help. progress: is told (done, of,
    path). held: id -> campaign file, of the campaigns of the store that this one is for: it gets another id."""
    out = folder / "campaign.yaml"
    if out.exists() and not force:
        raise UsageError(
            "the campaign file exists, and is never overwritten",
            where=str(out),
            hint=f"thermodata ingest {out} reads it as it stands and gives the lines of tests whose logs are new, "
            f"thermodata first-model {out} drafts a model of it; "
            "--force keeps it as campaign.1.yaml and drafts it anew, with what is written there by hand",
        )
    found = scan(folder, progress, encoding_declared_before(out) if out.exists() else None)
    if not found.logs and not found.ignored:
        raise UsageError(
            "a folder without files",
            where=str(folder),
            expected="raw logs",
            got="nothing",
            hint="thermodata plugins lists what the installed readers read",
        )
    name, plainly = id_of(folder, held), id_of(folder)
    draft, text = _with_answers(out, plan(name, folder, found, zones_before(out)), found)
    drafted = parse_campaign(text, str(out))
    model = model_text_of(drafted)
    kept = [keep(out)]
    write_new(out, text)
    load_campaign(out)  # a draft that doesn't load is a defect: it raises here
    first = folder / "model.yaml"
    made = model is not None and (force or not first.exists())
    if made and model is not None:
        if is_as_sealed(_to_compare(first) or ""):
            first.unlink()  # as drafted, and nobody's work
        kept.append(keep(first))
        write_new(first, model)
        load_model(first)
    return Drafted(
        out,
        first if made else None,
        tuple(k for k in kept if k is not None),
        draft,
        len({f.path for f in found.logs}),
        len({str(f.path) for f in found.logs}.union(draft.unused)),
        questions_in(text),
        missing_for_a_model(text, load_campaign(out)) if model is None else None,
        None if name == plainly else (plainly, held[plainly]),
        tuple(left_out_of(drafted, responses_of(drafted)[0])) if made else (),
    )


def _with_answers(out: Path, draft: Draft, found: Scan) -> tuple[Draft, str]:
    """A draft and its text, with what somebody wrote into the file before: once that is known of its signals, more of
    them may be seen, as the jump test of a probe."""
    text = text_of(draft)
    before = _to_compare(out)
    hand = by_hand(before, text) if before is not None else None
    if hand is None:
        return draft, text
    if said := list(hand.signals()):
        draft = plan(draft.campaign, out.parent, with_what_was_said(found, said, draft), zones_before(out))
    try:
        filled = without_deleted(with_answers(text_of(draft), hand), str(before))
        parse_campaign(filled, str(out))
    except ThermodataError as error:
        why = f"what the campaign file before has by hand is not kept: {error.what}"
        draft = replace(draft, notes=(*draft.notes, why))
        return draft, text_of(draft)
    return draft, filled


def write_answered(path: Path, text: str) -> tuple[Path, bool]:
    """A campaign file with other text; the one before is kept as campaign.N.yaml. A first model beside it that nobody
    has changed since it was drafted follows the answers. (where the one before is, whether the model followed).
    SpecError where the text does not load; StoreError where a file can't be written."""
    after = parse_campaign(text, path.name)
    before = load_campaign(path)
    model = path.with_name("model.yaml")
    there = _to_compare(model)
    untouched, chosen = _as_drafted(there, before)
    anew = model_text_of(after, chosen if chosen in responses_of(after) else None)
    # at no moment is there no campaign file, or half of one
    kept = _copied(path)
    write_text(path, text)
    if anew is not None and anew != there and (untouched or there is None):
        write_text(model, anew)
        return kept, True
    return kept, False


@dataclass(frozen=True, slots=True)
class FirstModel:
    """response: the displacement that it is of. responses: all that it may be of. kept: where a model file that
    somebody had changed is now; None where there was none. replaced: the other displacement that a draft was of
    which nobody had changed, and which is gone; None where there was none. left_out: channels that drive nothing in
    it, which says why."""

    model: Path
    response: str
    responses: tuple[str, ...]
    kept: Path | None
    replaced: str | None
    left_out: tuple[str, ...] = ()


def first_model(path: Path, response: str | None = None) -> FirstModel:
    """model.yaml beside a campaign file, drafted from it as it stands. response: the channel of a displacement; the
    first of `responses_of` where None. UsageError for what is no displacement, or where
    no sensor drives a plain effect."""
    campaign = load_campaign(path)
    known = responses_of(campaign)
    if response is not None and response not in known:
        raise unknown_name("displacement", response, known, where=path.name)
    if not known:
        raise UsageError(
            "a model needs a displacement",
            where=str(path),
            expected="a channel with quantity: displacement, axis: and at: tcp",
            got="none in channels",
            hint=f"answer the '# ?' of {asked}" if (asked := asked_of_a_displacement(_read(path))) else None,
        )
    text = model_text_of(campaign, response or known[0])
    if text is None:
        raise UsageError(
            "no sensor drives a plain effect here",
            where=str(path),
            expected="a temperature or a speed with its place",
            hint=(
                f"answer the '# ?' of {asked}" if (asked := asked_of_drivers(_read(path))) else "say where sensors are"
            )
            + ", or write a model file by hand",
        )
    model = path.with_name("model.yaml")
    there = _to_compare(model)
    # one that is as drafted can be had again; what somebody wrote can't
    untouched, before = _as_drafted(there, campaign)
    drafted = there is None or untouched or is_as_sealed(there)
    kept = None if drafted else _copied(model)
    write_text(model, text)
    load_model(model)
    made = response or known[0]
    replaced = None if before == made else before
    return FirstModel(model, made, tuple(known), kept, replaced, tuple(left_out_of(campaign, made)))


def modelled(path: Path) -> str | None:
    """The displacement that the model.yaml beside a campaign file was drafted for; None where somebody changed it, or
    where there is none."""
    return _as_drafted(_to_compare(path.with_name("model.yaml")), load_campaign(path))[1]


def _read(path: Path) -> str:
    return _to_compare(path) or ""


def _to_compare(path: Path) -> str | None:
    """The text of a file that somebody may have written in another encoding; never to be written back. None where it is
    not there."""
    return path.read_text(encoding="utf-8", errors="replace") if path.is_file() else None


def _as_drafted(text: str | None, campaign: Campaign) -> tuple[bool, str | None]:
    """(whether a model file is one that is drafted from this campaign file or an earlier state of it, for which
    displacement)."""
    drafts = ((r, model_text_of(campaign, r)) for r in responses_of(campaign) if text is not None)
    found = [r for r, draft in drafts if draft is not None and _is_a_draft_of_the_same(str(text), draft)]
    return bool(found), found[0] if found else None


def _is_a_draft_of_the_same(text: str, draft: str) -> bool:
    """Whether a model file is this draft, or one that nobody changed, made of an earlier state, of its response."""

    def response(of: str) -> str:
        return next((line.partition("#")[0].strip() for line in of.splitlines() if line.startswith("response:")), "")

    return text == draft or (is_as_sealed(text) and response(text) == response(draft))


def keep(path: Path) -> tuple[Path, Path] | None:
    """Moves a file that is there out of the way: campaign.yaml to campaign.1.yaml. (before, after), or None."""
    if not path.exists():
        return None
    kept = next(p for p in _names_of_kept(path) if not p.exists())
    path.rename(kept)
    return path, kept


def _copied(path: Path) -> Path:
    """The copy of a file as campaign.1.yaml, or the next number that nobody takes meanwhile."""
    before = path.read_bytes()
    for name in _names_of_kept(path):
        try:
            with name.open("xb") as file:
                file.write(before)
        except FileExistsError:
            continue
        except OSError as error:
            raise write_error(name, error) from error
        return name
    raise UsageError("too many earlier files are kept beside it", where=str(path), hint="move some away")


def _names_of_kept(path: Path) -> Iterator[Path]:
    return (path.with_name(f"{path.stem}.{n}{path.suffix}") for n in range(1, 10_000))


def write_new(out: Path, text: str) -> None:
    """Writes a file that must not be there yet, not even since a moment ago."""
    try:
        with out.open("x", encoding="utf-8") as file:
            file.write(text)
    except FileExistsError:
        raise UsageError(
            "the campaign file exists, and is never overwritten",
            where=str(out),
            hint="run thermodata init again with --force, which keeps it as campaign.1.yaml",
        ) from None
    except OSError as error:
        raise UsageError(
            "cannot write the draft",
            where=str(out),
            got=error.strerror or str(error),
            hint="give yourself the right to write there, or copy the logs to a folder of your own",
        ) from None
