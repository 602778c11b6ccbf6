"""The scalings that a file declares, applied when the raw layer becomes the tidy layer.

NI scalings go through npTDMS itself, so that the result equals what npTDMS gives to the last bit. npTDMS only
logs a warning on a scale type that it doesn't know and hands back the raw counts; here that is refused.
"""

from __future__ import annotations

import re
import warnings
from collections.abc import Mapping
from types import SimpleNamespace
from typing import Any

import numpy as np

from thermodata.errors import CalibrationError, ThermodataError
from thermodata.plugin import Array, Float1D, Scaling

NI_SCALE_TYPES = (
    "AdvancedAPI",
    "Add",
    "Linear",
    "Polynomial",
    "RTD",
    "Strain",
    "Subtract",
    "Table",
    "Thermistor",
    "Thermocouple",
)
_TYPE_KEY = re.compile(r"^NI_Scale\[(\d+)\]_Scale_Type$")
_SOURCE_KEY = re.compile(r"^NI_Scale\[(\d+)\]_\w*Input_Source$")
_RAW_INPUT = 0xFFFFFFFF
_MOST_SCALES = 200  # a damaged count must not become a huge allocation

Raw = Array | Mapping[int, Array]


def apply_scaling(scaling: Scaling | None, raw: Raw, *, channel: str | None = None) -> Float1D:
    """The scaled values, shape (n,), float64; a reading that the scaling cannot take (an RTD far out of its
    range) is NaN.

    raw: shape (n,); for a DAQmx channel with several raw scalers (a thermocouple and its cold junction) a
    mapping scaler number -> shape (n,), a structured array whose fields end in that number, or shape (n, k)
    in the order of `scaler_ids`. Raises CalibrationError for an unknown or malformed scaling.
    """
    if scaling is None:
        return _unscaled_numbers(raw, channel)
    if scaling.kind == "linear":
        gain, offset = (_number(scaling, key, default, channel) for key, default in (("gain", 1.0), ("offset", 0.0)))
        return _unscaled_numbers(raw, channel) * gain + offset
    check_scaling(scaling, channel=channel)
    scale = _ni(scaling)
    if scale is None:  # status "scaled": the file holds scaled values
        return _unscaled_numbers(raw, channel)
    data, scalers = _inputs(scaling, raw, channel)
    # npTDMS adds raw integers in their own width, where 200 + 100 is 44, and cuts what it makes of them to integers
    data, scalers = None if data is None else _wide(data), {k: _wide(v) for k, v in scalers.items()}
    n = len(data) if data is not None else len(next(iter(scalers.values())))
    return _scale(scale, data, scalers, np.arange(n), channel) if n else np.empty(0)


def check_scaling(scaling: Scaling | None, *, channel: str | None = None) -> None:
    """Refuses, without any data, a scaling that apply_scaling could not apply. Raises CalibrationError."""
    if scaling is None:
        return
    if scaling.kind == "linear":
        for key in ("gain", "offset"):
            _number(scaling, key, 0.0, channel)
        return
    if scaling.kind != "ni":
        raise _refusal(f"unknown kind of scaling '{scaling.kind}'", channel, "linear, ni", str(scaling.kind))
    properties = scaling.properties
    count = _count(properties)
    if not 0 <= count <= _MOST_SCALES:
        raise _refusal("NI scaling with an impossible number of scales", channel, f"at most {_MOST_SCALES}", str(count))
    if properties.get("NI_Scaling_Status", "unscaled") == "scaled":
        return
    for index in range(count):
        kind = properties.get(f"NI_Scale[{index}]_Scale_Type")
        if kind is not None and kind not in NI_SCALE_TYPES:
            raise _refusal(
                f"unknown NI scale type '{kind}' (NI_Scale[{index}])", channel, ", ".join(NI_SCALE_TYPES), str(kind)
            )
    _check_graph(properties, count, channel)
    try:
        _ni(scaling)
    except ThermodataError:
        raise
    except Exception as error:
        raise _refusal(
            f"malformed NI scaling: {type(error).__name__}: {error}",
            channel,
            "all of its properties",
            ", ".join(sorted(k for k in properties if k.startswith("NI_Scale")))[:300],
        ) from error


def scaler_ids(scaling: Scaling | None) -> tuple[int, ...]:
    """Numbers of the DAQmx raw scalers that an NI scaling reads, ascending; () where it reads plain raw data."""
    if scaling is None or scaling.kind != "ni":
        return ()
    return tuple(
        i
        for i in range(min(_count(scaling.properties), _MOST_SCALES))
        if f"NI_Scale[{i}]_Scale_Type" not in scaling.properties
    )


def _refusal(what: str, channel: str | None, expected: str, got: str) -> CalibrationError:
    return CalibrationError(
        what if channel is None else f"channel '{channel}': {what}",
        where=channel,
        expected=expected,
        got=got,
        hint="export the channel already scaled, or leave it out of the campaign file: raw counts are never "
        "passed for values",
    )


