"""Long tables whose tag alone does not name what is measured."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from thermodata_reader_cnc.opcua import long_table
from thermodata_reader_cnc.opcua.row_units import number_and_unit

from thermodata.errors import FormatError
from thermodata.reader.text.cells.values.status import BAD

from .logs import read_long, stamp, values

N = 40


@pytest.mark.parametrize("label", ["device", "host", "machine", "keller", "messung"])
@pytest.mark.parametrize("apart_s", [0, 2])
def test_sensors_of_one_name_on_two_devices_are_two_channels(tmp_path: Path, label: str, apart_s: int) -> None:
    rows = [f"{stamp(5 * k + apart_s * d)},mc{d},T_bed,{20 + 10 * d + k / 8}" for k in range(N) for d in (0, 1)]
    data = read_long(tmp_path, f"timestamp,{label},sensor,value", rows)
    found = values(data)
    assert set(found) == {"mc0/T_bed", "mc1/T_bed"}
    for d in (0, 1):
        own = np.array(found[f"mc{d}/T_bed"])
        assert set(own[~np.isnan(own)]) == {20 + 10 * d + k / 8 for k in range(N)}
    assert not data.losses


def test_devices_that_stand_one_behind_the_other_are_channels_of_their_own(tmp_path: Path) -> None:
    rows = [f"{stamp(k)},{where},T,{10 * d + k / 8}" for d, where in enumerate(("unten", "oben")) for k in range(N)]
    found = values(read_long(tmp_path, "time,lage,tag,value", rows))
    assert found == {"unten/T": [k / 8 for k in range(N)], "oben/T": [10 + k / 8 for k in range(N)]}


def test_the_name_of_a_measurement_gives_way_to_the_names_of_its_fields(tmp_path: Path) -> None:
    rows = [f"temperatures,{stamp(k)},M1,{f},{k + v}" for k in range(N) for v, f in enumerate(("front", "rear"))]
    data = read_long(tmp_path, "name,time,machine,field,value", rows)
    assert values(data) == {"front": [float(k) for k in range(N)], "rear": [k + 1.0 for k in range(N)]}
    rows = [f"{name},{stamp(k)},M1,x,{k + v}" for k in range(N) for v, name in enumerate(("bed", "hall"))]
    assert set(values(read_long(tmp_path, "name,time,machine,field,value", rows))) == {"bed/x", "hall/x"}


def test_statistics_of_a_sensor_are_channels(tmp_path: Path) -> None:
    rows = [f"{stamp(k)},T,{s},{k + v}" for k in range(N) for v, s in enumerate(("avg", "min", "max"))]
    assert set(values(read_long(tmp_path, "time,tag,stat,value", rows))) == {"T/avg", "T/min", "T/max"}


def test_a_word_that_says_how_the_machine_was_is_no_part_of_a_name(tmp_path: Path) -> None:
    rows = [f"{stamp(k)},T{t},{'warm' if k < N // 2 else 'cold'},{k + t},REAL" for k in range(N) for t in (1, 2)]
    found = values(read_long(tmp_path, "time,tag,remark,value,dataType", rows))
    assert found == {"T1": [k + 1.0 for k in range(N)], "T2": [k + 2.0 for k in range(N)]}


def test_a_device_that_the_first_look_did_not_meet_is_a_loss(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(long_table, "_LOOK", 1000)
    rows = [f"{stamp(k)},mc1,T,{k}" for k in range(3000)]
    rows[200] = f"{stamp(200)},mc2,T,7"
    data = read_long(tmp_path, "time,device,tag,value", rows)
    assert set(values(data)) == {"T"}
    assert 7 not in values(data)["T"][190:210]
    assert [loss.where for loss in data.losses] == ["long.csv line 202"]
    assert "mc2/T" in data.losses[0].reason


def test_all_values_under_one_coarse_stamp_are_kept(tmp_path: Path) -> None:
    rows = [f"2026-03-02 08:00:{k // 4:02d},{tag},{k + v}" for k in range(N) for v, tag in enumerate(("T", "rpm"))]
    data = read_long(tmp_path, "time,tag,value", rows)
    assert values(data) == {"T": [float(k) for k in range(N)], "rpm": [k + 1.0 for k in range(N)]}
    assert np.diff(data.t_ns["nc"]).tolist() == [0 if k % 4 else 10**9 for k in range(1, N)]


def test_columns_of_numbers_beside_the_value_are_said(tmp_path: Path) -> None:
    rows = [f"{stamp(k)},T{t},{k},{k + 0.5},5" for k in range(N) for t in (1, 2)]
    data = read_long(tmp_path, "time,tag,value,raw,span", rows)
    assert data.recording.notes == ("not read, beside the value: 'raw'",)


@pytest.mark.parametrize(
    ("header", "row"),
    [
        ("time,measurement,machine,field,value", "{ms},temp,M1,{tag},{v}"),
        ("time,field,value", "{ms},{tag},{v}"),
        ("time,field,value", "{ms}000,{tag},{v}"),
        ("name,time,field,value", "temp,{ms}000000,{tag},{v}"),
        ("L1Name,updatedate,enddate,timespan,signalname,value", "M1,{us} AM,{us} AM,5,{tag},{v}"),
        ("Tag,Time,Value", "{tag},{pi},{v}"),
    ],
)
def test_the_headers_of_further_exports(tmp_path: Path, header: str, row: str) -> None:
    first = np.datetime64("2026-07-16T08:00:00", "ms").astype(int)
    rows = [
        row.format(
            ms=first + k * 1000,
            us=f"07/16/2026 08:00:{k:02d}",
            pi=f"16-Jul-26 08:00:{k:02d}",
            tag=tag,
            v=k + v / 2,
        )
        for k in range(N)
        for v, tag in enumerate(("T1", "T2"))
    ]
    data = read_long(tmp_path, header, rows)
    assert values(data) == {"T1": [float(k) for k in range(N)], "T2": [k + 0.5 for k in range(N)]}
    assert data.t_ns["nc"].tolist() == [(first + k * 1000) * 1_000_000 for k in range(N)]


def test_a_month_by_name_between_two_numbers_that_goes_through_years_is_asked(tmp_path: Path) -> None:
    rows = [f"T,02-Mar-{k:02d} 08:00:00,{k}" for k in range(1, 25)]
    with pytest.raises(FormatError):
        read_long(tmp_path, "Tag,Time,Value", rows)


def test_the_count_of_rows_that_ends_an_export_of_wincc_is_no_loss(tmp_path: Path) -> None:
    rows = [f'"{tag}";"22.10.2026 07:{k:02d}:00";{21 + k / 8};1;{k}' for k in range(N) for tag in ("T_vorn", "n_Ist")]
    header = '"VarName";"TimeString";"VarValue";"Validity";"Time_ms"'
    data = read_long(tmp_path, header, [*rows, f'"$RT_COUNT$";{2 * N};;;;'])
    assert set(values(data)) == {"T_vorn", "n_Ist"}
    assert data.losses == ()
    assert any("'$RT_COUNT$'" in note for note in data.recording.notes)
    damaged = read_long(tmp_path, header, [*rows, '"T_vorn";5965;;;;'])
    assert len(damaged.losses) == 1


def test_the_history_of_home_assistant_is_taken_apart_by_entity(tmp_path: Path) -> None:
    rows = []
    for k in range(N):
        rows.append(f"sensor.hall_temp,{20 + k / 8},{stamp(k)}")
        rows.append(f"sensor.hall_hum,{45 + k},{stamp(k + 0.3)}")
        if k % 10 == 0:
            rows.append(f"binary_sensor.door,{'on' if k % 20 else 'off'},{stamp(k + 0.6)}")
    data = read_long(tmp_path, "entity_id,state,last_changed", rows)
    found = values(data)
    assert set(found) == {"sensor.hall_temp", "sensor.hall_hum", "binary_sensor.door"}
    assert set(found["sensor.hall_temp"]) == {20 + k / 8 for k in range(N)}
    assert {str(v) for v in found["binary_sensor.door"]} == {"None", "on", "off"}
    assert not data.losses


def test_a_state_beside_a_name_is_no_value(tmp_path: Path) -> None:
    rows = [f"{stamp(k)},M1,{'run' if k < N // 2 else 'stop'},{20 + k / 8}" for k in range(N)]
    path = tmp_path / "a.csv"
    path.write_text("\n".join(["time,name,state,T", *rows, ""]))
    assert long_table.claims(path.read_text().splitlines()) is None


@pytest.mark.parametrize(
    ("header", "unit"),
    [
        ("Zeit,Kanal,Wert,Kanal,Wert", False),
        ("time,channel1,value1,channel2,value2", False),
        ("time,tag,value,unit,tag,value,unit", True),
    ],
)
def test_several_names_and_values_of_a_row_are_told_apart_by_the_names(tmp_path: Path, header: str, unit: bool) -> None:
    def row(k: int) -> str:
        pairs = [("T_front", 20 + k / 8), ("T_rear", 10 + k / 8)][:: 1 if k < N // 2 else -1]
        return f"{stamp(k)}," + ",".join(f"{n},{v}" + (",degC" if unit else "") for n, v in pairs)

    data = read_long(tmp_path, header, [row(k) for k in range(N)])
    assert values(data) == {"T_front": [20 + k / 8 for k in range(N)], "T_rear": [10 + k / 8 for k in range(N)]}
    assert not data.losses
    assert not any("not read" in note for note in data.recording.notes)
    assert {s.unit for s in data.recording.signals} == {"degC" if unit else None}


def test_a_row_may_hold_fewer_of_its_names_and_values(tmp_path: Path) -> None:
    rows = [f"{stamp(k)},T_front,{20 + k / 8}" + (f",T_rear,{10 + k / 8}" if k % 2 else ",,") for k in range(N)]
    data = read_long(tmp_path, "time,tag,value,tag,value", rows)
    assert values(data)["T_front"] == [20 + k / 8 for k in range(N)]
    assert values(data)["T_rear"][1::2] == [10 + k / 8 for k in range(1, N, 2)]
    assert not data.losses


def test_numbers_of_channels_before_values_are_no_names() -> None:
    rows = [f"{stamp(k)},{k},{20 + k / 8},{2 * k},{10 + k / 8}" for k in range(N)]
    assert long_table.claims(["time,channel1,value1,channel2,value2", *rows]) is None


def test_a_cell_of_blanks_is_answered_at_once() -> None:
    """The pattern takes the square of its letters: a minute of 100,000 blanks."""
    assert number_and_unit("1" + " " * 100_000 + "x") is None
    assert number_and_unit("1 234,5 rpm") == (1234.5, "rpm")


@pytest.mark.parametrize("columns", ["status,severity", "severity"])
def test_a_severity_of_epics_flags_values_and_parts_no_series(tmp_path: Path, columns: str) -> None:
    rows = list[str]()
    for k in range(N):
        bad = 20 <= k < 25
        said = ("READ", "INVALID") if bad else ("NO_ALARM", "MINOR" if k % 7 == 0 else "NO_ALARM")
        for name in ("T_bed", "T_air"):
            told = said if name == "T_bed" else ("NO_ALARM", "NO_ALARM")
            rows.append(f"{name},{stamp(k)},{20 + k / 8},{','.join(told[-len(columns.split(',')) :])}")
    data = read_long(tmp_path, f"name,time,value,{columns}", rows)
    assert set(values(data)) == {"T_bed", "T_air"}
    assert {key[1]: np.flatnonzero(f & BAD).tolist() for key, f in data.flags.items() if (f & BAD).any()} == {
        "T_bed": [20, 21, 22, 23, 24]
    }


def test_a_severity_of_messages_flags_nothing(tmp_path: Path) -> None:
    rows = [f"{stamp(k)},T_bed,{20 + k / 8},{'WARNING' if k == 5 else 'INFO'}" for k in range(N)]
    data = read_long(tmp_path, "time,name,value,severity", rows)
    assert not any((f & BAD).any() for f in data.flags.values())
