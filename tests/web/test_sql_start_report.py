"""SQL, the way from raw logs to a store, and the report."""

from __future__ import annotations

import html
import json
import re
from pathlib import Path
from urllib.parse import quote

import numpy as np

from thermodata.store import Store

from ..view.conftest import Builder
from .client import Client
from .conftest import client_of, write_headers
from .test_compare_and_add import finished


def test_a_query_gives_rows_a_picture_and_files(reader: Client) -> None:
    query = quote("select t_s, value from signal('small', 'heat1', 'dZ') order by t_s")
    text = reader.get(f"/sql?q={query}").text
    assert "360 rows" in text
    assert json.loads(re.search(r'id="sqlplot">(.*?)</script>', text)[1])["axis"]["label"] == "t_s"
    answer = reader.get(f"/sql/csv?q={query}")
    assert answer.header("content-disposition") == 'attachment; filename="thermodata.csv"'
    assert len(answer.text.splitlines()) == 361
    assert reader.get(f"/sql/parquet?q={query}").body[:4] == b"PAR1"


def test_spans_of_time_and_structs_are_no_numbers_to_draw(reader: Client) -> None:
    query = "select t - min(t) over () as since, {'a': 1} as more, t_s, value from signal('small', 'heat1', 'dZ')"
    chart = json.loads(re.search(r'id="sqlplot">(.*?)</script>', reader.get(f"/sql?q={quote(query)}").text)[1])
    assert chart["axis"]["label"] == "t_s"
    assert [s["name"] for p in chart["panels"] for s in p["series"]] == ["value"]


def test_columns_that_are_not_drawn_are_named_and_so_are_rows_that_are_not_listed(reader: Client) -> None:
    columns = ", ".join(f"{i} * t_s as c{i:02}" for i in range(1, 15))
    text = reader.get(f"/sql?q={quote(f'select t_s, {columns} from sample order by t_s')}").text
    panel = json.loads(re.search(r'id="sqlplot">(.*?)</script>', text)[1])["panels"][0]
    assert [s["name"] for s in panel["series"]] == [f"c{i:02}" for i in range(1, 13)]
    assert panel["title"] == "12 columns", "their names stand beside it"
    assert "can't be told apart: c13, c14." in text
    assert "take them as a file; the first 500 are listed" in text
    temperatures = reader.get(f"/sql?q={quote('select t_s, T_hall from wide_small_log')}").text
    assert "T_hall [°C]" in temperatures


def test_rows_have_no_zeros_that_say_nothing_and_a_caret_stands_below_its_word(reader: Client) -> None:
    text = reader.get(
        "/sql?q=" + quote("select 2.0::double as a, 0.1::double + 0.2::double as b, 24::double as c")
    ).text
    assert re.findall(r'<td class="n">(.*?)</td>', text) == ["2", "0.3", "24"]
    wrong = html.unescape(reader.get("/sql?q=selec+x").text)
    assert re.search(r"<pre>[^<]*LINE 1: selec x\n +\^", wrong), "in letters of one width"


def test_what_is_refused_is_said_beside_the_query(reader: Client, tmp_path: Path) -> None:
    secret, stolen = tmp_path / "secret.txt", tmp_path / "x.csv"
    secret.write_text("root: nobody should read this")
    for query in (f"copy (select 1) to '{stolen}'", f"select * from read_text('{secret}')", "drop table test"):
        answer = reader.get(f"/sql?q={quote(query)}")
        assert answer.status == 400
        assert "This query is not run here" in answer.text
        assert "root:" not in answer.text
        assert reader.get(f"/sql/csv?q={quote(query)}").status == 400
    assert not stolen.exists()
    assert reader.get("/sql/exe?q=select+1").status == 400


def test_a_query_of_flagged_values_is_told_beside_its_rows(reader: Client) -> None:
    mean = quote("select avg(value) from temperature")
    said = "The values are of flagged samples too"
    assert said in reader.get(f"/sql?q={mean}").text
    assert said not in reader.get(f"/sql?q={mean}{quote(' where valid(flag)')}").text


