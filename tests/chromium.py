"""Drives a real Chromium through a pipe (DevTools protocol), with nothing but the standard library.

`find()` gives the program: THERMODATA_CHROMIUM, or one that stands in PATH; None where there is none, and tests skip.
"""

from __future__ import annotations

import base64
import contextlib
import json
import os
import select
import shutil
import subprocess
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

_NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome")
_FLAGS = (
    "--headless=new",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-dev-shm-usage",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--hide-scrollbars",
    "--lang=en-US",
    "--remote-debugging-pipe",
)


# the middle of an element that rests on top of the page [px], or null; its next click is told in `window.pressed`
_RESTING = """async selector => {
  const element = document.querySelector(selector);
  if (!element) return null;
  element.scrollIntoView({block: 'center'});
  const place = () => {
    const r = element.getBoundingClientRect();
    return [r.left + r.width / 2, r.top + r.height / 2];
  };
  const before = place();
  await new Promise(done => setTimeout(done, 50)); // no frame is drawn in a tab behind another
  const now = place(), top = document.elementFromPoint(...now);
  if (before[0] !== now[0] || before[1] !== now[1] || !top || !element.contains(top)) return null;
  window.pressed = false;
  element.addEventListener('click', () => { window.pressed = true; }, {capture: true, once: true});
  return now;
}"""


# how the browser says that a page was left while it was asked; a closed tab says otherwise
_LEFT = ("navigated or closed", "context was destroyed", "Cannot find context", "Promise was collected")


class PageLeftError(RuntimeError):
    """The page was left for another before it answered."""


def find() -> str | None:
    """The browser's path, or None."""
    named = os.environ.get("THERMODATA_CHROMIUM")
    if named:
        return named
    return next((path for name in _NAMES if (path := shutil.which(name))), None)


