"""From raw logs to the verdict, through the command line, on machines whose truth is known."""

from __future__ import annotations

import io
import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import asdict, dataclass
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow.parquet as pq
import pytest

from thermodata.cli import main
from thermodata.virtual import Truth, simulate

from ..keys import DIAGNOSIS, FIT, SCORE

PARAMETER = {"value", "unit", "low", "high"}
CHECK = {"name", "value", "threshold", "passed", "advice"}
SPOT = {"campaign", "test", "from_s", "to_s", "rmse_um", "state", "after_warm_start"}
CANDIDATE = {
    "as_modelled",
    "rank",
    "id",
    "effect",
    "family",
    "drivers",
    "gain_by",
    "phases",
    "claimed",
    "refinement",
    "probability",
    "probability_with_unread",
    "p_value",
    "rmse_um_before",
    "rmse_um_after",
    "acting_um_before",
    "acting_um_after",
    "fit_before",
    "fit_after",
    "locked_rmse_um_before",
    "locked_rmse_um_after",
    "locked_rmse_um_fitted",
    "locked_shape_um_before",
    "locked_shape_um_after",
    "locked_tests_asked",
    "stands_for",
    "beside",
    "parameters",
    "equivalent",
    "unread",
    "also_on",
    "why",
    "evidence",
    "rungs",
    "left_out",
    "courses",
}
ARTEFACT = {"kind", "campaign", "test", "at_s", "size_um", "why"}
UNKNOWN = {"time_constants_h", "hours_of_day", "states", "heat"}


@dataclass(frozen=True)
class Lab:
    """A campaign as the lab has it; the truth is for the asserts. base: the baseline's id."""

    folder: Path
    truth: Truth
    ingested: dict[str, Any]
    fitted: dict[str, Any]
    ask: Callable[..., Any]

    @property
    def base(self) -> str:
        return str(self.fitted["model"])


def asker(store: Path) -> Callable[..., Any]:
    """Runs a command on the store in this process; it must succeed; answers its JSON."""

    def ask(*words: object) -> Any:
        out, err = io.StringIO(), io.StringIO()
        with redirect_stdout(out), redirect_stderr(err):
            code = main(["--store", str(store), *map(str, words), "--json"])
        assert code == 0, err.getvalue()
        return json.loads(out.getvalue())

    return ask


