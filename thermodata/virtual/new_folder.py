"""Where a simulated campaign is written: into a folder that holds none yet."""

from __future__ import annotations

from pathlib import Path

from thermodata.errors import UsageError


def without_a_campaign(folder: Path | str) -> Path:
    """The folder, which need not exist. UsageError for one that holds a campaign."""
    path = Path(folder)
    if (path / "campaign.yaml").exists():
        raise UsageError(
            "the folder holds a campaign",
            where=str(path),
            expected="a new or empty folder",
            hint="name another folder",
        )
    return path
