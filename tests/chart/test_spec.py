from __future__ import annotations

import base64
import json
from typing import Any

import numpy as np
import pytest

from thermodata.chart import Axis, Band, Chart, HeatMap, Marks, Panel, Row, Series, Span, Strip, asset, script, style
from thermodata.chart.pack import exactly, packed, script_json
from thermodata.errors import ThermodataError


def unpacked(column: dict[str, Any]) -> np.ndarray:
    """As data.js does it."""
    if "n" in column:
        return column["start"] + column["step"] * np.arange(column["n"])
    if "u2" in column:
        codes = np.frombuffer(base64.b64decode(column["u2"]), "<u2")
        return np.where(codes == 65535, np.nan, column["low"] + column["step"] * codes)
    key = next(k for k in column if k in ("f4", "f8"))
    return np.frombuffer(base64.b64decode(column[key]), "<" + key)


def chart() -> Chart:
    t = np.arange(100) / 10
    y = np.sin(t)
    y[40:50] = np.nan
    return Chart(
        "Displacement of <test>",
        Axis("time", "h"),
        t,
        [
            Panel(
                "dZ",
                "um",
                [Series("measured", "um", y, "measured", band=Band(y - 1, y + 1, "95 %"))],
                marks=[Marks("dZ", "um", t[:3], y[:3], ["flag-spike"] * 3, ["spike", "spike", "held"])],
            ),
            Strip(Series("speed", "rpm", np.where(t > 5, 9000.0, 0.0), "lane", style="area"), "speed"),
        ],
        spans=[Span(1.0, 2.0, "weak", "6 um", "feed on", 1, (0,))],
        rows=[Row("dZ", [(1.0, 2.0, "flag-held", "held")])],
    )


@pytest.mark.parametrize("coarse", [False, True])
def test_a_column_comes_back_with_its_gaps(coarse: bool) -> None:
    values = np.concatenate([np.linspace(-40, 60, 500), [np.nan, 3.0]])
    back = unpacked(packed(values, coarse))
    assert np.array_equal(np.isnan(back), np.isnan(values))
    assert np.nanmax(np.abs(back - values)) <= (100 / 65534 if coarse else 1e-5)


@pytest.mark.parametrize("values", [[np.nan, np.nan], [7.0, 7.0, np.nan], []])
def test_columns_without_a_span_come_back_too(values: list[float]) -> None:
    back = unpacked(packed(np.array(values), coarse=True))
    assert np.array_equal(back, np.array(values), equal_nan=True)


def test_times_keep_all_their_digits() -> None:
    even = 1.77e9 + np.arange(1000) * 0.1
    uneven = np.sort(1.77e9 + np.random.default_rng(0).random(1000))
    assert exactly(even)["n"] == 1000
    assert np.abs(unpacked(exactly(even)) - even).max() < 1e-6
    assert np.array_equal(unpacked(exactly(uneven)), uneven)


def test_a_chart_is_plain_json_that_no_script_element_can_be_ended_with() -> None:
    text = script_json(chart().as_json(coarse=True))
    assert "<" not in text
    back = json.loads(text)
    assert back["about"] == "Displacement of <test>"
    assert back["panels"][1]["strip"]
    assert back["panels"][0]["series"][0]["band"]["label"] == "95 %"
    assert back["panels"][0]["marks"][0]["reasons"] == ["spike", "held"]
    assert back["panels"][0]["marks"][0]["reason"] == [0, 0, 1]
    assert back["spans"][0] == {
        "from": 1.0,
        "to": 2.0,
        "kind": "weak",
        "label": "6 um",
        "reason": "feed on",
        "rank": 1,
        "panels": [0],
    }


def test_small_values_on_a_logarithmic_axis_are_not_rounded_away() -> None:
    y = np.logspace(-6, 3, 50)
    spec = Chart(
        "", Axis("f", "Hz", scale="log"), y, [Panel("psd", "um2/Hz", [Series("a", "um", y, "model")], scale="log")]
    )
    back = unpacked(spec.as_json(coarse=True)["panels"][0]["series"][0]["y"])
    assert np.abs(back / y - 1).max() < 1e-6


def test_a_heat_map_keeps_its_scale() -> None:
    values = np.full((2, 5), 3.0)
    values[1, 3] = np.nan
    made = HeatMap("", Axis("t", "h"), "um", ["a", "b"], values, [5, 4], 0.0, 1.0, 16.0).as_json()
    assert made["limit"] == 16.0
    assert np.isnan(unpacked(made["values"])[8])


def test_the_files_of_a_page() -> None:
    assert "uPlot" in script()
    assert "--c-effect-6" in style()
    assert "MIT License" in asset("uplot/LICENSE")
    with pytest.raises(ThermodataError, match=r"chart\.js"):
        asset("chart.jss")
    # what a policy without 'unsafe-eval' and 'unsafe-inline' refuses, and what would ask a network
    for name in ("data.js", "paint.js", "readout.js", "chart.js", "heatmap.js", "mount.js"):
        for never in (
            "eval(",
            "new Function",
            "innerHTML",
            'setAttribute("style"',
            "fetch(",
            "XMLHttpRequest",
            "http",
            "script>",
        ):
            assert never not in asset(name), (name, never)


def test_the_language_is_mended_before_anything_asks_for_it() -> None:
    """uPlot formats by `navigator.language` as it loads, and fails as a whole where that is none (LANG=C)."""
    text = script()
    assert 0 <= text.index("new Intl.NumberFormat(navigator.language)") < text.index("uPlot")


@pytest.mark.parametrize(("label", "curves", "height"), [(None, 2, 110), (None, 16, 13 * 16 + 16), ("", 16, 110)])
def test_a_panel_is_high_enough_for_the_labels_of_its_lines(label: str | None, curves: int, height: int) -> None:
    series = [Series(f"t{k}", "degC", np.zeros(3), "measured", label=label) for k in range(curves)]
    assert Panel("temperatures", "degC", series, height=110).height == height
