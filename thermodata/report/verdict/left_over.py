"""What a model leaves, in words: on left-out tests, beside noise, and as it is fitted."""

from __future__ import annotations

from math import sqrt
from typing import TYPE_CHECKING

from thermodata.report.verdict.candidate_errors import but_for_one_test, left_out_tests
from thermodata.report.verdict.could_hide import may_act_instead
from thermodata.report.verdict.refined import named
from thermodata.report.verdict.twins import named_twins
from thermodata.report.words.numbers import LITTLE, duration, number, percent
from thermodata.schema.agreed.begins_on import begins_on
from thermodata.schema.agreed.limits import NOISY, OF_NOTHING
from thermodata.schema.answers.slip_ids import slip_ids

if TYPE_CHECKING:
    from thermodata.schema.answers.diagnosis import Diagnosis

MORE = 1.5
"""An error of the model as it stands of so many times that of its effects free to act otherwise is told."""
OTHERWISE = 3.0
"""An error of so many times that on left-out tests says that the model's effects act otherwise than it has them."""

STANDS_OUT = 2.0
"""An error in one window of so many times that on left-out tests is told beside it: a mean over all tests hides it."""
LONGER = 1.01
"""Times an averaging time: what is no longer is the same one."""
A_FIFTH = 0.2
"""What leaves this share of the response may hide heat that nobody logs, whatever else leaves as much."""
AS_SCORED = " (of calibration about levels fitted to them, others from their first samples on)"


def left_over(found: Diagnosis) -> str:
    """What is left where nothing is missing: noise, or what is slower than noise and yet too little to ask about."""
    if found.rmse_um is None:
        return "too little is left to ask about"
    left, as_fitted = f"{number(found.rmse_um)} um are left on {left_out_tests(found.candidates)}", otherwise(found)
    if found.noise_um is None:
        return f"{left}, too little to ask about{as_fitted}"
    noise = f"noise ({number(found.noise_um)} um{_between(found)})"
    if found.rmse_um <= NOISY * noise_of_left_out(found):
        return f"{left}, and they are {noise}{as_fitted}"
    if found.rmse_um <= NOISY * found.noise_um:
        return (
            f"{left}: as little as noise of shorter means, but more than white noise leaves in theirs "
            f"({number(found.noise_um)} um{_between(found)}){as_fitted}"
        )
    unseen = _unseen_heat(found.rmse_um, found.response_um)
    if unseen:
        share = percent(found.rmse_um / (found.response_um or 1.0))
        return f"{left}, {share} of the response, more than {noise}, and {unseen}{as_fitted}"
    return f"{left}, more than {noise}, but no more than models leave of a machine that lacks nothing{as_fitted}"


def not_logged(found: Diagnosis) -> str:
    """'that no logged channel reads its cause is 57 % probable'; '' where nobody knows. The share counts what was asked
    for."""
    if found.unknown is None or found.unknown.not_logged is None:
        return ""
    channel = "no logged channel that was asked about" if found.unknown.by_name else "no logged channel"
    return f"that {channel} reads its cause is {percent(found.unknown.not_logged)} probable"


def most_left(found: Diagnosis) -> str:
    """'; most in t8, up to 4.73 um over 3.0 h as it is fitted': the weak spot of the largest error, where that is far
    more than what all left-out tests leave; else ''."""
    spot = max(found.weak_spots, key=lambda s: s.rmse_um, default=None)
    if spot is None or found.rmse_um is None or spot.rmse_um <= STANDS_OUT * found.rmse_um:
        return ""
    several = len({s.campaign for s in found.weak_spots}) > 1
    test = f"{spot.campaign}/{spot.test}" if several else spot.test
    return f"; most in {test}, up to {number(spot.rmse_um)} um over {duration(spot.to_s - spot.from_s)} as it is fitted"