def test_the_views_stand_beside_with_their_units(reader: Client) -> None:
    text = reader.get("/sql").text
    assert "<summary>temperature</summary>" in text
    assert "[s] from the start of the test" in text
    assert "/sql?q=select" in text


def test_views_of_streams_are_folded_where_they_are_many_and_examples_run(reader: Client, tmp_path: Path) -> None:
    for many in (3, 20):
        b = Builder(tmp_path / f"of{many}" / "thermodata.store")
        for i in range(many):
            b.test(f"c{i:02}", "day")
            b.channel(f"c{i:02}", "day", "dZ")
            b.tidy(f"c{i:02}", "day", np.arange(5) * 60.0, {"dZ": np.arange(5.0)})
        text = html.unescape(client_of(b.store().path.parent)[0].get("/sql").text)
        names = re.findall(r"<summary>([^<]+)</summary>", text)
        wide = [name for name in names if name.startswith("wide_c")]
        assert len(wide) == many
        assert ("wide_… (20)" in names) is (many == 20)
        assert names.index("test") < names.index(wide[0]), "below the tables"
    for address in re.findall(r'<li><a href="(/sql[^"]+)">', reader.get("/sql").text):
        assert reader.get(html.unescape(address)).status == 200


def test_from_a_folder_of_raw_logs_to_a_store(made_lab: Path, tmp_path: Path) -> None:
    import shutil

    shutil.copytree(made_lab / "raw", tmp_path / "new" / "raw")
    with (tmp_path / "new" / "raw" / "day1.csv").open("a") as file:
        file.write("99999,odd,row\n")  # something to say after the ingest
    client, desk = client_of(tmp_path / "new", write=True)
    client = Client(client.app, [*client.headers, *write_headers(desk)])
    assert "Draft campaign.yaml" in client.get("/start").text
    _, onward = finished(client, client.post("/task/draft", {"folder": str(tmp_path / "new")}).text)
    assert onward is not None
    text = client.get(onward).text
    assert "that only you can answer" in text
    names = re.findall(r'name="(answer\.[^"]+)"', text)
    roles = [n for n in names if n.endswith(".role")]
    assert roles
    path = str(tmp_path / "new" / "campaign.yaml")
    form = {"file": path, "answer.machine.id": "138", **dict.fromkeys(roles, "calibration")}
    before = Path(path).read_text()
    shown = client.post("/start/preview", form).text
    assert "+  id: 138" in shown.replace("&#34;", '"').replace('"138"', "138")
    assert Path(path).read_text() == before  # shown, not written
    many = int(re.search(r'<h1 id="asks">(\d+) question', text)[1])
    written = client.post("/start/write", form).text
    assert "is written" in written
    fewer = int(re.search(r'<h1 id="asks" hx-swap-oob="true">(\d+) question', written)[1])
    assert fewer == many - 1 - len(roles), "the title follows"
    assert '<form id="answers" hx-swap-oob="true"' in written
    assert '<section class="card" id="model" hx-swap-oob="true"' in written
    assert "role: calibration" in Path(path).read_text()
    assert (tmp_path / "new" / "campaign.1.yaml").read_text() == before
    text, onward = finished(client, client.post("/task/ingest", {"campaign": path}).text)
    assert onward is None  # what was lost and noted is read first
    assert "is in the store:</b>" in text
    assert "What could not be read" in text
    assert 'href="/start?after=ingest#model">Fit a first model' in text
    listed = client.get(re.search(r'href="(/\?campaign=[^"]+)">Look at the tests', text)[1])
    assert listed.status == 200
    assert "Fit a first model" in listed.text
    assert Store(tmp_path / "new" / "thermodata.store").generation > 0


