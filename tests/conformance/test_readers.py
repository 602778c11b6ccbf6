"""Our readers of TDMS, LVM and tables against the kit, on files made for it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from thermodata.plugin import Source
from thermodata.testing.reader import FILE_CHECKS, Case, Check, it_claims_no_file_of_another_format

PRAGUE = Source(timezone="Europe/Prague")
START = np.datetime64("2026-03-01T08:00:00", "ns")


def tdms(path: Path) -> Source:
    """Two groups, three segments, integers with a scaling, text, and a timestamp channel."""
    from nptdms import ChannelObject, GroupObject, RootObject, TdmsWriter

    rng = np.random.default_rng(0)
    wave = {"wf_start_time": START, "wf_increment": 0.1, "wf_start_offset": 0.0, "unit_string": "V"}
    scale = {
        "NI_Scaling_Status": "unscaled",
        "NI_Number_Of_Scales": 1,
        "NI_Scale[0]_Scale_Type": "Linear",
        "NI_Scale[0]_Linear_Slope": 0.01,
        "NI_Scale[0]_Linear_Y_Intercept": 0.0,
        "NI_Scale[0]_Linear_Input_Source": 0xFFFFFFFF,
    }
    with TdmsWriter(str(path)) as writer:
        for i in range(3):
            when = START + (np.arange(5) + 5 * i) * np.timedelta64(1, "s")
            writer.write_segment(
                [
                    RootObject({"operator": "měřič"}),
                    GroupObject("Eddy", {}),
                    ChannelObject("Eddy", "Z", rng.normal(size=20), properties=wave),
                    ChannelObject(
                        "Eddy", "Y", rng.integers(-99, 99, 20).astype(np.int16), properties={**wave, **scale}
                    ),
                    ChannelObject("Temp", "Time", when.astype("datetime64[us]")),
                    ChannelObject("Temp", "T01", rng.normal(size=5), properties={"unit_string": "Grd C"}),
                    ChannelObject("Temp", "state", [f"ok {k}" for k in range(5)]),
                ]
            )
    return Source()


def lvm(path: Path) -> Source:
    head = (
        "LabVIEW Measurement\t\nWriter_Version\t2\nSeparator\tTab\nDecimal_Separator\t,\nMulti_Headings\tNo\n"
        "X_Columns\tOne\nTime_Pref\tAbsolute\nDate\t2026/03/01\nTime\t08:00:00,5\n***End_of_Header***\t\n\t\n"
        "Channels\t2\t\t\nSamples\t1\t1\t\nDate\t2026/03/01\t2026/03/01\t\nTime\t08:00:00,5\t08:00:00,5\t\n"
        "Y_Unit_Label\tdegC\tµm\t\nX0\t0,0E+0\t0,0E+0\t\nDelta_X\t1,0\t1,0\t\n***End_of_Header***\t\t\t\n"
        "X_Value\tT1\tdZ\tComment\n"
    )
    rows = "".join(
        f"{i},000000\t{20 + i / 8:.6f}\t{-i / 4:.6f}\t{'OK' if i % 7 else 'LOST'}\n".replace(".", ",")
        for i in range(30)
    )
    path.write_bytes((head + rows).encode("cp1252"))
    return PRAGUE


def csv(path: Path) -> Source:
    head = "Měření teplot\nČas [s];T1 [°C];n (U/min);Bemerkung\n"
    rows = "".join(
        f"{10 * i};{20 + i / 8:.3f};{100 * i};{'ok' if i % 5 else ''}\n".replace(".", ",") for i in range(12)
    )
    path.write_bytes((head + rows).encode("cp1250"))
    return PRAGUE


def csv_dates(path: Path) -> Source:
    path.write_text(
        "time,T1 [degC],state\n" + "".join(f"2026-03-01 08:00:{i:02}.5,{20 + i / 8:.3f},s{i:03}\n" for i in range(10))
    )
    return PRAGUE


def parquet(path: Path) -> Source:
    import pyarrow as pa
    import pyarrow.parquet as pq

    n = 40
    pq.write_table(
        pa.table(
            {
                "time": START + np.arange(n) * np.timedelta64(1, "s"),
                "T1 [degC]": np.arange(n, dtype=np.float32),
                "count": np.arange(n, dtype=np.int16),
                "door": np.arange(n) % 2 == 0,
                "label": [f"x{i}" for i in range(n)],
            }
        ),
        path,
        row_group_size=11,
    )
    return PRAGUE


def xlsx(path: Path) -> Source:
    """The least workbook that there is, by hand."""
    import zipfile

    def cell(column: str, row: int, value: object) -> str:
        if isinstance(value, str):
            return f'<c r="{column}{row}" t="inlineStr"><is><t>{value}</t></is></c>'
        return f'<c r="{column}{row}"><v>{value}</v></c>'

    rows = [("時間(s) ", "ch1(um)", "note")] + [(15.0 * i, i / 8, "ok") for i in range(30)]
    body = "".join(
        f'<row r="{i}">{"".join(cell(c, i, v) for c, v in zip("ABC", row, strict=True))}</row>'
        for i, row in enumerate(rows, 1)
    )
    main = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
    relations = "http://schemas.openxmlformats.org/package/2006/relationships"
    office = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
    types = "application/vnd.openxmlformats-package.relationships+xml"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as book:
        book.writestr(
            "[Content_Types].xml",
            '<Types xmlns="http://schemas.openxmlformats.org/package/2006/'
            f'content-types"><Default Extension="rels" ContentType="{types}"/><Default Extension="xml" '
            'ContentType="application/xml"/></Types>',
        )
        book.writestr(
            "_rels/.rels",
            f'<Relationships xmlns="{relations}"><Relationship Id="r1" '
            f'Target="xl/workbook.xml" Type="{office}/officeDocument"/></Relationships>',
        )
        book.writestr(
            "xl/workbook.xml",
            f'<workbook xmlns="{main}" xmlns:r="{office}"><sheets>'
            '<sheet name="data" sheetId="1" r:id="r1"/></sheets></workbook>',
        )
        book.writestr(
            "xl/_rels/workbook.xml.rels",
            f'<Relationships xmlns="{relations}"><Relationship Id="r1" '
            f'Target="worksheets/sheet1.xml" Type="{office}/worksheet"/></Relationships>',
        )
        book.writestr(
            "xl/worksheets/sheet1.xml", f'<worksheet xmlns="{main}"><sheetData>{body}</sheetData></worksheet>'
        )
    return Source(table={"sheet": 1, "header_rows": 1, "time": {"column": 1, "unit": "s"}})


def mat(path: Path) -> Source:
    """Two times, integers, text, a struct, and a matrix with names."""
    import scipy.io

    n = 40
    t, names = np.arange(n)[:, None] * 0.5, np.array(["dZ [um]", "n [rpm]"], object)
    states = np.array([f"s{i}" for i in range(n)], object)[:, None]
    scipy.io.savemat(
        path,
        {
            "time": t,
            "names": names,
            "data": np.hstack([np.sin(t), np.cos(t)]),
            "state": states,
            "run": {"t": t[::4], "count": np.arange(10, dtype=np.int16)[:, None]},
        },
        do_compression=True,
    )
    return PRAGUE


def mat73(path: Path) -> Source:
    import h5py

    with h5py.File(path, "w", userblock_size=512) as file:
        for name, values in (("time", np.arange(40) * 0.5), ("T1", np.sin(np.arange(40)))):
            item = file.create_dataset(name, data=values[None, :], chunks=(1, 16), compression="gzip")
            item.attrs["MATLAB_class"] = np.bytes_("double")
    with path.open("r+b") as raw:
        raw.write(b"MATLAB 7.3 MAT-file, Platform: GLNXA64 HDF5 schema 1.00 .".ljust(116) + b"\0" * 8 + b"\x00\x02IM")
    return PRAGUE


def mdf(path: Path) -> Source:
    import asammdf

    t, invalid = np.arange(40) * 0.5, np.arange(40) % 9 == 3
    with asammdf.MDF(version="4.10") as file:
        file.append(
            [
                asammdf.Signal(np.sin(t), t, name="T1", unit="degC", invalidation_bits=invalid),
                asammdf.Signal(np.arange(40, dtype=np.int16), t, name="raw", conversion={"a": 0.1, "b": 2.0}),
            ]
        )
        file.append([asammdf.Signal(np.arange(9), np.arange(9) * 1.0, name="n", unit="rpm")])
        file.save(path, overwrite=True, compression=2)
    return PRAGUE


MAKERS: dict[str, tuple[str, Callable[[Path], Source]]] = {
    "a.tdms": ("crio", tdms),
    "a.lvm": ("crio", lvm),
    "a.csv": ("table", csv),
    "b.csv": ("table", csv_dates),
    "a.parquet": ("table", parquet),
    "a.xlsx": ("table", xlsx),
    "a.mat": ("table", mat),
    "b.mat": ("table", mat73),
    "a.mf4": ("table", mdf),
}
CLAIMS = {"crio": ("TDMS", "LVM"), "table": ("XLSX", "PARQUET", "CSV")}


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> dict[str, tuple[Path, Source]]:
    folder = tmp_path_factory.mktemp("readers")
    return {name: (folder / name, make(folder / name)) for name, (_, make) in MAKERS.items()}


def reader_class(name: str) -> type:
    import thermodata_reader_crio
    import thermodata_reader_table

    return {"crio": thermodata_reader_crio.Reader, "table": thermodata_reader_table.Reader}[name]


@pytest.mark.parametrize("check", FILE_CHECKS, ids=lambda c: c.__name__)
@pytest.mark.parametrize("name", MAKERS)
def test_reader_passes_the_kit(name: str, check: Callable[..., None], made: dict[str, tuple[Path, Source]]) -> None:
    reader = reader_class(MAKERS[name][0])
    Check(check, Case(reader, (made[name],), CLAIMS[MAKERS[name][0]], "block_rows"), made[name])()


@pytest.mark.parametrize("name", CLAIMS)
def test_reader_leaves_other_formats_alone(name: str) -> None:
    it_claims_no_file_of_another_format(Case(reader_class(name), (), CLAIMS[name]))
