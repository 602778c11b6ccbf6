"""Mutants of the rules that decide a verdict, a check of a fit, a calibration or a clock."""

from __future__ import annotations

from mutant import Mutant

# the tests that stand beside the rules of a module
BESIDE = {
    "answer.py": ("the_answer", "the_locked_tests"),
    "artefact.py": ("steps",),
    "candidates.py": ("candidates",),
    "commanded.py": ("steps",),
    "confirm.py": ("the_locked_tests",),
    "evidence.py": ("evidence",),
    "investigate.py": ("investigation", "logging_faults"),
    "judge.py": ("the_verdict",),
    "logging_faults.py": ("logging_faults",),
    "cross_validation.py": ("left_out_tests",),
    "next_test.py": ("what_is_shown",),
    "problem.py": ("compression", "ranking"),
    "rank.py": ("ranking",),
    "unexplained.py": ("what_is_shown",),
    "weak.py": ("what_is_shown",),
    "whiten.py": ("ranking",),
}
CHECKS = ("tests/modelling/test_rules_of_checks.py",)
CALIBRATION = ("tests/calibration/test_rules_of_jump_checks.py", "tests/calibration/test_rules_of_clocks.py")


def diagnosis(file: str, old: str, new: str, why: str) -> Mutant:
    tests = tuple(f"tests/diagnosis/test_rules_of_{topic}.py" for topic in BESIDE[file])
    return Mutant(f"thermodata/diagnosis/{file}", old, new, why, tests)


def heat(file: str, old: str, new: str, why: str) -> Mutant:
    tests = ("tests/diagnosis/test_missing_heat.py", "tests/diagnosis/test_goes_with.py")
    return Mutant(f"thermodata/diagnosis/{file}", old, new, why, tests)


def check(old: str, new: str, why: str) -> Mutant:
    return Mutant("thermodata/modelling/checks.py", old, new, why, CHECKS)


def calibration(file: str, old: str, new: str, why: str) -> Mutant:
    return Mutant(f"thermodata/calibration/{file}", old, new, why, CALIBRATION)


