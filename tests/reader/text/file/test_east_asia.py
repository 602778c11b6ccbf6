"""Text in the legacy encodings of East Asia: read where words tell which, asked where they don't, never mojibake."""

from __future__ import annotations

import pytest

from thermodata.errors import FormatError
from thermodata.reader.text import decode
from thermodata.reader.text.file.east_asia import east_asian
from thermodata.reader.text.file.encoding import decode_head, find_encoding

_JAPANESE = [
    "時刻,①変位Z(μm),②主軸前部軸受温度(℃),№3 室温(℃)",
    "日付,時刻,主軸モータ巻線温度(℃),チラー給水温度(℃),X軸モータ温度(℃)",
    "経過時間(s),Z軸ボールねじナット温度(℃),テーブル軸受温度(℃)",
    "日時;主軸回転数(rpm);X軸送り速度(mm/min);主軸動力(kW)",
    "時間\t室温\t機内温度\t作動油温度",
    "測定時刻,コラム前面温度,コラム後面温度,ベッド温度",
    "時刻,クーラントタンク温度,制御盤温度,日射量",
    "年月日,変位X,変位Y,変位Z,主軸頭温度",
    "時刻,C軸回転数,A軸モータ温度,クーラントON,油圧ポンプON",
    "サンプル時刻,工具温度(赤外),ワーク温度,治具温度",
    "時刻,スピンドル温度,スピンドル負荷",
    "時間(min),周囲温度,床温度,天井付近温度",
]
_CHINESE = [
    "时间,主轴前轴承温度(℃),主轴后轴承温度(℃),主轴转速(rpm)",
    "日期,时间,X向位移(μm),Z向位移(μm)",
    "采样时间;丝杠螺母温度;电机温度;环境温度",
    "时间\t立柱前温度\t立柱后温度\t床身温度",
    "序号,时间,冷却液温度,液压油温度,主轴功率",
    "时刻,车间温度,车间湿度,工作台轴承温度",
    "时间,进给速度X,进给速度Y,主轴电流",
    "测量时间,热位移X,热位移Y,热位移Z",
    "时间(s),水箱温度,回水温度,供水温度",
    "日期时间,主轴箱温度,导轨温度,电柜温度",
]
_TAIWANESE = [
    "時間,主軸前軸承溫度(℃),主軸後軸承溫度(℃),主軸轉速(rpm)",
    "日期,時間,X向位移(μm),Z向位移(μm)",
    "取樣時間;螺桿螺帽溫度;馬達溫度;環境溫度",
    "時間\t立柱前溫度\t立柱後溫度\t床身溫度",
    "序號,時間,冷卻液溫度,液壓油溫度,主軸功率",
    "時刻,廠房溫度,廠房濕度,工作台軸承溫度",
    "時間,進給速度X,進給速度Y,主軸電流",
    "測量時間,熱位移X,熱位移Y,熱位移Z",
    "時間(s),水箱溫度,回水溫度,供水溫度",
    "日期時間,主軸頭溫度,導軌溫度,控制箱溫度",
]
_KOREAN = [
    "시간,변위X(um),변위Z(um),주축 전방 베어링 온도(℃)",
    "날짜,시각,주축모터 온도(℃),주축 회전수(rpm)",
    "시간;X축 이송속도;Z축 볼스크류 너트 온도;테이블 베어링 온도",
    "측정시간\t컬럼 전면 온도\t컬럼 후면 온도\t베드 온도",
    "시간,냉각수 ON,냉각수 탱크 온도,실내 온도",
    "일시,유압유 온도,주축 동력,C축 회전수",
    "시간,가공실 온도,제어반 온도,일사량",
    "경과시간(s),열변위 X,열변위 Y,열변위 Z",
    "번호,시간,주축 부하,스핀들 전류",
    "시간,칠러 공급 온도,칠러 리턴 온도",
]
_ROWS = "\n" + "".join(f"2026/03/02 08:00:{k:02d},0.{k:02d},20.{k % 9},22.0\n" for k in range(60))
HEADERS = [
    *((line, "cp932") for line in _JAPANESE),
    *((line, "euc-jp") for line in _JAPANESE if not set("①②№") & set(line)),
    *((line, "gb18030") for line in _CHINESE),
    *((line, "big5") for line in _TAIWANESE),
    *((line, "cp949") for line in _KOREAN),
]


@pytest.mark.parametrize(("header", "encoding"), HEADERS)
def test_a_header_of_east_asia_is_read_by_its_words(header: str, encoding: str) -> None:
    data = (header + _ROWS).encode(encoding)
    text, found, note = decode(data)
    assert (text.split("\n")[0], found) == (header, encoding)
    assert f"read as {encoding}" in (note or "")
    assert (decode_head(data) or "").startswith(header)


@pytest.mark.parametrize("encoding", ["cp932", "euc-jp", "gb18030", "big5", "cp949"])
def test_words_that_are_none_of_a_log_are_asked(encoding: str) -> None:
    word = {"gb18030": "梦想花园", "big5": "夢想花園", "cp949": "가나다라마바"}.get(encoding, "桜吹雪春眠")
    data = (f"{word},{word[::-1]}" + _ROWS).encode(encoding)
    assert east_asian(data) is None
    with pytest.raises(FormatError, match="does not name") as error:
        decode(data)
    assert "cp932" in str(error.value)
    assert "shift_jis" not in str(error.value)
    shown = (decode_head(data) or "").split("\n")[0]
    assert all(c.isascii() or c == "\ufffd" for c in shown)


@pytest.mark.parametrize(
    ("text", "encoding"),
    [
        ("Čas;Ložisko přední;Otáčky vřetene", "cp1250"),
        ("Temps;Pièce arrière;Débit", "cp1252"),
        ("Zeit;Spindellager vorne;Öltemperatur;Kühlung", "cp1252"),
        ("Время;Температура шпинделя", "cp1251"),
        ("Tid;Kjøling;Måling;Væske", "cp1252"),
    ],
)
def test_text_of_europe_is_none_of_east_asia(text: str, encoding: str) -> None:
    assert east_asian((text + _ROWS).encode(encoding)) is None


@pytest.mark.parametrize("encoding", ["cp932", "euc-jp"])
def test_a_head_of_a_japanese_logger_tells_by_its_own_words(encoding: str) -> None:
    head = "ベンダー,グラフテック\nモデル,GL840\nバージョン,Ver1.30\nサンプリング間隔,5s\n総データ点数,720\n"
    more = "開始時刻,2026/02/12,11:00:00\nトリガ時刻,\n"
    more += "CH,信号名,入力,レンジ,フィルタ,スパン\n番号,日付 時刻,ms,CH1,アラーム1\n"
    for text in (head, head + more):
        told = east_asian((text + _ROWS).encode(encoding))
        assert told is not None
        assert told[0] == encoding


def test_what_shift_jis_lacks_is_answered_with_cp932() -> None:
    data = (_JAPANESE[0] + _ROWS).encode("cp932")
    with pytest.raises(FormatError, match="does not decode") as error:
        decode(data, "shift_jis")
    assert "cp932" in (error.value.hint or "")
    assert find_encoding(data)[0] == "cp932"
