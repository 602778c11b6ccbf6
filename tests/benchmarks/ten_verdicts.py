"""Ten answers of `thermodata diagnose`, printed whole in docs/verdicts.md.

    uv run python tests/benchmarks/ten_verdicts.py [--kept FOLDER] [--only 3 7]    renews the page
    uv run python tests/benchmarks/ten_verdicts.py --check [--kept FOLDER]         names what differs from it

Each campaign is made in a folder of its own, and `ingest`, `fit` and `diagnose` run in this process at 100 columns.
What was printed stands in the page as it came, but for lines that are wider: these are folded as at a terminal.
`confirm` then asks the locked tests for the right name, which the table tells beside the answer. FOLDER keeps what was
printed, so that a run goes on where it was ended. All ten take a quarter of an hour.
"""

from __future__ import annotations

import argparse
import io
import json
import os
import re
import shutil
import sys
import tempfile
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import asdict, dataclass
from importlib import import_module
from pathlib import Path
from typing import Any

from measure import table
from outside import marks

from thermodata.report.text.table import sentences_folded
from thermodata.report.verdict.verdict import probability
from thermodata.report.words.numbers import number

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "verdicts.md"
REAL = ROOT / "tests" / "real" / "fl_thermal"
RECORDING = ROOT / ".." / "shared" / "data" / "fl_thermal" / "data.xlsx"
WIDTH = 100
DONE = (0, 3)  # exit codes of a command that answered
ID = re.compile(r"\b[0-9a-f]{8}(?:[0-9a-f]{4})?\b")  # of a model, which hangs on the bytes of its logs


@dataclass(frozen=True)
class Truth:
    """hidden: {cause, um, right: [candidate ids], twins: [ids]} each, as a make writes it; None where nobody knows.
    fault: what is wrong with the logs, or None."""

    hidden: list[dict[str, Any]] | None
    fault: str | None = None

    @property
    def right(self) -> str | None:
        """The right name, where one is hidden that is logged."""
        rights = [h["right"][0] for h in self.hidden or [] if h["right"]]
        return rights[0] if len(rights) == 1 else None


@dataclass(frozen=True)
class Case:
    """write: makes the campaign in a folder and answers what is true of it. making: how a reader makes the same, from
    the root of the repository. folder: where that puts it. model: its file there."""

    write: Callable[[Path], Truth]
    making: str
    folder: str = "out"
    model: str = "model.yaml"

    @property
    def commands(self) -> str:
        asks = f"thermodata ingest {self.folder}/campaign.yaml && thermodata fit {self.folder}/{self.model}"
        return f"{self.making}\n{asks}\nthermodata diagnose"


@dataclass(frozen=True)
class Answer:
    """printed: by `diagnose`, to stderr and stdout. said: the same as JSON, as much as the table asks for. confirmed:
    locked errors without and with the right name [um], None where there is none."""

    truth: Truth
    printed: str
    said: dict[str, Any]
    confirmed: list[float | None] | None


def of_make(name: str, case: int) -> Case:
    def write(folder: Path) -> Truth:
        truth = import_module(f"makes.{name}").write(folder, case)
        return Truth(truth["hidden"], truth["fault"])

    making = f"PYTHONPATH=tests/benchmarks python -m makes {name} out {case}"
    return Case(write, making, f"out/CASE_{case:02d}")


def of_simulated_lathe(stratum: str, seed: int) -> Case:
    def write(folder: Path) -> Truth:
        from thermodata.virtual.lathe.logs import simulate_lathe

        return of_lathe(simulate_lathe(folder, stratum, seed))

    return Case(write, f"thermodata simulate out --machine lathe --stratum {stratum} --seed {seed}")


def of_lathe(truth: Mapping[str, Any]) -> Truth:
    """What the simulator of lathes says of one."""
    worst = {cause: max(um.values()) for cause, um in truth["rms_um"].items()}
    hidden = [{"cause": c, "um": round(worst[c], 1), "right": truth["right"][c], "twins": []} for c in truth["hidden"]]
    faults = [f"the probe {f['channel']} slips by {f['size']:.1f} um in {f['test']}" for f in truth["faults"]]
    return Truth(hidden, "; ".join(faults) or None)


