"""A rule that a stretch proposes, put into the campaign file from the page: shown first, then written and kept."""

from __future__ import annotations

import html
import re
from pathlib import Path

from thermodata.schema.files.load import load_campaign

from .client import Client
from .conftest import client_of

STRETCH = "/test/range?campaign=small&test=heat1&from=3600&to=7200"


def fields(text: str, line: str) -> dict[str, str]:
    """The hidden fields of the form that puts this line."""
    for form in re.findall(r'<form hx-post="/rule/preview".*?</form>', text, re.S):
        found = {k: html.unescape(v) for k, v in re.findall(r'name="(\w+)" value="([^"]*)"', form)}
        if found["line"].startswith(line):
            return found
    raise AssertionError(f"no form for {line}")


def test_a_window_is_shown_then_written_and_the_file_before_is_kept(writer: Client, lab: Path) -> None:
    path = lab / "campaign.yaml"
    before = path.read_text()
    form = fields(writer.get(STRETCH).text, "window:")
    shown = writer.post("/rule/preview", form)
    assert "window: [3600 s, 7200 s]" in html.unescape(shown.text).replace('"', "")
    assert path.read_text() == before  # shown, not written
    answer = writer.post("/rule/write", form).text
    assert "is written" in answer
    assert 'hx-post="/task/ingest"' in answer
    heat1 = next(t for t in load_campaign(path).tests if t.id == "heat1")
    assert heat1.window == (3600.0, 7200.0)
    assert (lab / "campaign.1.yaml").read_text() == before


def test_who_only_reads_may_copy(reader: Client) -> None:
    text = reader.get(STRETCH).text
    assert "/rule/preview" not in text
    assert 'data-copy="window:' in text


def test_a_campaign_whose_file_is_elsewhere_is_said(lab: Path, writer: Client) -> None:
    form = {"campaign": "nobody", "test": "heat1", "line": "window: [0 s, 60 s]"}
    answer = writer.post("/rule/preview", form)
    assert answer.status == 400
    assert "is not here" in answer.text
    assert "<nav" in answer.text
    part = writer.post("/rule/preview", form, [("hx-request", "true")])
    assert part.status == 400
    assert "is not here" in part.text
    assert "<html" not in part.text, "a page would stand within the page"
    assert "<nav" not in part.text
    # one that a link leads out to is as good as none
    outside = lab.parent / "outside.yaml"
    outside.write_text((lab / "campaign.yaml").read_text().replace("id: small", "id: nobody", 1))
    (lab / "link.yaml").symlink_to(outside)
    assert writer.post("/rule/preview", form).status == 400


def test_no_rule_is_written_without_write(lab: Path) -> None:
    client, _ = client_of(lab)
    before = (lab / "campaign.yaml").read_text()
    answer = client.post("/rule/write", {"campaign": "small", "test": "heat1", "line": "window: [0 s, 60 s]"})
    assert answer.status == 403
    assert (lab / "campaign.yaml").read_text() == before