def in_parts(found: Diagnosis) -> str:
    """'2 open tests are too few to leave one out, so 4 parts of them are, each with a level of its own: ...'; '' where
    tests are."""
    parts = next((c.left_out for c in found.candidates if c.left_out), [])
    tests = len({(p.campaign, p.test) for p in parts})
    if tests == len(parts):
        return ""
    few = "1 open test is" if tests == 1 else f"{tests} open tests are"
    return (
        f"{few} too few to leave one out, so {len(parts)} parts of {'it' if tests == 1 else 'them'} are, each with a "
        "level of its own: how a course goes on within hours, not how far a whole test drifts"
    )


def noise_of_left_out(found: Diagnosis) -> float:
    """White noise in the means that left-out tests are compared by, in the response's unit; 0 where none is known."""
    over, compared, noise = found.noise_over_s, found.left_out_over_s, found.noise_um or 0.0
    return noise * sqrt(over / compared) if over and compared and compared > LONGER * over else noise


def as_of_nothing(found: Diagnosis) -> str:
    """'models of machines that lack nothing leave as much (9 % of the response)'; '' where they leave less, or what is
    left is not known."""
    left, response = found.rmse_um, found.response_um
    if left is None or not response or left > OF_NOTHING * response:
        return ""
    return f"models of machines that lack nothing leave as much ({percent(left / response)} of the response)"


def stays(found: Diagnosis) -> str:
    """'3.77 um stay then, 30 % of the response, ...': what refinements leave, where that is more than is left alone;
    else ''."""
    from thermodata.diagnosis.claims.measure import FLOOR_SHARE

    left, response = found.named_rmse_um, found.response_um
    if left is None or not response or left > (found.rmse_um or 0.0):
        return ""
    if left <= max(FLOOR_SHARE * response, NOISY * noise_of_left_out(found)):
        return ""
    said = f"{number(left)} um stay then, {percent(left / response)} of the response"
    if found.weak_spots:
        worst = found.weak_spots[0]
        said += f" (the model fails most in {worst.test}, from {duration(worst.from_s)} to {duration(worst.to_s)})"
    return ", ".join(filter(None, [said, _unseen_heat(left, response)]))


def _unseen_heat(left: float, response: float | None) -> str:
    """'as much as is left of machines that lack nothing, and heat of what nobody logs may be in it' of a fifth of the
    response and more; '' of less."""
    from thermodata.diagnosis.claims.measure import GOOD_SHARE

    if not response or left < A_FIFTH * response:
        return ""
    if left > GOOD_SHARE * response:
        return "more than is mostly left of a machine that lacks nothing: heat of what nobody logs may be in it"
    return "as much as models leave of a machine that lacks nothing, and heat of what nobody logs may be in it"


def otherwise(found: Diagnosis) -> str:
    """What the model itself leaves, where that is much more than with its effects free to act otherwise, or is the
    level of tests that begin with something on; else ''."""
    left, fitted = found.rmse_um, found.fitted_rmse_um
    if found.modelled_rmse_um is not None:
        return _as_modelled(found, found.modelled_rmse_um)
    if left is None or fitted is None:
        return ""
    # what the levels of such tests do not make
    other = fitted * sqrt(max(0.0, 1.0 - sum(one.of_squares for one in found.started_on)))
    if other < OTHERWISE * left or other <= NOISY * (found.noise_um or 0.0):
        return of_levels(found)
    instead = may_act_instead(found)
    slips = slip_ids(found)
    if slips:
        return (
            f"; that is beside the steps of the probe: as it is fitted the model leaves {number(fitted)} um on the "
            f"open tests{AS_SCORED}, for its fit has these steps: thermodata add {found.model[:8]} {' '.join(slips)}"
            f"{of_levels(found)}"
        )
    return (
        f"; that is with its effects free to act otherwise than by one lag each: as it is fitted the model leaves "
        f"{number(fitted)} um on the open tests{AS_SCORED}, so fit it "
        "to all of them, or add a second lag of what it has"
        f"{f'; or {instead}' if instead else ''}{of_levels(found, told=True)}"
    )


