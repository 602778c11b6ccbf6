"""`trace` and `check` as text: what a quality auditor asks for, in the order in which it is asked."""

from __future__ import annotations

from typing import Any

from thermodata.report.text.straight_line import offset_of, sum_of
from thermodata.report.text.table import cell, fields, table

Found = dict[str, Any]


def trace_text(found: Found) -> str:
    """A test, a channel, one sample or a model, and the way back to the files."""
    if "model" in found:
        head = [(k, found[k]) for k in ("model", "name", "parent", "stale")]
        if found["not_fitted_to"]:
            head.append(
                ("not fitted to", ", ".join(found["not_fitted_to"]) + " (thermodata fit takes in what came after)")
            )
        head += [(k, found[k]) for k in ("data_version", "created_at")]
        return "\n\n".join(
            [
                fields(head),
                table(
                    found["files"],
                    [
                        ("campaign", "campaign"),
                        ("test", "test"),
                        ("source", "source"),
                        ("source_path", "file"),
                        ("sha256", "SHA-256"),
                    ],
                    widest=64,
                ),
            ]
        )
    parts = [
        fields(
            [
                (name, found.get(key))
                for key, name in (
                    ("campaign", "campaign"),
                    ("test", "test"),
                    ("campaign_file", "campaign file"),
                    ("data_version", "data version"),
                    ("ingested_at", "ingested (UTC)"),
                )
            ]
        )
    ]
    if "channel" in found:
        parts.append(_channel(found))
    else:
        parts.append(fields([("channels", ", ".join(found["channels"]))]))
    if found.get("sample"):
        parts.append(_sample(found))
    parts.append(_files(found["files"]))
    for operand in found.get("operands", []):
        parts.append("from " + _channel(operand) + "\n\n" + _files(operand["files"]))
    return "\n\n".join(p for p in parts if p)


def _channel(found: Found) -> str:
    clock = found.get("clock") or {}
    lines: list[tuple[str, Any]] = [
        (
            "channel",
            f"{found['channel']} [{found['unit']}] {found['quantity']}"
            + (f" at {found['at']}" if found.get("at") else ""),
        ),
        ("sign", found["sign"]),
        (
            "signal",
            f"{found['signal']} [{found['raw_unit'] or 'no unit'}] of {found['source']}/{found['stream']}"
            if found["signal"]
            else None,
        ),
        ("derived", found.get("derive")),
        ("schedule", found.get("schedule")),
        ("scaling in the file", found["scaling"]),
        ("clock", f"{clock.get('clock')}, {clock.get('offset_ns', 0) / 1e9:+.6f} s" if clock else None),
    ]
    for step in found["calibrations"]:
        about = f"{step['calibration']} ({step['kind']})"
        gain = f", gain {step['gain']} {step['gain_unit'] or ''}".rstrip() if step.get("gain") is not None else ""
        gain += f", offset {offset}" if (offset := offset_of(step)) else ""
        file = "".join(f", from {f['source_path']} {f['sha256'][:12]}" for f in step["files"])
        lines.append(("calibration", about + gain + file))
    return fields([(k, v) for k, v in lines if v is not None])


def _plateaus(found: Found) -> list[tuple[str, Any]]:
    """The rows of the jump tests that made gain and offset, of the channel or of those that it is derived from."""
    lines: list[tuple[str, Any]] = []
    for step in found["calibrations"]:
        for i, at in enumerate(step["rows"] or ()):
            rows = f"rows {at['first_row'] + 1} to {at['last_row'] + 1} of {at['source_path']}, stream {at['stream']}"
            mean = f"{at['mean']:.6g} {at['unit']} (mean of {at['used']}) at {at['commanded_um']:g} um"
            lines.append(("" if i else step["calibration"], f"{rows}: {mean}"))
    return lines + [line for operand in found.get("operands", ()) for line in _plateaus(operand)]


def _sample(found: Found) -> str:
    sample, unit = found["sample"], found["unit"]
    lines: list[tuple[str, Any]] = [
        ("value", f"{sample['value']!r} {unit}" if isinstance(sample["value"], float) else sample["value"]),
        ("time", f"{sample['t_s']!r} s" + (f" = {sample['t']}" if sample["t"] else "")),
        ("flags", ", ".join(sample["flags"]) or "none"),
        ("tidy", f"{sample['tidy']['path']}, row {sample['tidy']['row'] + 1}"),
    ]
    for raw in [sample["raw"]] if sample["raw"] else sample.get("operands", []):
        if raw.get("schedule"):
            lines.append((raw["channel"], "from its schedule, not logged"))
            continue
        where = (
            f"{raw['source_path']}, stream {raw['stream']}, row {raw['row'] + 1} of {raw['rows']}: "
            if raw.get("rows")
            else f"{raw['source_path']}: "
        )
        name = raw.get("channel", "raw")
        lines += [(name, where + f"{raw['raw_value']!r}"), ("  SHA-256", raw["sha256"])]
        if raw.get("again"):
            lines.append(("  read again", _read_again(raw["again"], raw["raw_value"])))
    total = sum_of(found)
    lines += ([("sum", total)] if total else []) + _plateaus(found)
    return "sample (rows count from 1)\n" + fields(lines)


def _read_again(again: Found, stored: Any) -> str:
    if again.get("problem") or again["file"] != "unchanged":
        return str(again.get("problem") or again["file"])
    same = again["value"] == stored or (again["value"] != again["value"] and stored != stored)
    where = f" at {again['place']}" if again.get("place") else ""
    return f"the file gives {again['value']!r}{where}: " + ("the same" if same else "NOT the same")


def _files(files: list[Found]) -> str:
    if not files:
        return ""
    rows = []
    for file in files:
        rows.append({**file, "state": file.get("now", "current")})
        for i, old in enumerate(reversed(file.get("earlier", [])), 1):
            rows.append({**old, "state": f"earlier {i}, until {old.get('superseded_at') or '-'}"})
    shown = table(
        [{**row, "added_at": str(row["added_at"])[:19]} for row in rows],
        [
            ("source_path", "file"),
            ("stream", "stream"),
            ("bytes", "bytes"),
            ("rows", "rows"),
            ("reader", "reader"),
            ("added_at", "stored (UTC)"),
            ("state", "version"),
        ],
        widest=64,
    )
    # a table that is too wide for the screen goes on below with its first columns: a hash would stand in all of them
    hashes = {(row["source_path"], row["sha256"], row["state"]): row for row in rows}
    shown += "\n\n" + table(
        list(hashes.values()),
        [("source_path", "file"), *([("state", "version")] if len(rows) > len(files) else []), ("sha256", "SHA-256")],
        widest=64,
    )
    said = [f"  ! {f['source_path']}: {cell(x)}" for f in files for x in [*f["losses"], *f["notes"]]]
    return "\n".join([shown, *said])


def check_text(found: Found) -> str:
    """What a check of the store found."""
    head = fields(
        [
            ("files", found["files"]),
            ("MB", round(found["bytes"] / 1e6, 1)),
            ("damaged", len(found["damaged"]) or "none"),
        ]
    )
    if not found["damaged"]:
        return head
    return (
        head
        + "\n\n"
        + table(
            found["damaged"],
            [
                ("path", "file"),
                ("layer", "layer"),
                ("campaign", "campaign"),
                ("test", "test"),
                ("problem", "problem"),
                ("source_path", "made from"),
            ],
        )
    )
