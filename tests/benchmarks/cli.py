"""What a user waits for: the help, the demo, a diagnosis, the test suite.

    uv run python tests/benchmarks/cli.py [--runs 5] [--suite]

A limit stands beside each figure. --suite also runs pytest on the whole project.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path

from measure import PROGRAM, Run, machine, middle, run, table

ROOT = Path(__file__).parents[2]


def diagnosis(folder: Path, runs: int) -> tuple[Run, str]:
    """A campaign of ten tests of 12 h, ingested and fitted before the clock starts."""
    from thermodata.virtual import simulate

    truth = simulate(folder, hide="feed_screw", seed=0)
    store = folder / "store"
    run([PROGRAM, "--store", store, "ingest", truth.campaign_file, "--json"])
    model = run([PROGRAM, "--store", store, "fit", truth.model_file, "--json"]).answer["model"]
    done = middle([run([PROGRAM, "--store", store, "diagnose", model, "--json"]) for _ in range(runs)])
    tests = run([PROGRAM, "--store", store, "tests", "--json"]).answer
    channels = {c["channel"] for c in run([PROGRAM, "--store", store, "channels", "--json"]).answer}
    return done, f"diagnose, {len(tests)} tests of 12 h, {len(channels)} channels"


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--runs", type=int, default=5)
    arguments.add_argument("--suite", action="store_true")
    given = arguments.parse_args()
    found: list[tuple[str, float | None, Run]] = []
    bare = middle([run([sys.executable, "-c", "pass"]) for _ in range(given.runs)])
    found.append(("python -c pass, for comparison", None, bare))
    found.append(("--help", 0.5, middle([run([PROGRAM, "--help"]) for _ in range(given.runs)])))
    with tempfile.TemporaryDirectory() as folder:
        done, what = diagnosis(Path(folder) / "campaign", min(3, given.runs))
        found.append((what, 10.0, done))
        found.append(("demo", 60.0, run([PROGRAM, "demo", Path(folder) / "demo", "--json"])))
    if given.suite:
        found.append(("the test suite", None, run([Path(PROGRAM).with_name("pytest"), "-q"], ROOT)))
    print(machine())
    print(
        table(
            ["command", "wall [s]", "limit [s]", "kept", "peak RSS [MiB]"],
            [
                [
                    what,
                    f"{r.seconds:.2f}",
                    "" if limit is None else limit,
                    "" if limit is None else "yes" if r.seconds < limit else "NO",
                    f"{r.peak_mib:.0f}",
                ]
                for what, limit, r in found
            ],
        )
    )


if __name__ == "__main__":
    main()