def one_short_test() -> Case:
    """The demo's machine as somebody has it who measured an hour of one test."""

    def write(folder: Path) -> Truth:
        import yaml

        from thermodata.virtual import simulate

        simulate(folder, "coolant", 3)
        path = folder / "campaign.yaml"
        campaign = yaml.safe_load(path.read_text("utf-8"))
        campaign["tests"] = [{**campaign["tests"][0], "window": ["0 h", "1 h"]}]
        path.write_text(yaml.safe_dump(campaign, sort_keys=False), "utf-8")
        return Truth([{"cause": "coolant", "um": None, "right": [], "twins": []}])

    cut = "# of its tests leave the first alone in out/campaign.yaml, with window: [0 h, 1 h]"
    return Case(write, f"thermodata simulate out --hide coolant --seed 3\n{cut}")


def recorded() -> Case:
    def write(folder: Path) -> Truth:
        shutil.copytree(REAL, folder, dirs_exist_ok=True)
        shutil.copy(RECORDING, folder)
        return Truth(None)

    return Case(write, "cp -r tests/real/fl_thermal out && cp data.xlsx out", model="ch3.yaml")


CASES: Mapping[int, Case] = {
    1: of_make("horizontal_centre", 133),
    2: of_make("horizontal_centre", 141),
    3: of_make("heavy_lathe", 133),
    4: of_make("heavy_lathe", 128),
    5: of_make("heavy_lathe", 139),
    6: of_make("heavy_lathe", 141),
    7: one_short_test(),
    8: of_simulated_lathe("steps", 1),
    9: of_make("heavy_lathe", 47),
    10: recorded(),
}


def asked(case: Case, folder: Path) -> Answer:
    truth, store = case.write(folder), str(folder / "store")
    run("ingest", folder / "campaign.yaml", store=store)
    run("fit", folder / case.model, store=store)
    return answered(truth, store)


def answered(truth: Truth, store: str) -> Answer:
    """What is said of the model that was fitted last."""
    printed = run("diagnose", store=store).rstrip()
    said = json.loads(run("diagnose", "--json", store=store, aloud=False))
    confirmed = None
    if truth.right:
        looked = json.loads(run("confirm", said["model"], truth.right, "--json", store=store, aloud=False))
        confirmed = [looked["locked_rmse_um_before"], looked["locked_rmse_um_after"]]
    return Answer(truth, printed, {key: said[key] for key in ("verdict", "candidates", "artefacts")}, confirmed)


def run(*words: object, store: str, aloud: bool = True) -> str:
    """What a command prints, in this process. aloud: what it says to stderr, too."""
    from thermodata.cli import main

    out = io.StringIO()
    with redirect_stdout(out), redirect_stderr(out if aloud else io.StringIO()):
        code = main([*map(str, words), "--store", store])
    if code not in DONE:
        raise RuntimeError(f"{words}: exit code {code}\n{out.getvalue()}")
    return out.getvalue()


def answer(which: int, kept: Path | None) -> Answer:
    """From the folder that keeps them, else made now."""
    file = None if kept is None else kept / f"{which}.json"
    if file is not None and file.exists():
        said = json.loads(file.read_text("utf-8"))
        return Answer(**{**said, "truth": Truth(**said["truth"])})
    with tempfile.TemporaryDirectory() as folder:
        found = asked(CASES[which], Path(folder))
    if file is not None:
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(json.dumps(asdict(found)), "utf-8")
    return found


def folded(printed: str) -> str:
    """Lines of at most WIDTH, broken as at a terminal."""
    return sentences_folded(printed, WIDTH)


