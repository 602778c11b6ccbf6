"""What every reader makes of the fuzz seeds, their first mutations and real files, before and after a change.

    python tests/fuzz/dump.py corpus DIR [--mutations 40] [--real FOLDER]   # writes the files; made once
    python tests/fuzz/dump.py read DIR OUT.jsonl                            # reads them with the code that is installed
    python tests/fuzz/dump.py compare BEFORE.jsonl AFTER.jsonl [--show 3]   # what differs, by format and by kind

A line a file: its recording, each stream's rows by the hash of times, values, dtypes and flags (blocks are joined, so
that where they are cut does not matter), its losses, where three rows of each stream are said to stand, or the error.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import random
import shutil
import sys
import tempfile
import warnings
from collections import Counter, defaultdict
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
if str(ROOT) not in sys.path:
    sys.path.insert(0, str(ROOT))

FORMATS = sorted(p.stem for p in (Path(__file__).parent / "formats").glob("*.py") if p.stem not in ("foo", "mcap_edit"))
Entry = dict[str, Any]


def write_corpus(folder: Path, mutations: int, real: Path | None) -> None:
    """The files, and an index that names the reader and the declared source of each."""
    from tests.fuzz.worker import load_format

    shutil.rmtree(folder, ignore_errors=True)
    index: list[Entry] = []

    def put(form: str, reader: str, kind: str, number: int, name: str, data: bytes, source: Any) -> None:
        place = folder / form / f"{number:05d}"
        place.mkdir(parents=True)
        (place / name).write_bytes(data)
        declared = {k: getattr(source, k) for k in ("timezone", "encoding", "table", "topics", "options")}
        declared = {k: dict(v) if hasattr(v, "items") else v for k, v in declared.items() if v}
        path = str((place / name).relative_to(folder))
        index.append({"path": path, "format": form, "reader": reader, "kind": kind, "source": declared})

    for form in FORMATS:
        module = load_format(form)
        seeds = module.seeds()
        for k, seed in enumerate(seeds):
            put(form, module.READER, "seed", k, seed.name, seed.data, seed.source)
        for number in range(mutations * len(seeds)):
            seed = seeds[number % len(seeds)]
            mutation = module.mutate(seed, random.Random(f"0:{number}"))
            put(form, module.READER, mutation.kind, len(seeds) + number, seed.name, mutation.data, seed.source)
    if real is not None:
        from thermodata.plugin import Source
        from thermodata.reader import claims

        for number, path in enumerate(sorted(p for p in real.rglob("*") if p.is_file())):
            for reader in claims(path):
                put(f"real_{reader}", reader, "real", number, path.name, path.read_bytes(), Source())
    (folder / "index.json").write_text(json.dumps(index), encoding="utf-8")
    print(f"{len(index)} files of {len({e['format'] for e in index})} formats")


def _hash(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()[:16]


def _array(parts: list[Any]) -> str:
    joined = np.concatenate(parts)
    if joined.dtype.kind in "OU":
        return f"str {_hash(repr(joined.tolist()).encode())}"
    # one NaN and one zero: their other bits say nothing
    if joined.dtype.kind == "f":
        joined = np.where(np.isnan(joined), np.array(np.nan, joined.dtype), joined + 0.0)
    return f"{joined.dtype} {_hash(np.ascontiguousarray(joined).tobytes())}"


def read_one(path: Path, entry: Entry) -> Entry:
    """All that one file gives."""
    from thermodata.errors import ThermodataError
    from thermodata.plugin import Block, Head, Source
    from thermodata.reader import reader
    from thermodata.reader.contract.guard import described, guarded

    one, source = reader(entry["reader"]), Source(**entry["source"])
    result: Entry = {}
    try:
        with path.open("rb") as file:
            result["claim"] = one.sniff(Head(path.name, path.stat().st_size, file.read(65536)))
        recording = described(one, path, source)
        result["signals"] = [
            (s.name, s.stream, s.unit, s.dtype, repr(s.scaling), dict(s.properties)) for s in recording.signals
        ]
        result["clock"] = (recording.clock, recording.start_ns, recording.complete)
        result["notes"] = list(recording.notes)
        streams: dict[str, Any] = defaultdict(lambda: {"t": [], "v": defaultdict(list), "f": defaultdict(list), "n": 0})
        losses: list[Any] = []
        for item in guarded(one, path, source, recording):
            if not isinstance(item, Block):
                losses.append((item.where, item.from_ns, item.to_ns, item.fraction, item.reason))
                continue
            into = streams[item.stream]
            into["t"].append(item.t_ns)
            into["n"] += item.t_ns.size
            for name, values in item.values.items():
                into["v"][name].append(values)
                flags = (item.flags or {}).get(name)
                into["f"][name].append(np.zeros(item.t_ns.size, np.uint16) if flags is None else flags)
        result["losses"] = losses
        result["rows"] = {stream: s["n"] for stream, s in streams.items()}
        result["times"] = {stream: _array(s["t"]) for stream, s in streams.items()}
        result["values"] = {
            f"{stream}:{name}": _array(p) for stream, s in streams.items() for name, p in s["v"].items()
        }
        result["flags"] = {f"{stream}:{name}": _array(p) for stream, s in streams.items() for name, p in s["f"].items()}
        locate = getattr(one, "locate", None) or one.place
        result["trace"] = {
            f"{stream}:{row}": locate(path, source, stream, row)
            for stream, s in sorted(streams.items())[:4]
            for row in sorted({0, s["n"] // 2, s["n"] - 1})
        }
    except ThermodataError as error:
        result["error"] = f"{type(error).__name__}: {error}".replace(str(path), path.name)
    except Exception as error:
        result["crash"] = f"{type(error).__name__}: {error}".replace(str(path), path.name)
    return result


def read_all(folder: Path, out: Path) -> None:
    warnings.simplefilter("ignore")
    index = json.loads((folder / "index.json").read_text(encoding="utf-8"))
    with tempfile.TemporaryDirectory() as place, out.open("w", encoding="utf-8") as file:
        for entry in index:
            path = Path(place) / Path(entry["path"]).name
            shutil.copyfile(folder / entry["path"], path)
            file.write(json.dumps({**entry, "result": read_one(path, entry)}) + "\n")
            path.unlink()
    print(f"{len(index)} files read")


def compare(before: Path, after: Path, show: int) -> int:
    """Prints a table of what differs; 1 where anything does."""
    old, new = (
        {e["path"]: e for e in map(json.loads, p.read_text(encoding="utf-8").splitlines())} for p in (before, after)
    )
    total: Counter[str] = Counter()
    kinds: dict[str, Counter[str]] = defaultdict(Counter)
    shown: Counter[tuple[str, str]] = Counter()
    for path, entry in old.items():
        a, b = entry["result"], json.loads(json.dumps(new.get(path, {"result": {}})["result"]))
        total[entry["format"]] += 1
        keys = sorted(k for k in {*a, *b} if a.get(k) != b.get(k))
        for key in keys:
            kinds[entry["format"]][key] += 1
            if shown[entry["format"], key] < show:
                shown[entry["format"], key] += 1
                print(f"{path} ({entry['kind']}) {key}\n  before: {_brief(a.get(key))}\n  after:  {_brief(b.get(key))}")
        kinds[entry["format"]]["equal"] += not keys
    print("\n| format | files | equal | differing |\n|---|---|---|---|")
    for form, count in sorted(total.items()):
        said = ", ".join(f"{k} {n}" for k, n in kinds[form].most_common() if k != "equal")
        print(f"| {form} | {count} | {kinds[form]['equal']} | {said} |")
    return int(any(set(c) - {"equal"} for c in kinds.values()))


def _brief(value: Any) -> str:
    text = json.dumps(value, ensure_ascii=False)
    return text if len(text) < 700 else text[:700] + " ..."


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=("corpus", "read", "compare"))
    parser.add_argument("first", type=Path)
    parser.add_argument("second", type=Path, nargs="?")
    parser.add_argument("--mutations", type=int, default=40)
    parser.add_argument("--real", type=Path)
    parser.add_argument("--show", type=int, default=2)
    given = parser.parse_args()
    if given.what == "corpus":
        write_corpus(given.first, given.mutations, given.real)
    elif given.second is None:
        parser.error("a second path is missing")
    elif given.what == "read":
        read_all(given.first, given.second)
    else:
        return compare(given.first, given.second, given.show)
    return 0


if __name__ == "__main__":
    sys.exit(main())