def test_what_has_no_field_is_shown_with_its_line_and_counted(tmp_path: Path) -> None:
    (tmp_path / "hall.txt").write_text("a")
    (tmp_path / "campaign.yaml").write_text(
        "schema: thermodata/campaign/1\nid: hall\nmachine:\n  id: M1\nsources:\n"
        "  log: {reader: table, files: hall.txt, table: {time: {format: unknown}}}   # ? format of the dates: dmy or "
        "mdy? 04/05/2026 may be either; stands: [n]? its cells hold what was written last\n"
        "channels:\n  T: {source: log, signal: T, quantity: temperature, unit: degC, at: axis.b}   # ? at: axis.b?\n"
        "tests:\n  - {id: day1, kind: other, role: calibration}\n"
    )
    text = client_of(tmp_path, write=True)[0].get("/start").text
    assert '<h1 id="asks">3 questions' in text
    assert "<li>line 6: stands: [n]? its cells hold what was written last</li>" in text
    assert "A coloured frame marks what nobody has answered" in text
    assert 'name="answer.sources.log.table.time.format"' in text
    assert '<input type="checkbox" name="so.channels.T.at"' in text


def test_a_draft_that_got_another_id_than_its_folder_says_so(made_lab: Path, tmp_path: Path) -> None:
    import shutil

    for lab in ("hall", "yard"):
        shutil.copytree(made_lab / "raw", tmp_path / lab / "new" / "raw")
    client, desk = client_of(tmp_path, write=True)
    client = Client(client.app, [*client.headers, *write_headers(desk)])
    said = []
    for lab in ("hall", "yard"):
        _, onward = finished(client, client.post("/task/draft", {"folder": str(tmp_path / lab / "new")}).text)
        assert onward is not None
        said.append(client.get(onward).text)
        finished(client, client.post("/task/ingest", {"campaign": str(tmp_path / lab / "new/campaign.yaml")}).text)
    assert "Its id is" not in said[0]
    assert "Its id is <b>yard-new</b>: the store holds another campaign 'new'" in said[1]
    assert str(tmp_path / "hall/new/campaign.yaml") in said[1]
    assert "Its id is" not in client.get(f"/start?file={tmp_path / 'hall/new/campaign.yaml'}").text


def test_answers_stay_inside_the_folder(writer: Client, tmp_path: Path) -> None:
    for url in ("/start/preview", "/start/write"):
        answer = writer.post(url, {"file": "/etc/hosts.yaml", "answer.machine.id": "x"})
        assert answer.status == 400
        assert "outside of the chosen folders" in answer.text
    assert writer.get("/start?file=../x.yaml").status == 400


def test_a_report_is_written_into_the_folder_and_taken_as_a_file(writer: Client, lab: Path) -> None:
    text = writer.get("/report").text
    out = re.search(r'name="out" value="([^"]+)"', text)[1]
    model = re.search(r'name="model" value="([^"]+)"', text)[1]
    _, onward = finished(writer, writer.post("/task/report", {"model": model, "out": out}).text)
    assert onward is not None
    assert (lab / out).is_file()
    answer = writer.get(onward)
    assert (answer.header("content-disposition") or "").startswith("attachment")
    assert writer.get("/report/file?name=campaign.yaml").status == 400
    assert writer.get("/report/file?name=../../etc/passwd").status == 400


def test_the_displacement_of_the_first_model_is_chosen(writer: Client, lab: Path) -> None:
    path = lab / "campaign.yaml"
    dx = "  dX: {source: log, signal: dX, quantity: displacement, unit: um, axis: X, at: tcp}"
    path.write_text(path.read_text().replace("channels:\n", f"channels:\n{dx}\n", 1))
    text = writer.get("/start").text
    assert re.search(r'<option value="dZ"[^>]*>dZ: axis Z, at tcp</option>', text)
    assert "first-model" in text
    answer = writer.post("/start/model", {"file": str(path), "response": "dX"})
    assert "drafted for dX" in answer.text
    assert '<option value="dX" selected>' in answer.text
    assert f"first-model {path} --response dX" in answer.text
    assert "axis: X" in (lab / "model.yaml").read_text()
    assert writer.post("/start/model", {"file": str(path), "response": "nothing"}).status == 400
    assert writer.post("/start/model", {"file": "../elsewhere.yaml", "response": "dX"}).status == 400


