"""Whether a text is Japanese, Korean or Chinese in an encoding of its own, by the words that it holds.

Bytes of one such encoding mostly decode in the others too, into characters that make no words: '時刻' of cp932 is
'帪崗' in gb18030. So an encoding is taken where its text holds words of a machine tool's log, and no other's holds any.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache

ENCODINGS = ("cp932", "euc-jp", "gb18030", "big5", "cp949")

# what stands in names of signals, in pieces that also stand within longer words. Of kana and Hangul, words of two
# syllables are of other bytes in each encoding; hiragana and katakana stand at the same bytes in euc-jp and gb18030.
_KANA = """
モータ ベアリング スピンドル コラム テーブル ベッド ナット ねじ ネジ クーラント チラー ポンプ ファン オイル ワーク
ギヤ ギア ボール タンク プローブ センサ スケール サドル ラム リニア ガイド ヘッド フロント リア トルク アンプ ドライブ
サーボ サンプ データ データロガー チャンネル チャネル フロア カバー ノズル フィルタ エア エアー ユニット ブラケット
シリンダ ドア プログラム オーバライド オン オフ ハウジング クロスレール パレット トータル リターン タイム スピード
アンペア ロード 送り 戻り 往き 入り口 伸び たわみ 傾き すべり アナログ ステップ パルス コメント ステータス ケーシング
スリーブ クランプ ベンダー グラフテック モデル バージョン サンプリング トリガ レンジ スパン アラーム メーカ シリアル
"""
_JAPANESE = """
時刻 日付 日時 時間 経過 温度 主軸 軸受 変位 熱変位 回転 速度 回転数 電流 電圧 電力 負荷 室温 油温 水温 気温 外気
雰囲気 周囲 室内 機内 機械 工場 床面 天井 前部 後部 上部 下部 左側 右側 前側 後側 中央 入口 出口 油圧 作動油 潤滑 冷却
冷却水 冷却油 切削 切削液 切削油 研削 加工 加工室 工具 工作物 治具 流量 圧力 湿度 日射 日射量 送り速度 位置 座標 角度
抵抗 状態 運転 停止 異常 正常 電源 出力 動力 巻線 電動機 制御 制御盤 電装 配電盤 測定 計測 試験 番号 名称 単位 備考
基準 基礎 案内面 支柱 主軸頭 主軸台 減速機 歯車 空気 圧縮 空圧 振動 加速度 荷重 開閉 指令 目標 設定 補正 最大 最小
平均 旋回 傾斜 直動 間隔 総データ 点数 開始 終了 信号 信号名 入力 型式 形式
"""
_CHINESE = """
时间 日期 时刻 温度 主轴 轴承 位移 热位移 转速 速度 进给 进给速度 电流 电压 功率 电机 电动机 负载 室温 油温 水温 气温
环境 环境温度 车间 机床 床身 立柱 工作台 丝杠 滚珠丝杠 螺母 导轨 横梁 滑枕 溜板 主轴箱 齿轮箱 减速箱 冷却 冷却液
切削液 冷却水 冷水机 油冷机 水箱 油箱 液压 液压油 润滑 流量 压力 湿度 辐照 日照 位置 坐标 角度 电阻 状态 运行 停止
报警 正常 异常 开关 打开 关闭 前端 后端 前轴承 后轴承 上部 下部 左侧 右侧 前侧 后侧 中间 顶部 底部 进口 出口 入口 回水
供水 进水 出水 刀具 工件 夹具 传感器 测点 通道 序号 编号 单位 备注 数据 采集 采样 测量 试验 控制柜 电柜 伺服 驱动 空气
压缩空气 振动 加速度 风扇 转台 摆头 定子 转子 绕组 外壳 地面 热误差 误差 补偿 程序 倍率 最大 最小 平均 设定 目标 实际
直线 旋转 倾斜 時間 時刻 主軸 軸承 熱位移 轉速 進給 電流 電壓 馬達 電機 負載 環境 環境溫度 溫度 室溫 油溫 水溫 氣溫
廠房 機台 機床 床台 工作檯 螺桿 滾珠 滾珠螺桿 螺帽 導軌 橫樑 鞍座 主軸箱 主軸頭 齒輪箱 冷卻 冷卻液 冷卻水 冷卻機
油冷機 液壓 油壓 潤滑 壓力 濕度 座標 電阻 狀態 運轉 警報 異常 開關 後端 前軸承 後軸承 左側 右側 前側 後側 中間 頂部
進口 進水 夾具 感測器 序號 編號 單位 備註 資料 採樣 測量 測試 試驗 控制箱 電控箱 驅動 空氣 壓縮空氣 振動 風扇 轉台
旋轉 熱誤差 誤差 補償 程式 設定 目標 實際 直線 傾斜
"""
_KOREAN = """
시간 시각 날짜 일시 온도 주축 베어링 변위 열변위 회전 회전수 속도 이송 이송속도 전류 전압 전력 동력 출력 부하 모터
권선 볼스크류 볼나사 너트 컬럼 칼럼 베드 테이블 헤드 스핀들 하우징 가이드 안내면 기어 감속기 냉각 냉각수 냉각기 절삭유
칠러 쿨런트 탱크 유압 유압유 작동유 윤활 오일 유온 수온 실내 실외 외기 대기 기온 주변 환경 공장 바닥 천장 상부 하부
상단 하단 전면 후면 전방 후방 전단 후단 좌측 우측 중앙 내부 외부 입구 출구 공급 리턴 유량 압력 습도 일사 일사량 위치
좌표 각도 기울기 저항 상태 운전 정지 정상 이상 켜짐 꺼짐 열림 닫힘 공구 공작물 소재 지그 센서 채널 번호 단위 비고
데이터 측정 시험 제어 제어반 전장 서보 드라이브 공압 압축공기 공기 진동 가속도 하중 도어 펌프 회전축 기계 장비 가공
가공실 설정 목표 지령 실제 최대 최소 평균 프로그램
"""
_LIMIT = 128 * 1024  # of a file's bytes
_LINES = 400
_SHARE = 0.5  # of a text's letters that stand in words
_MOST_OF_OTHER = 0.25  # of that share in any other encoding
_FEWEST = 4  # letters, in two words
_LETTERS = re.compile("[\u3040-\u30ff\u3400-\u9fff\uac00-\ud7a3\uf900-\ufaff]+")
_HIGH = re.compile(rb"[\x80-\xff]")


@cache
def _words(encoding: str) -> re.Pattern[str]:
    """The words of the languages that an encoding is for, the longest first."""
    own = {
        "cp932": _KANA + _JAPANESE,
        "euc-jp": _KANA + _JAPANESE,
        "gb18030": _CHINESE,
        "big5": _CHINESE,
        "cp949": _KOREAN,
    }[encoding].split()
    return re.compile("|".join(sorted(set(own), key=lambda w: (-len(w), w))))


def _lines(data: bytes) -> Iterator[bytes]:
    """The whole lines that hold more than ASCII, each once."""
    part = data[:_LIMIT]
    whole = part[: part.rfind(b"\n") + 1] or part
    seen: set[bytes] = set()
    for line in whole.split(b"\n"):
        # of rows, only what is no number counts: a column of words is the same in each
        if _HIGH.search(line) and line not in seen:
            seen.add(line)
            yield line
            if len(seen) == _LINES:
                return


def _decoded(lines: list[bytes], encoding: str) -> str | None:
    try:
        return "\n".join(line.decode(encoding) for line in lines)
    except UnicodeDecodeError:
        return None


def _share_in_words(text: str, encoding: str) -> tuple[float, tuple[str, ...]]:
    """(the share of a text's letters that stand in words, the words)."""
    letters = set(_LETTERS.findall(text))
    count = sum(map(len, letters))
    found = [w for run in sorted(letters) for w in _words(encoding).findall(run)]
    return (sum(map(len, found)) / count if count else 0.0), tuple(dict.fromkeys(found))


def east_asian(data: bytes) -> tuple[str, tuple[str, ...]] | None:
    """(encoding, the words that tell) of a text that surely is in one of `ENCODINGS`; None where it is in none, or may
    be in two."""
    lines = list(_lines(data))
    texts = {name: text for name in ENCODINGS if lines and (text := _decoded(lines, name)) is not None}
    told = sorted(((*_share_in_words(text, name), name) for name, text in texts.items()), reverse=True)
    if not told:
        return None
    share, words, name = told[0]
    second = told[1][0] if len(told) > 1 else 0.0
    enough = len(words) > 1 and sum(map(len, words)) >= _FEWEST and share >= _SHARE
    return (name, words) if enough and second <= _MOST_OF_OTHER * share else None