def _as_modelled(found: Diagnosis, modelled: float) -> str:
    """The same by left-out tests, with what may hide behind its effects."""
    told = any(c.as_modelled for c in found.candidates)
    if told or modelled <= max(MORE * (found.rmse_um or 0.0), NOISY * noise_of_left_out(found)):
        return of_levels(found)
    instead = may_act_instead(found)
    return (
        "; that is with its effects free to act otherwise than by one lag each: as the model has them it leaves "
        f"{number(modelled)} um, and no effect that is logged takes 30 % of that away in most tests alike"
        f"{f'; or {instead}' if instead else ''}{of_levels(found)}"
    )


def offered(found: Diagnosis) -> str:
    """'as the model has its effects, one lag each, it leaves 1.2 um ...': what is offered for the model as it
    stands, and what may hide behind its effects; '' where nothing is."""
    one = next((c for c in found.candidates if c.as_modelled), None)
    if one is None:
        return ""
    instead = may_act_instead(found, but=[one.id])
    more = f"; or {instead}" if instead else ""
    left, free = found.modelled_rmse_um, found.rmse_um
    far = left is not None and free is not None and left >= OTHERWISE * free
    freed = f" ({number(free)} um with these free to act otherwise, as errors of a claim are told)" if far else ""
    but = but_for_one_test([one], left).removeprefix(", and ") if left is not None else ""
    return (
        f"as the model has its effects, one lag each, it leaves {number(left)} um on {left_out_tests([one])}"
        f"{freed}, and {number(one.rmse_um_after)} um with {named(one)}{f' ({but})' if but else ''}{named_twins(one)}, "
        f"another mode of them or a cause that they hide: add it, thermodata add {found.model[:8]} {one.rank}{more}"
    )


def of_levels(found: Diagnosis, told: bool = False) -> str:
    """That the model as it is fitted errs by the level of tests that begin with something on; '' where none does, or
    they make little of its error. told: whether that error was."""
    share = sum(one.of_squares for one in found.started_on)
    if share <= LITTLE:
        return ""
    tests = [
        begins_on(one.test, one.channels or dict([one.on.split(" at ", 1)]), one.rmse_um, one.left_um)
        for one in found.started_on
        if one.of_squares > LITTLE * share
    ]
    error = (
        ""
        if told
        else f"as it is fitted the model leaves {number(found.fitted_rmse_um)} um on the open tests{AS_SCORED}, and "
    )
    return (
        f"; {error}{percent(share)} of the square of that error is the level of tests that may have been on before: "
        f"{', and '.join(tests)}; left-out tests have their level free. thermodata fit says what to do (on_at_start)"
    )


def _between(found: Diagnosis) -> str:
    """', by which a mean of 60 s scatters by chance, 0.0194 um a mean of 2 min, as left-out tests are compared by':
    white noise is less in longer means, and an error on left-out tests may be below that of shorter ones."""
    over, compared = found.noise_over_s, found.left_out_over_s
    if not over:
        return ""
    said = f", by which a mean of {duration(over)} scatters by chance"
    if found.noise_um is None or compared is None or compared <= LONGER * over:
        return said
    there = number(noise_of_left_out(found))
    return f"{said}, {there} um a mean of {duration(compared)}, as left-out tests are compared by"


def on_left_out(found: Diagnosis) -> str:
    """' on left-out tests (1.4 um of the response's 5.1)'. A left-out test is foretold by a model that the others
    fitted, so the error may be larger than the response itself: then it says so."""
    left, response, tests = found.rmse_um, found.response_um, left_out_tests(found.candidates)
    if left is None:
        return ""
    if response is None:
        return f" on {tests} ({number(left)} um)"
    if left > response:
        return (
            f" on {tests} ({number(left)} um, more than the response's {number(response)}: fitted to the other "
            "tests, the model foretells a test worse than none would)"
        )
    return f" on {tests} ({number(left)} um of the response's {number(response)})"


def noise_words(found: Diagnosis) -> str:
    """'noise 0.0563 um, by which a mean of 60 s scatters by chance'; '' where none is known."""
    return "" if found.noise_um is None else f"noise {number(found.noise_um)} um{_between(found)}"