MUTANTS = [
    # ---- evidence
    diagnosis("evidence.py", "P_LIMIT = 0.02", "P_LIMIT = 0.9", "chance is claimed as a cause"),
    diagnosis("evidence.py", "TESTS_LIMIT = 0.7", "TESTS_LIMIT = 0.0", "one test alone carries a claim"),
    diagnosis("evidence.py", "\nDROP_LIMIT = 0.3", "\nDROP_LIMIT = 0.1", "a claim hardly lowers the error"),
    diagnosis(
        "evidence.py", "FAMILY_DROP_LIMIT = 0.5", "FAMILY_DROP_LIMIT = 0.3", "a twin of a known effect is claimed"
    ),
    diagnosis("evidence.py", "SHARP_WHITE_DROP = 0.3", "SHARP_WHITE_DROP = 0.1", "slow proxies pass as sharp"),
    diagnosis("evidence.py", "SHARP_DROP_LIMIT = 0.15", "SHARP_DROP_LIMIT = 0.05", "sharp trifles are claimed"),
    diagnosis(
        "evidence.py", "\nREMAINDER_LIMIT = 0.5", "\nREMAINDER_LIMIT = 0.9", "a proxy that leaves most is claimed"
    ),
    diagnosis("evidence.py", "NEAR_REMAINDER_LIMIT = 0.6", "NEAR_REMAINDER_LIMIT = 0.8", "proxies near the floor"),
    diagnosis("evidence.py", "NEAR_FLOORS = 1.5", "NEAR_FLOORS = 3.0", "proxies near the floor"),
    diagnosis("evidence.py", "PAIR_LIMIT = 0.35", "PAIR_LIMIT = 0.6", "two effects are claimed that leave most"),
    diagnosis("evidence.py", "FLOOR_SHARE = 0.7", "FLOOR_SHARE = 1.0", "slow proxies at the floor"),
    diagnosis("evidence.py", "STRONG_DROP = 0.65", "STRONG_DROP = 0.4", "claims where there is nothing to explain"),
    diagnosis("evidence.py", "SHARE_LIMIT = 0.03", "SHARE_LIMIT = 0.0", "trifles are claimed"),
    diagnosis("evidence.py", "SMALL_SHARE = 0.1 ", "SMALL_SHARE = 0.3 ", "a real error is left alone"),
    diagnosis("evidence.py", "NOISE_TIMES = 5.0", "NOISE_TIMES = 2.0", "noise is explained"),
    diagnosis("evidence.py", "if scored.white_drop <= 0:", "if scored.white_drop < -1:", "slow shapes pass as causes"),
    diagnosis(
        "evidence.py", "sse_after < scored.sse_before", "sse_after <= scored.sse_before", "no change counts as better"
    ),
    diagnosis(
        "evidence.py", "if scored.candidate.placeless:", "if False:", "a sensor without a place is never claimed"
    ),
    # ---- verdict
    diagnosis("judge.py", "if len(problem.blocks) < 2:", "if len(problem.blocks) < 1:", "one test makes a claim"),
    diagnosis("judge.py", "TRIED = 3 ", "TRIED = 9 ", "late candidates are claimed"),
    diagnosis("judge.py", "PAIRS_TRIED = 2", "PAIRS_TRIED = 1", "the better pair is not looked for"),
    diagnosis("judge.py", "TWIN_COSINE = 0.9 ", "TWIN_COSINE = 0.99 ", "twins are said to be told apart"),
    diagnosis("judge.py", "TWIN_SSE = 1.15", "TWIN_SSE = 1.0", "twins are said to be told apart"),
    diagnosis("judge.py", "TWIN_SSE_COSINE = 0.6", "TWIN_SSE_COSINE = 0.2", "strangers are said to be twins"),
    diagnosis("judge.py", "SIMPLER_SSE = 1.05", "SIMPLER_SSE = 2.0", "a worse candidate is claimed for being simple"),
    diagnosis("judge.py", "if rmse <= measure.floor:", "if rmse < 0:", "'none' is never said"),
    diagnosis("judge.py", "and not is_proxy(simplest(good), measure)", "", "a proxy is claimed"),
    diagnosis("judge.py", "if both.second is not None and ", "if ", "one effect is claimed as two"),
    diagnosis(
        "judge.py", "key=lambda item: item[1].left", "key=lambda item: -item[1].left", "the worse pair is claimed"
    ),
    # ---- locked tests
    diagnosis("confirm.py", "MUST_FALL = 0.02", "MUST_FALL = -9.0", "locked tests never withdraw a claim"),
    diagnosis(
        "confirm.py",
        "before, after = self.shape_before, self.shape_after",
        "before, after = self.before, self.after",
        "one unlucky zero withdraws a claim",
    ),
    diagnosis("confirm.py", "p - p.mean() if free and len(p) else p", "p", "one unlucky zero withdraws a claim"),
    diagnosis("confirm.py", '"verify_on": [], ', "", "verification tests are no part of the choice"),
    diagnosis("confirm.py", "deciding = both.responses[index]", "deciding = theirs", "a true pair is withdrawn"),
    diagnosis("answer.py", "if confirmation.holds or judgement.claimed is None:", "if True:", "a refuted claim stands"),
    diagnosis(
        "answer.py",
        "if judgement.claimed is not None:\n        locked =",
        "if True:\n        locked =",
        "locked tests are opened without a claim",
    ),
    diagnosis(
        "answer.py", "return int(np.argmax(left))", "return int(np.argmin(left))", "the best response is diagnosed"
    ),
    # ---- ranking
    diagnosis("rank.py", "2 * min(raw_p, white_p)", "min(raw_p, white_p)", "two looks at one question count once"),
    diagnosis(
        "rank.py", "np.sum(top_raw >= s.drop)", "np.sum(top_raw > s.drop)", "chance that does as well is not counted"
    ),
    diagnosis("rank.py", "SURROGATES = 199", "SURROGATES = 19", "p cannot fall below its limit"),
    diagnosis("rank.py", "PRIOR_SAMPLES = 30.0", "PRIOR_SAMPLES = 1.0", "gains are fitted to noise"),
    diagnosis("rank.py", "BASE_SHARE = 1.0", "BASE_SHARE = 9.0", "known effects run away in unseen tests"),
    diagnosis("rank.py", "SLACK_SHARE = 0.5", "SLACK_SHARE = 5.0", "known effects explain the missing one"),
    diagnosis("rank.py", "LARGEST_TIMES = 3.0", "LARGEST_TIMES = 30.0", "huge terms that cancel"),
    diagnosis(
        "rank.py",
        "float(by_raw[i] + by_white[i] + 0.01 * by_raw[i])",
        "float(by_raw[i])",
        "the order is that of the fall alone",
    ),
    diagnosis(
        "cross_validation.py",
        "gain = np.clip(gain, priors.lower[:, None], priors.upper[:, None])",
        "pass",
        "implausible gains, wrong signs",
    ),
    diagnosis("cross_validation.py", "+ np.diag(self.noise_var / priors.spread**2)", "", "gains are not drawn to zero"),
    diagnosis(
        "cross_validation.py",
        "Moments(*(_of_the_others(m) for m in moments))",
        "Moments(*(np.broadcast_to(m.sum(axis=0), m.shape) for m in moments))",
        "the left-out test is seen",
    ),
    diagnosis("cross_validation.py", "gram + self.price + 1e-6", "gram + 1e-6", "slack is free"),
    diagnosis("whiten.py", "ORDER = 3", "ORDER = 1", "inertia is left in what is whitened"),
    diagnosis("whiten.py", "shuffled -= shuffled.mean(axis=0)", "", "surrogates have an offset"),
    # ---- what is asked for
    diagnosis("candidates.py", "BEYOND = 1.5", "BEYOND = 15.0", "implausible gains"),
    diagnosis("candidates.py", '0.0 if g.sign == "+" else -b', "-b", "effects act the wrong way"),
    diagnosis(
        "candidates.py",
        "SLACK_FACTORS = (0.2, 5.0)",
        "SLACK_FACTORS = (0.9, 1.1)",
        "a distributed machine is a missing effect",
    ),
    diagnosis("candidates.py", "or names in lagged:", "or False:", "what the model lags already is claimed by name"),
    diagnosis(
        "candidates.py", "if candidate.refines and not any", "if candidate.refines and any", "refinements of nothing"
    ),
    diagnosis("candidates.py", "if not covered.issuperset(g.channels)", "", "lags rival named effects"),
    diagnosis("problem.py", "MIN_ROWS = 10", "MIN_ROWS = 1", "a test of one sample is left out in turn"),
    diagnosis("problem.py", "FEW_TESTS = 3", "FEW_TESTS = 9", "parts of one test pass as tests"),
    diagnosis("problem.py", "PART_ROWS = 100", "PART_ROWS = 10", "parts too short to tell anything"),
    diagnosis("problem.py", "* 1.4826 / np.sqrt(6.0)", "* 1.4826", "the noise is too large, the floor too high"),
    diagnosis("investigate.py", "- {GENERIC}", "", "a plain lag counts as a known family"),
    diagnosis("investigate.py", "for s in others[:TRIED] if", "for s in others if", "late second effects are claimed"),
    diagnosis(
        "investigate.py", "_error_of(asked_about, tests)", "_error_of(fitted, tests)", "wrong parameters go unnoticed"
    ),
    diagnosis(
        "investigate.py",
        'faults if judgement.verdict == "none" else',
        "faults if True else",
        "a missing effect passes as a wrong gain",
    ),
    diagnosis("investigate.py", "and s != home", "", "the response's own clock is suspected"),
    diagnosis(
        "investigate.py",
        "[p - p.mean() for p in parts if len(p)]",
        "parts",
        "an unlucky zero passes as wrong parameters",
    ),
    diagnosis(
        "problem.py",
        "base, slack = (\n                [block.base, own * scale]",
        "base, slack = (\n                [block.base]",
        "the second effect is the first one",
    ),
    # ---- faults of the logs
    diagnosis("logging_faults.py", "CLOCK_DROP = 0.4", "CLOCK_DROP = 0.05", "sound clocks are suspected"),
    diagnosis(
        "logging_faults.py", "inside = abs(best) < max(SHIFTS_S)", "inside = True", "slow effects pass as clocks"
    ),
    diagnosis("logging_faults.py", "ALL_DROP = 0.5", "ALL_DROP = 0.05", "sound probes are turned"),
    diagnosis("logging_faults.py", "LEAST_FIT = 60.0", "LEAST_FIT = 0.0", "a poor model speaks of the logs"),
    diagnosis(
        "logging_faults.py", "        tests.mend(i, factor)\n", "        pass\n", "sound tests are blamed for one"
    ),
    diagnosis("logging_faults.py", "GAIN_OFF = 0.15", "GAIN_OFF = 0.01", "sound gains are suspected"),
    diagnosis(
        "logging_faults.py", "    0.9  # a factor must", "    0.2  # a factor must", "missing effects pass as gains"
    ),
    diagnosis("logging_faults.py", "NOISES = 5.0", "NOISES = 0.0", "noise passes as a wrong gain"),
    diagnosis("logging_faults.py", "MISFIT_TIMES = 3.0", "MISFIT_TIMES = 1.0", "sound parameters are suspected"),
    diagnosis("logging_faults.py", "LEAST_TESTS = 4", "LEAST_TESTS = 2", "the wrong one of three is turned"),
    diagnosis("artefact.py", "Z_LIMIT = 12.0", "Z_LIMIT = 3.0", "noise is a slip"),
    diagnosis("artefact.py", "tread + max(", "0 * tread + max(", "treads are slips"),
    diagnosis("artefact.py", "WITHIN = 0.8", "WITHIN = 0.5", "what takes minutes is a slip"),
    diagnosis("artefact.py", "SHARP = 0.4", "SHARP = 0.0", "steep rises are slips"),
    diagnosis("artefact.py", "LEAST_UM = 0.5", "LEAST_UM = 0.0", "trifles are slips"),
    diagnosis("commanded.py", "COMMAND_S = 600.0", "COMMAND_S = 0.0", "shifts of a late clock are slips"),
    diagnosis("commanded.py", "HOLE_STEPS = 1.6", "HOLE_STEPS = 99.0", "what nobody saw is a slip"),
    diagnosis("commanded.py", "MOVED = 0.2", "MOVED = 0.9", "small commands explain nothing"),
    diagnosis("commanded.py", "POWERS = (1, 2)", "POWERS = (1,)", "centrifugal shifts are slips"),
    diagnosis("commanded.py", "FORETOLD = 0.2", "FORETOLD = 0.0", "a pump that cycles excuses every slip"),
    diagnosis("commanded.py", "ALIKE = 0.15", "ALIKE = 0.9", "a shift among others is a slip"),
    diagnosis("commanded.py", "ELSEWHERE_S = 1200.0", "ELSEWHERE_S = 0.0", "a slip excuses itself"),
    diagnosis("commanded.py", "bool(own.hole[i]) and", "False and", "what nobody logged is a slip"),
    Mutant(
        "thermodata/calibration/tread.py",
        "max(FINER, held - FINER)",
        "held",
        "half a tread passes for one",
        ("tests/calibration/test_tread.py",),
    ),
    Mutant(
        "thermodata/calibration/quality_value.py",
        "_BACK = 0.3",
        "_BACK = 0.0",
        "what comes back by itself is an offset",
        ("tests/calibration/test_quality.py",),
    ),
    # ---- what is shown
    diagnosis("weak.py", "STANDS_OUT = 1.3", "STANDS_OUT = 1.0", "every second window is weak"),
    diagnosis("weak.py", "3.0 * noise if", "0.0 * noise if", "noise is weak"),
    diagnosis("weak.py", "spots.sort(key=lambda w: -w.sse)", "", "the worst does not come first"),
    diagnosis("unexplained.py", "0.8 * len(means)", "0.1 * len(means)", "any hour of the day stands out"),
    diagnosis("unexplained.py", "len(means) >= 3 and", "len(means) >= 1 and", "one day is a rhythm"),
    diagnosis("unexplained.py", "< np.exp(-1)", "< 0.9", "time constants far too short"),
    diagnosis("next_test.py", "ENOUGH_TESTS = 8", "ENOUGH_TESTS = 99", "more of the same is advised for ever"),
    diagnosis(
        "next_test.py",
        "if t.candidate.effect.name != mine.effect.name",
        "",
        "the same effect is to be told from itself",
    ),
    # ---- the heat that is missing
    heat(
        "missing_heat.py", "KNOWN_SPREAD = 0.3", "KNOWN_SPREAD = 0.003", "what the known effects took is kept by them"
    ),
    heat("missing_heat.py", "KNOWN_SPREAD = 0.3", "KNOWN_SPREAD = 300.0", "the known effects take what is missing"),
    heat("missing_heat.py", "LEAVES = 0.1", "LEAVES = 0.001", "a distributed body has a time constant far too short"),
    heat("missing_heat.py", "ONE_SIDED = 0.55", "ONE_SIDED = 0.0", "a drift heats in one direction"),
    heat("missing_heat.py", "CHANGE = 0.05", "CHANGE = 50.0", "noise has a source, for changes cost nothing"),
    heat(
        "missing_heat.py", "one_way=sign != 0)\n        changes", "one_way=False)\n        changes", "heat is negative"
    ),
    heat("missing_heat.py", "(part % 2 != turn) | (part == 0)", "part >= 0", "what was seen counts as predicted"),
    heat("one_way.py", "(q > 0) | (slope < -1e-9 * largest)", "(q > 0)", "a source that rests never starts"),
    heat("goes_with.py", "ON_WITH, MORE_OFTEN = 0.8, 0.25", "ON_WITH, MORE_OFTEN = 0.7, 0.25", "half a companion"),
    heat("goes_with.py", "ON_WITH, MORE_OFTEN = 0.8, 0.25", "ON_WITH, MORE_OFTEN = 0.8, -1.0", "chance is a companion"),
    heat("goes_with.py", "OFF_WITH, NO_OFTENER = 0.6, 0.3", "OFF_WITH, NO_OFTENER = 0.7, 0.5", "causes are ruled out"),
    heat("goes_with.py", "FOLLOWS, FOLLOWS_NOT = 0.7, 0.3", "FOLLOWS, FOLLOWS_NOT = 0.6, 0.4", "halves are followed"),
    heat("goes_with.py", "STRONG, WEAK = 0.5, 0.15", "STRONG, WEAK = 0.4, 0.2", "tests are strong and absent too soon"),
    heat(
        "goes_with.py",
        "DAYS, MOST_DAYS, MOSTLY_ON = 3, 0.8, 0.6",
        "DAYS, MOST_DAYS, MOSTLY_ON = 2, 0.5, 0.9",
        "any hour",
    ),
    heat("first_seen.py", "SURE = 0.8", "SURE = 0.5", "a coin's direction is told as sure"),
    # ---- checks of a fit
    check("CONDITION = 1000.0", "CONDITION = 1e9", "effects that can't be told apart go unnoticed"),
    check("COLLINEAR = 0.98", "COLLINEAR = 1.0", "twins go unnoticed"),
    check("if abs(correlation[a, b]) > COLLINEAR", "if correlation[a, b] > COLLINEAR", "mirrored twins go unnoticed"),
    check("FEWEST = 5.0", "FEWEST = 1.0", "fits to a few independent samples pass"),
    check("AT_BOUND = 1e-3", "AT_BOUND = 1e-9", "parameters at their bounds go unnoticed"),
    check("if value > record:", "if value > 9 * record:", "time constants beyond the record pass"),
    check("abs(value) > top", "value > top", "implausible negative gains pass"),
    check("LAGS_APART = 1.5", "LAGS_APART = 1.0", "lags that are one pass as two"),
    check("UNSURE = 1.0", "UNSURE = 99.0", "lags that nothing tells pass"),
    check("RIPPLE = 1.0", "RIPPLE = 99.0", "quantisation of a sensor reaches the prediction"),
    # ---- calibrations and clocks
    calibration("jump_checks.py", "DATA_SHEET_PCT = 10.0", "DATA_SHEET_PCT = 90.0", "the wrong probe passes"),
    calibration("jump_checks.py", "UNCERTAINTY_PCT = 5.0", "UNCERTAINTY_PCT = 50.0", "poor calibrations pass"),
    calibration(
        "jump_checks.py", "NONLINEARITY_PCT = 2.0", "NONLINEARITY_PCT = 20.0", "a probe out of its range passes"
    ),
    calibration("jump_checks.py", "100.0 * abs(fit.drift_um)", "100.0 * fit.drift_um", "negative drift passes"),
    calibration("jump_checks.py", "NOISE_PCT = 5.0", "NOISE_PCT = 50.0", "noisy jumps pass"),
    calibration("jump_checks.py", "CROSSTALK_PCT = 10.0", "CROSSTALK_PCT = 100.0", "misaligned probes pass"),
    calibration("jump_checks.py", "answers[most] < 100.0,", "True,", "swapped cables pass"),
    calibration(
        "jump_checks.py",
        "0.4 * spec.dwell <= dwell <= 2.5",
        "0.0 * spec.dwell <= dwell <= 99",
        "other steps pass as the moves",
    ),
    calibration("jump_checks.py", "smallest = min(", "smallest = max(", "noise against the largest move"),
    calibration(
        "clock.py", "_LEAST_CORRELATION = 0.8", "_LEAST_CORRELATION = 0.2", "clocks of logs that don't look alike"
    ),
    calibration("clock.py", "_RIVAL = 0.97", "_RIVAL = 1.1", "a periodic programme sets the clock"),
    calibration("clock.py", "_LEAST_OVERLAP = 0.25", "_LEAST_OVERLAP = 0.01", "a chance overlap sets the clock"),
    calibration("clock.py", "_LEAST_EVENTS = 2", "_LEAST_EVENTS = 1", "one event sets the clock"),
    calibration("clock.py", "abs(slope) > 4 * error", "abs(slope) > 0 * error", "scatter is a drift"),
    calibration("clock_refine.py", "_LEAST_CORRELATION = 0.7", "_LEAST_CORRELATION = 0.0", "noise tells a lag"),
    calibration(
        "clock_refine.py", "_NEAR_THE_END = 0.98", "_NEAR_THE_END = 9.0", "a lag at the end of the search is believed"
    ),
    calibration("clock_events.py", "_MOST_PPM = 500.0", "_MOST_PPM = 1e9", "mixed-up events set the clock"),
    calibration("clock_events.py", "_MOST_OFF_S = 30.0", "_MOST_OFF_S = 1e9", "mixed-up events set the clock"),
    calibration("clock_events.py", "_LEAST_SPAN_S = 3600.0", "_LEAST_SPAN_S = 60.0", "typing errors are a drift"),
]
