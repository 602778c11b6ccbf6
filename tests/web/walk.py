"""A new user's way from a folder of raw logs to a verdict, in a real Chromium, by the clock.

    python -m tests.web.walk FOLDER ANSWERS.json [--most-s 600]

By mouse and keys only, with the pauses of a person: words that are new are read at 4 a second (a page is skimmed after
20 s), a field takes 1.5 s to find, a letter 0.25 s, a click 1 s. FOLDER holds raw logs and nothing of ours; it is
copied first. ANSWERS.json says what the person knows: "fields" (a regular expression on the name of a field -> what is
typed), "roles" (on the test's id -> role), "steps" (the commanded move of each step of a jump test), "response" (which
displacement, where there are several). Prints a table of steps: when each ended, how long the program and how long the
person took; then the verdict.
"""

from __future__ import annotations

import argparse
import contextlib
import json
import os
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ..chromium import Page, browser, find

_WORDS_A_S, _SKIM_S, _FIND_S, _LETTER_S, _CLICK_S = 4.0, 20.0, 1.5, 0.25, 1.0
# what stands on the page now; charts are looked at, not read
_TEXT = """[...document.querySelectorAll('main :is(h1, h2, p, li, td, label, pre, legend)')]
  .filter(e => e.checkVisibility() && !e.closest('[data-chart]')).map(e => e.innerText).join(' ')"""
_ANSWERED = "(document.querySelector('.verdict') && !document.querySelector('form[hx-post$=diagnose]'))"
_FIELDS = """[...document.querySelectorAll('form#answers [name]:not([type=hidden])')].map(e =>
  [e.name, e.tagName, e.value, Boolean(e.closest('.open')), e.closest('.question').innerText])"""


@dataclass
class Person:
    """Reads, points and types in a tab; takes down what took how long."""

    page: Page
    began: float = field(default_factory=time.monotonic)
    pauses_s: float = 0.0
    read: set[str] = field(default_factory=set)
    steps: list[tuple[str, float, float, float]] = field(default_factory=list)
    at: float = field(default_factory=time.monotonic)
    paused_at: float = 0.0

    def pause(self, seconds: float) -> None:
        time.sleep(seconds)
        self.pauses_s += seconds

    def look(self) -> None:
        """Reads what is new."""
        words = re.findall(r"\w+", self.page.js(_TEXT) or "")
        new = [w for w in words if w not in self.read]
        self.read |= set(words)
        self.pause(min(_SKIM_S, 2.0 + len(new) / _WORDS_A_S))

    def click(self, selector: str) -> None:
        self.pause(_CLICK_S)
        self.page.press(selector, 60)

    def type(self, selector: str, text: str) -> None:
        self.pause(_FIND_S)
        self.page.press(selector, 60)
        for letter in text:
            self.page.call("Input.insertText", text=letter)
            self.pause(_LETTER_S)

    def choose(self, selector: str, value: str) -> None:
        """In a list, by its first letters."""
        self.pause(_FIND_S)
        self.page.js(f"document.querySelector({json.dumps(selector)}).focus()")
        options = f"[...document.querySelector({json.dumps(selector)}).options]"
        label = self.page.js(f"{options}.find(o => o.value === {json.dumps(value)}).text")
        chosen = ""
        for letter in label[:12]:  # no more than it takes: after a pause a list begins to search anew
            self.page.key(letter)
            chosen = self.page.js(f"document.querySelector({json.dumps(selector)}).value")
            if chosen == value:
                return
        raise AssertionError(f"{selector}: typing '{label[:12]}' chose '{chosen}'")

    def step(self, what: str) -> None:
        """Ends a step."""
        now = time.monotonic()
        person = self.pauses_s - self.paused_at
        self.steps.append((what, now - self.began, now - self.at - person, person))
        self.at, self.paused_at = now, self.pauses_s
        print(f"| {_clock(now - self.began)} | {what} | {self.steps[-1][2]:.1f} s | {person:.0f} s |", flush=True)


def _clock(seconds: float) -> str:
    return f"{int(seconds // 60)}:{int(seconds % 60):02}"


