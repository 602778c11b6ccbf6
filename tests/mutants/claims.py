"""Mutants of the rules that decide a verdict."""

from __future__ import annotations

from pathlib import Path

from mutant import Mutant

ROOT = Path(__file__).resolve().parents[2]

# the tests that stand beside the rules of a module
BESIDE = {
    "artefact.py": ("steps", "steps_beside_commands", "steps_by_moves"),
    "candidate_effect.py": ("candidates", "unread_parts"),
    "of_library.py": ("candidates", "unread_parts"),
    "moves.py": ("clocks_in_part",),
    "sides.py": ("clocks_in_part",),
    "timings.py": ("clocks_by_commands", "clocks_in_part"),
    "by_commands.py": ("clocks_by_commands",),
    "as_modelled.py": ("what_is_modelled",),
    "by_heat.py": ("clocks_by_heat", "clocks_in_part"),
    "logs_compared.py": ("clocks_by_heat", "clocks_in_part"),
    "copies.py": ("copies",),
    "difference.py": ("a_difference",),
    "once.py": ("copies",),
    "compressed.py": ("compression", "investigation"),
    "commanded.py": ("steps", "clocks_by_heat", "steps_beside_commands", "steps_by_moves"),
    "known_beside.py": ("refinement", "what_the_air_warms"),
    "refinement.py": ("refinement", "what_the_air_warms"),
    "warm_at_rest.py": ("candidates", "what_the_air_warms"),
    "changes.py": ("steps", "clocks_by_heat", "steps_beside_commands", "steps_by_moves"),
    "places_that_tell.py": ("steps_by_moves",),
    "sudden.py": ("steps", "decays", "steps_beside_commands"),
    "repeating.py": ("repeated_steps",),
    "confirm.py": ("the_locked_tests",),
    "confirmation.py": ("the_locked_tests",),
    "chain.py": ("the_noise",),
    "discrepancy.py": ("the_noise",),
    "ends_of_logs.py": ("ends_of_logs",),
    "evidence.py": ("the_noise",),
    "foretold.py": ("the_locked_tests",),
    "heat_balance.py": ("clocks_by_heat",),
    "heat_sums.py": ("clocks_by_heat",),
    "investigate.py": ("investigation",),
    "faults.py": ("logging_faults",),
    "judge.py": ("the_verdict", "a_claim"),
    "beyond_noise.py": ("what_is_noise",),
    "kin.py": ("candidates",),
    "known.py": ("the_noise",),
    "known_effects.py": ("investigation", "refinement"),
    "errors_told.py": ("the_answer", "the_locked_tests"),
    "listed.py": ("the_answer", "the_locked_tests"),
    "stated.py": ("the_answer",),
    "on_locked.py": ("the_locked_tests", "investigation"),
    "logging_faults.py": ("logging_faults",),
    "loose.py": ("loose_sensors",),
    "exchanged.py": ("exchanged_sensors",),
    "temperature_sums.py": ("loose_sensors", "exchanged_sensors"),
    "measure.py": ("a_claim", "the_verdict"),
    "bare.py": ("unread_parts",),
    "feedback.py": ("feedback",),
    "next_test.py": ("what_is_shown", "unread_parts"),
    "to_find.py": ("what_is_shown", "unread_parts"),
    "opened.py": ("the_locked_tests",),
    "other_axes.py": ("other_axes",),
    "preference.py": ("selection",),
    "problem.py": ("compression", "the_noise"),
    "ranking.py": ("selection",),
    "responses.py": ("the_answer",),
    "probability.py": ("a_claim", "the_verdict", "the_locked_tests", "unread_parts", "other_axes"),
    "rules.py": ("a_claim", "the_verdict", "the_locked_tests", "unread_parts", "other_axes"),
    "rules_together.py": ("a_claim", "the_verdict", "the_locked_tests", "unread_parts", "other_axes"),
    "scored.py": ("a_claim",),
    "selection.py": ("selection",),
    "context.py": ("selection",),
    "in_noise_of_best.py": ("selection",),
    "beside.py": ("selection",),
    "turned.py": ("turned_probes",),
    "turned_locked.py": ("the_locked_tests",),
    "unexplained.py": ("what_is_shown",),
    "unlocking.py": ("the_answer", "the_locked_tests", "what_is_unlocked"),
    "unread.py": ("unread_parts", "candidates"),
    "windows.py": ("steps",),
    "weak.py": ("what_is_shown",),
    "row.py": ("the_answer", "the_locked_tests"),
    "of_claim.py": ("the_answer", "the_heat_of_a_motor"),
}
BRUTE_FORCE = ("tests/diagnosis/test_evidence_by_brute_force.py",)


def in_its_room(file: str) -> str:
    """The path of a module of the diagnosis, whose names are each there once."""
    [path] = (ROOT / "thermodata/diagnosis").rglob(file)
    return path.relative_to(ROOT).as_posix()


def diagnosis(file: str, old: str, new: str, why: str) -> Mutant:
    tests = tuple(f"tests/diagnosis/test_rules_of_{topic}.py" for topic in BESIDE[file])
    return Mutant(in_its_room(file), old, new, why, tests)


def limit(old: str, new: str, why: str) -> Mutant:
    tests = tuple(f"tests/diagnosis/test_rules_of_{topic}.py" for topic in BESIDE["rules.py"])
    return Mutant("thermodata/schema/agreed/limits.py", old, new, why, tests)


def products(file: str, old: str, new: str, why: str) -> Mutant:
    return Mutant(in_its_room(file), old, new, why, BRUTE_FORCE)


def heat(file: str, old: str, new: str, why: str) -> Mutant:
    tests = ("tests/diagnosis/test_missing_heat.py", "tests/diagnosis/test_goes_with.py")
    return Mutant(in_its_room(file), old, new, why, tests)


def rest(old: str, new: str, why: str) -> Mutant:
    return Mutant(in_its_room("at_rest.py"), old, new, why, ("tests/diagnosis/test_at_rest.py",))