class Chromium:
    """A browser. `open` gives a tab; commands and events go as JSON that ends with a zero byte."""

    def __init__(self, program: str) -> None:
        self._profile = tempfile.mkdtemp(prefix="chromium-")
        to_child, self._write = os.pipe()
        self._read, from_child = os.pipe()
        high = [os.dup(to_child), os.dup(from_child)]  # the child finds them at 3 and 4

        def place() -> None:
            a, b = os.dup(high[0]), os.dup(high[1])
            os.dup2(a, 3)
            os.dup2(b, 4)

        self._process = subprocess.Popen(
            [program, *_FLAGS, f"--user-data-dir={self._profile}"],
            close_fds=False,
            env={**os.environ, "LANG": "en_US.UTF-8", "LC_ALL": "en_US.UTF-8"},  # of C, pages get no language
            preexec_fn=place,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        for end in (to_child, from_child, *high):
            os.close(end)
        self._rest, self._last, self.ended = b"", 0, False
        self.events: list[dict[str, Any]] = []

    def call(self, method: str, session: str | None = None, timeout_s: float = 180.0, **params: Any) -> dict[str, Any]:
        """The result of a command; events that arrive meanwhile go to `events`."""
        self._last += 1
        number, message = self._last, {"id": self._last, "method": method, "params": params}
        if session:
            message["sessionId"] = session
        try:
            os.write(self._write, json.dumps(message).encode() + b"\0")
        except BrokenPipeError:
            self.ended = True
            raise ConnectionError("the browser has ended") from None
        until = time.monotonic() + timeout_s
        while time.monotonic() < until:
            for answer in self._messages(until):
                if answer.get("id") == number:
                    if "error" in answer:
                        said = answer["error"]["message"]
                        left = any(words in said for words in _LEFT)
                        raise (PageLeftError if left else RuntimeError)(f"{method}: {said}")
                    return dict(answer["result"])
                self.events.append(answer)
        raise TimeoutError(f"{method}: no answer within {timeout_s:g} s")

    def _messages(self, until: float) -> Iterator[dict[str, Any]]:
        """Whole messages that have arrived; one that is handed out is not read again."""
        if b"\0" not in self._rest:
            ready, _, _ = select.select([self._read], [], [], max(0.0, min(1.0, until - time.monotonic())))
            if not ready:
                return
            got = os.read(self._read, 1 << 20)
            if not got:
                self.ended = True
                raise ConnectionError("the browser has ended")
            self._rest += got
        while b"\0" in self._rest:
            raw, _, self._rest = self._rest.partition(b"\0")
            yield json.loads(raw)

    def open(self, url: str, width: int = 1200, height: int = 900, dark: bool = False, mobile: bool = False) -> Page:
        """A tab of its own with this page, loaded."""
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        page = Page(self, session, target)
        for domain in ("Page", "Runtime", "Network", "Log"):
            page.call(f"{domain}.enable")
        page.look(width, height, dark, mobile)
        page.go(url)
        return page

    def close(self) -> None:
        with contextlib.suppress(Exception):
            self.call("Browser.close", timeout_s=5)
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._process.wait(10)
        if self._process.poll() is None:
            self._process.kill()
            self._process.wait()
        os.close(self._read)
        os.close(self._write)
        shutil.rmtree(self._profile, ignore_errors=True)


class Page:
    """A tab."""

    def __init__(self, browser: Chromium, session: str, target: str) -> None:
        self._browser, self._session, self._target = browser, session, target

    def call(self, method: str, **params: Any) -> dict[str, Any]:
        return self._browser.call(method, self._session, **params)

    def go(self, url: str, timeout_s: float = 180.0) -> None:
        """Loads an address and waits until it is there."""
        until = time.monotonic() + timeout_s
        while True:
            failed = self.call("Page.navigate", url=url).get("errorText")
            if failed:
                raise ConnectionError(f"{url}: {failed}")
            again = time.monotonic() + timeout_s / 6  # a tab that was just made sometimes forgets where it was sent
            while time.monotonic() < again:
                with contextlib.suppress(PageLeftError):  # the one before it
                    if self.js("document.readyState === 'complete' && location.href !== 'about:blank'"):
                        return
                time.sleep(0.02)
            if time.monotonic() > until:
                raise TimeoutError(f"{url}: not loaded within {timeout_s:g} s")

    def look(self, width: int, height: int, dark: bool = False, mobile: bool = False) -> None:
        """The window's size, and what the system prefers."""
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=mobile)
        scheme = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
        self.call("Emulation.setEmulatedMedia", features=[scheme])

    def js(self, expression: str) -> Any:
        """The value of an expression (of what it promises); an error of the page is one here.

        Raises:
            PageLeftError: the page was left for another meanwhile.
            RuntimeError: the page's error.
        """
        answer = self.call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in answer:
            raise RuntimeError(json.dumps(answer["exceptionDetails"])[:2000])
        return answer["result"].get("value")

    def wait(self, expression: str, timeout_s: float = 300.0) -> Any:
        """The expression's value as soon as it is true; True for an element, which has no value of its own here.

        A page that is left for another meanwhile is waited for: the next one is asked.
        """
        until = time.monotonic() + timeout_s
        told = f"Promise.resolve({expression}).then(v => v instanceof Node ? true : v)"
        while True:
            with contextlib.suppress(PageLeftError):
                value = self.js(told)
                if value:
                    return value
            if time.monotonic() > until:
                raise TimeoutError(f"not true within {timeout_s:g} s: {expression}")
            time.sleep(0.03)

    def mouse(self, kind: str, x: float, y: float, **more: Any) -> None:
        """kind: 'mouseMoved', 'mousePressed', 'mouseReleased', 'mouseWheel'; x, y in the window [px]."""
        if kind in ("mousePressed", "mouseReleased"):
            more = {"button": "left", "clickCount": 1, **more}
        self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, **more)

    def click(self, x: float, y: float) -> None:
        self.mouse("mouseMoved", x, y)
        self.mouse("mousePressed", x, y)
        self.mouse("mouseReleased", x, y)

    def press(self, selector: str, timeout_s: float = 300.0) -> None:
        """Clicks on the first element of a CSS selector, and again where the click did not reach it.

        A page that still loads moves what stands below a chart: the element is pressed where it rests and
        lies on top, and asked whether it was hit. A page that is gone has been left by the click.
        """
        until = time.monotonic() + timeout_s
        while time.monotonic() < until:
            place = self.wait(f"({_RESTING})({json.dumps(selector)})", timeout_s)
            self.click(*place)
            try:
                if self.js("new Promise(r => setTimeout(() => r(window.pressed !== false), 50))"):
                    return
            except PageLeftError:
                return
        raise TimeoutError(f"no click reached {selector} within {timeout_s:g} s")

    def drag(self, x0: float, x1: float, y: float) -> None:
        self.mouse("mouseMoved", x0, y)
        self.mouse("mousePressed", x0, y)
        for i in range(1, 6):
            self.mouse("mouseMoved", x0 + (x1 - x0) * i / 5, y, buttons=1)
        self.mouse("mouseReleased", x1, y)

    def key(self, key: str) -> None:
        """A key as KeyboardEvent.key names it: 'Tab', 'ArrowLeft', 'a'."""
        text = {"Enter": "\r"}.get(key, key if len(key) == 1 else "")
        codes = {"Tab": 9, "Enter": 13, "Escape": 27, "ArrowLeft": 37, "ArrowUp": 38, "ArrowRight": 39, "ArrowDown": 40}
        code = codes.get(key, ord(key.upper()) if len(key) == 1 else 0)
        self.call("Input.dispatchKeyEvent", type="keyDown", key=key, text=text, windowsVirtualKeyCode=code)
        self.call("Input.dispatchKeyEvent", type="keyUp", key=key, windowsVirtualKeyCode=code)

    def events(self, *methods: str) -> list[dict[str, Any]]:
        """What the tab told so far, of these kinds."""
        self.js("0")  # what is on its way arrives before the answer
        return [
            e["params"] for e in self._browser.events if e.get("sessionId") == self._session and e["method"] in methods
        ]

    def complaints(self) -> list[str]:
        """Errors and warnings of the page: uncaught, of the console, of the policy, of the network."""
        said = [
            e["exceptionDetails"].get("exception", {}).get("description", e["exceptionDetails"]["text"])
            for e in self.events("Runtime.exceptionThrown")
        ]
        said += [
            " ".join(str(a.get("value", a.get("description"))) for a in e["args"])
            for e in self.events("Runtime.consoleAPICalled")
            if e["type"] in ("error", "warning", "assert")
        ]
        said += [
            e["entry"]["text"] for e in self.events("Log.entryAdded") if e["entry"]["level"] in ("error", "warning")
        ]
        return said

    def requests(self) -> list[str]:
        """Addresses of everything that the tab asked for, its own page with them."""
        return [e["request"]["url"] for e in self.events("Network.requestWillBeSent")]

    def picture(self, path: Path | str, whole: bool = True) -> None:
        """A PNG of the page (of the window where not `whole`)."""
        clip: dict[str, Any] = {}
        if whole:
            # what is drawn when it comes into sight must have been in sight
            self.js("document.querySelectorAll('[data-chart]').forEach(b => ThermoChart.of(b))")
            time.sleep(0.15)
            size = self.call("Page.getLayoutMetrics")["cssContentSize"]
            clip = {
                "captureBeyondViewport": True,
                "clip": {"x": 0, "y": 0, "width": size["width"], "height": size["height"], "scale": 1},
            }
        shot = self.call("Page.captureScreenshot", format="png", **clip)
        Path(path).write_bytes(base64.b64decode(shot["data"]))

    def paper(self, on: bool = True) -> None:
        """Shows the page as it goes to A4 within margins of 10 mm, charts redrawn for it; or as on the screen again."""
        self.look(680, 1000) if on else self.look(1280, 900)
        self.call("Emulation.setEmulatedMedia", media="print" if on else "")  # `look` sets it too
        self.js(f"dispatchEvent(new Event('{'beforeprint' if on else 'afterprint'}'))")

    def pdf(self, path: Path | str) -> None:
        """The page as it prints on A4."""
        made = self.call("Page.printToPDF", preferCSSPageSize=True, paperWidth=8.27, paperHeight=11.69)
        Path(path).write_bytes(base64.b64decode(made["data"]))

    def close(self) -> None:
        self._browser.call("Target.closeTarget", targetId=self._target)


@contextlib.contextmanager
def browser(program: str) -> Iterator[Chromium]:
    """A browser that is closed at the end."""
    made = Chromium(program)
    try:
        yield made
    finally:
        made.close()