def way(person: Person, known: dict[str, Any]) -> str:
    """From the first page to the verdict's headline."""
    page = person.page
    person.look()
    person.click("main a[href^='/start']")
    page.wait("location.pathname === '/start'")
    person.look()
    person.step("opened; Start with a folder of raw logs")
    person.click("form[hx-post='/task/draft'] button")
    page.wait("document.querySelector('#answers')")
    person.look()
    person.step(f"drafted: {page.js('document.querySelector(`h1`).textContent')}")
    print(f"  answered: {answer(person, known)}", flush=True)
    person.step("answered what is framed")
    person.click("#answers button[type=submit]")
    page.wait("document.querySelector('#diff .diff, #diff [role=alert], #diff .refused')")
    person.look()
    person.click("#diff form[hx-post='/start/write'] button")
    page.wait("document.querySelector('#diff h2')?.textContent.includes('is written')")
    person.look()
    person.step("read the lines that change; written")
    person.click("#diff form[hx-post='/task/ingest'] button")
    page.wait("document.querySelector('#again .task.done, #again .task.failed')", 600)
    person.look()
    print("  said: " + page.js("document.querySelector('#again').innerText").replace("\n", " / ")[:1500], flush=True)
    person.step("ingested, and read what was said")
    person.click("#again a[href*='#model']")
    page.wait("location.search.includes('after=ingest') && document.querySelector('#model form')")
    person.look()
    if known.get("response"):
        person.choose("#model select[name=response]", known["response"])
        person.click("#model form[hx-post='/start/model'] button")
        page.wait("document.querySelector('#model [role=status]')")
        person.look()
    person.click("#model form[hx-post='/task/fit'] button")
    page.wait("location.pathname === '/compare' || document.querySelector('.task.failed')", 600)
    person.look()
    lead = page.js("document.querySelector('.lead, .task.failed').innerText")
    person.step(f"fitted a first model: {lead}")
    person.click("a.button[href^='/missing']")
    page.wait("location.pathname === '/missing'")
    person.look()
    person.click("form[hx-post='/task/diagnose'] button")
    page.wait(f"{_ANSWERED} || document.querySelector('.task.failed')", 600)
    person.look()
    said = str(page.js("document.querySelector('.verdict, .task.failed').innerText"))
    person.step("asked what is missing, and read the verdict")
    if page.js("Boolean(document.querySelector('.candidate.claimed a.button[href^=\"/add\"]'))"):
        person.click(".candidate.claimed a.button[href^='/add']")
        page.wait("location.pathname === '/add'")
        person.look()
        person.click("form[hx-post='/task/add'] button")
        page.wait("location.pathname === '/compare' || document.querySelector('.task.failed')", 600)
        person.look()
        person.step(f"added it: {page.js('document.querySelector(`.lead, .task.failed`).innerText')}")
    return said


def answer(person: Person, known: dict[str, Any]) -> str:
    """Fills in what is framed and what the person knows better. -> what was answered, and what was left."""
    person.page.wait("!document.querySelector('label[hx-get]')", 60)  # the jump tests have been drawn
    done, left = [], []
    for name, tag, value, is_open, told in person.page.js(_FIELDS):
        selector = f'[name="{name}"]'
        if tag == "SELECT" and name.endswith(".role"):
            test = told.split("\n")[0].split(" · ")[0]
            wanted = next((role for text, role in known.get("roles", {}).items() if re.search(text, test)), None)
            if wanted and wanted != value:
                person.choose(selector, wanted)
                done.append(f"{test} {wanted}")
            continue
        if name.startswith("step."):
            moves = next((m for text, m in known.get("steps", {}).items() if re.search(text, name)), None)
            if moves and not value:
                person.type(selector, moves[int(name.rpartition(".")[2])])
                done.append(name)
            continue
        wanted = next((text for pattern, text in known.get("fields", {}).items() if re.search(pattern, name)), None)
        if wanted is not None and wanted != value:
            if tag == "SELECT":
                person.choose(selector, wanted)
            else:
                person.type(selector, wanted)
            done.append(f"{name}={wanted}")
        elif is_open:
            person.pause(_FIND_S)
            left.append(name)
    return f"{', '.join(done)}; left open: {', '.join(left) or 'nothing'}"


@contextlib.contextmanager
def served(folder: Path) -> Iterator[str]:
    """The address that a new workbench over a folder opens."""
    words = [sys.executable, "-m", "thermodata", "workbench", str(folder), "--write", "--no-browser", "--json"]
    server = subprocess.Popen(words, stdout=subprocess.PIPE, text=True)
    assert server.stdout is not None
    try:
        text = ""
        while not text.rstrip().endswith("}"):
            text += server.stdout.readline()
        yield json.loads(text)["address"]
    finally:
        server.kill()
        server.wait()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("answers", type=Path)
    parser.add_argument("--most-s", type=float, default=600.0)
    given = parser.parse_args()
    program = find()
    if program is None:
        raise SystemExit("no Chromium: install one, or name it in THERMODATA_CHROMIUM")
    with tempfile.TemporaryDirectory() as kept:
        folder = Path(kept) / given.folder.name
        shutil.copytree(given.folder, folder)
        with browser(program) as one:
            with served(folder) as address:
                page = one.open(address, 1280, 900)
                page.wait("document.readyState === 'complete' && location.pathname === '/'")
                person = Person(page)
                print("| clock | step | the program | the person |\n|---|---|---|---|")
                said = way(person, json.loads(given.answers.read_text()))
                took = time.monotonic() - person.began
                for complaint in page.complaints():
                    print(f"the page complains: {complaint}", file=sys.stderr)
            used = resource.getrusage(resource.RUSAGE_CHILDREN)  # of the server and its work: the browser still runs
        program_s = took - person.pauses_s
        print(
            f"\n{said}\n\n{_clock(took)} in all, {program_s:.0f} s of them the program's, which used "
            f"{used.ru_utime + used.ru_stime:.0f} s of processor time; load {os.getloadavg()[0]:.1f}"
        )
    raise SystemExit(0 if took <= given.most_s else f"longer than {given.most_s:g} s")


if __name__ == "__main__":
    main()