MUTANTS = [
    # ---- a claim
    diagnosis("rules.py", "P_LIMIT = 0.01", "P_LIMIT = 0.9", "chance is claimed as a cause"),
    diagnosis("rules.py", "holds=less < scored.evidence", "holds=True", "a body that grows is said to bend"),
    diagnosis("rules.py", "min(scored.sides", "max(scored.sides", "no body bends"),
    diagnosis("probability.py", "(2.45, 2.2, ", "(4.45, 2.2, ", "an answer is too sure of itself"),
    diagnosis("probability.py", "2.2, 1.1, ", "2.2, 0.0, ", "an answer is sure of what hardly lowers the error"),
    diagnosis("probability.py", "-1.8, -2.65, ", "0.0, -2.65, ", "what a sharper cause leaves is claimed"),
    diagnosis("probability.py", "-2.65, -0.9, ", "0.0, -0.9, ", "a casting that follows the cause is claimed"),
    diagnosis("probability.py", "-2.65, -0.9, ", "-2.65, 0.0, ", "the nut is claimed where the guideway has no sensor"),
    diagnosis(
        "unread.py",
        "and MachinePart(heat, name) not in known",
        "",
        "a guideway that the model has is named beside the nut",
    ),
    diagnosis(
        "unread.py", "for c in channels.values() if is_motion(c.quantity))", "for c in ())", "a lesser part beats it"
    ),
    diagnosis("unread.py", "part is not None and part.heat in heats for", "part is not None for", "any axis moves it"),
    diagnosis(
        "probability.py",
        "bool(of.unread) and not of.around",
        "bool(of.unread)",
        "a fixture silences the air it stands in",
    ),
    diagnosis("probability.py", "this_part=True", "this_part=False", "a fixture is told from the air too soon"),
    diagnosis("unread.py", "if all(warms_the_holder", "if False and all(warms_the_holder", "coolant is as sure as air"),
    diagnosis("unread.py", "Part(AIR, HOLDER) in known or", "", "a holder that the model has is named beside coolant"),
    diagnosis("unread.py", "or any(reads(channels, place) for", "or any(False for", "a holder with a sensor is named"),
    diagnosis("unread.py", "channel.quantity in CUTS and", "", "a spindle's speed is taken for cutting"),
    diagnosis("unread.py", "if own or len(others) > 1", "if own", "a feed is as sure of the nut as the nut is"),
    diagnosis("unread.py", "not (warm and any", "not (any", "a feed is as sure of the nut as the nut is"),
    diagnosis("probability.py", "(beaten and of.around)", "beaten", "a second cause is doubted for the first"),
    diagnosis("of_library.py", "around=len(names) == 1 and", "around=", "the layers of the hall's air are doubted"),
    diagnosis("unread.py", "warm == len(names) == 1", "warm", "the layers of the hall's air are doubted"),
    diagnosis("unread.py", "(moving and heat != AIR)", "(heat != AIR)", "where an axis stands is taken for its heat"),
    diagnosis("unread.py", "if not own <= {", "if False and {", "a scale is taken for a part that rubs"),
    diagnosis("unread.py", "if axis !=", "if False and axis !=", "a rotary axis is given a nut"),
    diagnosis("unread.py", "and quantity == TEMPERATURE}", "}", "a feed at the motor is no longer the screw's"),
    diagnosis("bare.py", "if channel.faulty is None}", "}", "a sensor that failed is as good as one"),
    diagnosis("row.py", "if not reads(beside, place)", "", "what another claim reads is named beside this one"),
    diagnosis("of_library.py", "known |= {", "known & {", "a nut that is modelled is named beside its guideway"),
    diagnosis(
        "probability.py", "BORNE_OUT, WORTH_ASKING = 0.5", "BORNE_OUT, WORTH_ASKING = 1.5", "another axis decides"
    ),
    diagnosis("probability.py", "WORTH_ASKING = 0.5, 0.3", "WORTH_ASKING = 0.5, 0.6", "another axis is hardly asked"),
    diagnosis("probability.py", "if there > 0.5 else", "if there > 0.0 else", "another axis speaks against a claim"),
    diagnosis("other_axes.py", "and info.faulty is None", "", "a probe that failed is asked"),
    diagnosis("other_axes.py", "not in (GENERIC, CONTROL)", "is not None", "any lag is the same as any other"),
    diagnosis("other_axes.py", " or set(one.channels) == set(other.channels)", "", "a lag of the nut is not the nut"),
    diagnosis("other_axes.py", ".holds:", ".holds is None:", "all axes are asked though one is enough"),
    diagnosis("other_axes.py", "and e.acts_on is None", "", "what acts on one axis is fitted to another"),
    diagnosis("other_axes.py", "return not fixed or", "return True or", "a gain of one axis is held on another"),
    diagnosis(
        "probability.py", " and not scored.candidate.of_motion", "", "a feed is as sure of the nut as the nut is"
    ),
    diagnosis("probability.py", "TOLD_APART = 0.93", "TOLD_APART = 0.5", "a claim does not say what else it may be"),
    diagnosis(
        "probability.py", "FALLS = (-0.2, 1.0)", "FALLS = (-9.0, 1.0)", "a misfit of the known effects refutes a cause"
    ),
    diagnosis("probability.py", "\nCLAIMED = 0.65", "\nCLAIMED = 0.55", "what is slow stands in for a cause"),
    diagnosis("probability.py", "PLACELESS_CLAIMED = 0.5", "PLACELESS_CLAIMED = 0.7", "nothing is ever claimed"),
    diagnosis("of_library.py", "passive=placed and nameless", "passive=nameless", "without places nothing is claimed"),
    diagnosis("of_library.py", "channel.at is None or is_casting", "is_casting", "a sensor of no place is a cause"),
    diagnosis(
        "of_library.py", "if not nameless and len(bodies) == len(names):", "if False:", "a washed table is friction"
    ),
    diagnosis(
        "of_library.py",
        "(bool(bodies) or any(_is_warmed_from_elsewhere",
        "(any(_is_warmed_from_elsewhere",
        "a washed table is a cause",
    ),
    diagnosis(
        "of_library.py", 'c.quantity == "temperature" and holds(h, c.at)', "holds(h, c.at)", "a speed is a sensor"
    ),
    diagnosis("of_library.py", " or is_casting(channel.at)", "", "a casting that follows the cause is claimed"),
    diagnosis("of_library.py", " or is_beside(channel.at)", "", "an electrical cabinet is claimed"),
    diagnosis(
        "refinement.py", "of_motion and kin in", "of_motion and kin not in", "a speed is a cause beside its motor"
    ),
    diagnosis("rules.py", "DOUBLES = -1.0", "DOUBLES = -9.0", "a part is claimed against all other tests"),
    diagnosis("rules.py", " and of.scored.candidate.kin is None", "", "one test makes a cause of another mode"),
    Mutant(
        "thermodata/diagnosis/candidates/basis.py",
        "left, tests = list(params), {",
        "left, tests = [], {",
        "a lag has a finer grid than its name",
        ("tests/diagnosis/test_what_is_kept.py",),
    ),
    Mutant(
        "thermodata/diagnosis/locked/left_on_locked.py",
        "left <= HALVES * spread",
        "left <= spread",
        "nothing is missing, though the locked tests say otherwise",
        ("tests/diagnosis/test_left_on_locked.py",),
    ),
    diagnosis(
        "rules.py", "OVERWHELMING = 0.5", "OVERWHELMING = 0.3", "left-out tests that speak against it are not heard"
    ),
    diagnosis("rules.py", "LEAST_TESTS = 2 ", "LEAST_TESTS = 1 ", "one test makes a cause"),
    diagnosis("rules.py", "\nDROP_LIMIT = 0.15", "\nDROP_LIMIT = 0.05", "a claim hardly lowers the error"),
    diagnosis(
        "rules.py", "STEADYING_DROP_LIMIT = 0.3", "STEADYING_DROP_LIMIT = 0.15", "what steadies a misfit is claimed"
    ),
    diagnosis("rules.py", "BETTER_LIMIT = 0.6", "BETTER_LIMIT = 0.4", "a few tests carry a claim"),
    diagnosis("rules.py", "SURE_BETTER_LIMIT = 0.4", "SURE_BETTER_LIMIT = 0.0", "a test or two carry a sure claim"),
    diagnosis("rules.py", "(of.strong or of.sure) and", "of.strong and", "a sure cause is refused for its fall"),
    diagnosis("rules.py", "SURE_BETTER_LIMIT if of", "BETTER_LIMIT if of", "a sure cause is refused"),
    diagnosis("refinement.py", 'kin == "part" and', "False and", "the air is claimed beside its gradient"),
    diagnosis("preference.py", 'own.candidate.kin != "part" or', "True or", "the gradient hides a third sensor"),
    diagnosis(
        "judge.py", 'and j.scored.candidate.kin == "part" and', "and False and", "what a gradient lacks is unknown"
    ),
    diagnosis("kin.py", "return names not in read and", "return False and", "the air is a mode of its gradient"),
    diagnosis("kin.py", '    return "part"\n', '    return "same"\n', "the air's lag is a mode of its gradient"),
    diagnosis("kin.py", 'return "near" if switched and not', 'return "near" if not', "a warm bearing is another's"),
    diagnosis("kin.py", "if switched and not names <= model.read", "if switched", "a switch is no mode of itself"),
    diagnosis("commanded.py", " and not is_around(channel.at)", "", "who opens the door sets the clock"),
    diagnosis("unread.py", ' or holds("tool", channel.at)', "", "the shaft's heat is the tool's"),
    diagnosis(
        "kin.py",
        '"heat" if other else',
        '"same" if other else',
        "the coolant's switch is a mode of its temperature",
    ),
    products(
        "invariance.py", "in (moves, moves & acts)", "in (moves,)", "a cause is refused for a test in which it rests"
    ),
    products(
        "invariance.py", "in (moves, moves & acts)", "in (moves & acts,)", "tests in which it rests don't speak for it"
    ),
    products("invariance.py", "across @ held[:, :-1]", "0 * across @ held[:, :-1]", "where it rests its gain is held"),
    diagnosis("rules.py", "SPREAD_LIMIT = 0.5", "SPREAD_LIMIT = 0.9", "a proxy of another gain a test is claimed"),
    diagnosis("rules.py", "FORETOLD = 0.5", "FORETOLD = 0.3", "a proxy of another gain a test is claimed"),
    diagnosis("rules.py", "WORTH_SHARE = 0.1 ", "WORTH_SHARE = 0.0 ", "trifles are claimed"),
    diagnosis("rules.py", "WORTH_SPREAD = 0.2, 0.2", "WORTH_SPREAD = 0.0, 0.2", "a trifle that is sure is claimed"),
    diagnosis("rules.py", "WORTH_SPREAD = 0.2, 0.2", "WORTH_SPREAD = 0.2, 0.9", "a proxy that is balanced is claimed"),
    diagnosis("rules.py", "(of.sure and _does_much", "(False and _does_much", "what a known effect hides is not named"),
    diagnosis("rules.py", "(of.sure and _does_much", "(_does_much", "what is slow and large stands beside a cause"),
    diagnosis("measure.py", "FLOOR_SHARE = 0.1 ", "FLOOR_SHARE = 0.3 ", "a real error is left alone"),
    diagnosis("measure.py", "TIMES = 5.0, 2.0", "TIMES = 2.0, 2.0", "noise is to be explained"),
    diagnosis("measure.py", "TIMES = 5.0, 2.0", "TIMES = 5.0, 5.0", "a large noise hides what is missing"),
    diagnosis(
        "judge.py",
        "judged, why, likely=_likely(own, ()))\n    more",
        "judged, why)\n    more",
        "at the floor the lock stays shut",
    ),
    diagnosis("turned.py", "MOVES = 0.2 ", "MOVES = 0.0 ", "a sound test that hardly moves is turned"),
    diagnosis("turned.py", "MOVES = 0.2 ", "MOVES = 0.3 ", "a turned test of a quarter is not told"),
    products("chain.py", " - slow**2 * np.expm1(-2 * apart)", "", "slow noise fades and is not renewed"),
    diagnosis("judge.py", "\nALIKE = 0.9 ", "\nALIKE = 0.99 ", "twins are said to be told apart"),
    diagnosis("judge.py", "APART = 2.0", "APART = 99.0", "what leaves far more passes as a twin"),
    diagnosis("judge.py", "APART = 2.0", "APART = 1.2", "the cause is not named beside its twin"),
    diagnosis("judge.py", "ALIKE_AT_ALL = 0.5", "ALIKE_AT_ALL = 0.2", "strangers are said to be twins"),
    diagnosis("judge.py", "NEARLY = 1.2", "NEARLY = 1.0", "twins are said to be told apart"),
    diagnosis("judge.py", "\nSURE = 2.0", "\nSURE = 9.0", "what the tests tell apart passes as twins"),
    diagnosis("judge.py", "difference.std(ddof=1)", "difference.std()", "chance tells twins apart"),
    diagnosis(
        "rules.py",
        "scored.candidate.passive or scored.candidate.family ==",
        "scored.candidate.family ==",
        "a casting that steadies a misfit is claimed",
    ),
    diagnosis("scored.py", "ACTS = 0.2", "ACTS = 0.0", "tests in which nothing acts decide"),
    diagnosis("scored.py", "self.gained[self.acts] > 0", "self.gained[self.acts] >= 0", "no change counts as better"),
    # ---- verdict
    diagnosis("judge.py", "if len(problem.blocks) < 2:", "if len(problem.blocks) < 1:", "one test makes a claim"),
    diagnosis("judge.py", "MOST_CLAIMS = 3", "MOST_CLAIMS = 9", "everything is claimed at once"),
    diagnosis("judge.py", "once[j.scored.candidate.id] is j and ", "", "one cause is claimed twice"),
    diagnosis("judge.py", "named and shared and", "named and", "a second axis of a family is never claimed"),
    diagnosis("judge.py", "named and shared and", "shared and", "two causes at one channel are one"),
    diagnosis("judge.py", " and mine.family not in (GENERIC, CONTROL)", "", "two lags are one"),
    diagnosis("judge.py", " and not any(again(j, o) for o in claims)", "", "one cause is claimed twice"),
    diagnosis("judge.py", " and not j.scored.candidate.passive", "", "a casting makes a cause less sure"),
    diagnosis(
        "opened.py",
        "replace(t, beaten=own.beaten, also_on=own.also_on)",
        "t",
        "a dull twin is claimed in a claim's place",
    ),
    diagnosis("judge.py", "beaten=True", "beaten=False", "what a sharper cause leaves is claimed"),
    diagnosis(
        "judge.py", "for j in members if j.refines is None and", "for j in members if", "a mode makes a cause less sure"
    ),
    diagnosis(
        "feedback.py",
        "if _loop_compensates(effect, heat",
        "if True or _loop_compensates(effect, heat",
        "no screw may be it",
    ),
    diagnosis(
        "feedback.py",
        "if _loop_compensates(effect, heat",
        "if False and _loop_compensates(effect, heat",
        "a kept screw may be it",
    ),
    diagnosis("judge.py", "if left <= measure.floor and", "if left < 0 and", "'none' is never said"),
    diagnosis("judge.py", "RATHER = 0.5", "RATHER = 0.6", "'none' beside what is rather missing"),
    diagnosis("judge.py", "RATHER = 0.5", "RATHER = 0.4", "'none' is not said beside what is rather none"),
    diagnosis("judge.py", ">= RATHER and not (one.looked", ">= RATHER and (True or one.looked", "no lock is heard"),
    diagnosis("judge.py", "member.scored.candidate.family and not failed", "True and not failed", "any twin"),
    diagnosis("judge.py", "family and not failed_rules(twin, measure, unit)", "family", "a twin that breaks rules"),
    diagnosis("judge.py", "in own if blunt(j.scored) is None", "in own", "proxies"),
    diagnosis("judge.py", "for j in own if blunt", "for j in judged if blunt", "a refinement is claimed as a cause"),
    diagnosis("measure.py", "SHARE = 0.25, 0.4", "SHARE = 0.9, 0.4", "much is left and nothing is said to be missing"),
    diagnosis("measure.py", "SHARE = 0.25, 0.4", "SHARE = 0.05, 0.4", "a distributed machine is never complete"),
    diagnosis("measure.py", "SHARE = 0.25, 0.4", "SHARE = 0.25, 0.9", "a refinement hides that something is missing"),
    diagnosis("measure.py", "SHARE = 0.25, 0.4", "SHARE = 0.25, 0.3", "a rough model that lacks nothing is unknown"),
    limit("PLAUSIBLE = 0.3", "PLAUSIBLE = 0.64", "nothing is missing beside what may be the cause"),
    limit("PLAUSIBLE = 0.3", "PLAUSIBLE = 0.1", "what is no cause makes that nothing is missing unsure"),
    diagnosis(
        "rules_together.py", " >= PLAUSIBLE or halves(alone, left)", " >= PLAUSIBLE", "what takes half is nothing"
    ),
    diagnosis("rules.py", "STRONG = 0.4", "STRONG = 0.04", "left-out tests that hardly gain are not heard"),
    diagnosis("rules_together.py", "HALVES = 0.5", "HALVES = 0.1", "a test at rest that is all wrong lacks nothing"),
    diagnosis(
        "rules_together.py", "HALVES = 0.5", "HALVES = 0.9", "what helps a little contradicts that nothing is missing"
    ),
    diagnosis("judge.py", "refined=rest < left", "refined=bool(kept)", "what lessens no error excuses one"),
    diagnosis("judge.py", "left > measure.noises and any(halves", "any(halves", "noise is to be explained"),
    diagnosis("measure.py", " / math.sqrt(averaged)", "", "means are held against the noise of samples"),
    diagnosis(
        "measure.py", "min(self.floor_of_samples", "min(self.floor", "samples are held against the noise of means"
    ),
    diagnosis("problem.py", "tuple(blocks), noise, every)", "tuple(blocks), noise)", "means pass for samples"),
    diagnosis("judge.py", "left > measure.noises and any(is_plain", "any(is_plain", "noise is plain"),
    diagnosis("rules_together.py", "PLAIN = 0.25", "PLAIN = 2.5", "none is said of what is plain"),
    diagnosis("probability.py", "0.0 if scored.looked is None else", "0.0 if True else", "locked tests weigh nothing"),
    diagnosis("probability.py", "OPENED = 0.4", "OPENED = 0.6", "the lock stays shut on what is likely"),
    diagnosis("probability.py", "OPENED = 0.4", "OPENED = 0.3", "the lock is opened for what is not likely"),
    diagnosis(
        "probability.py", "-2.6, -1.2, -2.3, 1.0)", "0.0, -1.2, -2.3, 1.0)", "one of several is claimed beside them"
    ),
    diagnosis(
        "probability.py",
        "-2.6, -1.2, -2.3, 1.0)",
        "-2.6, 0.0, -2.3, 1.0)",
        "what holds the probes is claimed for what warms it",
    ),
    diagnosis(
        "probability.py",
        "-1.2, -2.3, 1.0)",
        "-1.2, 0.0, 1.0)",
        "a guideway is claimed for the screw that no sensor reads",
    ),
    diagnosis("probability.py", "-2.3, 1.0)", "-2.3, 0.0)", "a bearing is believed no sooner than what it does"),
    diagnosis(
        "probability.py", "(of.of_source and not another)", "of.of_source", "a nut is claimed for a guideway not read"
    ),
    diagnosis(
        "of_library.py", 'channel.quantity == "temperature" and makes_heat', "makes_heat", "a pump that runs makes heat"
    ),
    Mutant(
        "thermodata/schema/words/places.py",
        "made and not _WOUND.intersection(parts)",
        "made",
        "a winding is a part that stores heat",
        ("tests/diagnosis/test_rules_of_candidates.py",),
    ),
    diagnosis("judge.py", "[left, *(j.alone.error_of_all for j in kept)]", "[left]", "a refined model is unknown"),
    diagnosis("probability.py", "max(samples, 1), FALLS[1], ", "max(samples, 1), 0.0, ", "a second look is not taken"),
    diagnosis(
        "selection.py",
        "(_ranked_among(first, some), beside_all))",
        "(beside_all,))",
        "what stands out alone is not seen",
    ),
    diagnosis(
        "selection.py",
        "(_ranked_among(first, some), beside_all))",
        "(_ranked_among(first, some),))",
        "nor beside the members",
    ),
    diagnosis("investigate.py", " and any_stands_out(", " and not any_stands_out(", "it is looked for in vain"),
    # ---- what is more than noise
    diagnosis("beyond_noise.py", "error**2 - white**2", "error**2", "a loud probe hides a fall"),
    diagnosis("beyond_noise.py", "if after >= before:", "if False:", "a rise beside the noise is a multiple"),
    diagnosis(
        "beyond_noise.py", "least = white * (2.0 / max(rows, 2.0)) ** 0.25", "least = 1e-9", "noise falls by most"
    ),
    diagnosis(
        "measure.py", "np.hypot(noise, FLOOR_SHARE * self.spread)", "1e9", "locked tests of a loud probe are silent"
    ),
    diagnosis(
        "kin.py",
        "heat_of(own, p.family) == heat_of(effect, family) for own, p in acting)",
        "cause(own) == cause(effect) for own, _ in acting)",
        "another spindle's bearing is a mode",
    ),
    # ---- refinement
    diagnosis("refinement.py", "GOOD = 0.4", "GOOD = 0.9", "what a poor model lacks is a refinement"),
    diagnosis(
        "refinement.py", "MOST, SURE = 0.6, 0.85", "MOST, SURE = 0.3, 0.85", "another mode is claimed as a cause"
    ),
    diagnosis("refinement.py", "\nKEPT = 0.25", "\nKEPT = 0.0", "a known heat is missing by another reading"),
    diagnosis("refinement.py", "drop >= MOST and prob", "drop >= 0 and prob", "a mode of a known heat is a cause"),
    diagnosis("refinement.py", "(scored) >= SURE", "(scored) >= 0.65", "what may be a mode of a known heat is a cause"),
    diagnosis("refinement.py", "return timed and ", "return ", "the speed is a cause beside its bearing"),
    diagnosis("refinement.py", 'if kin == "heat" and not', "if False and not", "the coolant is missing twice"),
    diagnosis("refinement.py", "REPLACED = 0.1", "REPLACED = 0.5", "a cause that overlaps takes a place"),
    diagnosis("refinement.py", "FOLLOWS = 0.8", "FOLLOWS = 0.9", "a body that the air warms is a cause"),
    diagnosis("refinement.py", "FOLLOWS = 0.8", "FOLLOWS = 0.7", "a part that makes heat of its own is air"),
    diagnosis("refinement.py", "HALF = 0.5", "HALF = 0.55", "a part that the air warms at rest is a cause"),
    diagnosis("refinement.py", "HALF = 0.5", "HALF = 0.45", "a part that moves warms by the air"),
    diagnosis("refinement.py", "if term.family != AIR:", "if False:", "what a source of heat warms is air"),
    diagnosis(
        "refinement.py",
        "sharpness(scored) >= EVIDENT or scored.candidate.family == AIR",
        "False",
        "what is evident is air, and air is a body",
    ),
    diagnosis("refinement.py", "None if any(self._air", "None if False and any(self._air", "a motor is air"),
    diagnosis("refinement.py", "None if any(self._air", "None if True or any(self._air", "no body is air"),
    diagnosis("warm_at_rest.py", "roots = TURNS if own in TURNS else (own,)", "roots = ()", "no part moves"),
    diagnosis("refinement.py", "WORTH = 20.0", "WORTH = 0.0", "an effect that was never there is replaced"),
    diagnosis("refinement.py", "LIKE = 0.9 ", "LIKE = 0.1 ", "a cause takes the place of a stranger"),
    diagnosis("refinement.py", "== GENERIC and body)", "== GENERIC)", "a cause is told a zero of another"),
    diagnosis("refinement.py", "candidate.passive or candidate.placeless", "candidate.passive", "without places"),
    diagnosis("refinement.py", "EVIDENT = 1.0", "EVIDENT = 9.0", "what is evident is told a zero of another"),
    diagnosis("refinement.py", "SMALL = 0.6 ", "SMALL = 0.1 ", "a small mode is claimed as a cause"),
    diagnosis("refinement.py", "not most and blunt(scored) and", "not most and", "a sure cause passes as another mode"),
    diagnosis("refinement.py", "MOVES, QUARTER = 0.6", "MOVES, QUARTER = 0.9", "air that moves the frame is a zero"),
    diagnosis("refinement.py", "MOVES, QUARTER = 0.6", "MOVES, QUARTER = 0.1", "another zero is missing air"),
    diagnosis("refinement.py", "len(shares) >= LEAST_TESTS and", "shares and", "one test tells a zero from air"),
    diagnosis("refinement.py", "of_motion or sharpness(scored) >= EVIDENT", "of_motion", "the cut is the hot part"),
    diagnosis("refinement.py", "OPPOSITE = -0.8", "OPPOSITE = 0.9", "heat is said to count from another zero"),
    diagnosis("refinement.py", "SHARE = (0.2, 1.5)", "SHARE = (0.0, 9.0)", "any heat counts from another zero"),
    diagnosis("refinement.py", "family == AIR or not", "family == 'x' or not", "the air counts from another zero"),
    diagnosis("refinement.py", 'or kin == "same"', "", "the same effect is missing again"),
    diagnosis(
        "refinement.py", 'kin == "near" and not is_surely_missing(scored)', 'kin == "near"', "the motor is its bearing"
    ),
    diagnosis("refinement.py", 'kin == "near" and', "False and", "what sits at its place is missing"),
    # ---- locked tests
    diagnosis("foretold.py", "KEPT = 0.5", "KEPT = 0.0", "a proxy survives the locked tests"),
    diagnosis("foretold.py", "LEAST = 0.02", "LEAST = -9.0", "locked tests never withdraw a claim"),
    diagnosis("foretold.py", "MUCH = 0.25", "MUCH = 0.9", "a large fall does not bear a claim out"),
    diagnosis("foretold.py", "OF_ITS_OWN = 0.75", "OF_ITS_OWN = 0.7", "a mode of what is there is missing"),
    diagnosis("foretold.py", "len(self.saying) > 1 and all(", "all(", "one way makes a mode a cause"),
    diagnosis("foretold.py", "PROBABLE = 0.5", "PROBABLE = 0.0", "a proxy survives the locked tests"),
    diagnosis("foretold.py", "PROBABLE = 0.5", "PROBABLE = 9.0", "one slow test withdraws a cause"),
    products(
        "on_locked.py",
        "base.log_probability(both) - base.log_probability(tests)",
        "base.log_probability(both)",
        "open tests speak twice",
    ),
    diagnosis(
        "on_locked.py",
        "    tests = np.arange(opened)\n",
        "    tests = np.arange(len(problem.blocks))\n",
        "the locked tests take part in the estimate",
    ),
    diagnosis("on_locked.py", "import rms_about_means", "import rms as rms_about_means", "an unlucky zero withdraws"),
    diagnosis(
        "on_locked.py",
        "_with_effects_as_open(problem, tests, noise, kept)",
        "problem",
        "what else was selected is forgotten",
    ),
    diagnosis(
        "confirmation.py",
        "before, after = self.shape_before, self.shape_after",
        "before, after = self.before, self.after",
        "one unlucky zero withdraws a claim",
    ),
    diagnosis("confirm.py", "    if free:\n", "    if not free:\n", "one unlucky zero withdraws a claim"),
    diagnosis("confirm.py", '"verify_on": [], ', "", "verification tests are no part of the choice"),
    diagnosis("confirm.py", "if set(some) & set(", "if not set(some) & set(", "parameters of another claim"),
    diagnosis(
        "foretold.py", "LOG_ODDS = (0.5, 1.9, -0.6)", "LOG_ODDS = (0.5, 1.9, 0.0)", "any fall speaks for a claim"
    ),
    diagnosis("foretold.py", "LOG_ODDS = (0.5, 1.9, ", "LOG_ODDS = (0.5, 0.0, ", "the model as it stands says nothing"),
    diagnosis("foretold.py", "LOG_ODDS = (0.5, 1.9, ", "LOG_ODDS = (0.0, 1.9, ", "other lags of the model say nothing"),
    diagnosis("foretold.py", "first, last = said[0], said[-1]", "first = last = said[0]", "one way speaks for both"),
    diagnosis(
        "foretold.py", " and not any(f.falls", " and not all(f.falls", "a claim that one way bears out is refuted"
    ),
    diagnosis("foretold.py", "f is not None and f.says(self.floor)", "f is not None", "noise refutes a claim"),
    diagnosis(
        "opened.py", "return _is_refuted(j) or blunt", "return blunt", "what falls in no way stands by its evidence"
    ),
    diagnosis("opened.py", "_is_refuted(j) or blunt(j.scored) is not None or", "_is_refuted(j) or", "likely is enough"),
    diagnosis(
        "opened.py",
        "min([place for place in short if place >= claims] or short, key",
        "min(short, key",
        "a claim goes for what is likely",
    ),
    diagnosis("opened.py", "best = max(found, key", "best = min(found, key", "the worst twin is taken"),
    diagnosis(
        "opened.py", "if worst < claims:\n            refused", "if False:\n            refused", "no word of a refusal"
    ),
    diagnosis(
        "opened.py", "return replace(anew, judged=judged, likely=())", "return found", "the lock says nothing of 'none'"
    ),
    diagnosis("opened.py", "standing = causes(asked)", "standing = tuple(asked)", "one cause is claimed in two modes"),
    diagnosis(
        "opened.py",
        "for j in asked if j.in_place_of is None})",
        "for j in asked})",
        "a twin that went is told for what was claimed",
    ),
    diagnosis(
        "selection.py",
        "for one in (read_alone, better_twin, what_warms_it, its_name):",
        "for one in (read_alone, better_twin, what_warms_it):",
        "a lag is claimed where another is preferred to its name",
    ),
    diagnosis("opened.py", "and families & _families(t, claim.beside)", "", "another's heat is claimed for it"),
    diagnosis(
        "opened.py",
        "if is_its_name(best.scored, j.scored)), best)",
        "if False), best)",
        "a lag is claimed for its name",
    ),
    diagnosis("unread.py", "return (*motors, *(", "return (*(", "a motor's losses are the cut's alone"),
    diagnosis(
        "unread.py",
        "in motors_of(names, channels) if not reads(channels, place))",
        "in motors_of(names, channels))",
        "a motor that a sensor reads may be it",
    ),
    diagnosis("of_claim.py", "if acts and test.kind in _NOTHING_IS_CUT)", "if acts)", "the cut acts where it is cut"),
    diagnosis("opened.py", "(_member_key(j) in unsound and silent)", "False", "locked tests that rest outweigh a rule"),
    diagnosis("judge.py", "if may_be_confirmed(j.scored)", "if True", "the lock is opened for everything"),
    diagnosis("judge.py", "alone = len(broken) == 1 and", "alone = broken and", "what breaks two rules is asked"),
    diagnosis("judge.py", "broken[0] in (*OUTWEIGHED, *few) and", "", "what the tests go against is asked"),
    diagnosis("judge.py", "key=lambda s: -probability(s)):", "key=probability):", "the least probable is asked"),
    diagnosis("judge.py", " and refines(one) is None:", ":", "another mode is asked of the locked tests"),
    diagnosis("judge.py", ' and one.kin != "same" and', " and", "a mode of one effect opens the lock"),
    diagnosis(
        "judge.py", "another = not judged.like_a_mode and", "another =", "what is told from no mode opens the lock"
    ),
    diagnosis("judge.py", "not nameless or is_surely_missing(judged.scored)", "not nameless", "a sure cause is a mode"),
    diagnosis("judge.py", "or not nameless or", "or", "a name that is told from no mode is one"),
    diagnosis("judge.py", " or one.of_motion)", ")", "a cut is no cause beside the warmth of its part"),
    diagnosis("judge.py", "and another and blunt(judged.scored) is None", "and another", "all modes open the lock"),
    diagnosis("judge.py", "enough, likely=_likely(maybe, ()))", "enough)", "a cause passes as a mode"),
    diagnosis("opened.py", "j.refines is not None and (", "False and (", "a mode is claimed as a cause"),
    diagnosis("opened.py", "and asked[worst].refines is None", "", "a twin of a mode is claimed"),
    diagnosis("judge.py", "[: MOST_CLAIMS - len(claims)]", "", "everything likely is asked at once"),
    diagnosis("on_locked.py", "if acts[i] or not claims", "", "a test in which a claim rests decides of it"),
    diagnosis("problem.py", "result - start @ (start.T @ result)", "result", "a warm start is to be explained"),
    diagnosis("discrepancy.py", "np.hstack([offsets, start])", "offsets", "a warm start counts as evidence"),
    diagnosis("opened.py", "TWINS_TRIED = 4", "TWINS_TRIED = 0", "a twin that holds is not found"),
    diagnosis("responses.py", "return int(np.argmax([", "return int(np.argmin([", "the best response is diagnosed"),
    diagnosis("as_modelled.py", "FALLS = 0.3", "FALLS = 0.99", "nothing is offered"),
    diagnosis("as_modelled.py", "ALONE = 0.9", "ALONE = 1.1", "a tool of one test is foretold"),
    diagnosis("as_modelled.py", "NOISY * problem.noise", "0.0", "noise is refined"),
    diagnosis("as_modelled.py", "scored.spread <= SPREAD_LIMIT", "True", "what acts otherwise in each test is offered"),
    diagnosis("as_modelled.py", "if is_its_name(best, s)", "if False", "a lag is offered for its name"),
    diagnosis("as_modelled.py", "> measure.floor else", "> 0 else", "an error that is left alone is refined"),
    diagnosis("of_library.py", "is_at_table(own) and", "False and", "a table that nothing turns rubs"),
    diagnosis("warm_at_rest.py", "AS_WARM = 0.75", "AS_WARM = 0.65", "a rotary table in a warm hall has no bearing"),
    diagnosis("warm_at_rest.py", "AS_WARM = 0.75", "AS_WARM = 0.85", "a table that the hall warms rubs"),
    diagnosis(
        "warm_at_rest.py", "return not turning and bool(resting)", "return False", "a table that never turns rubs"
    ),
    diagnosis(
        "row.py",
        "probability(scored) if told.stated else None",
        "probability(scored)",
        "a share that nobody measured is told",
    ),
    diagnosis(
        "listed.py",
        "explained(beside_the_model(item[0], investigation)[0])",
        "explained(item[0])",
        "the list contradicts the errors that stand in it",
    ),
    diagnosis("stated.py", "if scored.candidate.within:", "if False:", "a change of an effect is called a cause"),
    diagnosis("stated.py", 'kin not in ("same", "heat")', 'kin != ""', "a mode of the model is called the likeliest"),
    diagnosis("stated.py", "NAMED_SHARE * scored.evidence", "0.0", "a name stands for a lag that is far more evident"),
    diagnosis(
        "stated.py", "if scored.candidate.family not in UNNAMED:", "if True:", "a lag heads the list before its name"
    ),
    diagnosis(
        "listed.py",
        "told = [s for s in told if blunt(s)",
        "told or [s for s in told if blunt(s)",
        "what a claim explains is told",
    ),
    diagnosis(
        "errors_told.py",
        "if ranked and (judged or",
        "if False and (judged or",
        "the model's own error is another twice",
    ),
    diagnosis(
        "errors_told.py",
        "all(j.scored.columns is scored.columns for j in judged)",
        "any(j.scored.columns is scored.columns for j in judged)",
        "what stands beside a claim is forgotten",
    ),
    diagnosis(
        "errors_told.py",
        "all(j.scored.columns is scored.columns for j in judged)",
        "len(judged) == 1",
        "what was dropped falls from the wrong error",
    ),
    # ---- selection
    diagnosis("in_noise_of_best.py", "\nTRIED = 5", "\nTRIED = 1", "what is missing hides the right one as noise"),
    diagnosis("in_noise_of_best.py", "STANDS = 0.15", "STANDS = 0.95", "what is missing hides the right one as noise"),
    diagnosis(
        "selection.py", "found[id(one)] = again.evidence", "pass", "a proxy is credited with the cause's evidence"
    ),
    diagnosis("selection.py", "min(left, key=lambda", "max(left, key=lambda", "the likelier one loses the credit"),
    diagnosis("selection.py", "(own.credit or own.evidence) + gained", "best.evidence", "a swap takes all credit"),
    diagnosis(
        "in_noise_of_best.py",
        "(one.candidate.within, *one.candidate.channels)",
        "one.candidate.channels",
        "a lag hides a change of the effect on its channel",
    ),
    diagnosis("context.py", "MOST = 5 ", "MOST = 9 ", "as many effects as noise has shapes"),
    diagnosis("selection.py", "PASSES = 3", "PASSES = 1", "what a proxy stood in the way of stays unseen"),
    diagnosis("context.py", "return more and max(", "return True or max(", "what can't be named tells twins apart"),
    diagnosis("context.py", "default=0.0) < min(gained)", "default=0.0) < 1e9", "the lesser of two is named"),
    diagnosis("selection.py", "if first.known.left_out > good:", "if True:", "a good model hides causes"),
    diagnosis("context.py", "RIVALS = 3", "RIVALS = 9", "every candidate is tried beside the chosen"),
    diagnosis("context.py", "sound(now) and now.evidence >= was.evidence", "sound(now)", "a rival is no context"),
    diagnosis("context.py", "sound(now) and now.evidence", "now.evidence", "a context forbids the claim"),
    diagnosis("context.py", "(last, TRIED, WORTH)", "(last, TRIED, 0.0)", "trifles stand beside"),
    diagnosis("context.py", "i < len(chosen) or sound(one)", "i < len(chosen)", "what is sound stays unnamed"),
    diagnosis("context.py", "if read.isdisjoint(c.candidate.channels)", "", "a mode of a cause takes from it"),
    diagnosis("selection.py", "beside(problem, whole.context), whole", "problem, whole", "weighed in the noise of all"),
    diagnosis("ranking.py", "SCORED = 15", "SCORED = 3", "few candidates are shown"),
    diagnosis("context.py", "\nWORTH = 10.0", "\nWORTH = 1.0", "trifles are selected"),
    diagnosis("preference.py", "NAMED_SHARE = 0.95", "NAMED_SHARE = 0.5", "a name is taken for physics"),
    diagnosis("preference.py", "ALIKE_SHARE = 0.8", "ALIKE_SHARE = 0.2", "a name elsewhere is taken for physics"),
    diagnosis("preference.py", "\nALIKE = 0.8", "\nALIKE = 0.1", "a name elsewhere is taken for physics"),
    diagnosis("preference.py", "FEWER_SHARE = 0.8", "FEWER_SHARE = 0.2", "half of a cause is preferred"),
    diagnosis("preference.py", "AT_ONCE_SHARE = 0.9 ", "AT_ONCE_SHARE = 0.5 ", "heat is taken for a shift at once"),
    diagnosis("preference.py", "set(own.candidate.channels) != set", "set() != set", "another channel's shift acts"),
    diagnosis("preference.py", "(own, best) or _at_once(own, best)", "(own, best)", "heat that acts at once stays"),
    diagnosis("preference.py", "return all(point[t] <= min", "return all(point[t] >= min", "slow heat acts at once"),
    diagnosis("selection.py", "noise = _second_chance(problem, chosen, dropped, noise, sound)", "", "twins drop both"),
    diagnosis(
        "investigate.py",
        "selection, judgement, named = judged(active)",
        "selection, judgement, named = judged(everything)",
        "proxies",
    ),
    diagnosis("investigate.py", "if not named and any_", "if any_", "a casting drives out the cause"),
    diagnosis(
        "selection.py", "best = preferred(eligible.ranked)", "best = preferred(ranking.ranked)", "a casting swaps in"
    ),
    diagnosis("selection.py", "if worth >= WORTH and all(", "if all(", "trifles come back"),
    diagnosis(
        "selection.py",
        "if worth >= WORTH and all(sound(s) for s in each_beside_others(problem, tried, quieter)):",
        "if worth >= WORTH:",
        "what is unsound comes back",
    ),
    diagnosis("selection.py", "chosen.pop(worst)", "chosen.pop()", "a sound effect goes for an unsound one"),
    diagnosis("selection.py", "worst = min(unsound", "worst = max(unsound", "the most likely one goes first"),
    diagnosis("preference.py", " and _foretells_more(best, own)", "", "a member is swapped for what foretells less"),
    diagnosis(
        "preference.py", " or (own.candidate.passive and best.drop >= NAMED_SHARE * own.drop)", "", "a casting stands"
    ),
    diagnosis("preference.py", "own.candidate.passive and best.drop", "best.drop", "a name takes a cause's place"),
    diagnosis("preference.py", "(best.candidate.passive or len(other", "(len(other", "a casting hides what bends it"),
    diagnosis(
        "preference.py",
        "(_drove_out(own, best, ranking) or _is_clearly_likelier",
        "(_is_clearly_likelier",
        "a lag that drove out a name takes its place",
    ),
    diagnosis("preference.py", " or _is_clearly_likelier(best, own))", " or True)", "members are swapped by a hair"),
    diagnosis(
        "preference.py", "better or is_its_name(own, best) or", "better or", "a lag stands where its name is as likely"
    ),
    diagnosis("preference.py", "best.evidence >= NAMED_SHARE * own.evidence and", "", "a less likely name is taken"),
    diagnosis(
        "preference.py", "if not (own.candidate.of_holder or own.candidate.passive)", "if False", "a cut for all"
    ),
    diagnosis(
        "preference.py", "own.candidate.of_holder or own.candidate.passive", "own.candidate.passive", "a bracket cuts"
    ),
    diagnosis(
        "preference.py", "s.candidate.of_holder or s.candidate.passive or s.candidate.around", "False", "air cuts"
    ),
    diagnosis(
        "preference.py", "and s.evidence >= own.evidence\n            and abs", "and abs", "a lesser cut is taken"
    ),
    diagnosis(
        "heat_balance.py", "(shares.max(axis=1) >= TELLS) & usual", "shares.max(axis=1) >= TELLS", "a hall tells"
    ),
    diagnosis("preference.py", "            or _is_cause_of_mode(best, other)\n", "", "layers of air are the air"),
    diagnosis("preference.py", " or _is_cause_of_mode(own, best)", "", "layers give way to the air above"),
    diagnosis(
        "preference.py", 'apart = mode.kin == "same" and', "apart =", "a cause gives way to one of more channels"
    ),
    diagnosis("preference.py", "set(mode.channels) < set(cause.channels)", "True", "any air is a layer"),
    diagnosis("preference.py", " and is_surely_missing(other)", "", "doubted layers take the air's place"),
    diagnosis(
        "preference.py", "CAUSE_SHARE * own.evidence", "0.0 * own.evidence", "unlikely layers take the air's place"
    ),
    diagnosis("preference.py", "FORETELLS = 0.9, 0.8", "FORETELLS = 0.9, 0.9", "a twin is taken by a hair"),
    diagnosis("preference.py", "TWIN, FORETELLS = 0.9,", "TWIN, FORETELLS = 0.8,", "what acts otherwise is a twin"),
    diagnosis("preference.py", "and s.evidence >= NAMED_SHARE * own.evidence", "", "an unlikely twin is taken"),
    diagnosis("preference.py", "and s.candidate.kin in kin", "", "a mode of the model takes the place of a cause"),
    diagnosis(
        "preference.py",
        "and probability(s) >= probability(own)\n        and (own",
        "",
        "a twin that is less probable is taken",
    ),
    diagnosis(
        "preference.py", "and (own.candidate.around or not s.candidate.around)", "", "the air stands in for heat"
    ),
    diagnosis("preference.py", "return min(twins", "return max(twins", "the worst twin is taken"),
    # ---- products
    products("null.py", "DRAWS = 199", "DRAWS = 99", "p cannot fall below its limit"),
    products("null.py", "1 + np.sum(chance >= evidence)", "np.sum(chance >= evidence)", "chance has no chance"),
    products("null.py", "np.sum(chance >= evidence)", "np.sum(chance > evidence)", "chance that does as well"),
    products("null.py", "np.maximum(best,", "np.minimum(best,", "chance has one try"),
    products("null.py", "known.precision >= 1.0", "known.precision >= 0.0", "chance draws gains that would be fitted"),
    products(
        "invariance.py",
        "SPREADS = np.array([0.0,",
        "SPREADS = np.array([0.5,",
        "a cause is said to differ between tests",
    ),
    products("invariance.py", "if moves.sum() < 2:", "if moves.sum() < 1:", "one test says that gains are alike"),
    products("invariance.py", "size > 1e-6 * size.max()", "size > 1e-3 * size.max()", "weak tests are not asked"),
    products("invariance.py", " - np.log(weight)))", "))", "spreads are weighed as if their mean were known"),
    products("invariance.py", "quad = SPREADS**2 *", "quad = 0.0 *", "spreads are weighed against nothing"),
    products(
        "invariance.py", "cross @ solved(known.factor(known.every), cross.T)", "0.0", "the known effects stand still"
    ),
    products("evidence.py", "SPREAD = 0.5", "SPREAD = 0.05", "a distributed machine is foretold to be simple"),
    products("evidence.py", " - 0.5 * np.linalg.slogdet(scaled)[1]\n", "\n", "more freedom costs nothing"),
    products(
        "evidence.py",
        "left = moments.own - half @",
        "left = moments.own + half @",
        "known effects count twice",
    ),
    products("discrepancy.py", "self.logdet += 2 * float(np.log(sizes).sum())", "pass", "free offsets are for nothing"),
    products("directions.py", " - np.log(precision).sum()", "", "known effects are for nothing"),
    products("directions.py", " + _bases_left(self._problem)[1]", "", "searched noise: free offsets are for nothing"),
    products("directions.py", " + noise.white**2", "", "searched noise: no white noise"),
    products("known.py", "return before + after\n", "return parts + before + after\n", "the left-out test is seen"),
    products(
        "ranking.py",
        "base.space.each(without**2)",
        "base.space.each(without**2) / 2",
        "errors are half of what they are",
    ),
    # ---- noise and priors
    diagnosis("discrepancy.py", "LEAST_WHITE = 0.1", "LEAST_WHITE = 0.001", "a trifle that repeats outweighs all"),
    diagnosis("discrepancy.py", "TAU_S = (600.0", "TAU_S = (6.0", "slow noise passes as white"),
    diagnosis("discrepancy.py", "SLOW = (1e-2, 4.0)", "SLOW = (1e-2, 0.4)", "drift passes as a cause"),
    diagnosis("known.py", "GAIN = 2.0 ", "GAIN = 0.2 ", "known effects cannot grow"),
    diagnosis("known.py", "FREE = 1.0 ", "FREE = 0.0 ", "an effect that another one hides stays hidden"),
    diagnosis("known.py", "SEARCHED = 700", "SEARCHED = 70", "the noise is guessed from few rows"),
    diagnosis("evidence.py", "BEYOND = 0.25", "BEYOND = 0.0", "implausible gains"),
    diagnosis("known_effects.py", "BANK = (1 / 25, 1 / 5, 5.0, 25.0)", "BANK = (1 / 5, 5.0, 9.0, 25.0)", "fast modes"),
    # ---- what is asked for
    diagnosis("of_library.py", "UNNAMED = -3.0", "UNNAMED = 0.0", "lags rival named effects"),
    diagnosis(
        "of_library.py", "GENERIC and not placed", "GENERIC and all(usable[c].at is None for c in names)", "any sensor"
    ),
    diagnosis("kin.py", 'return "near" if near else "related"', 'return "related"', "kin is claimed"),
    diagnosis("of_library.py", "or e.name == STATIC", "", "a gain is asked for twice"),
    diagnosis(
        "candidate_effect.py",
        "SLACK_FACTORS = (0.2, 5.0)",
        "SLACK_FACTORS = (0.9, 1.1)",
        "a distributed machine is a missing effect",
    ),
    diagnosis(
        "of_library.py",
        "same or any(p.channels == names and p.modes >= modes(effect) for p in self.plain)",
        "same",
        "what the model lags already is claimed by name",
    ),
    diagnosis("of_library.py", "return not (alone or", "return (alone or", "refinements of nothing"),
    diagnosis("problem.py", "MIN_ROWS = 10", "MIN_ROWS = 1", "a test of one sample is left out in turn"),
    diagnosis("problem.py", "FEW_TESTS = 3", "FEW_TESTS = 9", "parts of one test pass as tests"),
    diagnosis("problem.py", "PART_ROWS = 100", "PART_ROWS = 10", "parts too short to tell anything"),
    diagnosis("problem.py", "* 1.4826 / np.sqrt(6.0)", "* 1.4826", "the noise is too large, the floor too high"),
    diagnosis("compressed.py", "WEIGHED_ROWS = 2400", "WEIGHED_ROWS = 240", "candidates are weighed by few rows"),
    diagnosis(
        "investigate.py", "if lock is None or not lock.confirms(found, told, j, measure)", "", "all axes are asked"
    ),
    diagnosis("investigate.py", " or len(open_still) < len(standing)", "", "a casting beside what the lock names"),
    diagnosis("on_locked.py", "self.asked.setdefault(claim.scored.candidate.id)", "pass", "a look is not counted"),
    diagnosis("unlocking.py", "dict.fromkeys(found.looked_for)", "dict[str, None]()", "a look is not counted"),
    diagnosis(
        "unlocking.py",
        "locked = [t for t in locked if t.key not in turned]",
        "locked = list(locked)",
        "a turned probe refuses",
    ),
    diagnosis("unlocking.py", "        if asked:\n", "        if True:\n", "a shut lock is said to be open"),
    diagnosis("unlocking.py", "j.scored.looked.at_second_look for", "True for", "a second look claims what it likes"),
    diagnosis(
        "unlocking.py", "asks(locked, faults, refused)", "asks(locked, faults)", "what is refused is asked again"
    ),
    diagnosis("turned_locked.py", "LEAST_FIT = 70.0", "LEAST_FIT = 20.0", "what runs the other way is turned"),
    diagnosis("turned_locked.py", "LEAST_FIT = 70.0", "LEAST_FIT = 97.0", "no locked probe is turned"),
    diagnosis("turned_locked.py", " or rms([is_there]) <= floor", "", "noise is turned"),
    diagnosis("foretold.py", "SECOND_LOOK = 0.5", "SECOND_LOOK = 0.2", "a second look claims by chance"),
    diagnosis("on_locked.py", "if may_be_confirmed(one.scored) else None", "", "the lock is opened for anything"),
    diagnosis("on_locked.py", "if beside_all.holds or ", "if True or ", "a blunt member withdraws a claim"),
    diagnosis("on_locked.py", "found.noise, refining, [claim", "found.noise, kept, [claim", "asked twice"),
    diagnosis(
        "investigate.py", "error_of(asked_about, tests)", "error_of(fitted, tests)", "wrong parameters go unnoticed"
    ),
    diagnosis(
        "faults.py",
        '"gain": judgement.verdict == "none" and at_floor',
        '"gain": True',
        "a missing effect passes as a wrong gain",
    ),
    diagnosis("faults.py", '"clock_offset": not judgement.claims', '"clock_offset": True', "a cause passes as a clock"),
    diagnosis("logging_faults.py", "and s != home", "", "the response's own clock is suspected"),
    diagnosis(
        "compressed.py",
        "import rms_about_means",
        "import rms as rms_about_means",
        "an unlucky zero passes as wrong parameters",
    ),
    # ---- faults of the logs
    diagnosis("logging_faults.py", "WARM_CLOCK_DROP = 0.75", "WARM_CLOCK_DROP = 0.4", "a sensor that lags is a clock"),
    diagnosis("logging_faults.py", "\nCLOCK_DROP = 0.4", "\nCLOCK_DROP = 0.05", "sound clocks are suspected"),
    diagnosis(
        "logging_faults.py", "inside = abs(best) < max(SHIFTS_S)", "inside = True", "slow effects pass as clocks"
    ),
    diagnosis("logging_faults.py", "ALL_DROP = 0.5", "ALL_DROP = 0.05", "sound gains are wrong"),
    diagnosis("logging_faults.py", "LEAST_FIT = 60.0", "LEAST_FIT = 0.0", "a poor model speaks of the logs"),
    diagnosis(
        "logging_faults.py", "        tests.mend(i, factor)\n", "        pass\n", "sound tests are blamed for one"
    ),
    diagnosis("turned.py", "ALL_DROP = 0.6", "ALL_DROP = 0.05", "sound probes are turned"),
    diagnosis("turned.py", "LEAST_FIT = 40.0", "LEAST_FIT = 0.0", "a test that nothing foretells is turned"),
    diagnosis("turned.py", "LEAST_TESTS = 3", "LEAST_TESTS = 2", "one of two tests is turned"),
    diagnosis("turned.py", "(np.sum(signs < 0) + together) >= len(signs)", "1 >= len(signs)", "most tests are turned"),
    diagnosis("turned.py", "(1, 2) if", "(1,) if", "two that are turned hide each other"),
    diagnosis(
        "turned.py",
        "_foretold_by_ridges(problem, lags)\n",
        "_foretold_by_ridges(problem, [])\n",
        "a missing effect hides a turned probe",
    ),
    Mutant(
        "thermodata/diagnosis/verdict/investigate.py",
        "if selection is not None and not single:",
        "if selection is not None:",
        "a slip makes parameters wrong",
        ("tests/diagnosis/test_answer.py",),
    ),
    Mutant(
        "thermodata/diagnosis/concluded.py",
        "beside.of if beside is not None else _of_claims",
        "_of_claims",
        "a slip is in the error with what is named",
        ("tests/diagnosis/test_answer.py",),
    ),
    diagnosis(
        "known_beside.py", "if not does[rows].any():", "if False:", "a test without the channel hides what it follows"
    ),
    Mutant(
        "thermodata/diagnosis/sound.py",
        "    if not steps:\n",
        "    if steps or not steps:\n",
        "a slip bends the effects that are asked of",
        ("tests/diagnosis/test_answer.py",),
    ),
    Mutant(
        "thermodata/diagnosis/sound.py",
        "(t.campaign, t.test) not in wrong",
        "True",
        "a turned test takes part in the choice",
        ("tests/diagnosis/test_rules_of_turned_probes.py",),
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
    diagnosis("artefact.py", "Z_ALONE = 5.0", "Z_ALONE = 12.0", "a slip where much is missing is none"),
    diagnosis("artefact.py", "\nALONE = 2.0", "\nALONE = 1.0", "one jump of many is a slip"),
    diagnosis(
        "artefact.py", "if (bare or beside) and not is_quick(", "if bare and not is_quick(", "a cooled shaft slips"
    ),
    diagnosis("artefact.py", "if bare and not smooth_but_for(", "if False and not smooth_but_for(", "a kink is a slip"),
    diagnosis("repeating.py", "LEAST = 3", "LEAST = 2", "two slips alike are stick-slip"),
    diagnosis("repeating.py", "ALIKE = 0.1", "ALIKE = 0.5", "slips of any size are stick-slip"),
    diagnosis("repeating.py", "CHANCE = 0.01", "CHANCE = 0.013", "an axis that never rests makes slips its own"),
    diagnosis("repeating.py", "CHANCE = 0.01", "CHANCE = 0.009", "an axis that sticks is a probe that slips"),
    diagnosis("repeating.py", "math.comb(len(steps), len(some)) * ", "", "of many slips some are an axis's own"),
    diagnosis("loose.py", "WHOLE = 0.7", "WHOLE = 0.6", "what coolant wets came loose"),
    diagnosis("loose.py", "WHOLE = 0.7", "WHOLE = 0.72", "a loose sensor is none"),
    diagnosis("loose.py", "EVIDENT = 0.65", "EVIDENT = 0.6", "what another programme drives came loose"),
    diagnosis("loose.py", "EVIDENT = 0.65", "EVIDENT = 0.7", "a loose sensor whose tests differ is none"),
    diagnosis("loose.py", "self.ratio > 0 and ", "", "a factor below zero has a logarithm"),
    diagnosis("exchanged.py", "DROP = 0.8", "DROP = 0.999", "exchanged cables are none"),
    diagnosis("exchanged.py", "LEFT * energy.sum()", "energy.sum() * 9", "what nothing foretells is exchanged"),
    diagnosis("exchanged.py", "and bool((turned <= (1 - EACH) * straight).all())", "", "a failed sensor is exchanged"),
    diagnosis("exchanged.py", "LEAST_TELLING = 2", "LEAST_TELLING = 9", "so many tests tell nothing"),
    diagnosis("exchanged.py", "LEAST_K = 0.5", "LEAST_K = 50.0", "no body is another one"),
    diagnosis("weak.py", "window.first and ", "", "what fails in the middle of a test is laid to its start"),
    diagnosis("weak.py", ' and window.test.start_state == "warm"', "", "a cold start is said to be warm"),
    rest("STANDS = 0.05", "STANDS = 0.052", "what an open test moves is said to rest"),
    rest("STANDS = 0.05", "STANDS = 0.048", "what crawls in an open test hides that nothing moves it"),
    rest(" or info.is_mask", "", "when it was measured is said to move the machine"),
    rest("if size > STANDS * most", "if size > 0", "a test in which it rests is said to move it"),
    rest('(None, "near", "related")', '(None, "near", "related", "same")', "what the model has could be missed"),
    rest('heats = info.quantity != "position"', "heats = True", "where an axis stands warms it"),
    diagnosis("artefact.py", "STAYS = 0.5", "STAYS = 0.0", "a spike is a slip"),
    diagnosis("once.py", "and np.array_equal(a, b, equal_nan=True)", "", "two tests of one programme are copies"),
    diagnosis("once.py", "float(np.ptp(a[known])) > 0", "True", "two flat tests are copies"),
    diagnosis("once.py", "LEAST_SAMPLES = 30", "LEAST_SAMPLES = 29", "few samples are a copy"),
    diagnosis("once.py", "in tests[:number] if", "in tests if", "two copies take each other out"),
    diagnosis("once.py", "one.sampled(mine)\n", "np.ones(len(one.t_s), bool)\n", "what was not measured is shared"),
    diagnosis("difference.py", "and len(sides) == 2", "", "one side tells a difference from itself"),
    diagnosis("difference.py", "len(needs) == 2 and ", "", "a bearing is a difference"),
    diagnosis("artefact.py", "WITHIN = 0.7", "WITHIN = 0.0", "where heat begins is a slip"),
    diagnosis("artefact.py", "SEEN = 0.3", "SEEN = 0.01", "what the model does is a slip"),
    diagnosis("artefact.py", "looked[max(0, i - side // 2) : i + side // 2]", "looked[i]", "a shoulder is a slip"),
    diagnosis("sudden.py", "rise - steeper * (t[i + 1]", "rise - 0 * steeper * (t[i + 1]", "bends are slips"),
    diagnosis("artefact.py", "SHARP = 0.4", "SHARP = 0.0", "steep rises are slips"),
    diagnosis("sudden.py", "BACK = 0.35", "BACK = 0.0", "what decays is a slip"),
    diagnosis("sudden.py", "BACK = 0.35", "BACK = 1.0", "a slip that heat takes back is none"),
    diagnosis("sudden.py", "BACK_TO = 0.1", "BACK_TO = 0.5", "what goes back by a half is no slip"),
    diagnosis("sudden.py", "NEARLY_ALL = 0.9", "NEARLY_ALL = 0.1", "a step that takes minutes is said to be at once"),
    diagnosis("artefact.py", "LEAST_UM = 0.5", "LEAST_UM = 0.0", "trifles are slips"),
    diagnosis("commanded.py", '(*COMMANDS, "temperature")', "COMMANDS", "another workpiece is a slip"),
    diagnosis("artefact.py", "windows is not None", "False", "a slip between two windows is none"),
    diagnosis("artefact.py", "<= 2 * windows.step_s", "< 0", "a slip within a window is two"),
    diagnosis("heat_balance.py", "LEAST_SHARE = 0.3", "LEAST_SHARE = 0.2", "a weak temperature moves a clock"),
    diagnosis("heat_balance.py", "BEATS = 4.0", "BEATS = 1.0", "a slow body moves a clock"),
    diagnosis("heat_balance.py", "step_s > UNMOVED_S", "False", "one coarse sample moves a clock"),
    diagnosis(
        "changes.py",
        "nowhere = np.zeros(len(value), dtype=np.bool_)",
        "nowhere = _kept_or_made(_value_held, block, name)[1]",
        "a warm room excuses every slip that nobody saw",
    ),
    diagnosis("changes.py", "max(SUDDEN * usual, LEAST_K)", "np.inf", "a gate on air that a day warms is a slip"),
    diagnosis("changes.py", "SUDDEN, LEAST_K = 4.0, 0.5", "SUDDEN, LEAST_K = 4.0, 0.4", "air of 0.45 K excuses a slip"),
    diagnosis(
        "stated.py", "or not chosen or bool(scored.others)", "or True", "what nobody asked beside the chosen is likely"
    ),
    diagnosis("stated.py", "and (m is not None or reads_as(s, modes) is None)", "", "a lag of a refinement is a cause"),
    diagnosis("heat_balance.py", "LEAST_TELLING = 2", "LEAST_TELLING = 1", "one temperature moves a clock"),
    diagnosis("heat_sums.py", "TWO_HOURS_S, ABOUT_S = 7200.0", "TWO_HOURS_S, ABOUT_S = 0.0", "two hours pass"),
    diagnosis("heat_sums.py", "around[rows])", "around[rows, :0])", "the air moves a clock"),
    diagnosis("logs_compared.py", "MOST_LEFT = 2 / 3", "MOST_LEFT = 1.1", "a log switched on late is moved"),
    diagnosis("logs_compared.py", "MOST_LEFT = 2 / 3", "MOST_LEFT = 0.6", "a wrong clock stays where it is"),
    diagnosis("ends_of_logs.py", "self.late, -self.shift_s", "self.late, self.shift_s", "a late log is moved later"),
    diagnosis("ends_of_logs.py", "tests[0] == tests[1] and", "", "logs of other tests are moved together"),
    diagnosis("judge.py", "(*OUTWEIGHED, *few)", "OUTWEIGHED", "one of two tests shuts the lock"),
    diagnosis("logs_compared.py", "if of.warmed == home:", "if False:", "the right log is moved"),
    diagnosis("logs_compared.py", "DECIDES = 0.15", "DECIDES = 0.13", "a log is moved by a guess"),
    diagnosis("logs_compared.py", "warmed if where_it_is > moved else by", "warmed", "the right log is moved, too"),
    diagnosis("by_heat.py", "if 2 * len(", "if len(", "half of the tests are blamed on the others, by heat"),
    diagnosis("by_heat.py", "if f.of.key == one.key]", "if f]", "one test hides another"),
    diagnosis(
        "heat_balance.py", "MOST_OWN = 0.5", "MOST_OWN = 0.6", "a drive that hardly worked elsewhere moves a clock"
    ),
    diagnosis(
        "heat_sums.py",
        "slice(max(0, -shift), n - over - max(0, shift))",
        "slice(0, n - over - abs(shift))",
        "shifts go one way",
    ),
    diagnosis("heat_balance.py", "MOST_TELL = 0.25", "MOST_TELL = 0.0", "two of fifteen temperatures move a clock"),
    diagnosis("heat_sums.py", "LEAST_LEFT = 0.45", "LEAST_LEFT = 0.3", "what is left of a test moves its clock"),
    diagnosis("heat_balance.py", "telling[usual].mean()", "telling.mean()", "what tells nowhere speaks for a clock"),
    diagnosis("heat_balance.py", "self.share - self.rest < TELLS", "False", "a test in which the machine waits tells"),
    diagnosis("timings.py", "if 2 * len(single) <", "if len(single) <", "half of the tests are blamed on the others"),
    diagnosis(
        "by_commands.py", "float(self.shifts_s[best] - all_s)", "float(self.shifts_s[best])", "a move counts twice"
    ),
    diagnosis("by_commands.py", ") > np.sum(best >", ") < -np.sum(best >", "the clock of all is never told"),
    diagnosis("sides.py", "changes <= 1 or", "True or", "a clock that comes and goes in most tests is moved"),
    diagnosis("sides.py", "(more - less >= APART)", "(more >= less)", "what tells neither way speaks for a clock"),
    diagnosis("logs_compared.py", "told.right - declared", "told.right", "what is declared speaks for the rest"),
    diagnosis("timings.py", "abs(t.shift_s + all_s) <=", "abs(t.shift_s) <=", "all are moved for a part"),
    diagnosis("moves.py", ", left=0.0, right=0.0", "", "held ends pass for measured ones"),
    diagnosis("timings.py", "timing.chance <= CHANCE and", "", "what chance gives moves a clock"),
    diagnosis(
        "by_commands.py", ", float(many ** (-2.0 * max(beyond, 0.0)))", "", "a program that alternates hides a clock"
    ),
    diagnosis(
        "logs_compared.py", "moved - where_it_is >= DECIDES", "False", "the displacement's own log is never late"
    ),
    diagnosis("timings.py", "late &= from_hour_s <= ABOUT_S", "pass", "any long shift is taken for an hour"),
    diagnosis(
        "by_commands.py", "2 * AROUND * step_s) <", "2 * AROUND * np.median(np.diff(t_s))) <", "bursts tell a clock"
    ),
    diagnosis("timings.py", "BEATS = 2.0", "BEATS = 1.0", "a clock that is nearly as good is wrong"),
    diagnosis("windows.py", "LEAST_WINDOWS = 12", "LEAST_WINDOWS = 9", "a few holes are windows"),
    diagnosis("windows.py", "lasts < np.maximum", "lasts < 9 * np.maximum", "holes are windows"),
    diagnosis(
        "changes.py",
        "return suddenly(_kept_or_made(_value_held, block, name)[0], block.t_s, BESIDE + 2)",
        "return np.abs(np.nan_to_num(over_three(_kept_or_made(_value_held, block, name)[0], block.t_s)))",
        "a motor that cools excuses a slip",
    ),
    diagnosis("commanded.py", "COMMAND_S = 600.0", "COMMAND_S = 0.0", "shifts of a late clock are slips"),
    diagnosis("sudden.py", "HOLE_STEPS = 1.6", "HOLE_STEPS = 99.0", "what nobody saw is a slip"),
    diagnosis("changes.py", "COMMANDED = 0.05", "COMMANDED = 0.9", "small commands explain nothing"),
    diagnosis("changes.py", "POWERS = (1, 2)", "POWERS = (1,)", "centrifugal shifts are slips"),
    diagnosis(
        "commanded.py",
        "for way, rows in own.rows.items():",
        "for way, rows in [r for r in own.rows.items() if r[0] != EITHER_WAY]:",
        "what every start and stop does is a slip",
    ),
    diagnosis("commanded.py", "elif quantity == POSITION:", "elif False:", "the growth of a screw is a slip"),
    diagnosis("changes.py", "{WARM: far * warmer}", "{WARM: far}", "so it is as it warms"),
    diagnosis("places_that_tell.py", "windows is not None and", "False and", "no window tells of a screw"),
    diagnosis("places_that_tell.py", "np.diff(place) * (", "np.diff(place) * 0 + (", "a screw that rests moves"),
    diagnosis("changes.py", "and holds(at, c.at)", "", "a column that is warm excuses slips"),
    diagnosis("commanded.py", "AS_WARM = 0.5", "AS_WARM = 0.0", "cold moves tell of a warm screw"),
    diagnosis("commanded.py", "AS_WARM = 0.5", "AS_WARM = 1.5", "a move excuses what none as warm does"),
    diagnosis("changes.py", "STANDS_S = 300.0", "STANDS_S = 60.0", "an axis that never stands moves"),
    diagnosis("changes.py", "STANDS_S = 300.0", "STANDS_S = 900.0", "a short stop is no place"),
    diagnosis("changes.py", "LEAST_MM = 1.0", "LEAST_MM = 0.0", "the noise of a position moves an axis"),
    diagnosis("commanded.py", "if alike >= ALIKE else 0.0", "", "one slip at a move asks for the growth of a screw"),
    diagnosis("places_that_tell.py", "commands.make(name) >= least", "True", "it is asked wherever an axis is logged"),
    diagnosis("of_library.py", "not (alone or ", "not (", "the growth of a screw is never missing"),
    diagnosis(
        "of_library.py", "in self.seen.telling and not", "is not None and not", "a place that tells nothing is a cause"
    ),
    diagnosis("of_library.py", " if role != told_by(effect)]", "]", "a place tells a screw from its guideway"),
    diagnosis("kin.py", "(told_by(effect) is None or ", "(", "a mode of a lag is a cause"),
    diagnosis("refinement.py", "and told_by(effect) is None)", "and True)", "a screw that grows is a mode of nothing"),
    diagnosis(
        "preference.py",
        " or other.candidate.effect.name in refines(best.candidate.effect)",
        "",
        "its place is named where a feed screw does",
    ),
    diagnosis("commanded.py", "FORETOLD = 0.2", "FORETOLD = 0.0", "a pump that cycles excuses every slip"),
    diagnosis("commanded.py", "ALIKE = 0.15", "ALIKE = 0.9", "a shift among others is a slip"),
    diagnosis("commanded.py", "ELSEWHERE_S = 1200.0", "ELSEWHERE_S = 0.0", "a slip excuses itself"),
    diagnosis("changes.py", "every**p", "every", "a fast spindle that slows a little makes slips"),
    diagnosis("changes.py", "hole[:-1] |= old[1:]", "pass", "what a command did last before a hole is a slip"),
    diagnosis("commanded.py", "bool(own.hole[i]) and", "False and", "what nobody logged is a slip"),
    Mutant(
        "thermodata/calibration/tread.py",
        "max(FINER, held - FINER)",
        "held",
        "half a tread passes for one",
        ("tests/calibration/test_tread.py",),
    ),
    Mutant(
        "thermodata/calibration/quality/sudden/step.py",
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
    diagnosis("to_find.py", "ENOUGH_TESTS = 8", "ENOUGH_TESTS = 99", "more of the same is advised for ever"),
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
    heat("goes_with.py", " and switched else", " else", "what the model left rules its cause out"),
    heat("goes_with.py", "HOURS_REST = 0.5", "HOURS_REST = 0.15", "hours of a source are silent while it fades"),
    heat("goes_with.py", "STRONG, WEAK = 0.5, 0.15", "STRONG, WEAK = 0.4, 0.2", "tests are strong and absent too soon"),
    heat(
        "goes_with.py",
        "DAYS, MOST_DAYS, MOSTLY_ON = 3, 0.8, 0.6",
        "DAYS, MOST_DAYS, MOSTLY_ON = 2, 0.5, 0.9",
        "any hour",
    ),
    heat("first_seen.py", "SURE = 0.8", "SURE = 0.5", "a coin's direction is told as sure"),
]
