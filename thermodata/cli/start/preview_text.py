"""`preview` for a person: the file, its streams and signals, what would be flagged, and the first rows."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from thermodata.draft.look import Meant, Watch, campaign_of, flagged, meaning_of
from thermodata.errors import UsageError
from thermodata.plugin import Reader, Signal, Source
from thermodata.report.text.table import fields, table


def previewed(file: Path, name: str | None, timezone: str | None, rows: int, campaign: Path | None) -> dict[str, Any]:
    """A file as JSON has it: what thermodata.reader.finding.preview finds, the campaign's word on it, and flags.

    campaign: a campaign file, or None: the one found beside the file, where it names the file. A declared time zone and
    reader stand over the campaign's.
    """
    from thermodata.reader.finding.preview import Until, begin, preview
    from thermodata.reader.finding.registry import reader, sniff

    meant, source, chosen = _declared_of(file, campaign)
    chosen = reader(name) if name else chosen
    if timezone is not None:
        source = Source(source.name, timezone, source.encoding, source.table, source.topics, source.options)
    begun = begin(chosen or sniff(file), file, source)
    chosen, recording = begun.reader, begun.recording
    watch = Watch(len({s.stream for s in recording.signals}) or 1)
    found = preview(file, source, until=Until(rows), watch=watch, begun=begun)
    absolute = found["clock"] == "absolute"
    by_stream: dict[str, list[Signal]] = {}
    for each in recording.signals:
        by_stream.setdefault(each.stream, []).append(each)
    for stream in found["streams"]:
        own = by_stream[stream["stream"]]
        told, events = flagged(watch, stream["stream"], own, meant, absolute)
        for signal in stream["signals"]:
            signal.update(
                told.get(
                    signal["name"],
                    {"quantity": None, "channel": None, "guess": None, "flags": {}, "values": None, "sparkline": None},
                )
            )
        stream["events"] = events
    if watch.watched < watch.seen:
        found["notes"].append(
            f"{watch.watched} of {watch.seen} signals were looked at, the first of each stream: quantities, ranges, "
            "flags and courses of the others are left open"
        )
    found["file"] = str(file)
    found["campaign"] = (
        None if meant is None else {"file": str(meant.campaign), "source": meant.source, "test": meant.test}
    )
    found["signals"] = [
        {"stream": s["stream"], "signal": x["name"], **{k: x[k] for k in ("unit", "dtype", "scaling")}}
        for s in found["streams"]
        for x in s["signals"]
    ]
    found["first_rows"] = {s["stream"]: s["first_rows"] for s in found["streams"] if s["rows"]}
    return found


def _declared_of(file: Path, campaign: Path | None) -> tuple[Meant | None, Source, Reader | None]:
    from thermodata.reader.finding.registry import reader
    from thermodata.schema.files.load import load_campaign
    from thermodata.store.raw.streams import declared

    at = campaign or campaign_of(file)
    if at is None:
        return None, Source(name="preview"), None
    try:
        loaded = load_campaign(at)
    except UsageError:
        if campaign is not None:
            raise
        return None, Source(name="preview"), None  # a draft in the making does not hinder a look at its files
    meant = meaning_of(loaded, at, file)
    if meant is None:
        if campaign is not None:
            raise UsageError(
                "the campaign file does not name this file",
                where=str(campaign),
                got=str(file),
                hint="correct 'files' of a source or a test, or leave out --campaign",
            )
        return None, Source(name="preview"), None
    spec = loaded.sources[meant.source].of_test(meant.test or "")
    return meant, declared(meant.source, spec), reader(spec.reader)


def preview_text(found: dict[str, Any]) -> str:
    """A preview for a person."""
    from thermodata.schema.words.sentences import counted

    campaign = found["campaign"]
    said = (
        None
        if campaign is None
        else f"{campaign['file']}: source {campaign['source']}"
        + (f", test {campaign['test']}" if campaign["test"] else "")
    )
    local = any("no time zone" in n for n in found["notes"])
    zone = found["timezone"] or ("UTC: no zone is declared" if local else None)
    whole = {True: "yes", False: "no: it is cut or damaged", None: "the format does not say"}[found["complete"]]
    parts = [
        fields(
            [
                ("file", found["file"]),
                ("size", _size(found["size_bytes"])),
                ("reader", f"{found['reader']} ({found['reason'] or 'as declared'})"),
                ("campaign", said),
                ("clock", found["clock"]),
                ("timezone", zone),
                ("start", found["start"]),
                ("complete", whole),
                (
                    "read",
                    f"all {counted(found['rows_read'], 'row')}"
                    if found["whole"]
                    else f"the first {found['rows_read']} rows only: the file is large; what follows holds for them",
                ),
            ]
        )
    ]
    if found["notes"] or found["losses"]:
        parts.append(
            "\n".join([*(f"note: {n}" for n in found["notes"]), *(f"loss: {_loss(x)}" for x in found["losses"][:10])])
        )
    for stream in found["streams"]:
        parts += _stream(stream)
    return "\n\n".join(parts)


def _stream(s: dict[str, Any]) -> list[str]:
    from thermodata.schema.words.sentences import counted

    rate = (
        "no rows"
        if not s["rows"]
        else counted(s["rows"], "row")
        + (f", every {s['step_s']:.6g} s, {_span(s['duration_s'])}, {s['start']} to {s['end']}" if s["step_s"] else "")
    )
    told = (("gaps", "gaps"), ("backward", "steps back"), ("repeated", "times repeated"))
    faults = [f"{s[k]} {what}" for k, what in told if s[k]]
    if s["gaps"]:
        faults[0] += f" (longest step {_span(s['largest_step_s'])})"
    head = f"stream {s['stream']}: {rate}" + (f"; {', '.join(faults)}" if faults else "")
    rows = [
        {
            "signal": x["name"],
            "unit": x["unit"],
            "dtype": x["dtype"],
            "scaling": x["scaling"],
            "is": (x["channel"] and f"{x['channel']} ({x['quantity']})") or (x["quantity"] or "?"),
            "low": x["values"] and x["values"]["low"],
            "high": x["values"] and x["values"]["high"],
            "flagged": ", ".join(f"{k} {n}" for k, n in x["flags"].items()) or None,
            "course": x["sparkline"],
        }
        for x in s["signals"][:200]
    ]
    columns = [
        ("signal", "signal"),
        ("unit", "unit"),
        ("dtype", "dtype"),
        ("scaling", "scaling"),
        ("is", "is"),
        ("low", "low"),
        ("high", "high"),
        ("flagged", "would be flagged"),
        ("course", "course"),
    ]
    shown = [c for c in columns if c[0] not in ("scaling", "flagged") or any(r[c[0]] for r in rows)]
    parts = [head + "\n" + table(rows, shown, widest=44)]
    if s["events"]:
        parts.append(
            "\n".join(
                f"  {e['flag']}{' ' + e['signal'] if e['signal'] else ''}: {e['from']} to {e['to']}, "
                f"{counted(e['n'], 'row')}{'; ' + e['detail'] if e['detail'] else ''}"
                for e in s["events"][:10]
            )
        )
    if s["first_rows"]:
        names = list(s["first_rows"][0])
        more = f" (and {counted(len(names) - 9, 'more column')})" if len(names) > 9 else ""
        parts.append(f"first rows{more}\n" + table(s["first_rows"], [(n, n) for n in names[:9]], widest=26))
    return parts


def _loss(x: dict[str, Any]) -> str:
    share = "" if x["fraction"] is None else f", {100 * x['fraction']:.2g} %"
    span = "" if x["from"] is None else f", from {x['from']}" + (f" to {x['to']}" if x["to"] else "")
    return f"{x['reason']} ({x['where']}{share}{span})"


def _size(n: int) -> str:
    return f"{n / 1e9:.2f} GB" if n >= 1e9 else f"{n / 1e6:.1f} MB" if n >= 1e6 else f"{n / 1e3:.1f} kB"


def _span(seconds: float | None) -> str:
    if seconds is None:
        return "-"
    return (
        f"{seconds / 3600:.2f} h"
        if seconds >= 7200
        else f"{seconds / 60:.1f} min"
        if seconds >= 180
        else f"{seconds:.6g} s"
    )