def make_lab(folder: Path, hide: str, seed: int) -> Lab:
    """Eight tests of 6 h, ingested and fitted. The ingest runs as a user's process does, with nothing imported."""
    truth = simulate(folder, hide=hide, seed=seed, tests=8, hours=6.0, rate_hz=0.1)
    store = folder / "thermodata.store"
    program = Path(sys.executable).with_name("thermodata")
    done = subprocess.run(
        [program, "ingest", truth.campaign_file, "--json"],
        cwd=folder,
        capture_output=True,
        env={**os.environ, "THERMODATA_STORE": str(store)},
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    ask = asker(store)
    return Lab(folder, truth, json.loads(done.stdout), ask("fit", truth.model_file), ask)


@pytest.fixture(scope="module")
def lab(once: Callable[[str, Callable[[Path], object]], Path], tmp_path_factory: pytest.TempPathFactory) -> Lab:
    """A machine with a screw that the baseline model doesn't know. Made once a run; each process has its own copy."""

    def make(folder: Path) -> None:
        made = make_lab(folder, "feed_screw", 1)
        (folder / "lab.json").write_text(json.dumps([asdict(made.truth), made.ingested, made.fitted]))

    folder = tmp_path_factory.mktemp("screw") / "lab"
    shutil.copytree(once("screw", make), folder)
    truth, ingested, fitted = json.loads((folder / "lab.json").read_text())
    return Lab(folder, Truth(**truth), ingested, fitted, asker(folder / "thermodata.store"))


@pytest.fixture(scope="module")
def diagnosis(lab: Lab) -> dict[str, Any]:
    found: dict[str, Any] = lab.ask("diagnose", lab.base)
    return found


@pytest.fixture(scope="module")
def better(lab: Lab, diagnosis: dict[str, Any]) -> dict[str, Any]:
    """The next version of the model, with the first candidate of the diagnosis."""
    added: dict[str, Any] = lab.ask("add", lab.base, diagnosis["candidates"][0]["rank"])
    return added


def error(scores: list[dict[str, Any]]) -> float:
    """Root of the mean squared RMSE over tests [um]."""
    return float(np.sqrt(np.mean([s["rmse_um"] ** 2 for s in scores if s["phase"] == "all"])))


def test_the_logs_are_in_the_store_without_losses(lab: Lab) -> None:
    summary = lab.ingested
    assert {
        "campaign",
        "tests",
        "files",
        "samples",
        "flags",
        "losses",
        "notes",
        "calibrations",
        "changed",
        "seconds",
    } <= set(summary)
    assert (summary["campaign"], summary["tests"], summary["losses"]) == (lab.truth.campaign, 8, [])
    # a log of three sources for each test, and a jump test for each axis
    assert summary["files"] == 3 * 8 + 3
    rows = lab.ask("sql", "select test, count(*) as n from sample where channel = 'dZ' group by test")
    assert {r["test"]: r["n"] for r in rows} == {t["test"]: 2160 for t in lab.ask("tests")}, "6 h at 0.1 Hz"


def test_tests_and_channels_are_described(lab: Lab) -> None:
    roles = [t["role"] for t in lab.ask("tests")]
    assert (roles.count("locked"), roles.count("verification") > 0) == (1, True)
    channels = {c["channel"]: c for c in lab.ask("channels")}
    assert (channels["dZ"]["unit"], channels["dZ"]["raw_unit"], channels["dZ"]["axis"]) == ("um", "V", "Z")
    assert (channels["T_nut_Z"]["at"], channels["T_nut_Z"]["quantity"]) == ("axis.z.nut", "temperature")
    assert channels["spindle_speed"]["source"] == "nc"


def test_jump_tests_give_gain_and_sign_of_the_probes(lab: Lab) -> None:
    true = json.loads((lab.folder / "truth" / "truth.json").read_text())["probes_um_per_v"]
    found = {c["axis"]: c for c in lab.ask("calibrations")}
    assert set(found) == set(true) == {"X", "Y", "Z"}
    assert len({np.sign(gain) for gain in true.values()}) == 2, "this machine has probes that look either way"
    for axis, gain in true.items():
        # the stated uncertainty is one standard deviation; 3 of it is 1 %, so this can fail
        assert found[axis]["gain"] == pytest.approx(gain, rel=3 * found[axis]["uncertainty_pct"] / 100)
        assert found[axis]["uncertainty_pct"] < 1.0
        assert found[axis]["sign"] == ("+" if gain > 0 else "-")
        assert all(c["passed"] for c in found[axis]["checks"])


@pytest.mark.parametrize("channel", ["dX", "dY", "dZ"])
def test_displacements_are_what_the_machine_did_sign_and_clock_included(lab: Lab, channel: str) -> None:
    for test in ("sp9000", "spectrum"):
        true = pq.read_table(lab.folder / "truth" / f"{test}.parquet", columns=["t_s", channel])
        rows = lab.ask(
            "sql",
            f"select t_s, value from displacement where test = '{test}' and channel = '{channel}' "
            "and flag = 0 order by t_s",
        )
        measured = np.array([[r["t_s"], r["value"]] for r in rows])
        expected = np.interp(measured[:, 0], true["t_s"].to_numpy(), true[channel].to_numpy())
        slope = np.polyfit(expected, measured[:, 1], 1)[0]
        assert slope == pytest.approx(1.0, abs=0.05)
        assert np.std(measured[:, 1] - expected) < 0.5, "noise of the probe [um]"


def test_clocks_of_the_sources_agree_after_ingest(lab: Lab) -> None:
    """The control's clock is half a minute off, as the campaign file says: speed and power must not show it."""
    rows = lab.ask("sql", "select test, source, start_ns from source where stream is not null and test is not null")
    by_test: dict[str, list[int]] = {}
    for row in rows:
        by_test.setdefault(row["test"], []).append(row["start_ns"])
    assert len(by_test) == 8
    assert max(max(v) - min(v) for v in by_test.values()) <= 1_500_000_000


def test_fit_and_compare_answer_every_key(lab: Lab) -> None:
    compared = lab.ask("compare", lab.base)
    for answer in (lab.fitted, compared):
        assert set(answer) >= FIT
        assert all(set(s) == SCORE for s in answer["scores"])
        assert all(set(p) == PARAMETER for p in answer["parameters"].values())
        assert all(set(c) == CHECK for c in answer["checks"])
        assert (answer["parent"], answer["before"], answer["response"]) == (None, None, "dZ")
        assert {s["role"] for s in answer["scores"]} == {"calibration", "verification"}, "locked tests stay closed"
    assert error(compared["scores"]) == pytest.approx(error(lab.fitted["scores"]))
    assert lab.fitted["parameters"]["spindle_bearing.gain"]["unit"] == "um/K"


def test_diagnosis_names_the_hidden_effect(lab: Lab, diagnosis: dict[str, Any]) -> None:
    assert set(diagnosis) == DIAGNOSIS
    assert diagnosis["weak_spots"]
    assert all(set(s) == SPOT for s in diagnosis["weak_spots"])
    assert all(set(c) == CANDIDATE for c in diagnosis["candidates"])
    assert all(set(a) == ARTEFACT for a in diagnosis["artefacts"])
    assert diagnosis["unknown"] is None or set(diagnosis["unknown"]) == UNKNOWN
    assert 0.0 <= diagnosis["explainable"] <= 1.0
    assert diagnosis["rmse_um"] > 3 * diagnosis["noise_um"]
    assert "feed_z" in {s["test"] for s in diagnosis["weak_spots"]}, "where the screw heats alone"

    assert diagnosis["verdict"] == "effect"
    first, *others = diagnosis["candidates"]
    assert (first["claimed"], first["rank"]) == (True, 1)
    assert first["effect"] == lab.truth.hidden
    assert first["family"] == lab.truth.family
    # the feed that heats the nut and the nut's temperature tell the same
    true = f"{lab.truth.hidden}:{','.join(lab.truth.drivers.values())}"
    assert true in (first["id"], *first["equivalent"])
    assert first["p_value"] < 0.05
    assert first["rmse_um_after"] < 0.5 * first["rmse_um_before"]
    assert first["locked_rmse_um_after"] < 0.5 * first["locked_rmse_um_before"]
    assert all(c["locked_rmse_um_before"] is c["locked_rmse_um_after"] is None for c in others if not c["claimed"])


def test_the_added_effect_lowers_the_error_and_is_the_true_one(lab: Lab, better: dict[str, Any]) -> None:
    assert set(better) == FIT | {"stale"}
    assert better["parent"] == lab.base
    assert [s["model"] for s in better["before"]] == [lab.base] * len(better["before"])
    assert error(better["scores"]) < 0.5 * error(better["before"])

    # its contribution, not only the sum, is what the screw did
    path = next((lab.folder / "thermodata.store" / "model" / better["model"]).glob("*__feed_z__dZ.parquet"))
    table = pq.read_table(path)
    columns = [c for c in table.column_names if c.startswith("c__feed_screw")]  # with its second lag, if it has one
    true = pq.read_table(lab.folder / "truth" / "feed_z.parquet", columns=["t_s", "feed_screw_Z"])
    expected = np.interp(table["t_s"].to_numpy(), true["t_s"].to_numpy(), true["feed_screw_Z"].to_numpy())
    found = np.sum([table[c].to_numpy() for c in columns], axis=0)
    assert np.corrcoef(found, expected)[0, 1] > 0.97
    assert np.polyfit(expected, found, 1)[0] == pytest.approx(1.0, abs=0.25)


def test_history_and_sql_tell_the_same_story(lab: Lab, better: dict[str, Any]) -> None:
    chain = lab.ask("history", better["model"])
    assert [v["model"] for v in chain] == [lab.base, better["model"]]
    assert chain[0]["added"] is None
    assert chain[1]["added"].split(", ")[0] == "feed_screw"
    assert chain[1]["rmse_um"] < chain[0]["rmse_um"]
    rows = lab.ask(
        "sql",
        f"select sqrt(avg(residual ** 2)) as rmse from residual where model = '{lab.base}' "
        "and test = 'feed_z' and valid",
    )
    score = next(s for s in lab.fitted["scores"] if s["test"] == "feed_z" and s["phase"] == "all")
    assert rows[0]["rmse"] == pytest.approx(score["rmse_um"], rel=1e-6)
    looks = lab.ask("sql", "select test, reason from locked_look")
    assert [(row["test"], "feed_screw" in row["reason"]) for row in looks] == [("day2", True)], "each look is counted"


class Loads(HTMLParser):
    """What a browser would fetch for a page."""

    def __init__(self) -> None:
        super().__init__()
        self.found: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        # <a href> is a link that a person follows, not a load
        names = ("src", "srcset", "data", "poster") if tag == "a" else ("src", "srcset", "data", "poster", "href")
        self.found += [v for name, v in attrs if name in names and v and not v.startswith(("#", "data:"))]


def test_the_report_is_one_page_that_loads_nothing(lab: Lab, better: dict[str, Any], tmp_path: Path) -> None:
    answer = lab.ask("report", better["model"], "-o", tmp_path / "report.html")
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert answer["bytes"] == len(page.encode())
    loads = Loads()
    loads.feed(page)
    assert loads.found == []
    style = page[page.index("<style") : page.index("</style>")]
    assert "@import" not in style
    assert "url(http" not in style
    assert "feed_screw" in page
    assert "T_nut_Z" in page


def test_nothing_is_claimed_on_a_machine_that_lacks_nothing(tmp_path: Path) -> None:
    whole = make_lab(tmp_path, "none", 1)
    found = whole.ask("diagnose", whole.base)
    assert set(found) == DIAGNOSIS
    assert found["verdict"] in ("none", "unknown", "not_testable")
    assert not any(c["claimed"] for c in found["candidates"])
    assert all("did not hold" in look["reason"] for look in whole.ask("sql", "from locked_look"))