def test_a_model_file_in_another_encoding_is_shown(writer: Client, lab: Path) -> None:
    (lab / "model.yaml").write_bytes("# für die Spindel\n".encode("latin-1"))
    answer = writer.get("/start")
    assert answer.status == 200
    assert "die Spindel" in answer.text
    path = lab / "campaign.yaml"
    path.write_bytes(path.read_bytes() + "# für die Spindel\n".encode("latin-1"))
    refused = writer.get("/start")
    assert refused.status == 400
    assert "not in UTF-8" in refused.text


def test_another_campaign_begins_with_any_folder_below(lab: Path) -> None:
    """Beside the campaign file that lies in the folder of the store, too."""
    (lab / "second" / "raw").mkdir(parents=True)
    client, desk = client_of(lab, write=True)
    client = Client(client.app, [*client.headers, *write_headers(desk)])
    text = html.unescape(client.get("/start").text)
    assert "<summary>Another campaign from its raw logs</summary>" in text
    assert re.search(r'<input name="folder" value="" list="folders"', text), "the folder itself has its campaign"
    listed = re.search(r'<datalist id="folders">(.*?)</datalist>', text)
    below = re.findall(r'value="([^"]+)"', listed[1] if listed else "")
    assert below == [str(lab / "raw"), str(lab / "second")], "no store"
    assert f"One elsewhere: <code>thermodata --store {desk.store_path} workbench FOLDER --write</code>" in text
    (lab / "raw" / "day1.csv").rename(lab / "second" / "raw" / "day1.csv")
    _, onward = finished(client, client.post("/task/draft", {"folder": "second"}).text)
    assert onward is not None
    assert "that only you can answer" in client.get(onward).text
    assert client.post("/task/draft", {"folder": "../.."}).status == 400


def test_who_only_reads_is_told_how_to_draft(made_lab: Path) -> None:
    text = client_of(made_lab)[0].get("/start").text
    assert 'name="folder"' not in text
    assert "or draft in a terminal: <code>thermodata" in text


def test_a_start_beside_stored_campaigns_names_them_and_leads_there(lab: Path, tmp_path: Path) -> None:
    """Where no campaign file lies in the folder that the workbench was started in, as above several campaigns."""
    client, desk = client_of(lab)
    assert "The store holds" not in client.get("/start").text
    above = lab / "small"
    above.mkdir()
    (lab / "campaign.yaml").rename(above / "campaign.yaml")
    store = Store(desk.store_path)
    for path, there in ((above / "campaign.yaml", True), (tmp_path / "elsewhere.yaml", False)):
        with store.write(views=False) as con:
            con.execute("update campaign set path = ?", [str(path)])
        text = client.get("/start").text
        assert "The store holds 1 campaign:" in text
        assert "Another campaign from its raw logs" in text
        assert ("/start?file=" in text) is there


def test_columns_have_their_units_and_those_of_one_unit_an_axis(reader: Client) -> None:
    text = reader.get(
        "/sql?q=" + quote("select t_s, dZ, T_bearing, T_hall from aligned('small', 'heat1', '60 s')")
    ).text
    assert "t_s [s]</th>" in text
    assert "dZ [µm]</th>" in text
    assert "T_bearing [°C]</th>" in text
    chart = json.loads(re.search(r'id="sqlplot">(.*?)</script>', text)[1])
    assert [(p["title"], p["unit"]) for p in chart["panels"]] == [("dZ", "um"), ("T_bearing, T_hall", "degC")]
    text = reader.get("/sql?q=" + quote("select channel, value from temperature limit 5")).text
    assert "value [°C]</th>" in text


def test_what_fails_is_answered_with_what_the_command_says(reader: Client) -> None:
    said = reader.get("/sql?q=" + quote("select nonsense from test")).text
    assert "<p>Try: test.test is its name; thermodata sql &#34;describe test&#34; lists its columns</p>" in said
