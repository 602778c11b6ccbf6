"""No citation dangles: what code and documents refer to stands in docs/."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from thermodata.effect import all_effects

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
PAGES = sorted([*DOCS.glob("*.md"), *ROOT.glob("*.md")])
KEY = re.compile(r"\[([a-z]+\d{4}|iso\d[\d-]*)\]")
HEADING = re.compile(r"docs/([\w-]+\.md)#([\w-]+)")
# working papers that are in no checkout
DANGLING = re.compile(r"modelling\.md|design\.md|style\.md|design, section|\bpapers? 00\d", re.IGNORECASE)
CODE = [
    path
    for folder in ("thermodata", "plugins", "tests")
    for path in sorted((ROOT / folder).rglob("*"))
    if path.suffix in (".py", ".txt", ".toml", ".sh", ".md", ".css", ".j2", ".yaml") and path != Path(__file__)
]


def literature() -> set[str]:
    """The keys that docs/literature.md lists."""
    return set(re.findall(r'<a id="ref-([\w-]+)"></a>\*\*\[\1\]\*\*', (DOCS / "literature.md").read_text("utf-8")))


def anchors(page: Path) -> set[str]:
    """What a link may lead to in a page: its headings as GitHub names them, and its own anchors."""
    text = re.sub(r"```.*?```", "", page.read_text("utf-8"), flags=re.DOTALL)
    named = {_anchor(title) for title in re.findall(r"^#+ (.+)$", text, flags=re.MULTILINE)}
    return named | set(re.findall(r'<a id="([\w-]+)"></a>', text))


def _anchor(title: str) -> str:
    bare = re.sub(r"[^\w\- ]", "", title.strip().lower())
    return bare.replace(" ", "-")


def missing(text: str) -> list[str]:
    """The citations of a text that lead nowhere."""
    gone = [f"[{key}]" for key in KEY.findall(text) if key not in literature()]
    for page, anchor in HEADING.findall(text):
        if not (DOCS / page).is_file() or anchor not in anchors(DOCS / page):
            gone.append(f"docs/{page}#{anchor}")
    return gone


@pytest.mark.parametrize("name", sorted(all_effects()))
def test_the_source_of_an_effect_stands_in_the_documents(name: str) -> None:
    source = all_effects()[name].source
    assert KEY.search(source) or HEADING.search(source), source
    assert missing(source) == []


def test_code_cites_only_what_the_documents_list() -> None:
    found = {str(p.relative_to(ROOT)): missing(p.read_text("utf-8")) for p in CODE}
    assert {path: gone for path, gone in found.items() if gone} == {}


def test_nothing_cites_papers_that_are_in_no_checkout() -> None:
    texts = {p: p.read_text("utf-8") for p in [*CODE, *PAGES]}
    assert {str(p.relative_to(ROOT)): m[0] for p, text in texts.items() if (m := DANGLING.search(text))} == {}


def test_every_work_of_the_literature_is_cited() -> None:
    texts = [p.read_text("utf-8") for p in CODE if p.suffix == ".py"] + [p.read_text("utf-8") for p in PAGES]
    for key in literature():
        cited = sum(len(re.findall(rf"\[{key}\]|#ref-{key}\b", text)) for text in texts)
        assert cited > 2, key  # its own entry and its link are two


@pytest.mark.parametrize("page", PAGES, ids=lambda p: p.name)
def test_links_lead_somewhere(page: Path) -> None:
    text = re.sub(r"```.*?```", "", page.read_text("utf-8"), flags=re.DOTALL)
    inline = re.findall(r"\]\(([^)\s]+(?:\([^)]*\)[^)\s]*)?)\)", text)
    defined = re.findall(r"^\[[^\]]+\]: (\S+)$", text, flags=re.MULTILINE)
    for target in (t for t in [*inline, *defined] if not t.startswith("http")):
        path, _, anchor = target.partition("#")
        file = page.parent / path if path else page
        assert file.exists(), target
        assert not anchor or anchor in anchors(file), target


@pytest.mark.parametrize(
    ("text", "gone"),
    [
        ("[golub1973] and docs/method.md#ranking", []),
        ("[golub1937]", ["[golub1937]"]),
        ("docs/method.md#rankings; docs/none.md#x", ["docs/method.md#rankings", "docs/none.md#x"]),
    ],
)
def test_what_leads_nowhere_is_found(text: str, gone: list[str]) -> None:
    assert missing(text) == gone


@pytest.mark.parametrize(
    "text", ["modelling.md section 5, row 8", "(design, section 7)", "Paper 003:", "papers 000-004"]
)
def test_the_old_papers_are_known_by_every_spelling(text: str) -> None:
    assert DANGLING.search(text)
