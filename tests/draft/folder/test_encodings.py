"""A folder in an encoding of East Asia: drafted with it where words tell, by what somebody declared, or asked."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.commands import Say

_ROWS = "".join(f"2026/03/02 08:{k // 60:02d}:{k % 60:02d},0.{k % 90:02d},20.{k % 9},22.0\n" for k in range(200))
_JAPANESE = "日時,①変位Z(μm),②主軸前部軸受温度(℃),№3 室温(℃)\n"
_UNTOLD = "日時,桜(μm),吹雪(℃),春眠不覚暁処処聞啼鳥(℃)\n"


def _folder(folder: Path, header: str, encoding: str) -> Path:
    (folder / "raw").mkdir(parents=True)
    for test in ("t1", "t2"):
        (folder / "raw" / f"{test}.csv").write_bytes((header + _ROWS).encode(encoding))
    return folder


@pytest.mark.parametrize(
    ("header", "encoding"),
    [
        (_JAPANESE, "cp932"),
        (_JAPANESE.replace("①", "").replace("②", "").replace("№", ""), "euc-jp"),
        ("时间,Z向位移(μm),主轴前轴承温度(℃),车间温度(℃)\n", "gb18030"),
        ("時間,Z向位移(μm),主軸前軸承溫度(℃),廠房溫度(℃)\n", "big5"),
        ("시간,변위Z(um),주축 전방 베어링 온도(℃),실내 온도(℃)\n", "cp949"),
    ],
)
def test_what_words_tell_is_drafted_and_ingested(header: str, encoding: str, tmp_path: Path, say: Say) -> None:
    folder = _folder(tmp_path / "a", header, encoding)
    assert say("init", folder).code == 0
    draft = (folder / "campaign.yaml").read_text(encoding="utf-8")
    assert f"encoding: {encoding}}}" in draft
    assert "at: spindle.bearing.front" in draft
    assert say("--store", tmp_path / "store", "ingest", folder / "campaign.yaml").code == 0
    name = header.split(",")[2].split("(")[0]
    assert name in say("sniff", folder / "raw").out
    assert name in say("preview", folder / "raw" / "t1.csv").out


def test_what_words_do_not_tell_is_asked_and_what_is_declared_is_kept(tmp_path: Path, say: Say) -> None:
    folder = _folder(tmp_path / "a", _UNTOLD, "cp932")
    say("init", folder)
    file = folder / "campaign.yaml"
    drafted = file.read_text(encoding="utf-8")
    assert "cp932 or euc-jp (Japanese)" in drafted
    shown = say("sniff", folder / "raw").out
    assert "\x93" not in shown
    assert "“ú" not in shown
    assert "encoding: ?}" in drafted
    file.write_text(drafted.replace("  # log:", "  log:").replace("encoding: ?", "encoding: shift_jis"), "utf-8")
    assert say("init", folder, "--force").code == 0
    drafted = file.read_text(encoding="utf-8")
    assert "encoding: shift_jis}" in drafted
    assert "吹雪" in drafted


def test_a_folder_in_utf_8_declares_none(tmp_path: Path, say: Say) -> None:
    folder = _folder(tmp_path / "a", _JAPANESE, "utf-8")
    say("init", folder)
    assert "encoding" not in (folder / "campaign.yaml").read_text(encoding="utf-8")


def test_a_file_of_few_words_is_read_in_the_encoding_that_the_others_tell(tmp_path: Path, say: Say) -> None:
    folder = _folder(tmp_path / "a", _JAPANESE, "cp932")
    (folder / "gauge_Z.csv").write_bytes(("日時,桜(μm),吹雪(℃),春眠不覚暁処処聞啼鳥(℃)\n" + _ROWS).encode("cp932"))
    say("init", folder)
    draft = (folder / "campaign.yaml").read_text(encoding="utf-8")
    assert "gauge_Z.csv: reader" not in draft
    assert "吹雪" in draft
    assert draft.count("encoding: cp932") >= 1
