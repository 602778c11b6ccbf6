"""Where heat comes from and where it goes: friction of bearings, nuts and guides, motors, air, coolant."""

from __future__ import annotations

import numpy as np

FloatND = np.ndarray[tuple[int, ...], np.dtype[np.float64]]

MEAN_DIAMETER_MM = 92.0
GREASE_FACTOR = 2.0
OIL_40C_MM2_S = 28.0
PRELOAD_N = 900.0


def viscosity_mm2_s(T: float) -> float:
    """Of the bearing's oil, falling with its temperature [degC] (Vogel's form)."""
    return OIL_40C_MM2_S * float(np.exp(880.0 / (T + 95.0) - 880.0 / 135.0))


def bearing_w(speed_rpm: float, T: float) -> float:
    """Heat of one spindle bearing: Palmgren's load-free torque and the torque of the preload."""
    if speed_rpm <= 0:
        return 0.0
    nu_n = max(viscosity_mm2_s(T) * speed_rpm, 2000.0)
    free_nmm = 1e-7 * GREASE_FACTOR * nu_n ** (2 / 3) * MEAN_DIAMETER_MM**3
    loaded_nmm = 3e-4 * PRELOAD_N * MEAN_DIAMETER_MM
    return float(1e-3 * (free_nmm + loaded_nmm) * 2 * np.pi * speed_rpm / 60)


def sliding_w(feed_m_min: float, coulomb_n: float, break_away_n: float, viscous_ns_m: float) -> float:
    """Heat of a nut or a guideway: Stribeck's friction force times speed."""
    v = abs(feed_m_min) / 60
    force = coulomb_n + (break_away_n - coulomb_n) * np.exp(-((v / 0.02) ** 2)) + viscous_ns_m * v
    return float(force * v)


def motor_w(speed_rpm: float, cutting_kw: float) -> float:
    """Losses of the spindle's motor: iron with its frequency, copper with the square of its torque."""
    if speed_rpm <= 0:
        return 0.0
    torque = 9550 * (cutting_kw + 0.3) / max(speed_rpm, 100.0)
    return float(190.0 * (speed_rpm / 4000) ** 1.4 + 0.11 * min(torque, 90.0) ** 2)


def forced_cubed(air_speed: float) -> float:
    """The cube of what forced convection gives alone, at an air speed [m/s]."""
    return float((6.2 * air_speed**0.8) ** 3)


def film_of(T: FloatND, air: FloatND | float, forced: FloatND | float, size_m: float = 0.5) -> FloatND:
    """Heat transfer of a wall to the hall [W/m2/K], of any shape: free and forced convection, and radiation.

    The free part grows with the fourth root of the difference (laminar plate), the forced one with the speed of the
    air to 0.8, and they add as cubes, as textbooks of heat transfer have it. forced: of `forced_cubed`.
    """
    free = 1.4 * np.sqrt(np.sqrt(np.abs(T - air) / size_m + 1e-6))
    radiated = 4 * 0.6 * 5.67e-8 * ((T + air) / 2 + 273.15) ** 3
    return np.asarray(np.cbrt(free**3 + forced) + radiated)