def _number(scaling: Scaling, key: str, default: float, channel: str | None) -> float:
    value = scaling.properties.get(key, default)
    if isinstance(value, bool) or not isinstance(value, int | float) or not np.isfinite(value):
        raise _refusal(f"linear scaling with {key} {value!r}", channel, "a finite number", repr(value))
    return float(value)


def _count(properties: Mapping[str, Any]) -> int:
    if "NI_Number_Of_Scales" in properties:
        try:
            return int(properties["NI_Number_Of_Scales"])
        except (TypeError, ValueError):
            return -1
    numbers = [int(m[1]) for m in map(_TYPE_KEY.match, properties) if m]
    return max(numbers) + 1 if numbers else 0


def _check_graph(properties: Mapping[str, Any], count: int, channel: str | None) -> None:
    """Every input is the raw data or an existing scale, and no scale feeds itself."""
    inputs: dict[int, set[int]] = {}
    for key, source in properties.items():
        match = _SOURCE_KEY.match(key)
        if not match or int(match[1]) >= count:
            continue
        if isinstance(source, bool) or not isinstance(source, int | np.integer):
            raise _refusal(f"NI scaling with input {source!r}", channel, "a scale's number", f"{key} = {source!r}")
        if int(source) != _RAW_INPUT:
            if not 0 <= int(source) < count:
                raise _refusal(
                    "NI scaling reads a scale that is not there", channel, f"0 to {count - 1}", f"{key} = {source}"
                )
            inputs.setdefault(int(match[1]), set()).add(int(source))
    settled: set[int] = set()
    while len(settled) < count:
        ready = {i for i in range(count) if i not in settled and inputs.get(i, set()) <= settled}
        if not ready:
            raise _refusal(
                "NI scaling feeds itself",
                channel,
                "a chain without a loop",
                f"scales {sorted(set(range(count)) - settled)}",
            )
        settled |= ready


def _ni(scaling: Scaling) -> Any:
    from nptdms.scaling import get_scaling

    # npTDMS fills below 0 degC afterwards what its square root leaves open
    warnings.filterwarnings("ignore", message="'where' used without 'out'", category=UserWarning)
    return get_scaling(scaling.properties, {}, {})


def _wide(raw: Array) -> Array:
    """Integers as float64; floats as they are, for npTDMS scales float32 in float32."""
    return raw.astype(np.float64) if raw.dtype.kind in "iub" else raw


def _unscaled_numbers(raw: Raw, channel: str | None) -> Float1D:
    if isinstance(raw, Mapping):
        if len(raw) != 1:
            raise _refusal("several raw scalers without an NI scaling", channel, "one raw array", f"{len(raw)}")
        raw = next(iter(raw.values()))
    if raw.dtype.kind not in "biuf":
        raise _refusal("raw values are not numbers", channel, "a number type", str(raw.dtype))
    return np.asarray(raw, dtype=np.float64)


def _inputs(scaling: Scaling, raw: Raw, channel: str | None) -> tuple[Array | None, dict[int, Array]]:
    """(plain raw data, scaler number -> data), as npTDMS keeps them."""
    ids = scaler_ids(scaling)
    scalers: dict[int, Array] = {}
    if isinstance(raw, Mapping):
        scalers = {int(k): np.asarray(v) for k, v in raw.items()}
    elif raw.dtype.names:
        scalers = {int(m[0]): raw[name] for name in raw.dtype.names if (m := re.search(r"\d+$", name))}
    elif raw.ndim == 2 and raw.shape[1] == len(ids):
        scalers = {i: raw[:, k] for k, i in enumerate(ids)}
    elif raw.ndim == 1 and len(ids) <= 1:
        return raw, dict.fromkeys(ids, raw)
    missing = [i for i in ids if i not in scalers]
    if missing or not scalers or len({len(v) for v in scalers.values()}) > 1:
        raise _refusal(
            f"NI scaling needs the raw scalers {list(ids)}",
            channel,
            "one equally long array for each",
            f"{sorted(scalers) or getattr(raw, 'shape', '')}",
        )
    return None, scalers


def _scale(scale: Any, data: Array | None, scalers: Mapping[int, Array], rows: Array, channel: str | None) -> Float1D:
    """Scales all rows in one call; where npTDMS raises (one broken wire spoils the block), halves the block
    until the rows at fault stand alone, and gives NaN for those."""
    whole = len(rows) == len(data if data is not None else next(iter(scalers.values())))
    view = SimpleNamespace(
        data=None if data is None else (data if whole else data[rows]),
        scaler_data={k: (v if whole else v[rows]) for k, v in scalers.items()},
    )
    try:
        with np.errstate(all="ignore"):
            return np.asarray(scale.scale(view), dtype=np.float64)
    except Exception as error:
        if not isinstance(error, ValueError | ArithmeticError | np.linalg.LinAlgError):
            got = f"{type(error).__name__}: {error}"
            raise _refusal("NI scaling fails", channel, "scales that npTDMS can apply", got) from error
        if len(rows) == 1:
            return np.array([np.nan])
        half = len(rows) // 2
        return np.concatenate([_scale(scale, data, scalers, part, channel) for part in (rows[:half], rows[half:])])
