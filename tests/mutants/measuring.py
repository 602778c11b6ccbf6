"""Mutants of the rules that decide a check of a fit, a calibration, a clock or whether a sensor can be read."""

from __future__ import annotations

from mutant import Mutant

CHECKS = ("tests/modelling/test_rules_of_checks.py",)
CALIBRATION = ("tests/calibration/test_rules_of_jump_checks.py", "tests/calibration/test_rules_of_clocks.py")


def check(old: str, new: str, why: str, file: str = "of_every_fit.py") -> Mutant:
    return Mutant(f"thermodata/modelling/trust/checks/{file}", old, new, why, CHECKS)


def calibration(file: str, old: str, new: str, why: str) -> Mutant:
    return Mutant(f"thermodata/calibration/{file}", old, new, why, CALIBRATION)


def constant(old: str, new: str, why: str) -> Mutant:
    return Mutant("thermodata/modelling/inputs/drivers.py", old, new, why, ("tests/modelling/test_usable.py",))


def starts(old: str, new: str, why: str) -> Mutant:
    tests = ("tests/calibration/test_quality_starts.py",)
    return Mutant("thermodata/calibration/between_tests/starts.py", old, new, why, tests)


MUTANTS = [
    # ---- sensors that are off
    constant("if tree.logical:", "if False:", "a limit that the sensor is off by is read as it stands"),
    constant("ALIKE = 1e-6", "ALIKE = 1e9", "a product with a sensor that is off is read as it stands"),
    constant("ALIKE = 1e-6", "ALIKE = -1.0", "a difference loses the test for a number that goes out"),
    # ---- checks of a fit
    check("CONDITION = 1000.0", "CONDITION = 1e9", "effects that can't be told apart go unnoticed"),
    check("COLLINEAR = 0.98", "COLLINEAR = 1.0", "twins go unnoticed"),
    check("if abs(correlation[a, b]) > COLLINEAR", "if correlation[a, b] > COLLINEAR", "mirrored twins go unnoticed"),
    check("FEWEST = 5.0", "FEWEST = 1.0", "fits to a few independent samples pass"),
    check("AT_BOUND = 1e-3", "AT_BOUND = 1e-9", "parameters at their bounds go unnoticed", "bound_checks.py"),
    check("if value > record:", "if value > 9 * record:", "time constants beyond the record pass", "term_checks.py"),
    check("abs(value) * there", "value * there", "implausible negative gains pass", "bound_checks.py"),
    check("LAGS_APART = 1.5", "LAGS_APART = 1.0", "lags that are one pass as two", "term_checks.py"),
    check("UNSURE = 1.0", "UNSURE = 99.0", "lags that nothing tells pass", "term_checks.py"),
    check("RIPPLE = 1.0", "RIPPLE = 99.0", "quantisation of a sensor reaches the prediction", "term_checks.py"),
    # ---- calibrations and clocks
    starts("LEAST_K = 8.0", "LEAST_K = 10.0", "a sensor that is off by 9 K passes"),
    starts("_in_company(name, at, before, i, sign)]", "False]", "a machine that was warmed up fails"),
    starts("+ COOLS_K:", "+ 99.0:", "a motor that cools is a sensor that fails"),
    starts("sum(map(_comes_back, after)) < LEAST_AFTER", "False", "a motor that is heated further fails"),
    starts("_fastest(after, usual) >= SLOWER * known", "False", "a motor that cools as ever, and was warm, fails"),
    starts("_fastest(after, new) >= AS_FAST * known", "True", "a motor that never rests is a sensor that fails"),
    starts("+ ALIKE_K", "+ 10 * ALIKE_K", "what is warm by another time each day fails"),
    starts("if name not in found}", "}", "one that fails hides the next one"),
    calibration("jump/checks.py", "DATA_SHEET_PCT = 10.0", "DATA_SHEET_PCT = 90.0", "the wrong probe passes"),
    calibration("jump/checks.py", "UNCERTAINTY_PCT = 5.0", "UNCERTAINTY_PCT = 50.0", "poor calibrations pass"),
    calibration(
        "jump/checks.py", "NONLINEARITY_PCT = 2.0", "NONLINEARITY_PCT = 20.0", "a probe out of its range passes"
    ),
    calibration("jump/checks.py", "100.0 * abs(fit.drift_um)", "100.0 * fit.drift_um", "negative drift passes"),
    calibration("jump/checks.py", "NOISE_PCT = 5.0", "NOISE_PCT = 50.0", "noisy jumps pass"),
    calibration("jump/checks.py", "CROSSTALK_PCT = 10.0", "CROSSTALK_PCT = 100.0", "misaligned probes pass"),
    calibration("jump/checks.py", "most[1] < 100.0,", "True,", "swapped cables pass"),
    calibration(
        "jump/checks.py",
        "DWELL[0] * declared <= dwell <= DWELL[1] *",
        "0.0 * declared <= dwell <= 99 *",
        "other steps pass as the moves",
    ),
    calibration("jump/checks.py", "smallest = min(", "smallest = max(", "noise against the largest move"),
    calibration(
        "clock/estimate.py",
        "_LEAST_CORRELATION = 0.8",
        "_LEAST_CORRELATION = 0.2",
        "clocks of logs that don't look alike",
    ),
    calibration("clock/estimate.py", "_RIVAL = 0.97", "_RIVAL = 1.1", "a periodic programme sets the clock"),
    calibration(
        "clock/estimate.py", "_LEAST_OVERLAP = 0.25", "_LEAST_OVERLAP = 0.01", "a chance overlap sets the clock"
    ),
    calibration("clock/estimate.py", "_LEAST_EVENTS = 2", "_LEAST_EVENTS = 1", "one event sets the clock"),
    calibration("clock/estimate.py", "abs(slope) > 4 * error", "abs(slope) > 0 * error", "scatter is a drift"),
    calibration("clock/refine.py", "_LEAST_CORRELATION = 0.7", "_LEAST_CORRELATION = 0.0", "noise tells a lag"),
    calibration(
        "clock/refine.py", "_NEAR_THE_END = 0.98", "_NEAR_THE_END = 9.0", "a lag at the end of the search is believed"
    ),
    calibration("clock/events.py", "_MOST_PPM = 500.0", "_MOST_PPM = 1e9", "mixed-up events set the clock"),
    calibration("clock/events.py", "_MOST_OFF_S = 30.0", "_MOST_OFF_S = 1e9", "mixed-up events set the clock"),
    calibration("clock/events.py", "_LEAST_SPAN_S = 3600.0", "_LEAST_SPAN_S = 60.0", "typing errors are a drift"),
]
