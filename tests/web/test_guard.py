"""Who is let in, and what every answer carries."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest

from thermodata.errors import UsageError
from thermodata.web.app import application
from thermodata.web.desk import Desk, Keys, desk_of
from thermodata.web.serve import listen, ticket_address

from ..commands import Said
from .client import Client, Header
from .conftest import PORT, client_of, headers_of, write_headers


@pytest.fixture
def bare(tmp_path: Path) -> tuple[Client, Desk]:
    """A browser that sends nothing but what a test gives it."""
    desk = desk_of(tmp_path, None, write=False, port=PORT)
    return Client(application(desk)), desk


def test_it_listens_on_this_machine_only() -> None:
    with listen() as bound:
        assert bound.getsockname()[0] == "127.0.0.1"
        with pytest.raises(UsageError, match="can't be opened"):
            listen(bound.getsockname()[1])


@pytest.mark.parametrize(
    "hosts",
    [
        [],
        ["evil.example"],
        [f"evil.example:{PORT}"],
        ["127.0.0.1"],
        [f"127.0.0.1:{PORT + 1}"],
        [f"localhost:{PORT}"],
        [f"127.0.0.1.evil.example:{PORT}"],
        [f"127.0.0.1:{PORT}", "evil.example"],
        ["evil.example", f"127.0.0.1:{PORT}"],
        [f"[::1]:{PORT}"],
        [f"127.0.0.1:{PORT} "],
    ],
)
def test_a_host_that_is_not_exactly_ours_gets_nothing(bare: tuple[Client, Desk], hosts: list[str]) -> None:
    client, desk = bare
    cookie = headers_of(desk)[1]
    # as a rebound name would have it: Origin and Host agree, and both are foreign
    headers: list[Header] = [*(("host", h) for h in hosts), cookie, *(("origin", f"http://{h}") for h in hosts)]
    assert client.get("/", headers).status == 421
    assert client.get(f"/open?ticket={desk.keys.ticket}", headers).status == 421
    assert client.get("/", headers_of(desk)).status == 200


@pytest.mark.parametrize(
    "path", ["/", "/static/workbench.css", "/static/htmx/htmx.min.js", "/nothing", "/sql?q=select+1"]
)
def test_reading_needs_the_cookie(bare: tuple[Client, Desk], path: str) -> None:
    client, desk = bare
    host: Header = ("host", desk.host)
    assert client.get(path, [host]).status == 403
    for wrong in ("", "x", desk.keys.ticket, desk.keys.form, desk.keys.session[:-1], desk.keys.session + "x"):
        assert client.get(path, [host, ("cookie", f"thermodata_{PORT}={wrong}")]).status == 403
    assert client.get(path, [host, ("cookie", f"other={desk.keys.session}")]).status == 403
    # the cookie of another workbench of this machine
    assert client.get(path, [host, ("cookie", f"thermodata_{PORT + 1}={desk.keys.session}")]).status == 403


def test_the_ticket_works_once_and_becomes_a_cookie_that_scripts_and_strangers_do_not_get(
    bare: tuple[Client, Desk],
) -> None:
    client, desk = bare
    host: Header = ("host", desk.host)
    url = ticket_address(desk).removeprefix(desk.address)
    assert client.get("/open?ticket=wrong", [host]).status == 403
    assert client.get("/open", [host]).status == 403
    first = client.get(url, [host])
    assert first.status == 200
    cookie = first.header("set-cookie") or ""
    assert "HttpOnly" in cookie
    assert "samesite=strict" in cookie.lower()
    assert desk.keys.session in cookie
    assert desk.keys.session not in first.text
    again = client.get(url, [host])
    assert again.status == 403
    assert again.header("set-cookie") is None
    assert client.get("/", [host, ("cookie", cookie.split(";")[0])]).status == 200


def test_keys_differ_from_each_other_and_from_those_of_another_start() -> None:
    one, other = Keys(), Keys()
    everything = {one.ticket, one.session, one.form, other.ticket, other.session, other.form}
    assert len(everything) == 6
    assert all(len(key) >= 43 for key in everything)


def test_a_ticket_is_spent_by_the_right_one_only() -> None:
    keys = Keys()
    assert not keys.spend("wrong")
    assert keys.spend(keys.ticket)
    assert not keys.spend(keys.ticket)


@pytest.mark.parametrize("method", ["PUT", "DELETE", "PATCH", "OPTIONS", "TRACE", "CONNECT"])
def test_nothing_but_get_head_and_post(bare: tuple[Client, Desk], method: str) -> None:
    client, desk = bare
    assert client.get("/", [*headers_of(desk), *write_headers(desk)], method=method).status == 405


def test_a_workbench_that_only_reads_writes_nothing(made_lab: Path) -> None:
    client, desk = client_of(made_lab)
    answer = client.post("/task/add", {"model": "baseline", "candidate": "1"}, write_headers(desk))
    assert answer.status == 403
    assert "--write" in answer.text
    assert desk.keys.form not in client.get("/").text  # nor does it hand out what a write needs


def _without(headers: list[Header], name: str, *others: str) -> list[list[Header]]:
    rest = [(k, v) for k, v in headers if k != name]
    return [rest, *([*rest, (name, other)] for other in others)]


@pytest.mark.parametrize("path", ["/", "/sql?q=select+1", "/static/workbench.js"])
@pytest.mark.parametrize("sent", ["cross-site", "same-site"])
def test_what_another_page_makes_a_browser_send_is_refused_though_it_carries_the_cookie(
    reader: Client, path: str, sent: str
) -> None:
    # another port of 127.0.0.1 is the same site: SameSite=Strict lets its requests carry the cookie
    assert reader.get(path, [("sec-fetch-site", sent)]).status == 403
    assert reader.get(path, [("sec-fetch-site", "same-origin")]).status == 200
    assert reader.get(path, [("sec-fetch-site", "none")]).status == 200
    assert reader.get(path).status == 200  # a program that says nothing must hold the cookie


def test_a_ticket_opens_from_anywhere(bare: tuple[Client, Desk]) -> None:
    client, desk = bare
    answer = client.get(f"/open?ticket={desk.keys.ticket}", [("host", desk.host), ("sec-fetch-site", "cross-site")])
    assert answer.status == 200
    assert "samesite=strict" in (answer.header("set-cookie") or "").lower()


@pytest.mark.parametrize("name", ["origin", "x-thermodata-token", "cookie"])
def test_a_write_needs_origin_token_and_cookie(made_lab: Path, name: str) -> None:
    client, desk = client_of(made_lab, write=True)
    whole = [*headers_of(desk), *write_headers(desk)]
    assert Client(client.app).post("/nothing", headers=whole).status == 404  # it comes as far as the routes
    wrong = {
        "origin": ("null", "http://evil.example", f"http://localhost:{PORT}", f"https://127.0.0.1:{PORT}", desk.host),
        "x-thermodata-token": ("", "x", desk.keys.session, desk.keys.ticket),
        "cookie": ("", "x", f"thermodata_{PORT}={desk.keys.form}"),
    }[name]
    for headers in _without(whole, name, *wrong):
        assert Client(client.app).post("/nothing", headers=headers).status == 403


def test_every_answer_forbids_what_is_inline_foreign_or_framed(bare: tuple[Client, Desk]) -> None:
    client, desk = bare
    for answer in (
        client.get("/", headers_of(desk)),
        client.get("/static/workbench.js", headers_of(desk)),
        client.get("/nothing", headers_of(desk)),
        client.get("/", [("host", "evil.example")]),
        client.get("/", [("host", desk.host)]),
    ):
        policy = dict(
            part.strip().split(" ", 1) for part in (answer.header("content-security-policy") or "").split(";")
        )
        assert policy["default-src"] == "'self'"
        assert "unsafe" not in str(policy)
        assert policy["frame-ancestors"] == policy["base-uri"] == policy["object-src"] == "'none'"
        assert answer.header("x-content-type-options") == "nosniff"
        assert answer.header("referrer-policy") == "no-referrer"
        assert answer.header("access-control-allow-origin") is None


@pytest.mark.parametrize(
    "name", ["../desk.py", "..%2fdesk.py", "/etc/passwd", "htmx/../../desk.py", "", "templates/base.html.j2"]
)
def test_static_serves_its_own_files_only(reader: Client, name: str) -> None:
    assert reader.get(f"/static/{name}").status == 404


def test_paths_stay_inside_the_chosen_folders(tmp_path: Path) -> None:
    lab, other = tmp_path / "lab", tmp_path / "other"
    (lab / "raw").mkdir(parents=True)
    other.mkdir()
    (lab / "way out").symlink_to(other)
    desk = desk_of(lab, None, write=True, port=PORT)
    assert desk.inside("raw") == (lab / "raw").resolve()
    assert desk.inside(lab / "raw" / "new.yaml") == (lab / "raw" / "new.yaml").resolve()
    for name in (
        "..",
        "../other",
        "raw/../../other",
        other,
        "/etc/passwd",
        "way out",
        "way out/x",
        "a\0b",
        "~",
        "../lab2",
    ):
        with pytest.raises(UsageError):
            desk.inside(name)


def test_a_store_of_its_own_and_the_folder_around_it_are_chosen(made_lab: Path, tmp_path: Path) -> None:
    by_store = desk_of(made_lab / "thermodata.store", None, write=False, port=PORT)
    by_folder = desk_of(made_lab, None, write=False, port=PORT)
    assert by_store.store_path == by_folder.store_path
    assert made_lab.resolve() in by_store.folders
    with pytest.raises(UsageError, match="no such folder"):
        desk_of(tmp_path / "nowhere", None, write=False, port=PORT)


def test_a_store_that_is_named_goes_before_that_of_the_environment(
    made_lab: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, say: Callable[..., Said]
) -> None:
    monkeypatch.setattr("uvicorn.Server.run", lambda *_, **__: None)  # it opens its port, and ends
    own, other = made_lab / "thermodata.store", tmp_path / "other.store"
    other.mkdir()
    monkeypatch.setenv("THERMODATA_STORE", str(other))

    def opened(*words: object) -> str:
        said = say("workbench", *words, "--no-browser", "--json")
        assert said.code == 0, said.err
        return str(json.loads(said.out)["store"])

    assert opened(own) == opened(made_lab) == str(own)
    assert opened() == opened(tmp_path) == str(other)
    assert opened(made_lab, "--store", other) == str(other)  # logs here, their store there
    talk = say("workbench", own, "--no-browser").err
    assert f"of {own}, and not of THERMODATA_STORE ({other})" in talk
    refused = say("workbench", own, "--store", other, "--no-browser")
    assert refused.code == 2
    assert "two stores are named" in refused.err


def test_two_stores_in_one_call_are_refused(made_lab: Path, tmp_path: Path, say: Callable[..., Said]) -> None:
    own = made_lab / "thermodata.store"
    refused = say("--store", tmp_path, "tests", "--store", own)
    assert refused.code == 2
    assert "two stores are named" in refused.err
    assert say("--store", own, "tests", "--store", own).code == 0