def with_block(page: str, name: str, text: str) -> str:
    """The page with what stands between the marks of this name made anew."""
    begin, end = f"<!-- {name} -->\n", f"<!-- end of {name} -->"
    before, mark, rest = page.partition(begin)
    _, found, after = rest.partition(end)
    if not mark or not found:
        raise ValueError(f"{PAGE.name} has no marks of {name!r}")
    return f"{before}{begin}{text}\n{end}{after}"


def blocks(answers: Mapping[int, Answer]) -> dict[str, str]:
    """Name of a block of the page -> its text; the table only where all ten were asked."""
    made = {
        f"answer {n}": f"```sh\n{CASES[n].commands}\n```\n\n```text\n{folded(a.printed)}\n```"
        for n, a in answers.items()
    }
    if len(answers) == len(CASES):
        made["table"] = "\n" + table(HEAD, [row(n, a) for n, a in sorted(answers.items())]) + "\n"
    return made


def without_ids(page: str) -> str:
    """An id may make a line longer or shorter, so where it is folded does not count either."""
    return " ".join(ID.sub("", page).split())


HEAD = ("answer", "verdict", "hidden", "said", "that is", "locked, before and with it [um]", "with the right name [um]")


def row(which: int, a: Answer) -> list[str]:
    claims = [c for c in a.said["candidates"] if c["claimed"]]
    locked = [claims[0]["locked_rmse_um_before"], claims[0]["locked_rmse_um_after"]] if claims else None
    return [
        str(which),
        a.said["verdict"].replace("_", " "),
        hidden(a.truth),
        named(a.said),
        outcome(a.truth, claims),
        from_to(locked),
        from_to(a.confirmed),
    ]


def hidden(truth: Truth) -> str:
    if truth.hidden is None:
        return "nobody knows"
    causes = [h["cause"] + ("" if h["um"] is None else f" ({h['um']} um)") for h in truth.hidden] or ["nothing"]
    return "; ".join([" and ".join(causes), *filter(None, [truth.fault])])


def named(said: Mapping[str, Any]) -> str:
    """What an answer names: its claims, else its refinements, else the likeliest; and the faults of the logs."""
    candidates: list[dict[str, Any]] = said["candidates"]
    parts = [f"`{c['id']}` {probability(c['probability'])}" for c in candidates if c["claimed"]]
    if not parts and said["verdict"] == "refine":
        parts = ["refined by " + " and ".join(f"`{c['id']}`" for c in candidates if c["refinement"])]
    likeliest = max((c for c in candidates if c["probability"]), key=lambda c: c["probability"], default=None)
    if not parts and likeliest:
        parts = [f"none; likeliest `{likeliest['id']}` {probability(likeliest['probability'])}"]
    parts += sorted({f"`{a['kind']}` in {a['test'] or 'all tests'}" for a in said["artefacts"]})
    return ", ".join(parts) or "none"


def outcome(truth: Truth, claims: Sequence[Mapping[str, Any]]) -> str:
    if truth.hidden is None:
        return "not known"
    if not claims:
        return "silent" if any(h["right"] for h in truth.hidden) else "right"
    return ", ".join(c.mark for c in marks(truth.hidden, claims)[0])


def from_to(um: Iterable[float | None] | None) -> str:
    return "–" if um is None else " -> ".join(map(number, um))


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--check", action="store_true")
    arguments.add_argument("--kept", type=Path)
    arguments.add_argument("--only", type=int, nargs="*", choices=CASES, default=[*CASES], metavar="N")
    given = arguments.parse_args()
    os.environ["COLUMNS"] = str(WIDTH)
    answers = {n: answer(n, given.kept) for n in given.only}
    page = PAGE.read_text("utf-8")
    if given.check:
        differ = [n for n, new in blocks(answers).items() if without_ids(with_block(page, n, new)) != without_ids(page)]
        print("\n".join(f"differs: {name}" for name in differ) or "as printed")
        return 1 if differ else 0
    for name, text in blocks(answers).items():
        page = with_block(page, name, text)
    PAGE.write_text(page, "utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
